"""Bridge between a real Panda (panda-python, libfranka) and the graph."""
