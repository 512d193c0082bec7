"""How the ball moved in each episode, from a bag."""

from dataclasses import dataclass

import numpy as np
from shared_control import contract
from shared_control.robot.model import RobotModel

from .reader import Bag

_JUMP = 0.03
"""m between two samples: the ball was dropped anew; a rolling ball makes a tenth of that."""


@dataclass(frozen=True, eq=False)
class EpisodeTrack:
    """One episode that came to its end."""

    number: int
    phase: str
    start_ns: int
    """The robot's time at its start."""
    seconds: np.ndarray
    """(n,), since the start"""
    position_error: np.ndarray
    """(n,), tray centre - ball along base x, m"""

    @property
    def end_ns(self) -> int:
        """The robot's time at its end."""
        return self.start_ns + round(self.seconds[-1] * 1e9)


def episode_tracks(bag: Bag) -> list[EpisodeTrack]:
    """The finished episodes of a bag in their order. One that was broken off, and began again, is left out."""
    starts, ends = bag.training[contract.EPISODE], bag.training[contract.EPISODE_RETURN]
    error = _position_error(bag)
    tracks = []
    for index, (start_ns, number) in enumerate(zip(starts.received_ns, starts.values, strict=True)):
        next_ns = starts.received_ns[index + 1] if index + 1 < len(starts.received_ns) else bag.end_ns
        ended = ends.received_ns[(ends.received_ns > start_ns) & (ends.received_ns <= next_ns)]
        if not len(ended):
            continue
        first, last = np.searchsorted(bag.ball.received_ns, (start_ns, ended[0]))
        first = _after_drop(bag.ball.position[first:last, 0]) + first
        if last - first < 2:
            continue
        stamps = bag.ball.stamp_ns[first:last]
        tracks.append(EpisodeTrack(
            int(number), _phase(bag, int((start_ns + ended[0]) / 2)), int(stamps[0]),
            (stamps - stamps[0]) * 1e-9, error[first:last]))
    return tracks


def _position_error(bag: Bag) -> np.ndarray:
    """Tray centre - ball along base x at every sample of /ball, m."""
    joints, ball = bag.joint_states, bag.ball
    if not len(joints.stamp_ns) or not len(ball.stamp_ns):
        return np.empty(len(ball.stamp_ns))
    model = RobotModel()
    index = np.searchsorted(joints.received_ns, ball.received_ns).clip(max=len(joints.received_ns) - 1)
    tray_x = np.array([model.tray_pose(q)[0][0] for q in joints.q[index]])
    return tray_x - ball.position[:, 0]


def _after_drop(x: np.ndarray) -> int:
    """The episode is announced about when the ball is dropped: index of the first sample after that."""
    jumps = np.flatnonzero(np.abs(np.diff(x[:50])) > _JUMP)
    return int(jumps[-1]) + 1 if len(jumps) else 0


def _phase(bag: Bag, received_ns: int) -> str:
    phases = bag.training[contract.PHASE]
    index = int(np.searchsorted(phases.received_ns, received_ns, 'right')) - 1
    return str(phases.values[index]) if index >= 0 else ''
