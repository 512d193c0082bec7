"""session_recorder_node: every topic of the contract into a bag."""
