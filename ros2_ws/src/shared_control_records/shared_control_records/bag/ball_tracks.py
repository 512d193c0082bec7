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

"""How the ball moved in each episode, from a bag."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from shared_control import contract
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.verdict import Verdict, episode_key

from .reader import Bag
from .verdicts import last_verdicts

_PERIOD_NS = round(POLICY_PERIOD * 1e9)
_JUMP = 0.03
"""m between two samples: the ball was dropped anew; a rolling ball makes a tenth of that."""


@dataclass(frozen=True, eq=False)
class EpisodeTrack:
    """One episode that came to its end."""

    number: int
    phase: str
    start_ns: int
    """The robot's time at its start."""
    received_ns: tuple[int, int]
    """The recorder's time at its start and at its end."""
    seconds: np.ndarray
    """(n,), since the start"""
    position_error: np.ndarray
    """(n,), m, as the task has it: signed along its one axis, a distance with two"""
    on_tray: np.ndarray
    """(n, 2), where the ball was on the tray, in the tray's frame, m"""
    failed: bool
    """Whether the task failed (the ball fell)."""
    verdict: Verdict = Verdict.NONE
    """What a person has said of it."""

    @property
    def end_ns(self) -> int:
        """The robot's time at its end."""
        return self.start_ns + round(self.seconds[-1] * 1e9)


def episode_tracks(bag: Bag) -> list[EpisodeTrack]:
    """The finished episodes of a bag in their order, with those that a person has discarded.

    One that was broken off, and began again, is left out.
    """
    starts, ends = bag.training[contract.EPISODE], bag.training[contract.EPISODE_RETURN]
    model = _Pose()
    tracks: list[EpisodeTrack] = []
    ended_ns: list[int] = []
    for index, (start_ns, number) in enumerate(zip(starts.received_ns, starts.values, strict=True)):
        next_ns = starts.received_ns[index + 1] if index + 1 < len(starts.received_ns) else bag.end_ns
        ended = ends.received_ns[(ends.received_ns > start_ns) & (ends.received_ns <= next_ns)]
        if not len(ended) or not len(bag.joint_states.stamp_ns):
            continue
        first, last = np.searchsorted(bag.ball.received_ns, (start_ns, ended[0]))
        first = _after_drop(bag.ball.position[first:last]) + first
        if last - first < 2:
            continue
        samples = _thinned(bag.ball.stamp_ns[first:last]) + first
        stamps = bag.ball.stamp_ns[samples]
        ended_ns.append(int(ended[0]))
        tracks.append(EpisodeTrack(
            int(number), _phase(bag, (int(start_ns) + int(ended[0])) // 2), int(stamps[0]),
            (int(bag.ball.received_ns[first]), int(bag.ball.received_ns[last - 1])),
            (stamps - stamps[0]) * 1e-9, *_seen(bag, samples, model)))
    verdicts = last_verdicts(bag, [(at, episode_key(track.phase, track.number))
                                   for at, track in zip(ended_ns, tracks, strict=True)])
    return [replace(track, verdict=verdict) for track, verdict in zip(tracks, verdicts, strict=True)]


def broken_off(bag: Bag) -> list[tuple[int, float]]:
    """Number and duration, s of the robot's time, of each episode of teaching in a bag that did not come to its end.

    It lasted until the learner told of its progress (10 Hz) for the last time.
    """
    starts, ends = bag.training[contract.EPISODE], bag.training[contract.EPISODE_RETURN]
    progress = bag.training[contract.HUMAN_SHARE].received_ns
    found = []
    for index, (start_ns, number) in enumerate(zip(starts.received_ns, starts.values, strict=True)):
        next_ns = starts.received_ns[index + 1] if index + 1 < len(starts.received_ns) else bag.end_ns
        within = progress[(progress > start_ns) & (progress < next_ns)]
        if not len(within) or ((ends.received_ns > start_ns) & (ends.received_ns <= next_ns)).any():
            continue
        first, last = np.searchsorted(bag.ball.received_ns, (start_ns, within[-1]))
        if _phase(bag, int(within[0])) != 'teach' or last - first < 2:
            continue
        stamps = bag.ball.stamp_ns[first + _after_drop(bag.ball.position[first:last]):last]
        steps = np.diff(stamps)  # the simulator may have been started anew within it
        found.append((int(number), float(steps[steps > 0].sum()) * 1e-9))
    return found


def _thinned(stamps_ns: np.ndarray) -> np.ndarray:
    """Indices of the samples that a learner may have seen: the first of each period of the policy, and the last."""
    return np.unique(np.append(
        np.flatnonzero(np.diff((stamps_ns - stamps_ns[0]) // _PERIOD_NS, prepend=-1)), len(stamps_ns) - 1))


class _Pose(RobotModel):
    """The model that tracks are taken from: poses alone, each once.

    A task describes the manipulability with every state, which tracks have no use for.
    """

    _last: tuple[np.ndarray | None, Any] = (None, None)

    def tray_pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See :class:`RobotModel`."""
        if self._last[0] is not q:
            self._last = q, super().tray_pose(q)
        return self._last[1]

    def manipulability(self, q: np.ndarray) -> float:
        """See :class:`RobotModel`; not computed."""
        return np.nan


def _seen(bag: Bag, samples: np.ndarray, model: RobotModel) -> tuple[np.ndarray, np.ndarray, bool]:
    """At some samples of /ball: position errors, (n,), m; the ball on the tray, (n, 2), m; whether the task failed."""
    joints, ball, task = bag.joint_states, bag.ball, bag.task
    index = (np.searchsorted(joints.received_ns, ball.received_ns[samples], 'right') - 1).clip(min=0)
    none = np.zeros(len(task.axes))
    errors, on_tray, failed = [], [], False
    for q, position, velocity in zip(joints.q[index], ball.position[samples], ball.velocity[samples], strict=True):
        state = task.describe(PlantState(q, tuple(position), tuple(velocity), none, none, none), model)
        origin, rotation = model.tray_pose(q)
        errors.append(state.position_error)
        on_tray.append(rotation.T[:2] @ (position - origin))
        failed = failed or task.failed(state)
    return np.array(errors), np.array(on_tray), failed


def _after_drop(positions: np.ndarray) -> int:
    """The episode is announced about when the ball is dropped: index of the first of ``positions`` after that."""
    jumps = np.flatnonzero(np.abs(np.diff(positions[:50, :2], axis=0)).max(axis=1) > _JUMP)
    return int(jumps[-1]) + 1 if len(jumps) else 0


def _phase(bag: Bag, received_ns: int) -> str:
    phases = bag.training[contract.PHASE]
    index = int(np.searchsorted(phases.received_ns, received_ns, 'right')) - 1
    return str(phases.values[index]) if index >= 0 else ''
