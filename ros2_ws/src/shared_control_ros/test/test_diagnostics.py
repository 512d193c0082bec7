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

"""What a node reports of itself."""

from dataclasses import replace

import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from shared_control_ros import contract
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Polled
from shared_control_ros.stamps import set_ns, to_ns

PERIOD_NS = 20_000_000


@pytest.fixture
def node(observer):
    node = Node('reporting', context=observer.context, parameter_overrides=[Parameter('use_sim_time', value=True)])
    yield node
    node.destroy_node()


def test_stamps_are_simulation_time_though_the_node_serves_no_clock(observer, node):
    """A loop that takes its messages by hand, as the tutor's and the agent's do, never spins."""
    clock, heard = observer.publisher(contract.CLOCK), observer.listen(contract.DIAGNOSTICS)
    diagnostics = Diagnostics(node, 0.02)
    observer.spin(clock.get_subscription_count)
    message, now_ns = Clock(), 10**18

    def reported():
        nonlocal now_ns
        now_ns += PERIOD_NS
        set_ns(message.clock, now_ns)
        clock.publish(message)
        diagnostics.publish({})
        return len(heard) > 20 and to_ns(heard[-1].header.stamp) >= 10**18

    observer.spin(reported)
    late = now_ns - to_ns(heard[-1].header.stamp)
    assert late < 25 * PERIOD_NS, f'{late * 1e-9} s late'


def test_a_publisher_that_cannot_be_heard_is_named(observer, node, capfd):
    """As rclpy does by its executor, which passes over what is polled."""
    Polled(node, contract.BALL)
    camera = observer.publisher(replace(contract.BALL, qos=contract.qos_unreliable()))
    diagnostics = Diagnostics(node, 0.02)
    said = ''

    def warned():
        nonlocal said
        diagnostics.publish({})
        said += capfd.readouterr().err
        return "'ball', offering incompatible QoS. No messages will be received from it" in said

    observer.spin(warned)
    diagnostics.publish({})
    assert 'incompatible' not in capfd.readouterr().err, 'once'
    observer.node.destroy_publisher(camera)
