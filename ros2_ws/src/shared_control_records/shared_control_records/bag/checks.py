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

"""Whether a bag is what it should be: complete, without gaps, and with a sum that is that of its parts throughout."""

from collections.abc import Iterable, Iterator
from functools import partial, reduce

import numpy as np
from shared_control import contract

from .reader import Bag
from .recorded import Wrenches
from .timing import simulator_runs

TICK_NS = 1_000_000
POLICY_NS = 20 * TICK_NS
APPLIED_EVERY = 20
"""Ticks; the applied moment is published every ten, or at the next chance after that."""
AT_START = 2
"""Ticks or commands that may lack their counterpart where the recording begins."""
JOINT_STATES = contract.JOINT_STATES.full_name
EFFORT_COMMANDS = contract.EFFORT_COMMANDS.full_name
APPLIED_WRENCH = contract.APPLIED_WRENCH.full_name
NEVER_SILENT = tuple(topic.full_name for topic in (
    contract.JOINT_STATES, contract.EFFORT_COMMANDS, contract.HUMAN_WRENCH, contract.AGENT_WRENCH,
    contract.APPLIED_WRENCH, contract.HUMAN_APPLIED, contract.AGENT_APPLIED, contract.BALL, contract.DIAGNOSTICS,
    contract.CLOCK))
"""Topics that have messages in every session."""
EXPECTED = tuple(topic.full_name for topic in contract.BAG_TOPICS if topic not in (
    contract.HUMAN_VERDICT, contract.VERDICT))
"""Topics that every bag has. Sessions of before people could judge episodes have no verdicts."""


def check_bag(bag: Bag, expected: Iterable[str] = EXPECTED, moment_limit: float = 20.0) -> list[str]:
    """What is wrong with a bag, in words; nothing when it is fine.

    Args:
        expected: the topics that it should have.
        moment_limit: the controller's parameter, N m.
    """
    return [*_check_topics(bag, expected), *_check_joint_states(bag), *_check_commands(bag),
            *_check_applied(bag), *_check_sums(bag, moment_limit)]


def _check_topics(bag: Bag, expected: Iterable[str]) -> Iterator[str]:
    for topic in expected:
        if topic not in bag.counts:
            yield f'{topic} was not recorded'
        elif topic in NEVER_SILENT and not bag.counts[topic]:
            yield f'{topic} has no messages'
    for topic, count in bag.unusable.items():
        yield f'{topic}: {count} unusable messages'


def _check_joint_states(bag: Bag) -> Iterator[str]:
    """A tick is 1 ms after the one before, or a repetition of it, or the first of a simulator that started anew.

    A simulator that is reset where its controller has left it, between two policy ticks, goes on at the next of these.
    """
    joints = bag.ticks
    steps = np.diff(joints.stamp_ns)
    odd = np.flatnonzero((steps != TICK_NS) & (steps != 0)) + 1
    fresh = odd[(joints.stamp_ns[odd] % POLICY_NS == 0) & joints.at_rest[odd]]
    is_reset = (steps[fresh - 1] > 0) & (steps[fresh - 1] < POLICY_NS)
    gaps = np.setdiff1d(odd, (*fresh[is_reset], *fresh[~is_reset][:_restarts(bag)]))
    if len(gaps):
        missing = (joints.stamp_ns[gaps] - joints.stamp_ns[gaps - 1]) / TICK_NS - 1
        lost = f'{missing.sum():.0f} ticks missing' if (missing > 0).all() else 'time runs backwards'
        yield (f'{JOINT_STATES}: {_count(len(gaps), "gap")}, {lost}; '
               f'the first after {_seconds(bag, joints.received_ns[gaps[0] - 1])}')


def _check_commands(bag: Bag) -> Iterator[str]:
    """One command a tick, and the torque that a tick reports is one that was commanded.

    The last tick before an end or a restart may be left without an answer, and a repeated tick may have two. A recorder
    that finds the controller after the simulator lacks the first commands: what it heard after both is compared. It may
    also hear what was sent before it was there in one go, long after the answers: then the whole is compared.
    """
    joints, commands = bag.ticks, bag.commands
    if not len(joints.stamp_ns) or not len(commands.torque):
        return
    new = np.diff(joints.stamp_ns, prepend=0) != 0
    both_ns = max(joints.received_ns[0], commands.received_ns[0])
    ticks = int((new & (joints.received_ns >= both_ns - TICK_NS)).sum())
    answers = int((commands.received_ns >= both_ns).sum())
    unanswered = (ticks - answers, int(new.sum()) - len(commands.torque))
    repetitions = int((~new).sum())
    if not any(-repetitions - AT_START <= number <= AT_START + _restarts(bag) for number in unanswered):
        yield (f'{EFFORT_COMMANDS}: {answers} commands for {ticks} ticks of '
               f'{JOINT_STATES}')
    # An episode begins at rest, with a torque that nobody commanded.
    # Mostly the newest command: the others alone are looked for among all.
    newest = np.searchsorted(commands.received_ns, joints.received_ns, 'right') - 1
    strange = np.flatnonzero(~joints.at_rest & (joints.effort != commands.torque[newest.clip(min=0)]))
    if len(strange):
        strange = strange[~np.isin(joints.effort[strange], commands.torque)]
    if len(strange):
        yield (f'{EFFORT_COMMANDS}: {_count(len(strange), "tick")} with a torque that was not commanded; '
               f'the first after {_seconds(bag, joints.received_ns[strange[0]])}')


def _check_applied(bag: Bag) -> Iterator[str]:
    known_jumps = _restarts(bag)
    for topic, wrenches in ((contract.APPLIED_WRENCH, bag.applied), (contract.HUMAN_APPLIED, bag.human_applied),
                            (contract.AGENT_APPLIED, bag.agent_applied)):
        gaps = np.flatnonzero(np.diff(wrenches.stamp_ns) > APPLIED_EVERY * TICK_NS)
        if len(gaps) > known_jumps:
            yield (f'{topic.full_name}: {_count(len(gaps) - known_jumps, "time")} nothing for more than '
                   f'{APPLIED_EVERY} ticks; the first after {_seconds(bag, wrenches.received_ns[gaps[0]])}')


def _check_sums(bag: Bag, moment_limit: float) -> Iterator[str]:
    """The controller publishes a sum and its parts with one stamp, so they must agree to the last bit."""
    of_topics = [_by_stamp(wrenches) for wrenches in (bag.applied, bag.human_applied, bag.agent_applied)]
    common = reduce(partial(np.intersect1d, assume_unique=True), (stamps for stamps, _ in of_topics))
    applied, human, agent = (moments[np.searchsorted(stamps, common)] for stamps, moments in of_topics)
    sums = np.clip(agent + human, -moment_limit, moment_limit)
    wrong = np.flatnonzero((applied != sums).any(axis=1))
    if len(wrong):
        first = wrong[0]
        received_ns = bag.applied.received_ns[np.flatnonzero(bag.applied.stamp_ns == common[first])[-1]]
        yield (f'{APPLIED_WRENCH}: the sum is not that of its parts at {_count(len(wrong), "tick")}; the first after '
               f'{_seconds(bag, received_ns)}: {_moment(applied[first])} applied, {_moment(sums[first])} of its parts')


def _by_stamp(wrenches: Wrenches) -> tuple[np.ndarray, np.ndarray]:
    """Stamps, rising, and the moment of each: of a tick that was answered again, the last one."""
    if (np.diff(wrenches.stamp_ns) > 0).all():
        return wrenches.stamp_ns, wrenches.moment
    stamps, last = np.unique(wrenches.stamp_ns[::-1], return_index=True)
    return stamps, wrenches.moment[::-1][last]


def _moment(moment: np.ndarray) -> str:
    return ', '.join(f'{value:.4f}' for value in moment) + ' N m'


def _restarts(bag: Bag) -> int:
    """How often the simulator started anew."""
    return max(len(simulator_runs(bag)) - 1, 0)


def _count(number: int, what: str) -> str:
    return f'{number} {what}' if number == 1 else f'{number} {what}s'


def _seconds(bag: Bag, received_ns: int) -> str:
    return f'{(received_ns - bag.start_ns) * 1e-9:.3f} s'
