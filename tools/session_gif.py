"""A small moving picture of a recorded session: what the person and the robot gave, and what the ball did.

    python tools/session_gif.py out/demo docs/images/session.gif

Shows the first and the last taught episode, and the robot's first test alone, side by side, from the bag: the tray with
its ball (tilt drawn as it was), and the two moments that the controller used.
"""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.figure import Figure
from shared_control.command_line import script_parser
from shared_control.robot.model import RobotModel, pitch
from shared_control_records.bag.ball_tracks import EpisodeTrack, episode_tracks
from shared_control_records.bag.reader import Bag, read_bag
from shared_control_records.plotting.style import AGENT, HUMAN, INK, STYLE

SECONDS = 8.0
"""Shown of each episode."""
RATE = 10
"""Pictures a second, at twice the speed of the session."""
BALL_RADIUS_SHOWN = 1.5
"""cm"""
MOMENT_SHOWN = 25.0
"""N m"""


class Scene:
    """One episode: the tray above, the two moments below."""

    def __init__(self, figure: Figure, column: int, title: str, bag: Bag, track: EpisodeTrack):
        stamps = track.start_ns + (np.arange(0.0, SECONDS, 2.0 / RATE) * 1e9).astype(np.int64)
        at = np.searchsorted(bag.ball.stamp_ns, stamps).clip(max=len(bag.ball.stamp_ns) - 1)
        joints = bag.joint_states
        model = RobotModel()
        rows = np.searchsorted(joints.stamp_ns, stamps).clip(max=len(joints.stamp_ns) - 1)
        self.tilt = np.array([pitch(model.tray_pose(q)[1]) for q in joints.q[rows]])
        centre = np.array([model.tray_pose(q)[0] for q in joints.q[rows]])
        self.ball = 100.0 * (bag.ball.position[at] - centre)
        self.human = bag.human_applied.moment_at(stamps)[:, 0]
        self.agent = bag.agent_applied.moment_at(stamps)[:, 0]
        self._half = 100.0 * bag.task.scene.half_length
        tray = figure.add_subplot(2, 3, column)
        tray.set(xlim=(-24, 24), ylim=(-8, 10), aspect='equal', title=title)
        tray.axis('off')
        tray.plot([0, 0], [-7, -4.5], color=INK, linewidth=1)
        self._tray, = tray.plot([], [], color=INK, linewidth=4)
        self._dot, = tray.plot([], [], 'o', color='#E69F00', markersize=9)
        bars = figure.add_subplot(2, 3, 3 + column)
        bars.set(xlim=(-MOMENT_SHOWN, MOMENT_SHOWN), ylim=(-0.6, 1.6), yticks=[0, 1])
        bars.set_yticklabels(['robot', 'tutor'] if column == 1 else [])
        bars.set_xlabel('N m')
        self._bars = bars.barh([0, 1], [0.0, 0.0], color=[AGENT, HUMAN])

    def draw(self, number: int) -> None:
        """Picture ``number``."""
        along = np.array([np.cos(self.tilt[number]), -np.sin(self.tilt[number])]) * self._half
        self._tray.set_data([-along[0], along[0]], [-along[1], along[1]])
        self._dot.set_data([self.ball[number, 0]], [self.ball[number, 2]])
        self._bars[0].set_width(self.agent[number])
        self._bars[1].set_width(self.human[number])


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('session', type=Path, metavar='SESSION', help='folder of a session with the task balance')
    parser.add_argument('picture', type=Path, metavar='FILE', help='the moving picture, a GIF')
    args = parser.parse_args()
    bag = read_bag(args.session / 'bag')
    tracks = episode_tracks(bag)
    taught = [track for track in tracks if track.phase == 'teach']
    tested = [track for track in tracks if track.phase == 'test']
    with matplotlib.rc_context({**STYLE, 'font.size': 8, 'axes.titlesize': 9, 'axes.grid': False}):
        figure = Figure(figsize=(7.2, 2.3), dpi=80, layout='constrained')
        scenes = [Scene(figure, 1, 'episode 1', bag, taught[0]),
                  Scene(figure, 2, f'episode {taught[-1].number}', bag, taught[-1]),
                  Scene(figure, 3, 'then alone', bag, tested[0])]
        frames = range(len(scenes[0].tilt))
        animation = FuncAnimation(figure, lambda number: [scene.draw(number) for scene in scenes], frames)
        animation.save(args.picture, PillowWriter(fps=RATE))


if __name__ == '__main__':
    main()
