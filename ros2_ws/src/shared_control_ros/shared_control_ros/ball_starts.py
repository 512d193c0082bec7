"""Where a simulated robot drops the ball: the parameter ``seed``, which a learner sets before each episode."""

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control.tasks.task import BallStarts


def follow_seed(node: Node, starts: BallStarts) -> None:
    """Begin ``starts`` anew whenever the node's parameter ``seed`` is set."""
    def on_parameters(parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'seed':
                starts.seed(parameter.value)
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(on_parameters)
