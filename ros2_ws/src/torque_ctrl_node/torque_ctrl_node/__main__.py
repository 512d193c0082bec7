"""The command ``torque_ctrl_node``."""

from shared_control_ros.node_command import run_node


def main() -> int:
    """Entry point."""
    return run_node('torque_ctrl_node.node')


if __name__ == '__main__':
    raise SystemExit(main())
