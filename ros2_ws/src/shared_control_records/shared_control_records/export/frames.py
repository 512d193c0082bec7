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

"""The episodes of a bag, time-aligned at the policy's rate."""

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from shared_control import contract
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.model import RobotModel, pitch
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict

from ..bag.ball_tracks import EpisodeTrack, episode_tracks
from ..bag.reader import Bag
from ..bag.recorded import Wrenches
from ..bag.runs import run_window

PERIOD_NS = round(POLICY_PERIOD * 1e9)


@dataclass(frozen=True, eq=False)
class EpisodeFrames:
    """One episode, a row every 20 ms of the robot's time.

    States are those at the beginning of the period; moments are what counted at its end. So a row holds what was seen
    and what came of it.
    """

    task: Task
    session: str
    """Name of the session, or of its bag; as in :func:`session_names`."""
    devices: str
    """What was in the hand in the session: ``keys (terminal), stick (joy)``; empty: nothing was used."""
    number: int
    phase: str
    """``teach`` or ``test``"""
    stamp_ns: np.ndarray
    """(n,)"""
    q: np.ndarray
    """(n, 7), rad"""
    qd: np.ndarray
    """(n, 7), rad/s"""
    ball_position: np.ndarray
    """(n, 3), m, base frame"""
    ball_velocity: np.ndarray
    """(n, 3), m/s"""
    position_error: np.ndarray
    """(n,), m, as the task has it: signed along its one axis, a distance with two"""
    pitch: np.ndarray
    """(n,), of the tray about base y, rad"""
    on_tray: np.ndarray
    """(n, 2), the ball in the tray's frame, m"""
    lean: np.ndarray
    """(n, 2), sines of the tray's tilt along base x and base y"""
    observation: np.ndarray
    """(n, observation_size), what the task has a learner see, integrals apart"""
    reward: np.ndarray
    """(n,), unscaled, of the state at the end of the period"""
    failed: bool
    """Whether the task failed; else time was up."""
    succeeded: bool
    """Whether the task calls the episode a success."""
    verdict: Verdict
    """What a person has said of it: success, failure, or nothing."""
    applied: np.ndarray
    """The sum of both moments as applied, (n, k), N m"""
    agent: np.ndarray | None
    """The agent's moment as it counted, likewise; None when the controller did not publish the parts"""
    human: np.ndarray | None
    """The human's, likewise"""

    def __len__(self) -> int:
        return len(self.stamp_ns)

    @property
    def is_success(self) -> bool:
        """As the person has it, and the task when no person has judged the episode."""
        return self.verdict is Verdict.SUCCESS if self.verdict else self.succeeded


def action_rows(task: Task) -> tuple[int, ...]:
    """Rows of the wrench that actions of a data set have: both horizontal moments, and what else the task shares.

    LeRobot takes a feature of one number for a scalar, which its policies cannot have for an action: so a task with
    one axis has a second one that is zero.
    """
    return tuple(sorted({3, 4, *task.axes}))


def session_names(bags: Sequence[Path]) -> list[str]:
    """What the session of each bag is called: as its folder, or as the bag where that is in no session's folder.

    Where sessions in several folders have one name, all go by their paths from the folder that they have in common.

    Raises:
        ValueError: a bag is given twice, or beside a file of it.
    """
    resolved = [bag.resolve() for bag in bags]
    for bag in resolved:
        if resolved.count(bag) > 1 or (bag.is_file() and bag.parent in resolved):
            raise ValueError(f'the bag {bag} is given twice, be it by its session, its folder or a file: name it once')
    places = [_session(bag) for bag in bags]
    if len({place.name for place in places}) == len(set(places)):
        return [place.name for place in places]
    root = os.path.commonpath([place.parent for place in places])
    return [str(place.relative_to(root)) for place in places]


def check_alike(differing: Iterable[tuple[str, str]]) -> None:
    """Refuse sessions for one data set that would not have the same columns in it.

    Args:
        differing: names of sessions, and what each is of, in words.

    Raises:
        ValueError: they differ; the message names one of each kind.
    """
    found: dict[str, str] = {}
    for session, what in differing:
        found.setdefault(what, session)
    if len(found) > 1:
        kinds = '; '.join(f'{session}: {what}' for what, session in found.items())
        raise ValueError(f'a data set has the same columns throughout, and these sessions differ ({kinds}): '
                         'export them apart')


def common_task(episodes: Sequence[EpisodeFrames]) -> tuple[Task, bool]:
    """The task of all episodes, and whether it is known what agent and human gave.

    Raises:
        ValueError: that is not the same for all; the message names the sessions.
    """
    check_alike((episode.session, f'{episode.task.name}, {"with" if episode.human is not None else "without"} the '
                                  'parts of the sum') for episode in episodes)
    return episodes[0].task, episodes[0].human is not None


def episode_frames(bag: Bag, session: str | None = None) -> list[EpisodeFrames]:
    """The finished episodes of a bag, in their order, without those that a person has discarded.

    A controller that publishes no parts of the sum (another one, or of the first version) leaves ``agent`` and
    ``human`` out.

    Args:
        session: what the session is called; as :func:`session_names` has it when not given.

    Raises:
        ValueError: it has no finished episode that counts, or nothing was applied, or one of the two parts alone; the
            message names the bag.
    """
    if not len(bag.applied.stamp_ns):
        raise ValueError(f'the bag {bag.path} has no messages on {contract.APPLIED_WRENCH.full_name}: what moved the '
                         'robot is not known, so there is no action to export')
    parts = {topic.full_name: bool(len(wrenches.stamp_ns)) for topic, wrenches in (
        (contract.HUMAN_APPLIED, bag.human_applied), (contract.AGENT_APPLIED, bag.agent_applied))}
    if any(parts.values()) and not all(parts.values()):
        missing, = (name for name, there in parts.items() if not there)
        raise ValueError(f'the bag {bag.path} has no messages on {missing}, but the other part of the sum: it is not '
                         'whole')
    tracks = episode_tracks(bag)
    between = cache(Wrenches.between)  # most episodes are of one run, and each would sort all of it
    session = session_names([bag.path])[0] if session is None else session
    frames = [_frames(bag, session, track, all(parts.values()), between) for track in tracks
              if track.verdict is not Verdict.DISCARD]
    if not frames:
        discarded = ' that was not discarded' if tracks else ''
        raise ValueError(f'the bag {bag.path} holds no finished episode{discarded}')
    return frames


def _frames(bag: Bag, session: str, track: EpisodeTrack, with_parts: bool,
            between: Callable[[Wrenches, tuple[int, int]], Wrenches]) -> EpisodeFrames:
    window = run_window(bag, track.received_ns[0])
    agent = between(bag.agent, window).stamp_ns
    agent = agent[np.searchsorted(agent, track.start_ns):]
    # The agent's stamps are those of the states that it acted on.
    start_ns = int(agent[0]) if len(agent) and agent[0] - track.start_ns < PERIOD_NS else track.start_ns
    begin = np.arange(start_ns, track.end_ns, PERIOD_NS)
    at = np.append(begin, track.end_ns)
    joints, ball = (_newest(series.received_ns, series.stamp_ns, at, window)
                    for series in (bag.joint_states, bag.ball))
    moments = {}
    for who, wrenches in (('applied', bag.applied), *(
            (('agent', bag.agent_applied), ('human', bag.human_applied)) if with_parts else ())):
        own = between(wrenches, window)
        if not len(own.stamp_ns):
            raise ValueError(f'the bag {bag.path} has no moments of episode {track.number}')
        moments[who] = own.moment_at(begin + PERIOD_NS - 1)
    q, position, velocity = bag.joint_states.q[joints], bag.ball.position[ball], bag.ball.velocity[ball]
    model, task, none = RobotModel(), bag.task, np.zeros(len(bag.task.axes))
    states = [task.describe(PlantState(*row, none, none, none), model) for row in zip(
        q, map(tuple, position), map(tuple, velocity), strict=True)]
    errors, speeds = (np.array([getattr(state, name) for state in states]) for name in ('position_error', 'velocity'))
    poses = [model.tray_pose(row) for row in q]
    count = len(begin)
    return EpisodeFrames(
        task, session, ', '.join(bag.devices), track.number, track.phase, begin,
        q[:count], bag.joint_states.qd[joints][:count], position[:count], velocity[:count], errors[:count],
        pitch=np.array([pitch(rotation) for _, rotation in poses])[:count],
        on_tray=np.array([rotation.T[:2] @ (where - origin) for (origin, rotation), where in zip(
            poses, position, strict=True)])[:count],
        lean=np.array([rotation[:2, 2] for _, rotation in poses])[:count],
        observation=np.array([task.observe(state) for state in states])[:count],
        reward=np.array([sum(task.reward_terms(state).values()) for state in states])[1:],
        failed=track.failed, succeeded=bool(task.succeeded(errors[1:], speeds[1:], track.failed)),
        verdict=track.verdict, applied=moments['applied'], agent=moments.get('agent'), human=moments.get('human'))


def _session(bag: Path) -> Path:
    """The folder of a bag's session, where the bag is called so; any other bag, without the ending of a file."""
    bag = Path(os.path.abspath(bag))
    folder = bag.parent if bag.is_file() else bag
    if folder.name == 'bag':
        return folder.parent
    return bag.with_suffix('') if bag.is_file() else bag


def _newest(received_ns: np.ndarray, stamps_ns: np.ndarray, at_ns: np.ndarray, window: tuple[int, int]) -> np.ndarray:
    """Indices of the newest messages at some times of the robot, of those received in a window of the recorder's time.

    The first message when there is none before.
    """
    first, last = np.searchsorted(received_ns, window)
    return (np.searchsorted(stamps_ns[first:last], at_ns, 'right') - 1).clip(min=0) + first
