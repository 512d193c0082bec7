"""``shared-control session``: teach the robot, keep everything, measure what it has learned."""

import argparse
import json
import signal
import sys
import time
from pathlib import Path
from typing import Any

from shared_control.human.profiles import PROFILES
from shared_control.learning.evaluate import evaluate_policy_file
from shared_control.learning.presets import PRESETS, preset
from shared_control.session.folder import SessionFolder
from shared_control.session.report import write_report

from . import parameters as ros_parameters
from .node_process import NodeProcess
from .progress import EpisodePrinter
from .supervisor import SessionError, Supervisor

POLL_SECONDS = 0.1


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``session`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'session', help='teach the robot on the running graph', description=__doc__,
        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument('--tutor', choices=('keyboard', 'sim', 'none'), default='keyboard',
                        help='who teaches: you at this terminal, a simulated tutor, or nobody')
    parser.add_argument('--profile', choices=tuple(PROFILES), default='expert', help='of the simulated tutor')
    parser.add_argument('--preset', choices=tuple(PRESETS), default='coached', help='what is learned and how')
    parser.add_argument('--episodes', type=int, default=0,
                        help='teach this many, then test; 0: until you say that it has learned it')
    parser.add_argument('--minutes', type=float, default=45.0, help='teach for this long at the most')
    parser.add_argument('--test-episodes', type=int, default=20, help='of the policy alone, at the end')
    parser.add_argument('--seed', type=int, default=0, help='of ball starts, learner and simulated tutor')
    parser.add_argument('--output', type=Path, default=None,
                        help='folder of the session; a new one below out/sessions when not given')
    parser.add_argument('--overwrite', action='store_true', help='remove what an earlier session left in that folder')
    parser.add_argument('--resume', type=Path, default=None, metavar='FOLDER',
                        help='go on with an earlier session: its learner, its settings, its folder')
    parser.add_argument('--params-file', type=Path, default=ros_parameters.DEFAULTS, help='ROS parameters of the nodes')
    parser.add_argument('--no-screen', action='store_true', help='print a line an episode instead of the screen')
    parser.set_defaults(run=run)
