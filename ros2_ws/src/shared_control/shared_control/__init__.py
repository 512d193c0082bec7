"""ROS-free library of shared-control training: robot, controller, world, task, people, learning."""
