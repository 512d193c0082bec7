# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Where a simulated robot drops the ball: the parameter ``seed``, which a learner sets before each episode."""

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from shared_control.tasks.task import BallStarts

from .contract import SEED_SERVICE


def follow_seed(node: Node, starts: BallStarts) -> None:
    """Begin ``starts`` anew whenever the node's parameter ``seed`` is set, by its own services or the simulator's.

    The service ``simulator/set_parameters`` takes that one parameter, so that a learner need not know the node's name.
    """
    def on_parameters(parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'seed':
                starts.seed(parameter.value)
        return SetParametersResult(successful=True)

    def on_request(request: SetParameters.Request, response: SetParameters.Response) -> SetParameters.Response:
        response.results = [
            node.set_parameters([Parameter.from_parameter_msg(parameter)])[0] if parameter.name == 'seed' else
            SetParametersResult(successful=False, reason=f'{SEED_SERVICE} takes seed alone, not {parameter.name!r}')
            for parameter in request.parameters]
        return response

    node.add_on_set_parameters_callback(on_parameters)
    node.create_service(SetParameters, SEED_SERVICE, on_request)
