"""``shared-control report``: the page of a study, or of a session from its bag alone."""

import argparse
import sys
from pathlib import Path


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``report`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'report', help='the report of a study or of a bag', description=__doc__)
    parser.add_argument('source', type=Path, help="a study's folder, a session's bag folder, or a single MCAP file")
    parser.add_argument('--output', type=Path, default=None,
                        help="new folder for a bag's report (default: beside it), or for a study's "
                             '(default: report/ in its folder)')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write a report; the exit code."""
    # Imported late: pinocchio and matplotlib take seconds, which `--help` need not wait for.
    from .study.folder import StudyFolder
    if StudyFolder.is_at(args.source):
        from .study_report.report import write_study_report
        page = write_study_report(StudyFolder(args.source), args.output or args.source / 'report')
    else:
        from .bag.task import session_record
        from .session.bag_report import write_bag_report
        page = write_bag_report(args.source, args.output or args.source.absolute().with_name(
            f'{args.source.stem}_report'))
        if not session_record(args.source):
            print('note: this bag has no record of the session (`ros2 bag record` and `convert` keep none): preset, '
                  'test of the policy and restarts are unknown, the tutor is guessed, the task is taken to be balance '
                  "unless a session's settings.json lies beside the bag", file=sys.stderr)
    print(page)
    return 0
