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

"""``shared-control study``: participants x conditions from one YAML file; docs/how_to/study.md."""

import argparse
import os
import shlex
import sys
from pathlib import Path

from shared_control.command_line import add_json_option, add_parser, prose, write_json


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``study`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'study', run, summary='run a study: participants x conditions, from one YAML file',
        description='Run a study as its plan says: teach and test policies of simulated participants and those that '
                    'nobody teaches, or lead a real participant through their part. Stopped, by whatever, it goes on '
                    'where it was when the same command is given again. The exit code is 2 when a run has failed or '
                    'its result cannot be read, and 130 when it was stopped.',
        examples=['shared-control study studies/quick.yaml',
                  'shared-control study studies/baselines.yaml --quick --json -',
                  'shared-control study studies/people.yaml --participant 3',
                  'shared-control study studies/people.yaml --participant 3 --note "the phone rang in part 2"',
                  'shared-control report out/studies/quick'])
    parser.add_argument('plan', type=Path, metavar='PLAN', help='YAML file; studies/ has examples')
    parser.add_argument('--output', type=Path, default=None, metavar='FOLDER',
                        help='folder of the study (default: out/studies/NAME, as the plan is called)')
    parser.add_argument('--quick', action='store_true',
                        help='a participant of each of the first two groups, three episodes: whether all of it runs '
                             '(default: all of the plan)')
    parser.add_argument('--workers', type=int, default=len(os.sched_getaffinity(0)), metavar='N',
                        help='processes on this machine (default: one a core)')
    parser.add_argument('--ray', metavar='ADDRESS', default=None,
                        help='do the runs on this Ray cluster, auto: the one running here (default: on this machine)')
    parser.add_argument('--participant', type=int, metavar='N', default=None,
                        help='lead this real participant through what is left to do (default: what needs nobody)')
    about = parser.add_mutually_exclusive_group()
    about.add_argument('--withdraw', choices=('keep', 'delete'), default=None,
                       help='--participant takes no further part: keep, or delete, what was recorded of them '
                            '(default: they go on)')
    about.add_argument('--note', metavar='TEXT', default=None,
                       help='note this about --participant, with the time, also while they take part (default: none)')
    about.add_argument('--exclude', metavar='REASON', default=None,
                       help='leave --participant out of the report, and say there why (default: they count)')
    about.add_argument('--include', action='store_true', help='take --exclude back')
    add_json_option(parser, 'the figures of every condition with every group of simulated participants')


def run(args: argparse.Namespace) -> int:
    """Do what is left of a study; the exit code."""
    try:
        return _run(args)
    except KeyboardInterrupt:
        print('stopped; the same command goes on where it was', file=sys.stderr)
        raise
    except EOFError:
        print('nobody answers any more: the same command goes on where it was', file=sys.stderr)
        return 130


def _run(args: argparse.Namespace) -> int:
    from .folder import StudyFolder
    from .notes import add_note
    from .people import INTERRUPTED, asker_of, lead_through, withdraw
    from .run import do_runs
    if args.workers < 1:
        raise ValueError(f'--workers is {args.workers}, expected at least 1')
    noted = next(((kind, text) for kind, text in (
        ('note', args.note), ('exclude', args.exclude), ('include', '' if args.include else None))
        if text is not None), None)
    for option in ('withdraw', 'note', 'exclude', 'include'):
        if getattr(args, option) not in (None, False) and args.participant is None:
            raise ValueError(f'--{option} needs --participant NUMBER')
    folder = StudyFolder(
        args.output or Path('out/studies') / (f'{args.plan.stem}-quick' if args.quick else args.plan.stem))
    plan = folder.begin(args.plan, args.participant, args.quick, claims=noted is None)
    if args.participant is not None:
        if plan.people is None:
            raise ValueError(f'the participants of {args.plan} are simulated: leave --participant out')
        participant = plan.participant(args.participant)
        if noted is not None:
            add_note(folder.person(participant), *noted)
            print({'note': 'Noted', 'exclude': 'Left out of the report', 'include': 'Counts again'}[noted[0]]
                  + f': participant {participant.number}.')
            return 0
        if args.withdraw:
            withdraw(folder, plan, participant, args.withdraw)
            did = 'deleted' if args.withdraw == 'delete' else 'kept'
            print(f'Participant {participant.number} has withdrawn; what was recorded is {did}.')
            if args.withdraw == 'delete':
                print(f'The report, if there was one, is gone with it, and can be written anew:\n'
                      f'  shared-control report {shlex.quote(str(folder.path))}\n'
                      'Copies, exports and reports in other places are yours to clean.')
            return 0
        return 0 if lead_through(folder, plan, participant, asker_of(plan.people)) else INTERRUPTED
    who = 'simulated' if plan.people is None else 'real'
    if args.json is not None and plan.people is not None:
        raise ValueError(f'the participants of {args.plan} are real: leave --json out, the report has their figures')
    prints = prose(args.json)
    print(f'{len(plan.participants)} {who} participants x {len(plan.conditions)} conditions in {folder.path}',
          file=prints, flush=True)
    do_runs(folder, plan, args.workers, args.ray, prints)
    from ..study_report.measures import load_study  # late: what learns takes seconds to load
    study = load_study(folder)
    if plan.people is None:
        from ..study_report.cells import as_text, cell_rows
        rows = cell_rows(study)
        print(as_text(rows), file=prints)
        if args.quick:
            print('The quick form tests once, so nobody can be skilled, which takes two tests in a row.', file=prints)
        write_json({'tutors': 'simulated', 'seed': plan.seed, 'cells': rows,
                    'left_out': list(map(folder.without_path, study.problems))}, args.json)
    print(f'The report:\n  shared-control report {shlex.quote(str(folder.path))}', file=prints)
    if study.problems:
        problems = ''.join(f'\n  {problem}' for problem in study.problems)
        raise ValueError(f'{len(study.problems)} of {len(plan.jobs)} runs cannot be read, and no figure counts them:'
                         f'{problems}')
    return 0
