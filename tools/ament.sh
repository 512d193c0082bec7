#!/usr/bin/env bash
# The linters of a ROS machine with this project's configuration; those to run are named (PyPI has flake8 and pep257):
#   tools/ament.sh flake8 pep257 copyright xmllint
set -euo pipefail
cd "$(dirname "$0")/.."
PATH="$PWD/.venv/bin:$PATH"
said=$(mktemp)
trap 'rm -f "$said"' EXIT
for linter in "$@"; do
    case $linter in
        flake8) arguments=(--config ament_flake8.ini ros2_ws/src) ;;
        # Docstrings as Google writes them. What has one and how it ends is for ruff to say (D1, D415); an argument that its
        # name explains is not listed (D417); D208, D402 and D403 take examples, notes and names (PPO) for faults.
        pep257) arguments=(--convention google --add-ignore D100 D101 D102 D103 D104 D105 D106 D107 D208 D402 D403 D415 D417
                           -- ros2_ws/src) ;;
        copyright | xmllint) arguments=(ros2_ws/src) ;;
        *) echo "error: no linter ament_$linter is set up here" >&2; exit 2 ;;
    esac
    # They name every file that is in order, too.
    "ament_$linter" "${arguments[@]}" > "$said" 2>&1 || { grep --invert-match --extended-regexp "^(checking|\* )" "$said"; exit 1; }
    echo "ament_$linter: no problems"
done
