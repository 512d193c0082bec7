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
