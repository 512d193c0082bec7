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

"""The running graph: what the page shows of it, and what it may ask for."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node
from sensor_msgs.msg import Joy
from shared_control.keys import PAGE, PressesBySource, count_buttons, has_let_go
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background, Polled, follow_clock
from shared_control_ros.watching.judge import Judge
from shared_control_ros.watching.lesson import Lesson
from shared_control_ros.watching.observer import Moment, Observer
from shared_control_ros.watching.pause import Pause
from shared_control_ros.watching.scene import Scene

from .ending import Ending
from .history import History
from .page_requests import PageRequests
from .picture import LIT_FOR, Picture
from .showing import Showing

NOTICE_FOR = 8.0
"""s"""


class LiveDesk:
    """See :class:`Desk`. All that it does is quick: it is called from the server's event loop."""

    is_replay = False

    def __init__(self, node: Node, task: Task = BALANCE, showing: Showing = Showing(),
                 session: Path | None = None):
        self.is_over = False
        self.showing = showing
        self._ending = Ending(session, showing.shows_result)
        self._stage = ''
        self.task = task
        self._node = node
        self._observer = Observer(node, task)
        self._scene = Scene(task=task)
        self._lesson = Lesson(node)
        self._restarts = 0
        self._human = Moment(node, contract.HUMAN_WRENCH, task)
        self._heard = Polled(node, contract.KEYS, depth=50)
        self._presses = PressesBySource()
        self._hand = ''
        self._lit_until = [0.0] * count_buttons(task.keys)
        self._history = History()
        self._keys = node.create_publisher(contract.KEYS.msg_type, contract.KEYS.name, contract.KEYS.qos)
        self._joy = Joy(buttons=[0] * count_buttons(task.keys))
        self._joy.header.frame_id = PAGE
        self._pause = Pause(node)
        self._requests = PageRequests(node, self._tell, self._pause)
        self._judge = Judge(node, self._tell)
        self._background = Background(node)
        self._notice_until = 0.0

    def look(self) -> Picture:
        """See :class:`Desk`."""
        if self._requests.is_pending:
            self._background.spin_once(0.0)
        self._requests.expire()
        self._lesson.update()
        self._pause.update()
        now = time.monotonic()
        scene = self._scene
        scene.phase, scene.episode, scene.began_ns = self._lesson.phase, self._lesson.episode, self._lesson.began_ns
        self._follow(scene)
        full = self.showing.feedback == 'full'
        self._hear_keys(now)
        if now > self._notice_until:
            scene.message = ''
        return Picture(
            q=scene.q, ball=scene.ball, ball_on_tray=scene.ball_on_tray, pitch=scene.pitch, tilt=scene.tilt,
            asked=self._human.update(now), parts=scene.parts if full else None,
            phase=scene.phase, episode=scene.episode, time_left=scene.time_left,
            episode_seconds=scene.episode_seconds, rests_left=scene.rests_left,
            next_in=scene.next_in,
            outcome=None if self.showing.feedback == 'none' else scene.outcome,
            ended=scene.ended, verdict=scene.verdict,
            ends_teaching=self._requests.ending, ending=self._ended(now),
            human_share=scene.human_share if full else None, success=scene.success if full else None,
            keys=[int(now < lit) for lit in self._lit_until],
            hand=self._hand, paused=self._requests.paused, silent_for=scene.simulator_silent_for,
            notice=scene.message.strip() or (f'Waiting {scene.waiting}'.replace('\n', ': ') if scene.waiting else ''),
            time=max(self._observer.stamp_ns, 0) * 1e-9, history=self._history if full else History())

    def _follow(self, scene: Scene) -> None:
        """Bring the scene and the list of episodes up to date."""
        if self._lesson.restarts != self._restarts:
            self._restarts = self._lesson.restarts
            if self._lesson.phase == 'teach':  # a test counts from 1, too
                self._history.clear()
        known, share = len(scene.returns), scene.human_share
        self._observer.update(scene)
        self._requests.follow(scene.phase, self._observer.stamp_ns)
        new = scene.returns[known:]
        if scene.phase not in ('test', 'done'):
            for value in new:
                self._history.add(value, share if len(new) == 1 else None)
        if scene.ended is not None and scene.ended[0] == 'teach':
            self._history.last_counts = scene.verdict is not Verdict.DISCARD
        self._judge.update(scene)

    @property
    def is_finished(self) -> bool:
        """See :class:`Desk`."""
        return (self._ending.look(time.monotonic()) or {}).get('stage') == 'over'

    def file(self, name: str) -> Path | None:
        """See :class:`Desk`."""
        return self._ending.file(name)

    def _ended(self, now: float) -> dict[str, Any] | None:
        return {'stage': self._stage} if self._stage else self._ending.look(now)

    def _hear_keys(self, now: float) -> None:
        while (joy := self._heard.take()) is not None:
            source = joy.header.frame_id
            if has_let_go(joy.axes, joy.buttons):
                self._presses.forget(source)
                continue
            try:
                pressed = self._presses.update(source, joy.buttons)
            except ValueError:
                continue  # teleop_key_node complains
            if pressed:
                self._hand = source
            for key, down in enumerate(joy.buttons[:len(self._lit_until)]):
                if down:
                    self._lit_until[key] = now + LIT_FOR

    def press(self, buttons: list[int], axes: Sequence[float] = ()) -> None:
        """See :class:`Desk`."""
        follow_clock(self._node)
        self._joy.header.stamp = self._node.get_clock().now().to_msg()
        self._joy.buttons, self._joy.axes = buttons, list(axes)
        self._keys.publish(self._joy)

    def let_go(self) -> None:
        """See :class:`Desk`. An empty state says so at once; silence would say it after half a second."""
        self.press([])

    def do(self, command: str, value: Any) -> None:
        """See :class:`Desk`."""
        if command == 'pause':
            self._requests.toggle_pause(self._observer.stamp_ns)
        elif command == 'repeat':
            if self._requests.paused:
                self._tell('It is paused: go on first.')
            else:
                self._requests.repeat()
        elif command == 'start':
            self._requests.start()
        elif command == 'finish':
            self._requests.finish()
        elif command == 'keep_teaching':
            self._requests.keep_teaching()
        elif command == 'judge':
            verdict = Verdict(value)
            if self.showing.verdicts:
                self._judge.say(self._scene, verdict)
        elif command == 'stop':
            self.is_over, self._stage = True, 'stopped'
        elif command == 'close':
            self.is_over, self._stage = True, 'closed'
        else:
            raise ValueError(f'no command {command!r}')

    def _tell(self, text: str) -> None:
        self._scene.message = text[:1].upper() + text[1:]
        self._notice_until = time.monotonic() + NOTICE_FOR

    def close(self) -> None:
        """Leave no moment behind."""
        self.let_go()
        self._keys.wait_for_all_acked(Duration(nanoseconds=200_000_000))
        self._background.close()
