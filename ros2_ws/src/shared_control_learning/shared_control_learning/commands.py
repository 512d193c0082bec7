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

"""The options of ``shared-control train`` and ``tutors``. What they do is imported late: torch takes seconds."""

import argparse
from pathlib import Path
from typing import Any

from shared_control.command_line import add_json_option, add_parser
from shared_control.control.sharing import WAYS
from shared_control.plugins import LEARNERS, TASKS, WORLDS, names
from shared_control.teaching.tutors import HANDS, TUTOR_NAMES

from .train_options import TrainOptions


def add_train(commands: argparse._SubParsersAction) -> None:
    """Add ``train`` to the command line."""
    parser = add_parser(
        commands, 'train', _train, summary='teach a policy in this process, by a simulated tutor or by nobody',
        description='Teach a policy headless and as fast as the machine can, with a simulated tutor or none; after '
        'each episode the policy is tested alone. The folder gets policy.safetensors, episodes.csv, run.json and '
        'TensorBoard logs. The exit code is 1 when the policy was tested and is not skilled yet.',
        examples=['shared-control train --profile low --until-skilled',
                  'shared-control train --preset autonomous --episodes 30 --output out/alone',
                  'shared-control train --resume out/train --episodes 40'])
    default = TrainOptions()

    def add(name: str, text: str, **options: Any) -> None:  # those that are not given are not in the namespace
        parser.add_argument(name, default=argparse.SUPPRESS, help=text, **options)

    add('--preset', "how it is learned (default: the task's; guided for balance and plate)", choices=names(LEARNERS))
    add('--task', "what is learned (default: the preset's task, or balance)", choices=names(TASKS))
    add('--physics', f'what the arm moves in (default: {default.physics})', choices=names(WORLDS))
    add('--profile', 'who the simulated tutor is, a profile or a family of which the seed draws one: '
        f'{", ".join(TUTOR_NAMES)}; or none (default: expert; none for a preset that nobody teaches, and for a '
        'task that tutors do not know)', choices=(*TUTOR_NAMES, 'none'), metavar='NAME')
    add('--sharing', f'what counts of the two moments (default: {default.sharing})', choices=WAYS)
    add('--human-only', "do not apply the agent's moment", action='store_true')
    add('--seed', f'seed of everything random (default: {default.seed})', type=int, metavar='N')
    add('--episodes', f'teach this many at the most (default: {default.episodes})', type=int, metavar='N')
    add('--until-skilled', 'stop when two tests in a row were passed', action='store_true')
    add('--evaluate-every', f'test after every Nth episode; 0: never (default: {default.evaluate_every})', type=int,
        metavar='N')
    parser.add_argument('--output', type=Path, default=Path('out/train'), metavar='FOLDER', help='folder of the run')
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument('--resume', type=Path, metavar='FOLDER',
                        help='go on with the run in this folder, with the options that it began with but for those '
                        'that are given (default: begin a new run)')
    choice.add_argument('--overwrite', action='store_true',
                        help='remove what an earlier run wrote in the folder, and nothing else')
    add_json_option(parser, 'the result')


def add_tutors(commands: argparse._SubParsersAction) -> None:
    """Add ``tutors`` to the command line."""
    parser = add_parser(
        commands, 'tutors', _tutors, summary='list simulated tutors, and how well each does the task alone',
        description='Measure simulated tutors: every individual has one episode with a robot that gives no moment of '
        'its own. Families marked "tuning" may be used to choose settings; results are of those held out.',
        examples=['shared-control tutors', 'shared-control tutors expert low --individuals 24 --task plate'])
    parser.add_argument('tutors', nargs='*', metavar='NAME', default=None,
                        help=f'profiles and families: {", ".join(TUTOR_NAMES)} (default: all; with a stick those who '
                             'can have one)')
    parser.add_argument('--individuals', type=int, default=12, metavar='N', help='individuals of each')
    parser.add_argument('--task', choices=names(TASKS), default='balance', help='what they do')
    parser.add_argument('--device', choices=HANDS, default=HANDS[0],
                        help='what they have in the hand; a stick holds any moment')
    add_json_option(parser, 'all figures')


def _train(args: argparse.Namespace) -> int:
    from .train_command import run
    return run(args)


def _tutors(args: argparse.Namespace) -> int:
    from .tutors_command import run
    return run(args)
