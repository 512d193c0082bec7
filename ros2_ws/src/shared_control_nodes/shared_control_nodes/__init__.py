"""Light nodes of the graph: the simulated tutor, the views, the bridge to a real Panda."""
