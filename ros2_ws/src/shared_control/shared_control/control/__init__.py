"""From the two moments to joint torques."""
