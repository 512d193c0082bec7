"""A recorded session as pictures."""

import math

import numpy as np
from shared_control import contract
from shared_control.keys import count_buttons
from shared_control.robot.model import RobotModel, pitch
from shared_control_records.bag.reader import Bag, BagReadError
from shared_control_records.bag.recorded import Series, Wrenches

from .history import History
from .picture import LIT_FOR, Moments, Picture

LONGEST_STILL = 2.0
"""As much is played of a longer gap in the recording (between two runs of a session), s."""
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
        self._press_ns = np.array([press.received_ns for press in bag.presses], np.int64)

    @property
    def length(self) -> float:
        """s"""
        return float(self._elapsed[-1])

    def picture(self, seconds: float) -> Picture:
        """What was to be seen so many seconds after the beginning."""
        index = int(np.searchsorted(self._elapsed, seconds, 'right')) - 1
        within = min(seconds - self._elapsed[index], LONGEST_STILL)
        now_ns = int(self._received[index] + within * 1e9)
        q = self._bag.joint_states.q[index]
        origin, rotation = self._model.tray_pose(q)
        ball = self._bag.ball.position[_before(self._bag.ball.received_ns, now_ns) or 0]
        keys, hand = self._keys(now_ns)
        training = self._bag.training
        return Picture(
            q=q, ball=ball, ball_on_tray=rotation.T @ (ball - origin), pitch=pitch(rotation),
            tilt=math.acos(min(float(rotation[2, 2]), 1.0)),
            human=_moment(self._bag.human_applied, now_ns),
            agent=_moment(self._bag.agent_applied, now_ns),
            applied=_moment(self._bag.applied, now_ns),
            phase=_latest(training[contract.PHASE], now_ns), episode=_latest(training[contract.EPISODE], now_ns),
            time_left=_latest(training[contract.TIME_LEFT], now_ns),
            human_share=_latest(training[contract.HUMAN_SHARE], now_ns),
            success=_latest(training[contract.SUCCESS], now_ns), keys=keys, hand=hand, time=seconds,
            history=self._history(now_ns))

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
        for at_ns, value in zip(returns.received_ns, returns.values, strict=True):
            if at_ns > now_ns:
                break
            if _latest(self._bag.training[contract.PHASE], int(at_ns)) not in ('test', 'done'):
                history.add(float(value), _latest(self._bag.training[contract.HUMAN_SHARE], int(at_ns)))
        return history


def _before(times_ns: np.ndarray, now_ns: int) -> int | None:
    """Index of the last of ``times_ns`` that is not after ``now_ns``; None when there is none."""
    index = int(np.searchsorted(times_ns, now_ns, 'right')) - 1
    return index if index >= 0 else None


def _latest(series: Series, now_ns: int):  # type: ignore[no-untyped-def]  # a number or a text, as the topic has it
    index = _before(series.received_ns, now_ns)
    return None if index is None else series.values[index].item()


def _moment(wrenches: Wrenches, now_ns: int) -> Moments | None:
    index = _before(wrenches.received_ns, now_ns)
    if index is None or now_ns - wrenches.received_ns[index] > STALE_AFTER * 1e9:
        return None
    return tuple(wrenches.moment[index].tolist())
