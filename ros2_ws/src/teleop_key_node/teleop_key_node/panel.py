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

"""The terminal as a teacher's desk: its keys go to /human/keys, its screen shows the lesson."""

import locale
import os
import time

from rclpy.node import Node
from sensor_msgs.msg import Joy
from shared_control.keys import LEFT_AND_RIGHT, TERMINAL, Key, KeyMap, count_buttons
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from shared_control_ros.stamps import set_ns
from shared_control_ros.watching.judge import Judge
from shared_control_ros.watching.lesson import Lesson
from shared_control_ros.watching.observer import Observer
from shared_control_ros.watching.pause import Pause
from shared_control_ros.watching.requests import Requests
from shared_control_ros.watching.scene import Scene

from .keyboard import HeldKeys, Keyboard, Stroke
from .screen import render
from .sources import Sources
from .terminal import Terminal

_KEYS = {Stroke.LEFT: Key.LEFT, Stroke.RIGHT: Key.RIGHT, Stroke.UP: Key.UP, Stroke.DOWN: Key.DOWN,
         Stroke.SPACE: Key.SPACE}
_VERDICTS = {Stroke.GOOD: Verdict.SUCCESS, Stroke.BAD: Verdict.FAILURE, Stroke.DISCARD: Verdict.DISCARD}
_REPEAT_EVERY = 0.08
"""The state of the keys is repeated after this, s."""
_MESSAGE_FOR = 8.0
"""How long a notice stays, s."""
_PAUSED_WITHIN = 1.0
"""How long the answer to the pause is waited for before this process stops, s."""


def speaks_unicode(characters: str) -> bool:
    """Whether to draw with more than ASCII; ``auto`` asks the locale. The Linux console's font has no braille."""
    if characters == 'auto':
        return locale.getencoding().upper() in ('UTF-8', 'UTF8') and os.environ.get('TERM') != 'linux'
    return characters == 'unicode'


class Panel:
    """Reads the terminal and draws on it.

    Args:
        rate: of the ticks, Hz.
        frame_rate: of the screen, Hz.
        keystroke: change of M_yh at one press, N m.
        moment_limit: bound of |M_yh|, N m.
        in_session: whether a lesson is about to be given.
        feedback: what the person is told: one of ``FEEDBACK``.
        verdicts: whether the person is offered to judge episodes.
        pause: what is known of it; kept up to date by the node.
        characters: ``auto``, ``unicode`` or ``ascii``.
        task: what is taught.
        keys: what the keys move; none when the person holds another device: then only q, p and the screen are here.
    """

    def __init__(self, node: Node, terminal: Terminal, rate: float, frame_rate: float, keystroke: float,
                 moment_limit: float, characters: str, keys: KeyMap, task: Task, in_session: bool,
                 feedback: str, verdicts: bool, pause: Pause):
        self.terminal = terminal
        known = {*keys, Key.SPACE} if keys else set()
        self._keyboard = Keyboard([stroke for stroke, key in _KEYS.items() if key not in known])
        self._held = HeldKeys(1.0 / rate)
        self._sends_keys = bool(keys)
        self._keys = node.create_publisher(contract.KEYS.msg_type, contract.KEYS.name, contract.KEYS.qos)
        self._joy = Joy(buttons=[0] * count_buttons(keys or LEFT_AND_RIGHT))
        self._joy.header.frame_id = TERMINAL
        self._repeat_ticks = max(round(_REPEAT_EVERY * rate), 1)
        self._ticks = 0
        self.requests = Requests(node, self.tell, pause)
        self._judge = Judge(node, self.tell)
        self._observer = Observer(node, task)
        self._scene = Scene(task=task, human=(0.0,) * len(task.axes), moment_limit=moment_limit, keystroke=keystroke,
                            in_session=in_session, feedback=feedback, offers_verdicts=verdicts)
        self._restarts = 0
        self._frame_period = 1.0 / frame_rate
        self._next_frame = 0.0
        self._unicode = speaks_unicode(characters)
        self._message_until = 0.0
        self._asked_until = 0.0

    def tell(self, text: str) -> None:
        """Show the person a notice for some seconds."""
        self._scene.message = f' {text[:1].upper()}{text[1:]}' if text else ''
        self._message_until = time.monotonic() + _MESSAGE_FOR

    def read(self, now_ns: int) -> None:
        """Publish which keys are down: at every change, and every 0.08 s as a sign that the terminal is still there.

        Nothing is published before there is a time.
        """
        pressed = self._held.update(self._keyboard.strokes(self.terminal.read()), time.monotonic())
        if not self.terminal.is_entered:
            return  # in the background: as good as gone
        set_ns(self._joy.header.stamp, now_ns)
        for stroke in pressed:
            self._obey(stroke)
        buttons = [int(key in self._held_keys()) for key in range(len(self._joy.buttons))]
        changed = buttons != list(self._joy.buttons)
        self._joy.buttons = buttons
        self._ticks += 1
        if self._sends_keys and now_ns and (changed or self._ticks % self._repeat_ticks == 0):
            self._keys.publish(self._joy)
        self.requests.expire()

    def suspend(self, background: Background) -> None:
        """Pause, since nobody is there any more, and stop until the person is back, who goes on."""
        self.requests.pause(True, self._observer.stamp_ns)
        deadline = time.monotonic() + _PAUSED_WITHIN
        while self.requests.is_pending and time.monotonic() < deadline:
            background.spin_once(0.05)
        self.terminal.suspend()

    def _held_keys(self) -> set[Key]:
        return {_KEYS[stroke] for stroke in self._held.down if stroke in _KEYS}

    def _obey(self, stroke: Stroke) -> None:
        if stroke is Stroke.START and self._scene.phase == 'practice':
            self.requests.start()
        elif stroke is Stroke.FINISH:
            self._finish()
        elif stroke is Stroke.PAUSE:
            self.requests.toggle_pause(self._observer.stamp_ns)
        elif stroke in _VERDICTS and self._scene.offers_verdicts:
            self._judge.say(self._scene, _VERDICTS[stroke])
        elif stroke is Stroke.REDRAW:
            self.terminal.redraw()

    def _finish(self) -> None:
        """The first press asks, the second ends the teaching, and another takes that back."""
        now = time.monotonic()
        if self._scene.phase == 'practice':
            self.tell('This is practice: the teaching has not begun.')
        elif self.requests.ending:
            self.requests.keep_teaching()
        elif now < self._asked_until:
            self._asked_until = 0.0
            self.requests.finish()
        else:
            self._asked_until = now + _MESSAGE_FOR
            self.tell('End the teaching with this episode and test the robot? Press q again.')

    def draw(self, sources: Sources, lesson: Lesson) -> None:
        """Draw a frame if one is due."""
        now = time.monotonic()
        if now < self._next_frame or not self.terminal.is_entered:
            return
        self._next_frame = max(self._next_frame + self._frame_period, now)
        scene = self._scene
        if lesson.restarts != self._restarts:
            self._restarts = lesson.restarts
            scene.returns.clear()
            scene.discarded.clear()
        scene.phase, scene.episode, scene.began_ns = lesson.phase, lesson.episode, lesson.began_ns
        self._observer.update(scene)
        self._judge.update(scene)
        self.requests.follow(lesson.phase, self._observer.stamp_ns)
        scene.human = tuple(sources.moment.tolist())
        scene.ending = self.requests.ending
        scene.hand = 'you' if sources.last_pressed in ('', TERMINAL) else sources.last_pressed
        scene.paused = self.requests.paused
        if now > self._message_until:
            scene.message = ''
        self.terminal.paint(render(scene, *self.terminal.size, self._unicode))

    def close(self) -> None:
        """Put the terminal back as it was."""
        self.terminal.close()
