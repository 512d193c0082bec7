#!/usr/bin/env bash
# colcon build and colcon test of the workspace, with colcon from PyPI and no ROS install.
# PYTHON names an interpreter that has the project's requirements (default: .venv). Arguments go to colcon test,
# for instance --packages-select torque_ctrl_node.
set -euo pipefail
cd "$(dirname "$0")/.."
python=$(realpath --no-symlinks "${PYTHON:-.venv/bin/python}")
cd ros2_ws
"$python" -m colcon build --base-paths src --event-handlers console_direct- 2> log.txt || { cat log.txt; exit 1; }
rm -f log.txt
"$python" -m colcon test --base-paths src --return-code-on-test-failure --event-handlers console_direct+ "$@"
"$python" -m colcon test-result --all
