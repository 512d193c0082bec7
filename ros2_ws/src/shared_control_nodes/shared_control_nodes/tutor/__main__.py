"""The command ``sim_tutor_node``."""

from shared_control_ros.node_command import run_node


def main() -> int:
    """Entry point."""
    return run_node('shared_control_nodes.tutor.node')


if __name__ == '__main__':
    raise SystemExit(main())
