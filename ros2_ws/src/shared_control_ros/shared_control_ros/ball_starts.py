"""Where a simulated robot drops the ball: the parameter ``seed``, which a learner sets before each episode."""

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control.task.balance import BallStarts

from .parameters import declare


def declare_ball_starts(node: Node, description: str) -> tuple[BallStarts, int]:
    """Declare ``seed``; the ball starts that begin anew whenever it is set, and its first value."""
    seed = declare(node, 'seed', 0, description, minimum=0, maximum=2**31 - 1, read_only=False)
    starts = BallStarts(seed)

    def on_parameters(parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'seed':
                starts.seed(parameter.value)
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(on_parameters)
    return starts, seed
