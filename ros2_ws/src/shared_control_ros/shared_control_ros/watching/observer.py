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

"""What the screen shows of robot, ball and learning, taken from the topics when it is drawn."""

import math
import time
from collections import deque

import numpy as np
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from shared_control.robot.model import RobotModel, pitch
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict, split_episode_key

from .. import contract
from ..ball_states import ball_state
from ..fast_loop import Polled
from ..joints import joint_positions
from ..stamps import to_ns
from ..wrenches import moment_of
from .outcome import FirstLeft, outcome_of
from .scene import Moments, Parts, Scene

EPISODES = ('teach', 'test')
"""Phases that are episodes."""
SILENT_AFTER = 0.5
"""A topic is silent when it brings nothing new for this long, s of the wall clock."""
_COUNTED = 100
"""So much of a countdown is kept: ten seconds of it, for a screen that is slow or was suspended."""

_NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""A screen that is slow or suspended asks nobody to send again."""


class Observer:
    """Keeps the newest of each topic, at the price of the frames that are drawn, not of the messages that pass."""

    def __init__(self, node: Node, task: Task = BALANCE):
        self._log = node.get_logger()
        self._model = RobotModel()
        self._joint_states = Polled(node, contract.JOINT_STATES_THROTTLE, qos_profile=_NEWEST)
        self._ball = Polled(node, contract.BALL, qos_profile=_NEWEST)
        self._parts = AppliedParts(node, task)
        latest = contract.qos_latched(1)
        self._time_left = Polled(node, contract.TIME_LEFT, qos_profile=contract.qos_latched(_COUNTED))
        self._countdown: deque[tuple[int, float]] = deque(maxlen=_COUNTED)
        """When, ns, the agent said that how much is left, s: of this phase, and of the next if that is known late."""
        self._share = Polled(node, contract.HUMAN_SHARE, qos_profile=latest)
        self._success = Polled(node, contract.SUCCESS, qos_profile=latest)
        self._rests_left = Polled(node, contract.RESTS_LEFT, qos_profile=latest)
        self._waiting = Polled(node, contract.WAITING, qos_profile=latest)
        self._returns = Polled(node, contract.EPISODE_RETURN, qos_profile=contract.qos_latched())
        self._verdicts = Polled(node, contract.VERDICT, qos_profile=contract.qos_latched())
        self._task = task
        self._length = task.episode_seconds
        self._begun: tuple[str | None, int | None] = None, None
        self._stamp_ns = -1
        self._moved_at = time.monotonic()  # nobody has waited for longer
        self._tray: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def stamp_ns(self) -> int:
        """Stamp of the newest /joint_states, ns; -1 when there was none."""
        return self._stamp_ns

    def update(self, scene: Scene) -> None:
        """Bring the scene up to date; its phase and episode must be so already."""
        now = time.monotonic()
        joints = self._joint_states.take()
        if joints is not None:
            self._read_joints(joints, scene, now)
        ball = self._ball.take()
        if ball is not None and self._tray is not None:
            self._read_ball(ball, scene)
        silent = now - self._moved_at
        scene.simulator_silent_for = silent if silent > SILENT_AFTER else None
        scene.parts = self._parts.update(now)
        self._read_time_left(scene)
        scene.human_share = self._latest(self._share, scene.human_share)
        scene.success = self._latest(self._success, scene.success)
        if (rests := self._rests_left.take()) is not None:
            scene.rests_left = max(rests.data, 0)
        if (waiting := self._waiting.take()) is not None:
            scene.waiting = waiting.data
        while (message := self._returns.take()) is not None:
            if math.isfinite(message.data):
                scene.returns.append(message.data)
                scene.verdict = Verdict.NONE
                scene.outcome = outcome_of(
                    self._task, self._length, scene.time_left,
                    None if scene.ball_on_tray is None else scene.ball_on_tray.tolist())
        self._read_verdicts(scene)

    def _read_verdicts(self, scene: Scene) -> None:
        """The newest is about the last episode that has ended; at its end it is empty."""
        while (message := self._verdicts.take()) is not None:
            try:
                scene.ended, scene.verdict = split_episode_key(message.key), Verdict(message.value)
            except ValueError as error:
                self._drop(self._verdicts, str(error))
        if scene.returns:
            last = len(scene.returns) - 1
            scene.discarded = scene.discarded - {last} | ({last} if scene.verdict is Verdict.DISCARD else set())

    def _read_time_left(self, scene: Scene) -> None:
        """The topic means the episode while there is one, and the break otherwise.

        Topics are heard one after the other: what was said of which is known by when it was said.
        """
        while (taken := self._time_left.take_with_info()) is not None:
            if math.isfinite(taken[0].data):
                self._countdown.append((taken[1]['source_timestamp'], taken[0].data))
        if (scene.phase, scene.episode) != self._begun:
            while self._countdown and self._countdown[0][0] < scene.began_ns:
                _, left = self._countdown.popleft()
                if self._begun[0] in EPISODES:
                    scene.time_left = left
            self._begun = scene.phase, scene.episode
            scene.next_in = None
            if scene.phase in EPISODES:
                scene.outcome = scene.time_left = scene.first_left = None
        if self._countdown:
            self._count_down(scene)
        if scene.phase in EPISODES:
            self._length = scene.episode_seconds

    def _count_down(self, scene: Scene) -> None:
        (first_ns, first), (_, newest) = self._countdown[0], self._countdown[-1]
        if scene.phase not in EPISODES:
            scene.next_in = newest
            return
        scene.time_left = newest
        if scene.first_left is None:
            scene.first_left = FirstLeft((first_ns - scene.began_ns) * 1e-9, first)

    def _read_joints(self, joints: JointState, scene: Scene, now: float) -> None:
        try:
            q = joint_positions(joints, self._model.spec)
        except ValueError as error:
            self._drop(self._joint_states, str(error))
            return
        stamp_ns = to_ns(joints.header.stamp)
        if stamp_ns != self._stamp_ns:  # a simulator that stands still repeats its last tick
            self._stamp_ns, self._moved_at = stamp_ns, now
        scene.q = q
        self._tray = self._model.tray_pose(q)
        scene.pitch = pitch(self._tray[1])
        scene.tilt = math.acos(min(float(self._tray[1][2, 2]), 1.0))

    def _read_ball(self, ball: Odometry, scene: Scene) -> None:
        assert self._tray is not None
        try:
            position, _ = ball_state(ball, self._model.spec.base_frame)
        except ValueError as error:
            self._drop(self._ball, str(error))
            return
        in_base = np.array(position)
        origin, rotation = self._tray
        scene.ball, scene.ball_on_tray = in_base, rotation.T @ (in_base - origin)

    @staticmethod
    def _latest(topic: Polled, before: float | None) -> float | None:
        message = topic.take()
        return before if message is None or not math.isfinite(message.data) else message.data

    def _drop(self, topic: Polled, what: str) -> None:
        self._log.error(f'not shown, a message on {topic.topic_name}: {what}', throttle_duration_sec=1.0)


class Moment:
    """The moment of a wrench topic along the axes of a task; None when it is silent."""

    def __init__(self, node: Node, topic: contract.Topic, task: Task = BALANCE):
        self._topic = Polled(node, topic, qos_profile=_NEWEST)
        self._axes = task.axes
        self._moment: Moments | None = None
        self._heard_at = -math.inf

    def update(self, now: float) -> Moments | None:
        """(k,), N m, at ``now`` of the monotonic clock."""
        wrench = self._topic.take()
        if wrench is not None:
            self._heard_at = now
            try:
                self._moment = tuple(moment_of(wrench, self._axes).tolist())
            except ValueError:
                self._moment = None
        return self._moment if now - self._heard_at <= SILENT_AFTER else None


class AppliedParts:
    """What the controller used of both moments at one of its ticks, and their sum; None when it is silent.

    The three topics are heard one after the other: only what bears the same stamp is shown together.
    """

    def __init__(self, node: Node, task: Task = BALANCE):
        several = QoSProfile(depth=20, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._topics = [Polled(node, topic, qos_profile=several) for topic in (
            contract.HUMAN_APPLIED, contract.AGENT_APPLIED, contract.APPLIED_WRENCH)]
        self._axes = task.axes
        self._heard: list[dict[int, Moments]] = [{} for _ in self._topics]
        self._parts: Parts | None = None
        self._heard_at = -math.inf

    def update(self, now: float) -> Parts | None:
        """At ``now`` of the monotonic clock."""
        for topic, heard in zip(self._topics, self._heard, strict=True):
            while (wrench := topic.take()) is not None:
                try:
                    heard[to_ns(wrench.header.stamp)] = tuple(moment_of(wrench, self._axes).tolist())
                except ValueError:
                    continue
        common = self._heard[0].keys() & self._heard[1].keys() & self._heard[2].keys()
        if common:
            newest = max(common)
            self._parts = Parts(*(heard[newest] for heard in self._heard))
            self._heard_at = now
            self._heard = [{stamp: heard[stamp] for stamp in heard if stamp > newest} for heard in self._heard]
        for heard in self._heard:
            if len(heard) > 100:  # of a clock that began anew, or one topic alone
                heard.clear()
        return self._parts if now - self._heard_at <= SILENT_AFTER else None
