"""What viewers (RViz, Foxglove) need beside the topics of the contract."""
