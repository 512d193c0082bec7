#!/usr/bin/env bash
# colcon build of the workspace and colcon test, with colcon from PyPI and no ROS install.
# PYTHON names an interpreter that has the project's requirements (default: .venv). Arguments name the packages to
# test; all of them when there are none.
set -euo pipefail
cd "$(dirname "$0")/.."
python=$(realpath --no-symlinks "${PYTHON:-.venv/bin/python}")
cd ros2_ws
"$python" -m colcon build --base-paths src --event-handlers console_direct- 2> log.txt || { cat log.txt; exit 1; }
rm -f log.txt
packages=("${@/#/src/}")
"$python" -m colcon test --event-handlers console_direct+ --return-code-on-test-failure \
    --paths "${packages[@]:-src/*}"
"$python" -m colcon test-result --all
