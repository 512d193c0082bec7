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

"""Teleoperation: turns keys and sticks on /human/keys, or another device, into M_h on /human/target_wrench (50 Hz).

A gamepad, a space mouse or a pedal counts as its driver publishes it on /joy (parameters joy_...).

With a terminal it reads the keys there as well and shows the lesson: arrows or a/d tip the tray, space takes the push
away, Enter ends the practice, q the teaching, p pauses, Ctrl-C quits; g says that the last episode was good, b bad, x
discards it. Each press adds a notch of push, which stays. The left key moves the ball to the left of the picture.
"""

import time

import numpy as np
from rclpy.duration import Duration
from rclpy.node import Node
from shared_control.keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, OUR_SOURCES, Key, has_let_go
from shared_control.plugins import DEVICES, load, names
from shared_control.teaching.device import Device
from shared_control.teaching.feedback import FEEDBACK
from shared_control.teaching.key_device import KeyDevice
from shared_control.verdict import Verdict
from shared_control_ros import contract
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background, Polled
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import declare
from shared_control_ros.robot_parameter import declare_robot
from shared_control_ros.runner import Stop, run
from shared_control_ros.stamps import set_ns
from shared_control_ros.task_parameter import declare_task
from shared_control_ros.watching.lesson import Lesson
from shared_control_ros.watching.pause import Pause
from shared_control_ros.wrenches import base_wrench, set_moment

from .joystick import Joystick, declare_stick
from .panel import Panel
from .shared_names import SharedNames, words_of_shared
from .sources import Sources
from .terminal import NoTerminal, Terminal
from .ticker import Ticker
from .verdict_buttons import VerdictButtons

TICKS_PER_POLL = 5
"""How often services are looked at."""
KEYS_DEVICE = 'keys'
"""The device that a terminal's keys are states of."""


class TeleopKeyNode:
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('teleop_key_node')
        self._role = claim(node, 'teleoperation')
        robot = declare_robot(node)
        self._task = declare_task(node, 'What is taught: axes and keys.')
        self._device = declare(
            node, 'device', KEYS_DEVICE, 'What the person holds in the hand.', choices=names(DEVICES))
        self._keystroke = declare(
            node, 'keystroke', KEYSTROKE, 'Change of M_yh at one press.', unit='N m', minimum=0.0, maximum=200.0)
        self._moment_limit = declare(
            node, 'moment_limit', HUMAN_MOMENT_LIMIT, 'Bound of |M_yh|, and about each axis of a task with several.',
            unit='N m', minimum=0.1, maximum=200.0)
        self._timeout = declare(
            node, 'source_timeout', 0.5, 'A source of keys that pressed and is silent for longer: M_yh goes to zero.',
            unit='s', minimum=0.1, maximum=10.0)
        self._rate = declare(
            node, 'rate', 50.0, 'How often M_yh is published.', unit='Hz', minimum=10.0, maximum=200.0)
        self._screen = declare(
            node, 'screen', 'auto', 'auto: read keys and show the lesson in the terminal, if there is one. off: serve '
            '/human/keys only.', choices=('auto', 'off'))
        self._frame_rate = declare(
            node, 'frame_rate', 25.0, 'How often the screen is drawn.', unit='Hz', minimum=1.0, maximum=60.0)
        self._characters = declare(
            node, 'characters', 'auto', 'What the screen is drawn with; auto: as the locale has it.',
            choices=('auto', 'unicode', 'ascii'))

        self._feedback = declare(
            node, 'feedback', 'full', 'What is told besides tray, ball and keys. ball: how each episode ended. '
            "full: and the robot's push, human share, score and tests.", choices=FEEDBACK)
        self._offers_verdicts = declare(
            node, 'verdicts', True, 'Offer keys and buttons that call the last episode good, bad or discarded.')
        self._in_session = declare(
            node, 'in_session', False, 'A lesson is about to be given: until the agent speaks, the screen says that it '
            'starts, and after its end that it is over.')

        buttons = {verdict: declare(
            node, f'{verdict}_button', -1, 'Button of /human/keys (from 0) that gives the last episode the verdict '
            f'{verdict}; -1: none.', minimum=-1, maximum=63) for verdict in Verdict if verdict}
        self._verdicts = VerdictButtons(
            node, buttons if self._offers_verdicts else {}, len(Key) if self._device == KEYS_DEVICE else 0)

        stick = declare_stick(node)
        self._joystick = Joystick(node, OUR_SOURCES, as_it_is=self._device != KEYS_DEVICE)
        self._keys = Polled(node, contract.KEYS, depth=50)
        self._names = SharedNames()
        self._lesson = Lesson(node)
        self._pause = Pause(node)
        device: Device = (
            KeyDevice(self._task, self._keystroke, self._moment_limit, *stick) if self._device == KEYS_DEVICE
            else load(DEVICES, self._device)(self._task, self._keystroke, self._moment_limit))
        self._sources = Sources(device, self._timeout)
        self._none = np.zeros(len(self._task.axes))
        self._wrench = base_wrench(robot.base_frame)
        self._publisher = node.create_publisher(
            contract.HUMAN_WRENCH.msg_type, contract.HUMAN_WRENCH.name, contract.HUMAN_WRENCH.qos)
        self._ticker = Ticker(node, 1.0 / self._rate)
        self._diagnostics = Diagnostics(node, 1.0 / self._rate, needs=self._ticker.clock)
        self._panel = self._open_panel()
        self._background = Background(node)
        self._ticks = 0

    def _open_panel(self) -> Panel | None:
        serves = f'serving {self._keys.topic_name} only'
        if self._screen == 'off':
            self.node.get_logger().info(f'screen is off: {serves}')
            return None
        try:
            terminal = Terminal()
        except NoTerminal as reason:
            self.node.get_logger().info(f'no terminal ({reason}): {serves}')
            return None
        keys = self._task.keys if self._device == KEYS_DEVICE else {}
        return Panel(self.node, terminal, self._rate, self._frame_rate, self._keystroke, self._moment_limit,
                     self._characters, keys, self._task, self._in_session, self._feedback,
                     self._offers_verdicts, self._pause)

    def run(self, stop: Stop) -> None:
        """Turn what the person does into M_h until told to stop."""
        while not stop.requested:
            now_ns = self._ticker.wait()
            if self._panel is not None:
                self._serve_panel(self._panel, now_ns)
            self._follow_lesson()
            self._joystick.poll()
            self._hear_keys(now_ns)
            self._publish(self._sources.moment, now_ns)
            self._diagnostics.tick()
            if self._panel is not None:
                self._panel.draw(self._sources, self._lesson)
            self._ticks += 1
            if self._ticks % TICKS_PER_POLL == 0:
                self._background.poll()
            if self._diagnostics.due():
                self._report()

    def _serve_panel(self, panel: Panel, now_ns: int) -> None:
        if panel.terminal.suspend_requested:
            self._sources.release()
            self._publish(self._none, now_ns)
            panel.suspend(self._background)
            self._diagnostics.skip()
        panel.read(now_ns)
        if panel.requests.is_pending:
            self._background.spin_once(0.0)
        if panel.terminal.is_gone:
            panel.close()
            self._panel = None
            self.node.get_logger().warning(f'the terminal is gone: serving {self._keys.topic_name} only')

    def _follow_lesson(self) -> None:
        """Every episode and phase starts without a moment of the human; most phases, pauses and stops stay so."""
        begins = self._lesson.update()
        was_off = self._pause.controller_is_off
        self._pause.update()
        if self._pause.controller_is_off and not was_off:
            self._tell('the controller is stopped or disabled: keys do not count until it is enabled')
        counts = self._lesson.keys_count and not self._pause.is_on and not self._pause.controller_is_off
        if begins or counts != self._sources.is_active:
            self._sources.release()
            self._sources.is_active = counts

    def _hear_keys(self, now_ns: int) -> None:
        while (taken := self._keys.take_with_info()) is not None:
            joy, info = taken
            source = joy.header.frame_id
            if self._names.is_shared(source, info['publication_sequence_number'], time.monotonic()):
                text = words_of_shared(source, self._keys.topic_name)
                self.node.get_logger().error(text, throttle_duration_sec=1.0)
                self._tell(text)
                continue  # it falls silent, and its moment goes
            if has_let_go(joy.axes, joy.buttons):
                self._sources.leave(source)
                continue
            try:
                self._sources.hear(source, joy.axes, joy.buttons, now_ns, time.monotonic())
                self._verdicts.hear(source, joy.buttons)
            except ValueError as error:
                text = f'dropped a message of {source!r} on {self._keys.topic_name}: {error}'
                self.node.get_logger().error(text, throttle_duration_sec=1.0)
                self._tell(text)
        for source in self._sources.drop_silent(now_ns, time.monotonic()):
            text = (f'{source!r} fell silent on {self._keys.topic_name} for more than {self._timeout} s: '
                    'M_yh is set to zero')
            self.node.get_logger().warning(text, throttle_duration_sec=1.0)
            self._tell(text)

    def _tell(self, text: str) -> None:
        if self._panel is not None:
            self._panel.tell(text)

    def _publish(self, moment: np.ndarray, now_ns: int) -> None:
        if not now_ns:
            return  # the time is not known yet: a stamp of 0 would be taken for a stale moment
        set_ns(self._wrench.header.stamp, now_ns)
        set_moment(self._wrench, moment, self._task.axes)
        self._publisher.publish(self._wrench)

    def _report(self) -> None:
        over = self._in_session and self._lesson.phase == 'done'
        if not over and self._lesson.forget_if_over():
            self._sources.release()
        self._diagnostics.publish({}, moment=self._sources.moment.tolist())

    def close(self) -> None:
        """Publish zero and put the terminal back as it was."""
        try:
            self._publish(self._none, self.node.get_clock().now().nanoseconds)
            self._publisher.wait_for_all_acked(Duration(nanoseconds=200_000_000))
        finally:
            if self._panel is not None:
                self._panel.close()
            self._background.close()


def main() -> int:
    """Entry point."""
    return run(TeleopKeyNode)


if __name__ == '__main__':
    raise SystemExit(main())
