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

"""A recorded session as pictures."""

import math
from functools import cache

import numpy as np
from shared_control import contract
from shared_control.keys import count_buttons
from shared_control.robot.model import RobotModel, pitch
from shared_control.verdict import Verdict, episode_key
from shared_control_records.bag.reader import Bag, BagReadError
from shared_control_records.bag.recorded import Series, Wrenches
from shared_control_records.bag.runs import run_window
from shared_control_records.bag.verdicts import last_verdicts
from shared_control_ros.watching.outcome import FirstLeft, Outcome, episode_length, outcome_of
from shared_control_ros.watching.scene import Parts

from .history import History
from .picture import LIT_FOR, Picture

LONGEST_STILL = 2.0
"""As much is played of a longer gap in the recording (between two runs of a session), s."""
TRACE_PERIOD = 0.05
"""s"""
STALE_AFTER = 0.2
"""The controller repeats its moments; it was not there when they are older, s of the recorder's clock."""


class Recording:
    """Looks into a bag at any time.

    Raises:
        BagReadError: the bag has nothing to be seen.
    """

    def __init__(self, bag: Bag):
        if not len(bag.joint_states.q) or not len(bag.ball.position):
            raise BagReadError(f'the bag {bag.path} has no /joint_states, or no /ball: there is nothing to see')
        self._bag = bag
        self.task = bag.task
        self._model = RobotModel()
        self._received = bag.joint_states.received_ns
        steps = np.minimum(np.diff(self._received, prepend=self._received[0]) * 1e-9, LONGEST_STILL)
        self._elapsed = np.cumsum(steps)
        self._run = 0, 0
        """The recorder's time, ns, within which a moment was looked for last; see :func:`run_window`."""
        self._between = cache(Wrenches.between)
        self._press_ns = np.array([press.received_ns for press in bag.presses], np.int64)

    @property
    def length(self) -> float:
        """How long it is, s."""
        return float(self._elapsed[-1])

    def picture(self, seconds: float) -> Picture:
        """What was to be seen so many seconds after the beginning."""
        index, now_ns = self._at(seconds)
        q = self._bag.joint_states.q[index]
        origin, rotation = self._model.tray_pose(q)
        ball = self._ball(now_ns)
        keys, hand = self._keys(now_ns)
        training = self._bag.training
        phase = _latest(training[contract.PHASE], now_ns)
        return Picture(
            q=q, ball=ball, ball_on_tray=rotation.T @ (ball - origin), pitch=pitch(rotation),
            tilt=math.acos(min(float(rotation[2, 2]), 1.0)),
            parts=self._parts(now_ns), phase=phase, episode=_latest(training[contract.EPISODE], now_ns),
            time_left=_latest(training[contract.TIME_LEFT], now_ns),
            episode_seconds=self._episode_seconds(phase, now_ns), outcome=self._outcome(phase, now_ns),
            human_share=_latest(training[contract.HUMAN_SHARE], now_ns),
            success=_latest(training[contract.SUCCESS], now_ns), keys=keys, hand=hand, time=seconds,
            history=self._history(now_ns))

    def trace(self, seconds: float, back: float) -> list[list[float | None]]:
        """Time and all moments, every 0.05 s of the ``back`` seconds before, as the chart of the page has them."""
        rows: list[list[float | None]] = []
        for at in np.arange(max(seconds - back, 0.0), seconds, TRACE_PERIOD):
            parts = self._parts(self._at(float(at))[1])
            moments = [None] * (3 * len(self.task.axes)) if parts is None else [
                value for moment in parts for value in moment]
            rows.append([float(at), *moments])
        return rows

    def marks(self) -> list[tuple[float, str, str]]:
        """Where episodes begin, s, their names (numbers, and T1, T2 ... for tests), and a person's verdicts on them."""
        training = self._bag.training
        starts = training[contract.EPISODE]
        episodes = [(at_ns, str(_latest(training[contract.PHASE], at_ns)), int(number)) for at_ns, number in zip(
            starts.received_ns.tolist(), starts.values, strict=True)]
        verdicts = last_verdicts(self._bag, [(at_ns, episode_key(phase, number)) for at_ns, phase, number in episodes])
        return [(round(float(np.interp(at_ns, self._received, self._elapsed)), 2),
                 f'{"T" if phase == "test" else ""}{number}', str(verdict))
                for (at_ns, phase, number), verdict in zip(episodes, verdicts, strict=True)]

    def _at(self, seconds: float) -> tuple[int, int]:
        """The joint states of so many seconds after the beginning (index), and the recorder's clock then, ns."""
        index = int(np.searchsorted(self._elapsed, seconds, 'right')) - 1
        within = min(seconds - self._elapsed[index], LONGEST_STILL)
        return index, int(self._received[index] + within * 1e9)

    def _ball(self, now_ns: int) -> np.ndarray:
        """Where the ball was, base frame, (3,), m."""
        return self._bag.ball.position[_before(self._bag.ball.received_ns, now_ns) or 0]

    def _parts(self, now_ns: int) -> Parts | None:
        """The moments of the controller's newest tick; None when it was not there, or the bag has not all of them."""
        bag = self._bag
        index = _before(bag.applied.received_ns, now_ns)
        if index is None or now_ns - bag.applied.received_ns[index] > STALE_AFTER * 1e9:
            return None
        received_ns, stamp_ns = int(bag.applied.received_ns[index]), bag.applied.stamp_ns[index]
        if not self._run[0] <= received_ns < self._run[1]:
            self._run = run_window(bag, received_ns)
        moments = []
        for all_wrenches in (bag.human_applied, bag.agent_applied):
            wrenches = self._between(all_wrenches, self._run)
            other = int(np.searchsorted(wrenches.stamp_ns, stamp_ns, 'right')) - 1
            if other < 0:
                return None
            moments.append(tuple(wrenches.moment[other].tolist()))
        human, agent = moments
        return Parts(human, agent, tuple(bag.applied.moment[index].tolist()))

    def _outcome(self, phase: str | None, now_ns: int) -> Outcome | None:
        """How the last episode ended, as long as the next has not begun."""
        training = self._bag.training
        ended = _before(training[contract.EPISODE_RETURN].received_ns, now_ns)
        if phase not in ('learn', 'wait') or ended is None:
            return None
        ended_ns = int(training[contract.EPISODE_RETURN].received_ns[ended])
        lasted = _latest(training[contract.PHASE], ended_ns)
        q = self._bag.joint_states.q[_before(self._received, ended_ns) or 0]
        origin, rotation = self._model.tray_pose(q)
        on_tray = rotation.T @ (self._ball(ended_ns) - origin)
        length = self._episode_seconds(lasted, ended_ns)
        return outcome_of(self.task, length, _latest(training[contract.TIME_LEFT], ended_ns), on_tray.tolist())

    def _episode_seconds(self, phase: str | None, now_ns: int) -> float:
        """The longest that the episode lasts, s."""
        training = self._bag.training
        begin = _before(training[contract.EPISODE].received_ns, now_ns)
        first_left = None
        if begin is not None:
            begin_ns = training[contract.EPISODE].received_ns[begin]
            times_ns, left = training[contract.TIME_LEFT].received_ns, training[contract.TIME_LEFT].values
            index = int(np.searchsorted(times_ns, begin_ns))
            if index < len(times_ns) and times_ns[index] <= now_ns:
                first_left = FirstLeft((times_ns[index] - begin_ns) * 1e-9, float(left[index]))
        return episode_length(self.task, phase, first_left)

    def _keys(self, now_ns: int) -> tuple[list[int], str]:
        """Keys that are lit, and the source of the latest press."""
        last = _before(self._press_ns, now_ns)
        first = np.searchsorted(self._press_ns, now_ns - LIT_FOR * 1e9)
        lit = [0] * count_buttons(self.task.keys)
        if last is None:
            return lit, ''
        for press in self._bag.presses[first:last + 1]:
            if press.key < len(lit):
                lit[press.key] = 1
        return lit, self._bag.presses[last].source

    def _history(self, now_ns: int) -> History:
        history = History()
        returns = self._bag.training[contract.EPISODE_RETURN]
        nexts = [*returns.received_ns, now_ns + 1][1:]
        for at_ns, next_ns, value in zip(returns.received_ns, nexts, returns.values, strict=True):
            if at_ns > now_ns:
                break
            if _latest(self._bag.training[contract.PHASE], int(at_ns)) not in ('test', 'done'):
                history.add(float(value), _latest(self._bag.training[contract.HUMAN_SHARE], int(at_ns)))
                said = [judgement.verdict for judgement in self._bag.judgements
                        if at_ns < judgement.received_ns < min(next_ns, now_ns + 1)]
                history.last_counts = not said or said[-1] is not Verdict.DISCARD
        return history


def _before(times_ns: np.ndarray, now_ns: int) -> int | None:
    """Index of the last of ``times_ns`` that is not after ``now_ns``; None when there is none."""
    index = int(np.searchsorted(times_ns, now_ns, 'right')) - 1
    return index if index >= 0 else None


def _latest(series: Series, now_ns: int):  # type: ignore[no-untyped-def]  # a number or a text, as the topic has it
    index = _before(series.received_ns, now_ns)
    return None if index is None else series.values[index].item()
