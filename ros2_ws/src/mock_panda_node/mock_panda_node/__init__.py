"""A mock Panda: the topics and the behaviour of an effort-controlled one, in simulation."""
