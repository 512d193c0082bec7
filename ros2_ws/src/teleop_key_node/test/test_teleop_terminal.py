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

"""The running node in a real terminal (a pty): typed keys, the screen, and the terminal afterwards."""

import os
import signal
import termios
import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import JointState
from shared_control.keys import Key, KeyPresses
from shared_control.robot.spec_file import panda
from shared_control_ros import contract
from std_srvs.srv import SetBool, Trigger
from teleop_key_node.keyboard import HeldKeys

LEFT, RIGHT = b'\x1b[D', b'\x1b[C'
ENTER, LEAVE = '\x1b[?1049h', '\x1b[?1049l'


def test_typed_keys_reach_the_topics(graph, start_in_terminal):
    terminal = start_in_terminal()
    for keys, m_y in ((LEFT, 5.0), (b'a', 10.0), (RIGHT, 5.0), (b'd', 0.0), (b'\x1bOC', -5.0), (b' ', 0.0),
                      (LEFT, 5.0), (LEFT, 10.0)):
        terminal.type(keys)
        graph.expect(m_y)
        graph.hold(m_y, 0.3)  # the key is up again: a terminal does not say so
    graph.hold(10.0, 1.0)  # the terminal repeats its state: it is still there
    terminal.expect('+10.0 N m')

    states, pressed, keys = [], [], KeyPresses()
    while (joy := graph.joys.take()) is not None:
        assert joy.header.frame_id == 'terminal'
        states.append(tuple(joy.buttons))
        pressed += keys.update(joy.buttons)
    assert pressed == [Key.LEFT] * 2 + [Key.RIGHT] * 3 + [Key.SPACE] + [Key.LEFT] * 2
    assert states[-1] == (0, 0, 0)
    assert len(states) - 2 * len(pressed) >= 10, 'the state is repeated at 10 Hz'

    terminal.type(b'\x03')
    assert terminal.popen.wait(60) == 0
    graph.expect(0.0)
    assert terminal.modes == terminal.modes_before


def test_a_key_that_is_held_does_not_count_as_often_as_the_terminal_repeats_it(graph, start_in_terminal):
    terminal = start_in_terminal()
    for _ in range(60):
        terminal.type(LEFT)
        time.sleep(0.033)
    graph.hold(graph.listen(), 0.3)
    pressed, keys = [], KeyPresses()
    while (joy := graph.joys.take()) is not None:
        pressed += keys.update(joy.buttons)
    assert 1 <= len(pressed) <= 10, 'one, and another whenever this test or the node was held up'


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGHUP])
def test_the_terminal_is_restored(graph, start_in_terminal, number):
    terminal = start_in_terminal()
    terminal.expect('WAITING FOR THE SIMULATOR')
    assert not terminal.modes[3] & termios.ECHO
    assert terminal.modes[3] & termios.ISIG, 'Ctrl-C works'
    assert terminal.stop(number) == 0
    assert terminal.modes == terminal.modes_before
    terminal.expect(LEAVE)
    screen = terminal.shown.partition(ENTER)[2].partition(LEAVE)[0]
    assert screen.rindex('\x1b[?25h') > screen.rindex('\x1b[?25l'), 'the cursor is back'
    assert '[INFO]' not in screen, 'log lines wait until the screen is gone'


def test_suspended_the_person_lets_go_and_it_is_paused(graph, start_in_terminal):
    asked = []

    def on_pause(request, response):
        asked.append(request.data)
        response.success = True
        return response
    graph.node.create_service(SetBool, contract.PAUSE_SERVICE, on_pause)
    executor = SingleThreadedExecutor(context=graph.context)
    executor.add_node(graph.node)

    def until(happened):
        graph.until(lambda: executor.spin_once(timeout_sec=0.01) or happened(), str(asked))
    terminal = start_in_terminal()
    # Alone in its session, the process cannot stay stopped: it comes back at once.
    terminal.type(LEFT)
    graph.expect(5.0)
    for _ in range(2):  # paused already, it stays so
        before = len(terminal.shown)
        terminal.type(b'\x1a')
        until(lambda before=before: ENTER in terminal.shown[before:])
        assert terminal.shown.index(LEAVE, before) < terminal.shown.index(ENTER, before)
        graph.expect(0.0)
        until(lambda before=before: '[ PAUSED ]' in terminal.shown[before:])
    assert asked == [True, True]
    terminal.type(b'p')
    until(lambda: asked == [True, True, False])
    before = len(terminal.shown)
    until(lambda: '[ PAUSED ]' not in terminal.shown[before:] and 'WAITING FOR' in terminal.shown[before:])
    terminal.type(RIGHT)
    graph.expect(-5.0)
    executor.shutdown()


def test_the_screen_shows_the_lesson(graph, start_in_terminal):
    terminal = start_in_terminal('characters:=ascii')
    terminal.expect('[ WAITING FOR THE SIMULATOR ]')
    joints = JointState(name=list(reversed(panda().joints)), position=list(reversed(panda().home)))
    ball = Odometry()
    ball.header.frame_id = 'panda_link0'
    ball.pose.pose.position.x, ball.pose.pose.position.z = -0.385, 0.93
    joint_publisher, ball_publisher = graph.publisher(contract.JOINT_STATES_THROTTLE), graph.publisher(contract.BALL)
    graph.begin('teach', episode=4)

    def shown() -> bool:
        joints.header.stamp.nanosec += 1
        joint_publisher.publish(joints)
        ball_publisher.publish(ball)
        return 'cm left of the middle' in terminal.shown
    graph.until(shown, 'the ball')
    terminal.expect('tilt 1.0 deg, left side down')
    terminal.expect('[ TEACH ]')
    terminal.expect('episode 4')
    assert terminal.shown.isascii()

    # A resize is seen at the next frame.
    before = len(terminal.shown)
    terminal.resize(16, 60)
    terminal.expect('\x1b[2J', after=before)
    terminal.expect('\x1b[16;1H', after=before)
    assert '\x1b[17;1H' not in terminal.shown[terminal.shown.rindex('\x1b[2J'):]


@pytest.mark.parametrize('size', [(0, 0), (24, 0)])
def test_a_terminal_that_does_not_know_its_size_is_drawn_on(start_in_terminal, size):
    """Serial lines and containers say 0 by 0."""
    terminal = start_in_terminal()
    terminal.expect('Teach the robot')
    known = len(terminal.shown)
    terminal.resize(*size)
    terminal.expect('Teach the robot', after=known)


def test_the_person_asks_the_other_nodes(graph, start_in_terminal):
    terminal = start_in_terminal()
    terminal.type(b'q')
    terminal.expect('Press q again')
    time.sleep(4 * HeldKeys.REPEATS_WITHIN)  # sooner it would be the terminal's repetition
    terminal.type(b'q')
    terminal.expect('Nobody serves /learner/finish')
    asked = []

    def on_finish(_, response):
        asked.append('finish')
        response.success, response.message = True, 'One more test.'
        return response

    def on_pause(request, response):
        asked.append(request.data)
        response.success = True
        return response
    graph.node.create_service(Trigger, contract.FINISH_SERVICE, on_finish)
    graph.node.create_service(SetBool, contract.PAUSE_SERVICE, on_pause)
    executor = SingleThreadedExecutor(context=graph.context)
    executor.add_node(graph.node)

    def ask(key: bytes, count: int) -> None:
        deadline = time.monotonic() + 60.0
        while len(asked) < count and time.monotonic() < deadline:
            terminal.type(key)
            for _ in range(30):
                executor.spin_once(timeout_sec=0.01)
    time.sleep(4 * HeldKeys.REPEATS_WITHIN)
    before = len(terminal.shown)
    terminal.type(b'q')
    terminal.expect('Press q again', after=before)
    time.sleep(4 * HeldKeys.REPEATS_WITHIN)
    ask(b'q', 1)
    terminal.expect('One more test.')
    ask(b'p', 2)
    terminal.expect('[ PAUSED ]')
    ask(b'p', 3)
    assert asked == ['finish', True, False]
    # The simulator has told that it is paused, and not answered yet.
    reports = graph.publisher(contract.DIAGNOSTICS)
    graph.until(lambda: reports.get_subscription_count() == 1, 'the screen hears the simulator')
    time.sleep(4 * HeldKeys.REPEATS_WITHIN)
    before = len(terminal.shown)
    terminal.type(b'p')
    received = graph.received
    graph.until(lambda: graph.listen() == 0.0 and graph.received > received + 20, 'the key to be read')
    reports.publish(DiagnosticArray(status=[DiagnosticStatus(values=[KeyValue(key='paused', value='True')])]))
    terminal.expect('[ PAUSED ]', after=before)
    time.sleep(4 * HeldKeys.REPEATS_WITHIN)
    terminal.type(b'p')
    graph.until(lambda: executor.spin_once(timeout_sec=0.01) or asked[3:] == [True, False], 'both wishes')
    executor.shutdown()


def test_the_person_judges_the_last_episode(graph, start_in_terminal):
    heard, verdict = graph.polled(contract.HUMAN_VERDICT), graph.publisher(contract.VERDICT)
    terminal = start_in_terminal()
    graph.until(verdict.get_subscription_count, 'the screen hears')
    terminal.type(b'x')
    terminal.expect('No episode has ended yet')
    verdict.publish(KeyValue(key='teach 3', value=''))
    terminal.expect('episode 3')
    terminal.expect('g: good   b: bad   x: discard')
    words = []

    def said(*expected: str) -> bool:
        while (message := heard.take()) is not None:
            words.append(message.data)
        return words == list(expected)
    for key, word in ((b'g', 'success'), (b'B', 'failure'), (b'x', 'discard')):
        time.sleep(4 * HeldKeys.REPEATS_WITHIN)
        terminal.type(key)
        words.clear()
        graph.until(lambda word=word: said(word), word)
    verdict.publish(KeyValue(key='teach 3', value='discard'))
    terminal.expect('episode 3: discarded')
    terminal.expect('the robot forgets it')
    verdict.publish(KeyValue(key='test 1', value=''))
    time.sleep(4 * HeldKeys.REPEATS_WITHIN)
    terminal.type(b'x')
    terminal.expect('cannot be discarded')


def test_continued_the_terminal_is_set_up_anew(graph, start_in_terminal):
    terminal = start_in_terminal()
    terminal.expect(ENTER)
    terminal.type(LEFT)
    graph.expect(5.0)
    os.kill(terminal.popen.pid, signal.SIGCONT)  # a shell may have changed the modes meanwhile
    before = len(terminal.shown)
    terminal.expect(ENTER, after=before - 1)
    assert not terminal.modes[3] & termios.ECHO
