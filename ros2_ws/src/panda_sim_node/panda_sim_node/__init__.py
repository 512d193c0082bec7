"""Simulator of the Panda with tray and ball as a ROS 2 node, and a mock of the real one."""
