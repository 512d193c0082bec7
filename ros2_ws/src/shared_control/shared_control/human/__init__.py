"""People at the keys, real and simulated."""
