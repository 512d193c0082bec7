"""The Franka Emika Panda: limits, gains and rigid-body model."""
