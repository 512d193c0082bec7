#!/usr/bin/env bash
# colcon build and colcon test of the workspace, with colcon from PyPI and no ROS install.
# PYTHON names an interpreter that has the project's requirements (default: .venv).
set -euo pipefail
cd "$(dirname "$0")/.."
python=$(realpath --no-symlinks "${PYTHON:-.venv/bin/python}")
colcon=("$python" -m colcon)
cd ros2_ws
"${colcon[@]}" --log-base log build --base-paths src --event-handlers console_cohesion- --python-testing pytest 2>/dev/null \
    || "${colcon[@]}" --log-base log build --base-paths src
"${colcon[@]}" --log-base log test --base-paths src --return-code-on-test-failure --event-handlers console_direct+
"${colcon[@]}" test-result --all
