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

"""The running node over DDS, without a terminal."""

import signal
import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Joy
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from std_msgs.msg import Header
from teleop_key_node.shared_names import SharedNames


def test_presses_of_several_sources_add_up(graph, start):
    process = start('source_timeout:=10.0')
    graph.press(1, 0, 0)
    graph.expect(5.0)
    for _ in range(5):
        graph.press(1, 0, 0)  # still held: no press
    graph.hold(5.0, 0.1)
    graph.press(1, 0, 0, source='page')
    graph.expect(10.0)
    for source in ('page', 'test'):
        graph.press(0, 0, 0, source=source)
        graph.press(1, 0, 0, source=source)
    graph.hold(10.0, 0.1)  # the limit
    graph.press(0, 1, 0)
    graph.expect(5.0)
    graph.press(0, 0, 1)
    graph.expect(0.0)
    graph.press(0, 1, 0)
    graph.expect(-5.0)
    graph.press()  # nobody is there any more
    graph.expect(0.0)

    received, began = graph.received, time.monotonic()
    graph.hold(0.0, 1.0)
    rate = (graph.received - received) / (time.monotonic() - began)
    assert 25.0 < rate < 60.0, 'zero is published, too'
    assert process.stop() == 0
    assert 'no terminal (/dev/tty' in process.output()


def test_bad_messages_are_dropped_and_named(graph, start):
    process = start('screen:=off', 'source_timeout:=10.0')
    graph.press(1, 0, 0)
    graph.expect(5.0)
    graph.press(1, 0, source='short')
    time.sleep(1.1)  # errors are throttled
    graph.press(0, 7, 0, source='odd')
    graph.press(0, 1, 0)
    graph.expect(0.0)
    process.stop()
    output = process.output()
    assert "'short' on /human/keys: expected 3 buttons (left, right, space) or more, got 2" in output
    assert "'odd' on /human/keys: expected buttons of 0 or 1 (left, right, space, up, down), got [0, 7, 0]" in output


def test_a_silent_source_takes_its_moment_with_it(graph, start):
    start('screen:=off')
    graph.press(0, 1, 0)
    graph.expect(-5.0)
    for _ in range(7):
        time.sleep(0.1)
        graph.press(0, 0, 0)  # repeats its state: it is there
    assert graph.listen() == -5.0
    graph.expect(0.0)


def test_keys_rest_unless_the_robot_is_taught_and_time_goes_on(graph, start):
    start('screen:=off', 'source_timeout:=10.0')
    graph.begin('teach', episode=1)
    time.sleep(0.2)
    graph.press(1, 0, 0)
    graph.expect(5.0)
    graph.begin('learn')
    graph.expect(0.0)
    graph.press(0, 0, 0)
    graph.press(1, 0, 0)
    graph.hold(0.0, 0.15)
    graph.begin('teach', episode=2)
    graph.press(1, 0, 0)  # held since before: no press
    graph.hold(0.0, 0.15)
    graph.press(0, 1, 0)
    graph.expect(-5.0)
    graph.begin('teach', episode=3)
    graph.expect(0.0)

    reports = graph.publisher(contract.DIAGNOSTICS)
    graph.until(lambda: reports.get_subscription_count() == 1, 'the node hears the simulator')

    def report(**values):
        status = DiagnosticStatus(values=[KeyValue(key=key, value=str(value)) for key, value in values.items()])
        reports.publish(DiagnosticArray(status=[DiagnosticStatus(), status]))

    def expect_zero_until(**goes_on):
        for down in (0, 1, 0):
            graph.press(down, 0, 0)
        for values in (stands, goes_on):
            report(**values)
            received = graph.received
            graph.until(lambda before=received: graph.listen() == 0.0 and graph.received > before + 10, 'ten zeros')
    runs, starts = {'paused': False}, {'emergency_stop': False, 'enabled': False, 'enables_itself': True}
    for stands, goes_on in (
            ({'paused': True}, runs),
            ({'emergency_stop': True, 'enabled': False, 'enables_itself': False}, starts | {'enabled': True}),
            ({'emergency_stop': False, 'enabled': False, 'enables_itself': False}, starts)):
        graph.press(1, 0, 0)
        graph.expect(5.0)
        report(**stands)
        graph.expect(0.0)
        expect_zero_until(**goes_on)
    graph.press(1, 0, 0)
    graph.expect(5.0)


def test_a_gamepad_counts_as_its_driver_publishes_it(graph, start):
    pad = graph.publisher(contract.JOY)

    def send(*axes, buttons=(0,) * 8, name='joy'):
        message = Joy(axes=axes, buttons=buttons)
        message.header.frame_id = name
        pad.publish(message)
    process = start('screen:=off', 'joy_axes:=[3, -1]', 'joy_scale:=[-1.0, 1.0]', 'joy_buttons:=[6, 5, 7, -1, -1]',
                    'dead_band:=0.25', 'source_timeout:=3.0', 'moment_limit:=10.0', 'keystroke:=4.0')
    graph.until(lambda: pad.get_subscription_count() == 1, 'the node')
    send(1.0, 1.0, 1.0, 0.15)
    graph.until(lambda: graph.listen() == 0.0, 'the first moment')
    send(0.0, 0.0, 0.0, -0.625)
    graph.expect(5.0)
    send(0.0, 0.0, 0.0, 1.0)
    graph.expect(-10.0)
    send(0.0, 0.0, 0.0, 0.1, buttons=(1, 1, 1, 1, 1, 0, 1, 0))
    graph.expect(4.0)
    joys = []
    while (joy := graph.joys.take()) is not None:
        joys.append(joy)
    assert {joy.header.frame_id for joy in joys} == {'joy'}
    assert list(joys[-1].buttons) == [1, 0, 0, 0, 0, 0, 1, 0] and list(joys[-1].axes)[1] == 0.0
    pad.publish(Joy(header=Header(frame_id='joy')))  # its driver leaves
    graph.expect(0.0)
    send(0.0, 0.0, 0.0, -1.0, name='terminal')  # a driver that takes the name of a source of ours
    graph.expect(10.0)
    graph.expect(0.0)  # unplugged
    process.stop()
    output = process.output()
    assert "'joy' on /joy: 4 axes, 8 buttons; joy_axes and joy_buttons say which of them count" in output
    assert "'joy' fell silent" in output


@pytest.mark.parametrize('topic', [contract.JOY, contract.KEYS])
def test_two_publishers_of_one_name_do_not_press_a_held_button_again_and_again(graph, start, topic):
    """One holds the left button, the other reports that nothing is held."""
    publishers = graph.publisher(topic), graph.publisher(topic)

    def send(held):
        for publisher, buttons in zip(publishers, ((held, 0, 0), (0, 0, 0)), strict=True):
            message = Joy(buttons=buttons, axes=(0.0, 0.0))
            message.header.frame_id = 'pad'
            publisher.publish(message)
    process = start('screen:=off', 'keystroke:=1.0', 'moment_limit:=10.0')
    graph.until(lambda: all(publisher.get_subscription_count() for publisher in publishers), 'the node')
    largest = 0.0
    for _ in range(60):
        send(1)
        time.sleep(0.02)
        largest = max(largest, graph.listen())
    assert largest < 5.0
    graph.expect(0.0)
    process.stop()
    assert f"two publishers call themselves 'pad' on /{topic.name}" in process.output()


def test_a_publisher_alone_counts_and_so_do_two_of_different_names(graph, start):
    first, second = graph.publisher(contract.KEYS), graph.publisher(contract.KEYS)
    start('screen:=off', 'keystroke:=1.0', 'moment_limit:=10.0', 'source_timeout:=5.0')
    graph.until(lambda: all(publisher.get_subscription_count() for publisher in (first, second)), 'the node')
    for _ in range(3):
        for publisher, name in ((first, 'left hand'), (second, 'right hand')):
            for down in (1, 0):
                message = Joy(buttons=(down, 0, 0))
                message.header.frame_id = name
                publisher.publish(message)
    graph.expect(6.0)


def test_a_publisher_that_is_started_anew_shares_no_name():
    names = SharedNames()
    heard = [*range(500, 520), *range(1, 20)]
    assert not any(names.is_shared('pad', number, 0.1 * at) for at, number in enumerate(heard))
    mixed = [number for both in zip(range(20, 40), range(1, 21), strict=True) for number in both]
    found = [names.is_shared('pad', number, 4.0 + 0.05 * at) for at, number in enumerate(mixed)]
    assert not any(found[:3]) and all(found[4:])
    assert not names.is_shared('pad', 41, 60.0), 'the other is gone'
    assert not names.is_shared('pad', None, 61.0), 'a middleware without numbers'


def test_a_mapping_that_cannot_be_is_named(run_to_its_end):
    ended = run_to_its_end('joy_axes:=[0]')
    assert ended.returncode != 0
    assert 'parameter joy_axes is [0], expected 2 numbers' in ended.stdout + ended.stderr


def test_buttons_of_a_joy_judge_the_last_episode(graph, start):
    heard = graph.polled(contract.HUMAN_VERDICT)
    start('screen:=off', 'source_timeout:=10.0', 'success_button:=5', 'discard_button:=7')
    words = []

    def said(*expected):
        while (message := heard.take()) is not None:
            words.append(message.data)
        return words == list(expected)
    graph.press(0, 0, 0, 0, 0, 1, 1, 0, source='pad')  # down when it is first heard: no press
    graph.press(0, 0, 0, 0, 0, 0, 0, 0, source='pad')
    for _ in range(2):  # held
        graph.press(0, 0, 0, 0, 0, 1, 0, 0, source='pad')
    graph.until(lambda: said('success'), 'a verdict')
    graph.press(0, 0, 0, source='page')  # has no such button
    graph.press(0, 0, 0, 0, 0, 1, 1, 1, source='pad')  # the sixth has no verdict
    graph.until(lambda: said('success', 'discard'), 'another')
    graph.press(1, 0, 0, source='pad')
    graph.expect(5.0)


def test_zero_is_the_last_that_is_published(graph, start):
    process = start('screen:=off', 'source_timeout:=10.0')
    graph.press(1, 0, 0)
    graph.expect(5.0)
    assert process.stop(signal.SIGTERM) == 0
    graph.expect(0.0)


def test_stamps_follow_simulation_time(graph, start):
    clock = graph.publisher(contract.CLOCK)
    message = Clock()
    set_ns(message.clock, 10**18 - 20_000_000)
    start('screen:=off', 'use_sim_time:=true', meanwhile=lambda: clock.publish(message))
    assert min(graph.stamps) >= 10**18 - 20_000_000, 'nothing is published before the time is known'

    def ticked() -> bool:
        clock.publish(message)  # again and again: the node may not hear yet
        graph.listen()
        return graph.stamps[-1] == now_ns
    for now_ns in range(10**18, 10**18 + 200_000_000, 20_000_000):
        set_ns(message.clock, -now_ns)  # no robot's time
        clock.publish(message)
        set_ns(message.clock, now_ns)
        graph.until(ticked, 'the tick of the clock')


def test_a_button_has_one_verdict(run_to_its_end):
    result = run_to_its_end('success_button:=5', 'failure_button:=5')
    assert result.returncode == 2
    assert 'which has another verdict already' in result.stderr


@pytest.mark.parametrize(('parameter', 'said'), [
    ('rate:=0.0', "parameter 'rate' is out of range (10.0 to 200.0)"),
    ('screen:=always', "parameter 'screen' has no choice 'always'"),
    ('discard_button:=4', "parameter 'discard_button' is 4, but buttons 0 to 4 are the keys: choose 5 or a higher one"),
])
def test_a_wrong_parameter_is_named(parameter, said, run_to_its_end):
    result = run_to_its_end(parameter)
    assert result.returncode == 2
    assert said in result.stderr
    assert 'Traceback' not in result.stderr
