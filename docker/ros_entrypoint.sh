#!/usr/bin/env bash
# Runs a command with ROS, the workspace and its nodes' names at hand. A node that is started by its name, and not by
# `ros2 run`, gets the container's signals itself.
set -e
source /opt/ros/jazzy/setup.bash
source /shared-control/ros2_ws/install/local_setup.bash
for folder in /shared-control/ros2_ws/install/lib/*_node /shared-control/ros2_ws/install/lib/shared_control; do
    PATH=$folder:$PATH
done
exec "$@"
