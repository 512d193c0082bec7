"""Whether M_y = M_yai + M_yh held throughout a bag.

The controller takes the newest moment of human and of agent at every tick, and publishes the sum whenever it changes
and every ten ticks. A bag does not say which two messages a sum was made of. So this looks for a way to explain every
applied moment by one message of each source, such that no source ever goes back to an older message and none is taken
up later than the controller would accept it. It goes by the stamps, the robot's time: when a message reached the
recorder tells little on a busy machine, where one may be sent again and come seconds late.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from shared_control.contract import BASE_FRAME
from shared_control.control.moments import freshness

from .reader import Bag
from .recorded import Wrenches

AHEAD = 0.02
"""s: a stamp may be this much ahead of the tick that the message is applied at; the clock goes out at 100 Hz."""
SETTLING = 1.0
"""After its start the controller may not have heard of a source for this long, s."""
SILENCE = 0.2
"""A node that said nothing for this long (of the recorder's clock) may have been started anew, s."""
JOINING = 0.5
"""For this long the controller may hear a node that has just started before the recorder does, s."""
LATE = 0.05
"""s: a message that reached the recorder no sooner than this before it would have been too old may have come too late
for the controller, which then refused it."""
TOLERANCE = 1e-9
"""N m"""
_NONE = -1
"""In place of a message's index: the controller has not heard of the source."""


@dataclass(frozen=True)
class Mismatch:
    """An applied moment that no two messages explain."""

    received_ns: int
    stamp_ns: int
    m_y: float
    """As applied, N m."""
    nearest: float
    """The nearest sum of what the sources had sent, N m."""


def find_mismatches(bag: Bag, moment_limit: float, command_timeout: float) -> Iterator[Mismatch]:
    """Applied moments that are not the sum of what human and agent asked for.

    Args:
        moment_limit: the controller's bound of |M_y|, N m.
        command_timeout: the controller's time after which a moment fades, s.
    """
    applied = bag.applied
    agent = _Source(bag, bag.agent, command_timeout)
    human = _Source(bag, bag.human, command_timeout)
    silent = _after_silence(applied.received_ns)
    frontier = [(_NONE, _NONE)]
    settled_ns = 0
    for tick, stamp_ns, m_y in zip(range(len(silent)), applied.stamp_ns.tolist(), applied.m_y.tolist(), strict=True):
        if silent[tick]:
            frontier = [(_NONE, _NONE)]
            settled_ns = stamp_ns + round(SETTLING * 1e9)
        settling = stamp_ns < settled_ns
        agent_indices, agent_moments = agent.candidates(stamp_ns, settling)
        human_indices, human_moments = human.candidates(stamp_ns, settling)
        sums = np.clip(np.add.outer(agent_moments, human_moments), -moment_limit, moment_limit)
        explanations = [
            (agent_indices[i], human_indices[j])
            for i, j in zip(*np.nonzero(np.abs(sums - m_y) <= TOLERANCE), strict=True)
            if any(i_before <= agent_indices[i] and j_before <= human_indices[j] for i_before, j_before in frontier)]
        if explanations:
            frontier = _earliest(explanations)
        elif not (agent.joining[tick] or human.joining[tick]):
            nearest = sums.flat[np.abs(sums - m_y).argmin()]
            yield Mismatch(int(applied.received_ns[tick]), stamp_ns, m_y, float(nearest))


class _Source:
    """The messages of one source that the controller may have taken up at a tick."""

    def __init__(self, bag: Bag, wrenches: Wrenches, timeout: float):
        usable = (wrenches.frame == BASE_FRAME) & np.isfinite(wrenches.m_y)
        started_ns = wrenches.received_ns[_after_silence(wrenches.received_ns)]
        next_start = np.append(started_ns, 2**63 - 1)[np.searchsorted(started_ns, bag.applied.received_ns)]
        self.joining = next_start - bag.applied.received_ns < JOINING * 1e9
        """(ticks,): the source has started, but the recorder has not heard it yet."""
        self._timeout = timeout
        # By stamp, so that one that is wrong by far, which the controller drops, stands where it disturbs nobody.
        order = np.flatnonzero(usable)[np.argsort(wrenches.stamp_ns[usable], kind='stable')]
        self._m_y = wrenches.m_y[order].tolist()
        too_old_at = np.append(bag.applied.received_ns, 2**63 - 1)[
            np.searchsorted(bag.applied.stamp_ns, wrenches.stamp_ns[order] + round(timeout * 1e9))]
        self._maybe_refused = (wrenches.received_ns[order] > too_old_at - round(LATE * 1e9)).tolist()
        self._stamps_ns = wrenches.stamp_ns[order].tolist()

    def candidates(self, now_ns: int, settling: bool) -> tuple[list[int], list[float]]:
        """Indices of messages, and the moment that each amounts to at ``now_ns``, N m.

        The oldest is the newest that is too old to be accepted now: it may still be the last one that was. If it came
        too late for that, those before it are in question.
        """
        first = bisect_right(self._stamps_ns, now_ns - round(self._timeout * 1e9)) - 1
        while first > 0 and self._maybe_refused[first]:
            first -= 1
        end = bisect_right(self._stamps_ns, now_ns + round(AHEAD * 1e9))
        indices = list(range(max(first, 0), end))
        moments = [self._m_y[index] * freshness((now_ns - self._stamps_ns[index]) * 1e-9, self._timeout)
                   for index in indices]
        if settling or first == _NONE:
            return [_NONE, *indices], [0.0, *moments]
        return indices, moments


def _after_silence(received_ns: np.ndarray) -> np.ndarray:
    """Whether a message is the first of all, or the first after a silence."""
    return np.diff(received_ns, prepend=0) > SILENCE * 1e9


def _earliest(pairs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """The pairs to which no other is at most equal in both: what can follow a pair can follow these."""
    kept: list[tuple[int, int]] = []
    for pair in sorted(pairs):
        if not kept or pair[1] < kept[-1][1]:
            kept.append(pair)
    return kept
