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

"""What must hold in a session's folder, whatever befell it."""

import json
import struct
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
from mcap.reader import make_reader
from shared_control import contract
from shared_control.control.moments import FADE_TIME
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control_learning.episode_table import BROKEN_OFF, read_rows
from shared_control_learning.policy_file import PolicyFileError, load_policy
from shared_control_records.bag.ball_tracks import broken_off
from shared_control_records.bag.checks import check_bag
from shared_control_records.bag.reader import Bag, BagReadError, read_bag
from shared_control_records.bag.recorded import Wrenches
from shared_control_records.session.folder import SessionFolder

SOURCES = (contract.HUMAN_WRENCH, contract.AGENT_WRENCH)
TICK_NS = 1_000_000
EPSILON = 1e-9
UNSEEN_SECONDS = 1.5
"""What an agent that was killed may not have kept of an episode, and the time that its progress is told late."""
LOST_NS = 1_000_000_000
"""How much of what was sent a killed recorder may lose."""


def violations(path: Path, recorder_killed_ns: list[int], lost_rows: bool) -> list[str]:
    """What does not hold, in words; nothing when all does.

    Args:
        path: of the session's folder.
        recorder_killed_ns: when its recorder was killed, wall clock.
        lost_rows: whether episodes may be missing from the bag: its recorder was killed, stopped, or without a disk.
    """
    folder = SessionFolder.open(path)
    try:
        bag = read_bag(folder.bag, every_tick=True)
    except BagReadError as error:
        return [f'bag: {error}']
    return [*_torques(bag, panda()), *_moments(bag, 0.1, _lost(folder.bag)), *_sums(bag), *_mcap(folder.bag, bag),
            *_recording(bag, recorder_killed_ns), *_learner(folder), *_table(folder, bag, lost_rows), *_report(folder)]


def _torques(bag: Bag, robot: RobotSpec) -> Iterator[str]:
    """No torque beyond limit or rate, by what the robot reports to have applied."""
    joints = bag.joint_states
    if not len(joints.effort):
        yield 'torque: there are no /joint_states'
        return
    beyond = (np.abs(joints.effort) > robot.torque_max + EPSILON) | ~np.isfinite(joints.effort)
    if beyond.any():
        yield f'torque: beyond the limit at {beyond.any(axis=1).sum()} ticks'
    in_a_row = (np.diff(joints.stamp_ns) == TICK_NS) & (joints.qd[1:] != 0.0).any(axis=1)
    steps = np.abs(np.diff(joints.effort, axis=0))[in_a_row]
    too_fast = steps > robot.torque_rate_max * 1e-3 + EPSILON
    if too_fast.any():
        yield f'torque: beyond the rate at {too_fast.any(axis=1).sum()} ticks, at most {steps.max():.3f} N m in 1 ms'


def _lost(path: Path) -> dict[str, np.ndarray]:
    """By topic of a source, (n, 2): the stamps between which messages were sent that the recorder did not get, ns.

    By the publisher's own count of its messages.
    """
    lost: dict[str, list[tuple[int, int]]] = {topic.full_name: [] for topic in SOURCES}
    last: dict[str, tuple[int, int]] = {}
    for file in sorted(path.glob('*.mcap')):
        with file.open('rb') as stream, suppress(Exception):  # what mcap cannot read is another violation
            for _, channel, message in make_reader(stream).iter_messages(list(lost)):
                seconds, nanoseconds = struct.unpack_from('<iI', message.data, 4)
                stamp_ns = seconds * 1_000_000_000 + nanoseconds
                sequence, before_ns = last.get(channel.topic, (message.sequence, stamp_ns))
                if message.sequence > sequence + 1:
                    lost[channel.topic].append((before_ns, stamp_ns))
                last[channel.topic] = message.sequence, stamp_ns
    return {topic: np.array(pairs, np.int64).reshape(-1, 2) for topic, pairs in lost.items()}


def _moments(bag: Bag, timeout: float, lost: dict[str, np.ndarray]) -> Iterator[str]:
    """No moment counts that nobody has asked for within its time-out."""
    for name, topic, asked, applied in (('human', SOURCES[0], bag.human, bag.human_applied),
                                        ('agent', SOURCES[1], bag.agent, bag.agent_applied)):
        # What was lost on its way to the recorder may have come to the controller.
        unknown = lost[topic.full_name] + round((timeout + FADE_TIME) * 1e9) * np.array([-1, 1])
        counted = applied.moment.any(axis=1)
        old = [tick for tick in np.flatnonzero(counted) if not _asked_for(asked, applied, tick, timeout)
               and not ((unknown[:, 0] <= applied.stamp_ns[tick]) & (applied.stamp_ns[tick] <= unknown[:, 1])).any()]
        if old:
            tick = old[0]
            yield (f'moment: the {name} moment {applied.moment[tick]} counted at {applied.stamp_ns[tick] * 1e-9:.3f} s '
                   f'without anybody asking for it within {timeout} s; {len(old)} such ticks')


def _asked_for(asked: Wrenches, applied: Wrenches, tick: np.intp, timeout: float) -> bool:
    """Whether a message with this moment, or a larger one that fades, has a stamp near enough."""
    stamp, moment = applied.stamp_ns[tick], applied.moment[tick]
    near = (asked.stamp_ns >= stamp - round((timeout + FADE_TIME) * 1e9)) & (
        asked.stamp_ns <= stamp + round(timeout * 1e9))
    values = asked.moment[near]
    return bool(((np.sign(values) == np.sign(moment)) | (moment == 0)).all(axis=1).any()
                and (np.abs(values).max(axis=0) >= np.abs(moment) - EPSILON).all()) if len(values) else False


def _sums(bag: Bag) -> Iterator[str]:
    yield from (line for line in check_bag(bag) if 'the sum is not' in line)


def _mcap(path: Path, bag: Bag) -> Iterator[str]:
    """The same messages by another library."""
    count = 0
    for file in sorted(path.glob('*.mcap')):
        try:
            with file.open('rb') as stream:
                count += sum(1 for _ in make_reader(stream).iter_messages(log_time_order=False))
        except Exception as error:  # mcap raises errors of many kinds
            yield f'bag: mcap cannot read {file.name}: {error!r}'
    if count != sum(bag.counts.values()):
        yield f'bag: mcap reads {count} messages, rosbags {sum(bag.counts.values())}'


def _recording(bag: Bag, killed_ns: list[int]) -> Iterator[str]:
    received = bag.joint_states.received_ns
    for time_ns in killed_ns:
        before = received[received <= time_ns]
        if len(before) and time_ns - before[-1] > LOST_NS and (received > time_ns).any():
            yield f'bag: {(time_ns - before[-1]) * 1e-9:.2f} s lost before the recorder was killed'


def _learner(folder: SessionFolder) -> Iterator[str]:
    if folder.policy.exists():
        try:
            load_policy(folder.policy)
        except PolicyFileError as error:
            yield f'policy: {error}'


def _table(folder: SessionFolder, bag: Bag, lost_rows: bool) -> Iterator[str]:
    """Every episode in the table is in the bag and the other way round, unless the recorder was away."""
    if lost_rows:
        return
    returns = bag.training[contract.EPISODE_RETURN].values
    seconds: dict[int, list[float]] = {}
    for row in read_rows(folder.episodes):
        value = float(row['return'])
        if np.isclose(returns, value, rtol=1e-4, atol=1e-4).any():
            continue
        if row['phase'] == BROKEN_OFF:
            seconds.setdefault(int(row['episode']), []).append(float(row['seconds']))
        else:
            yield f'table: the return {value} of episode {row["episode"]} is not in the bag'
    for number, recorded in broken_off(bag):
        if recorded > UNSEEN_SECONDS:
            of_table = seconds.get(number, [])
            nearest = min(of_table, key=lambda kept: abs(kept - recorded), default=0.0)
            if abs(nearest - recorded) > UNSEEN_SECONDS:
                yield (f'table: episode {number} was broken off after {recorded:.2f} s by the bag, by the table after '
                       f'{of_table}')
            else:
                of_table.remove(nearest)


def _report(folder: SessionFolder) -> Iterator[str]:
    if not folder.report.exists():
        yield 'report: there is none'
        return
    try:
        json.loads(folder.summary.read_text(), parse_constant=lambda name: (_ for _ in ()).throw(ValueError(name)))
    except (OSError, ValueError) as error:
        yield f'report: summary.json: {error}'
