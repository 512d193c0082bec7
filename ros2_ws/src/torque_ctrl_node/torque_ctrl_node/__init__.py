"""1 kHz computed-torque controller that sums the moments of human and agent."""
