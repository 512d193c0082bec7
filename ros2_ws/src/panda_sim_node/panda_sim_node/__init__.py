"""PyBullet simulator of the Panda with tray and ball as a ROS 2 node."""
