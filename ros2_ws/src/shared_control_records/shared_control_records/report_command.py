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

"""``shared-control report``: the page of a study, or of a session from its bag alone."""

import argparse
import sys
from pathlib import Path

from shared_control.command_line import add_parser


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``report`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'report', run, summary='write the report of a session or of a study',
        description='Write the report of a study, or of a session from its bag alone: one page, its figures and '
                    'numbers beside it.',
        examples=['shared-control report out/demo', 'shared-control report out/studies/quick',
                  'shared-control report somebody_elses_bag/ --output out/theirs'])
    parser.add_argument('source', type=Path, metavar='SESSION_OR_STUDY',
                        help="a session's folder, its bag's folder, or an MCAP file; or a study's folder")
    parser.add_argument('--output', type=Path, default=None, metavar='FOLDER',
                        help="new folder for a session's report, any for a study's (default: SESSION_report beside "
                             'it; STUDY/report)')


def run(args: argparse.Namespace) -> int:
    """Write a report; the exit code."""
    # Imported late: pinocchio and matplotlib take seconds, which `--help` need not wait for.
    from .bag.files import find_bag
    from .study.folder import StudyFolder
    if StudyFolder.is_at(args.source):
        from .study_report.report import write_study_report
        study = StudyFolder(args.source)
        page = write_study_report(study, args.output or study.report)
    else:
        from .bag.task import session_record
        from .session.bag_report import write_bag_report
        from .session.folder import report_beside
        bag = find_bag(args.source)
        page = write_bag_report(bag, args.output or report_beside(args.source))
        if not session_record(bag):
            print('note: this bag has no record of the session (`ros2 bag record` and `convert` keep none): preset, '
                  'test of the policy and restarts are unknown, the tutor is guessed, the task is what its nodes '
                  "reported (balance, if they did not) unless a session's settings.json lies beside the bag",
                  file=sys.stderr)
    print(page)
    return 0
