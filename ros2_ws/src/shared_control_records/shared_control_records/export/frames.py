"""The episodes of a bag, time-aligned at the policy's rate."""

from dataclasses import dataclass

import numpy as np
from shared_control import contract
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.robot.model import RobotModel, pitch
from shared_control.tasks.task import Task

from ..bag.ball_tracks import EpisodeTrack, episode_tracks
from ..bag.reader import Bag
from ..bag.runs import run_window

PERIOD_NS = round(POLICY_PERIOD * 1e9)


@dataclass(frozen=True, eq=False)
class EpisodeFrames:
    """One episode, a row every 20 ms of the robot's time.

    States are those at the beginning of the period; moments are what counted at its end. So a row holds what was seen
    and what came of it.
    """

    task: Task
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
    agent: np.ndarray
    """The agent's moment as it counted, (n, k), N m"""
    human: np.ndarray
    """The human's, likewise"""
    applied: np.ndarray
    """Their sum as applied, likewise"""

    def __len__(self) -> int:
        return len(self.stamp_ns)


def episode_frames(bag: Bag) -> list[EpisodeFrames]:
    """The finished episodes of a bag, in their order.

    Raises:
        ValueError: it has none, or not the moments that counted; the message names the bag.
    """
    for topic, wrenches in ((contract.HUMAN_APPLIED, bag.human_applied), (contract.AGENT_APPLIED, bag.agent_applied),
                            (contract.APPLIED_WRENCH, bag.applied)):
        if not len(wrenches.stamp_ns):
            raise ValueError(f'the bag {bag.path} has no messages on {topic.full_name}')
    frames = [_frames(bag, track) for track in episode_tracks(bag)]
    if not frames:
        raise ValueError(f'the bag {bag.path} holds no finished episode')
    return frames


def _frames(bag: Bag, track: EpisodeTrack) -> EpisodeFrames:
    window = run_window(bag, track.received_ns[0])
    agent = bag.agent.between(window).stamp_ns
    agent = agent[np.searchsorted(agent, track.start_ns):]
    # The agent's stamps are those of the states that it acted on.
    start_ns = int(agent[0]) if len(agent) and agent[0] - track.start_ns < PERIOD_NS else track.start_ns
    begin = np.arange(start_ns, track.end_ns, PERIOD_NS)
    joints, ball = (_newest(series.received_ns, series.stamp_ns, begin, window)
                    for series in (bag.joint_states, bag.ball))
    moments = []
    for wrenches in (bag.agent_applied, bag.human_applied, bag.applied):
        own = wrenches.between(window)
        if not len(own.stamp_ns):
            raise ValueError(f'the bag {bag.path} has no moments of episode {track.number}')
        moments.append(own.moment_at(begin + PERIOD_NS - 1))
    q, position = bag.joint_states.q[joints], bag.ball.position[ball]
    model = RobotModel()
    velocity = bag.ball.velocity[ball]
    seen = np.array([_seen(bag.task, model, *row) for row in zip(q, position, velocity, strict=True)], float)
    seen = seen.reshape(-1, 6)
    return EpisodeFrames(
        bag.task, track.number, track.phase, begin, q, bag.joint_states.qd[joints], position, velocity,
        seen[:, 0], seen[:, 1], seen[:, 2:4], seen[:, 4:], *moments)


def _seen(task: Task, model: RobotModel, q: np.ndarray, ball: np.ndarray, velocity: np.ndarray) -> list[float]:
    """Position error, pitch, the ball on the tray and the lean at one moment."""
    none = np.zeros(len(task.axes))
    state = task.describe(PlantState(q, tuple(ball), tuple(velocity), none, none, none), model)
    origin, rotation = model.tray_pose(q)
    return [state.position_error, pitch(rotation), *rotation.T[:2] @ (ball - origin), *rotation[:2, 2]]


def _newest(received_ns: np.ndarray, stamps_ns: np.ndarray, at_ns: np.ndarray, window: tuple[int, int]) -> np.ndarray:
    """Indices of the newest messages at some times of the robot, of those received in a window of the recorder's time.

    The first message when there is none before.
    """
    first, last = np.searchsorted(received_ns, window)
    return (np.searchsorted(stamps_ns[first:last], at_ns, 'right') - 1).clip(min=0) + first
