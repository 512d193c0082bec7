"""The parameter that says which robot a node has to do with."""

from rclpy.node import Node
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import load_robot

from .parameters import ParameterError, declare


def declare_robot(node: Node) -> RobotSpec:
    """Declare the parameter ``robot`` and read the robot it names.

    Raises:
        ParameterError: there is no such robot, or its file cannot be used.
    """
    name = declare(node, 'robot', 'panda', "The robot: a name, or the path of a robot's YAML file.")
    try:
        return load_robot(name)
    except ValueError as error:
        raise ParameterError(f"parameter 'robot': {error}") from error
