"""Whether a bag is what it should be: complete, without gaps, and with M_y = M_yai + M_yh throughout."""

from collections.abc import Iterable, Iterator

import numpy as np
from shared_control import contract

from .moment_check import find_mismatches
from .reader import Bag
from .recorded import JointStates
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
    contract.APPLIED_WRENCH, contract.BALL, contract.DIAGNOSTICS, contract.CLOCK))
"""Topics that have messages in every session."""
EXPECTED = tuple(topic.full_name for topic in contract.BAG_TOPICS)


def check_bag(bag: Bag, expected: Iterable[str] = EXPECTED, moment_limit: float = 20.0,
              command_timeout: float = 0.1) -> list[str]:
    """What is wrong with a bag, in words; nothing when it is fine.

    Args:
        expected: the topics that it should have.
        moment_limit: the controller's parameter, N m.
        command_timeout: the controller's parameter, s.
    """
    return [*_check_topics(bag, expected), *_check_joint_states(bag), *_check_commands(bag),
            *_check_applied(bag), *_check_sums(bag, moment_limit, command_timeout)]


def _check_topics(bag: Bag, expected: Iterable[str]) -> Iterator[str]:
    for topic in expected:
        if topic not in bag.counts:
            yield f'{topic} was not recorded'
        elif topic in NEVER_SILENT and not bag.counts[topic]:
            yield f'{topic} has no messages'
    for topic, count in bag.unusable.items():
        yield f'{topic}: {count} unusable messages'


def _check_joint_states(bag: Bag) -> Iterator[str]:
    """A tick is 1 ms after the one before, or a repetition of it, or the first of a simulator that started anew."""
    joints = bag.joint_states
    steps = np.diff(joints.stamp_ns)
    odd = np.flatnonzero((steps != TICK_NS) & (steps != 0)) + 1
    fresh = odd[(joints.stamp_ns[odd] % POLICY_NS == 0) & _is_reset(joints)[odd]]
    gaps = np.setdiff1d(odd, fresh[:_restarts(bag)])
    if len(gaps):
        missing = (joints.stamp_ns[gaps] - joints.stamp_ns[gaps - 1]) / TICK_NS - 1
        lost = f'{missing.sum():.0f} ticks missing' if (missing > 0).all() else 'time runs backwards'
        yield (f'{JOINT_STATES}: {_count(len(gaps), "gap")}, {lost}; '
               f'the first after {_seconds(bag, joints.received_ns[gaps[0] - 1])}')


def _check_commands(bag: Bag) -> Iterator[str]:
    """One command a tick, and the torque that a tick reports is one that was commanded.

    The last tick before an end or a restart may be left without an answer, and a repeated tick may have two. Only what
    the recorder heard after it had found both the simulator and the controller is compared.
    """
    joints, commands = bag.joint_states, bag.commands
    if not len(joints.stamp_ns) or not len(commands.torque):
        return
    new = np.diff(joints.stamp_ns, prepend=0) != 0
    both_ns = max(joints.received_ns[0], commands.received_ns[0])
    ticks = int((new & (joints.received_ns >= both_ns - TICK_NS)).sum())
    answers = int((commands.received_ns >= both_ns).sum())
    repetitions = int((~new).sum())
    if not -repetitions - AT_START <= ticks - answers <= AT_START + _restarts(bag):
        yield (f'{EFFORT_COMMANDS}: {answers} commands for {ticks} ticks of '
               f'{JOINT_STATES}')
    commanded = set(map(bytes, commands.torque + 0.0))  # + 0.0 makes -0.0 the same as 0.0
    applied = joints.effort + 0.0
    strange = [tick for tick in np.flatnonzero(~_is_reset(joints)) if bytes(applied[tick]) not in commanded]
    if strange:
        yield (f'{EFFORT_COMMANDS}: {_count(len(strange), "tick")} with a torque that was not commanded; '
               f'the first after {_seconds(bag, joints.received_ns[strange[0]])}')


def _is_reset(joints: JointStates) -> np.ndarray:
    """Whether a tick is the first of an episode: the arm is at rest, and holds a torque that nobody commanded."""
    return (joints.qd == 0.0).all(axis=1)


def _check_applied(bag: Bag) -> Iterator[str]:
    stamps = bag.applied.stamp_ns
    gaps = np.flatnonzero(np.diff(stamps) > APPLIED_EVERY * TICK_NS)
    known_jumps = _restarts(bag)
    if len(gaps) > known_jumps:
        yield (f'{APPLIED_WRENCH}: {_count(len(gaps) - known_jumps, "time")} nothing for more than '
               f'{APPLIED_EVERY} ticks; the first after {_seconds(bag, bag.applied.received_ns[gaps[0]])}')


def _check_sums(bag: Bag, moment_limit: float, command_timeout: float) -> Iterator[str]:
    mismatches = find_mismatches(bag, moment_limit, command_timeout)
    first = next(mismatches, None)
    if first is not None:
        count = 1 + sum(1 for _ in mismatches)
        yield (f'{APPLIED_WRENCH}: M_y is not M_yai + M_yh at {_count(count, "tick")}; the first after '
               f'{_seconds(bag, first.received_ns)}: {first.m_y:.4f} N m applied, {first.nearest:.4f} N m asked for')


def _restarts(bag: Bag) -> int:
    """How often the simulator started anew."""
    return max(len(simulator_runs(bag)) - 1, 0)


def _count(number: int, what: str) -> str:
    return f'{number} {what}' if number == 1 else f'{number} {what}s'


def _seconds(bag: Bag, received_ns: int) -> str:
    return f'{(received_ns - bag.start_ns) * 1e-9:.3f} s'
