"""The options of ``shared-control session``."""

import argparse
from dataclasses import fields
from pathlib import Path
from typing import Any

from shared_control.control.sharing import WAYS
from shared_control.plugins import LEARNERS, TASKS, WORLDS, names
from shared_control.teaching.tutors import TUTOR_NAMES
from shared_control_ros.host_and_port import host_and_port

from .parameters import DEFAULTS
from .settings import TUTORS, Settings

_NEW_ONLY = ('output', 'overwrite', 'params_file')
"""Options, besides settings, that a session that goes on has no use for: it has a folder, and keeps its file there."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add them. Those that are not given are not in the namespace: a session that goes on keeps its own values."""
    default = Settings()

    def add(name: str, text: str, **options: Any) -> None:
        parser.add_argument(name, default=argparse.SUPPRESS, help=text, **options)

    add('--tutor', f'who teaches: you at this terminal, you in a browser, a simulated tutor, or nobody (default: '
        f'{default.tutor})', choices=TUTORS)
    add('--page', 'where the page of --tutor page is served; another host than loopback opens it to the network, with '
        f'a token (default: {default.page[0]}:{default.page[1]})', type=host_and_port, metavar='HOST:PORT')
    add('--profile', f'who the simulated tutor is: a profile, or a family, of which the seed draws one (default: '
        f'{default.profile})', choices=TUTOR_NAMES)
    add('--task', 'what is learned (default: what the preset was made for; balance)', choices=names(TASKS))
    add('--preset', 'how it is learned (default: as the task is; coached)', choices=names(LEARNERS))
    add('--physics', f'what the arm moves in (default: {default.physics})', choices=names(WORLDS))
    add('--sharing', f'what counts of the two moments (default: {default.sharing})', choices=WAYS)
    add('--episodes', f'teach this many, then test; 0: until you say that it has learned it (default: '
        f'{default.episodes})', type=int)
    add('--minutes', f'teach for this long at the most (default: {default.minutes:g})', type=float)
    add('--test-episodes', f'of the policy alone, at the end (default: {default.test_episodes})', type=int)
    add('--robot', "the robot: a name, or the path of a robot's file (default: as the parameter file has it; panda)")
    add('--seed', f'of ball starts, learner and simulated tutor (default: {default.seed})', type=int)
    add('--screen', 'show the lesson in the terminal; --no-screen: print a line an episode instead',
        action=argparse.BooleanOptionalAction)
    add('--blind', 'tell the person neither how the robot learns nor what came of it, as a study does',
        action='store_true')
    add('--output', 'folder of the session (default: a new one below out/sessions)', type=Path)
    add('--overwrite', 'remove what an earlier session wrote in that folder, and nothing else', action='store_true')
    add('--params-file', f'ROS parameters of the nodes; what it does not name is as in {DEFAULTS.name} of this package',
        type=Path)
    parser.add_argument(
        '--resume', type=Path, metavar='FOLDER',
        help='go on with an earlier session: its learner, its parameters, its folder, and its settings unless other '
        'options change them; all may be given but --task, --preset, --physics, --robot, --seed, --output, --overwrite '
        'and --params-file')


def given_settings(args: argparse.Namespace) -> dict[str, Any]:
    """The settings that were given, by name."""
    return {field.name: getattr(args, field.name) for field in fields(Settings) if hasattr(args, field.name)}


def refuse_options_of_new_sessions(args: argparse.Namespace) -> None:
    """For a session that goes on.

    Raises:
        ValueError: an option was given that belongs to a new session; the message names it.
    """
    for name in _NEW_ONLY:
        if hasattr(args, name):
            raise ValueError(f'--{name.replace("_", "-")} belongs to a new session: leave it out with --resume')
