"""``shared-control session``: teach the robot, keep everything, measure what it has learned."""

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

from shared_control_records.bag import annotate, recover
from shared_control_records.bag.task import RECORD
from shared_control_records.session import bag_metadata
from shared_control_records.session.folder import SessionFolder

from . import parameters as ros_parameters
from .graph import overrides
from .options import add_options, given_settings, refuse_options_of_new_sessions
from .page import Page
from .settings import Settings
from .teaching import End, teach


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``session`` to the ``shared-control`` command."""
    parser = commands.add_parser('session', help='teach the robot on the running graph', description=__doc__)
    add_options(parser)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run a session and report it; the exit code.

    Raises:
        ValueError: an option or the parameter file cannot be used; no file was written or removed.
        OSError: a file cannot be read, or the folder not used.
    """
    earlier = None if args.resume is None else SessionFolder.open(args.resume)
    settings = _new_settings(args) if earlier is None else _resumed_settings(args, earlier)
    params_file = getattr(args, 'params_file', ros_parameters.DEFAULTS) if earlier is None else earlier.given_parameters
    parameters = ros_parameters.load(params_file)
    given_parameters = params_file.read_bytes()
    if settings.tutor == 'keyboard' and not _has_terminal():
        raise ValueError('there is no terminal to press keys in: use --tutor sim, or start the session from one')
    shows_screen = _has_terminal() and settings.screen and settings.tutor != 'page'
    page = Page.choose(settings, parameters)

    # Nothing is left to be refused but the folder itself.
    if earlier is None:
        path = getattr(args, 'output', None) or Path('out/sessions') / time.strftime('%Y-%m-%d_%H-%M-%S')
        folder = SessionFolder.create(path, hasattr(args, 'overwrite'), settings.to_json())
        folder.given_parameters.write_bytes(given_parameters)
    else:
        folder = earlier
        folder.claim()
        folder.write_settings(settings.to_json())
    if page is not None:
        settings = replace(settings, page=(page.host, page.port))
    ros_parameters.save(
        ros_parameters.lay_over(parameters, overrides(settings, folder.path, shows_screen)), folder.parameters)

    print(f'Session in {folder.path}: {settings.task}, {settings.preset}, tutor: {settings.teacher}.', flush=True)
    end, restarts = teach(folder, settings.tutor, shows_screen, page)
    _report(folder, end, restarts, settings.test_episodes)
    return end.value


def _new_settings(args: argparse.Namespace) -> Settings:
    return Settings().with_options(given_settings(args)).resolved()


def _resumed_settings(args: argparse.Namespace, folder: SessionFolder) -> Settings:
    """The settings of an earlier session, with what the options change in them."""
    refuse_options_of_new_sessions(args)
    content = folder.read_json(folder.settings)
    if content is None:
        raise ValueError(f'{folder.settings} is missing: it is not known how to go on')
    try:
        settings = Settings.from_json(content)
    except ValueError as error:
        raise ValueError(f'cannot use {folder.settings}: {error}') from error
    return settings.resumed_with(given_settings(args)).resolved()


def _report(folder: SessionFolder, end: End, restarts: int, test_episodes: int) -> None:
    """Test the policy, complete the bag, write the report, and tell what came of it."""
    # Imported late: torch and matplotlib take seconds, and the person wants to begin.
    from shared_control_records.session.report import write_report

    from .aftermath import describe_policy, tell_summary, test_policy
    if folder.bag.exists():
        recover(folder.bag)
    if end is not End.FAILED:
        describe_policy(folder)
    if end is End.DONE and test_episodes:
        test_policy(folder, test_episodes)
    if folder.bag.exists() and any(folder.bag.glob('*.mcap')):
        annotate(folder.bag, RECORD, bag_metadata.pack(folder, restarts))
    tell_summary(folder, write_report(folder, restarts))
    if end is not End.DONE:
        print(f'Stopped before the end. Go on with\n  shared-control session --resume {folder.path}')


def _has_terminal() -> bool:
    try:
        Path('/dev/tty').open('rb').close()
    except OSError:
        return False
    return sys.stdin.isatty()
