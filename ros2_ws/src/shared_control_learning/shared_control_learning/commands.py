"""The options of ``shared-control train`` and ``tutors``. What they do is imported late: torch takes seconds."""

import argparse
from pathlib import Path

from shared_control.control.sharing import WAYS
from shared_control.plugins import LEARNERS, TASKS, WORLDS, names
from shared_control.teaching.tutors import TUTOR_NAMES


def add_train(commands: argparse._SubParsersAction) -> None:
    """Add ``train`` to the command line."""
    parser = commands.add_parser(
        'train', help='teach a policy in this process, by a simulated tutor or by nobody',
        description='Teaches a policy headless and as fast as the machine can, with a simulated tutor or none; after '
        'each episode the policy is tested alone. The folder gets policy.safetensors, episodes.csv, run.json and '
        'TensorBoard logs.')
    parser.add_argument('--preset', choices=names(LEARNERS), default='', help='how it is learned (default: as the '
                        'task is; coached)')
    parser.add_argument('--task', choices=names(TASKS), default='', help='what is learned (default: what the preset '
                        'was made for; balance)')
    parser.add_argument('--physics', choices=names(WORLDS), default='bullet', help='(default: %(default)s)')
    parser.add_argument('--tutor', choices=(*TUTOR_NAMES, 'none'), help='simulated tutor (default: expert; none for a '
                        'preset that nobody teaches, and for a task that tutors do not know)')
    parser.add_argument('--sharing', choices=WAYS, default='additive', help='what counts of the two moments (default: '
                        '%(default)s)')
    parser.add_argument('--human-only', action='store_true', help="the agent's moment is not applied (4.7)")
    parser.add_argument('--seed', type=int, default=0, help='of everything random (default: 0)')
    parser.add_argument('--episodes', type=int, default=20, help='at most so many (default: 20)')
    parser.add_argument('--until-skilled', action='store_true', help='stop when two tests in a row were passed')
    parser.add_argument('--evaluate-every', type=int, default=1, metavar='N', help='test after every Nth episode; 0: '
                        'never (default: 1)')
    parser.add_argument('--output', type=Path, default=Path('out/train'), help='folder (default: out/train)')
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument('--resume', action='store_true', help='go on with the run in the folder')
    choice.add_argument('--overwrite', action='store_true', help='begin anew in a folder that holds a run: remove '
                        'what that run wrote, and nothing else')
    parser.add_argument('--json', type=Path, metavar='FILE', help='write the result there as well; - for the output')
    parser.set_defaults(run=_train)


def add_tutors(commands: argparse._SubParsersAction) -> None:
    """Add ``tutors`` to the command line."""
    parser = commands.add_parser(
        'tutors', help='simulated tutors: families, sources, and how well each does the task alone',
        description='Every individual has one episode with a robot that gives no moment of its own. All tutors are '
        'simulated. Families marked "tuning" may be used to choose settings; results are of those held out.')
    parser.add_argument('tutors', nargs='*', metavar='NAME', default=list(TUTOR_NAMES),
                        help=f'profiles and families (default: all): {", ".join(TUTOR_NAMES)}')
    parser.add_argument('--individuals', type=int, default=12, help='of each (default: %(default)s)')
    parser.add_argument('--task', choices=names(TASKS), default='balance')
    parser.add_argument('--json', type=Path, metavar='FILE', help='write the figures there as well')
    parser.set_defaults(run=_tutors)


def _train(args: argparse.Namespace) -> int:
    from .train_command import run
    return run(args)


def _tutors(args: argparse.Namespace) -> int:
    from .tutors_command import run
    return run(args)
