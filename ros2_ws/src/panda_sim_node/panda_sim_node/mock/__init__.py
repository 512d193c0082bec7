"""A mock of a real Panda."""
