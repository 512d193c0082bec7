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

"""Fixtures of this folder."""

import pytest
from rclpy.node import Node
from shared_control_ros.fast_loop import Background
from shared_control_testing.nodes import *  # noqa: F403


@pytest.fixture
def agent(observer):
    """A node in the place of the agent's, and what serves its requests; ended with the test."""
    node = Node('agent', context=observer.context)
    background = Background(node)
    yield node, background
    background.close()
    node.destroy_node()
