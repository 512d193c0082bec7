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

"""The simulated robot under its controller, and nobody to teach it."""

from launch import LaunchDescription
from shared_control_bringup.graph import BESIDE_A_SIMULATOR
from shared_control_bringup.launching import (
    common_arguments,
    end_with,
    environment,
    graph_node,
    in_namespace,
    view,
    view_argument,
)


def generate_launch_description() -> LaunchDescription:
    """See the module."""
    return LaunchDescription([
        *common_arguments(),
        view_argument(),
        *environment(),
        in_namespace([
            graph_node('torque_ctrl_node', parameters=BESIDE_A_SIMULATOR, output='screen'),
            graph_node('panda_sim_node', output='screen'),
        ]),
        view(),
        end_with(),
    ])
