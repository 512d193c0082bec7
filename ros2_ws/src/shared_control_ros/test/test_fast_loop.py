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

"""Receiving by hand, beside an executor that serves the rest."""

import subprocess
import sys
import time

from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background, Polled, follow_clock
from shared_control_ros.stamps import set_ns
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger


def test_a_polled_subscription_gives_the_newest_and_waits_for_the_next(observer):
    publisher = observer.publisher(contract.EFFORT_COMMANDS)
    polled = Polled(observer.node, contract.EFFORT_COMMANDS)
    observer.spin(publisher.get_subscription_count)
    assert polled.take() is None
    while polled.wait(0.1) is None:  # until discovery is complete on both sides
        publisher.publish(Float64MultiArray(data=[0.0]))
    for value in (1.0, 2.0, 3.0):
        publisher.publish(Float64MultiArray(data=[value]))
    time.sleep(0.2)
    observer.spin_for(0.1)  # an executor leaves it alone
    assert list(polled.take().data) == [3.0]
    started = time.monotonic()
    assert polled.wait(0.1) is None
    assert time.monotonic() - started >= 0.09


def test_raw_messages_are_bytes(observer):
    publisher = observer.publisher(contract.EFFORT_COMMANDS)
    polled = Polled(observer.node, contract.EFFORT_COMMANDS, raw=True)
    message = None
    while message is None:
        publisher.publish(Float64MultiArray(data=[1.5]))
        message = polled.wait(0.1)
    assert isinstance(message, bytes)


def test_background_serves_when_polled(observer):
    server = Node('server', context=observer.context)
    server.create_service(Trigger, '~/hello', lambda _, response: Trigger.Response(success=True))
    background = Background(server)
    client = observer.node.create_client(Trigger, 'server/hello')
    observer.spin(client.service_is_ready)
    future = client.call_async(Trigger.Request())

    def answered():
        background.poll()
        return future.done()

    observer.spin(answered)
    assert future.result().success
    background.close()
    server.destroy_node()


def test_a_negative_clock_is_dropped_and_named(observer, capfd):
    node = Node('follower', context=observer.context, parameter_overrides=[Parameter('use_sim_time', value=True)])
    background = Background(node)
    publisher, message = observer.publisher(contract.CLOCK), Clock()
    observer.spin(publisher.get_subscription_count)

    def heard(serve):
        """Whether the clock has gone on by a second, after a time that it cannot have shown."""
        until = node.get_clock().now().nanoseconds + 10**9
        said = ''
        for _ in range(100):
            for now_ns in (-10**9, until):
                set_ns(message.clock, now_ns)
                publisher.publish(message)
                time.sleep(0.02)
                serve()
            said += capfd.readouterr().err
            if node.get_clock().now().nanoseconds == until and '/clock: its stamp is -1.000 s' in said:
                return True
        return False

    assert heard(lambda: background.spin_once(0.1)), 'by the executor'
    time.sleep(1.0)  # an error is said once a second
    assert heard(lambda: follow_clock(node)), 'by hand'
    background.close()
    node.destroy_node()


def test_a_loop_is_not_collected_from_and_has_timers_that_are_on_time():
    code = ('import gc; from shared_control_ros.real_time import keep_loop_on_time; keep_loop_on_time(); '
            'print(gc.isenabled(), open("/proc/self/timerslack_ns").read().strip())')
    said = subprocess.run([sys.executable, '-c', code], check=True, capture_output=True, text=True).stdout
    assert said.split() == ['False', '1']
