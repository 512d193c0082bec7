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

"""The options of ``shared-control session``."""

import argparse
from dataclasses import fields
from pathlib import Path
from typing import Any

from shared_control.control.sharing import WAYS
from shared_control.plugins import LEARNERS, TASKS, WORLDS, names
from shared_control.teaching.feedback import FEEDBACK
from shared_control.teaching.tutors import TUTOR_NAMES
from shared_control_ros.host_and_port import host_and_port

from .parameters import DEFAULTS
from .settings import EPISODES_OF_SIMULATED, TUTORS, Settings

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
    add('--profile', f'who the simulated tutor is, a profile or a family of which the seed draws one: '
        f'{", ".join(TUTOR_NAMES)} (default: {default.profile})', choices=TUTOR_NAMES, metavar='NAME')
    add('--task', "what is learned (default: the preset's task, or balance)", choices=names(TASKS))
    add('--preset', "how it is learned (default: the task's; guided for balance and plate)", choices=names(LEARNERS))
    add('--physics', f'what the arm moves in (default: {default.physics})', choices=names(WORLDS))
    add('--sharing', f'what counts of the two moments (default: {default.sharing})', choices=WAYS)
    add('--episodes', 'teach this many, then test; 0: until you say that it has learned it, or for all of --minutes '
        f'(default: {default.episodes}; with --tutor sim: {EPISODES_OF_SIMULATED})', type=int, metavar='N')
    add('--minutes', f'teach for this long at the most (default: {default.minutes:g})', type=float, metavar='MIN')
    add('--test-episodes', 'test the policy alone in this many episodes at the end; 0: no test (default: '
        f'{default.test_episodes})', type=int, metavar='N')
    add('--robot', "the robot: a name, or the path of a robot's file (default: as the parameter file has it; panda)",
        metavar='ROBOT')
    add('--seed', f'seed of ball starts, learner and simulated tutor (default: {default.seed})', type=int, metavar='N')
    add('--screen', 'show the lesson in the terminal; --no-screen: print a line an episode instead (default: '
        '--screen)', action=argparse.BooleanOptionalAction)
    add('--practice-rests', 'practise until the ball has been brought to rest this often; 0: until you want to teach '
        f'(default: {default.practice_rests})', type=int, metavar='N')
    add('--practice-minutes', 'practise for this long at the most to come to that (default: '
        f'{default.practice_minutes:g})', type=float, metavar='MIN')
    add('--feedback', 'what a person is told while teaching. none: what they see. ball: how each episode ended. full: '
        f"and the robot's push, human share, score and tests (default: {default.feedback}; with --blind: ball)",
        choices=FEEDBACK)
    add('--verdicts', 'offer keys that call the last episode good, bad or discarded; --no-verdicts: offer none '
        '(default: --verdicts; with --blind: --no-verdicts)', action=argparse.BooleanOptionalAction)
    add('--blind', 'tell the person neither condition and folder nor what came of the session, as a study does',
        action='store_true')
    add('--output', 'folder of the session (default: a new one below out/sessions)', type=Path, metavar='FOLDER')
    add('--overwrite', 'remove what an earlier session wrote in that folder, and nothing else', action='store_true')
    add('--params-file', f'ROS parameters of the nodes; what it does not name is as in our own (default: '
        f'{DEFAULTS.name} of shared_control_bringup)', type=Path, metavar='FILE')
    parser.add_argument(
        '--resume', type=Path, metavar='FOLDER',
        help='go on with an earlier session: its learner, its parameters, its folder, and its settings unless other '
        'options change them; all may be given but --task, --preset, --physics, --robot, --seed, --output, --overwrite '
        'and --params-file (default: begin a new session)')


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
