"""The physical world, simulated."""
