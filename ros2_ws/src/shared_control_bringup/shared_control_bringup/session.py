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

"""``shared-control session``: teach the robot, keep everything, measure what it has learned."""

import argparse
import os
import shlex
import sys
import time
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from shared_control.files import write_atomically
from shared_control_learning.episode_table import keep_unfinished
from shared_control_records.bag import annotate, recover
from shared_control_records.bag.task import RECORD
from shared_control_records.session import bag_metadata
from shared_control_records.session.final_test import load_test, sha256
from shared_control_records.session.folder import SessionFolder

from . import parameters as ros_parameters
from .graph import overrides
from .interrupts import Interrupts
from .neighbours import Neighbours
from .node_process import NodeProcess
from .options import given_settings, refuse_options_of_new_sessions
from .page import TOKEN, Page
from .parameter_check import check_values, refuse_overridden
from .settings import EPISODES_OF_SIMULATED, Settings
from .supervisor import STOP_SECONDS, end_by_force
from .teaching import POLL_SECONDS, End, teach
from .terminal import restored_terminal

PAGE_SECONDS = 600.0
"""How long the page stays for a person who has left it open, s."""


def run(args: argparse.Namespace) -> int:
    """Run a session and report it; the exit code.

    Raises:
        ValueError: an option or the parameter file cannot be used; no file was written or removed.
        OSError: a file cannot be read, or the folder not used.
    """
    earlier = None if args.resume is None else SessionFolder.open(args.resume)
    settings = _new_settings(args) if earlier is None else _resumed_settings(args, earlier)
    if earlier is not None:
        _check_results(earlier)
        if _is_taught(settings, earlier, given_settings(args)):
            return _test_only(settings, earlier)
    params_file = getattr(args, 'params_file', ros_parameters.DEFAULTS) if earlier is None else earlier.given_parameters
    given_parameters = params_file.read_bytes()  # once: it may be a pipe
    given = ros_parameters.read(given_parameters, params_file)
    if earlier is None:
        check_values(given, params_file)
    parameters = ros_parameters.over_defaults(given)
    if settings.tutor == 'keyboard':
        _require_terminal()
    shows_screen = _has_terminal() and _can_draw() and settings.screen and settings.tutor != 'page'
    path = earlier.path if earlier else getattr(args, 'output', None) or (
        Path('out/sessions') / time.strftime('%Y-%m-%d_%H-%M-%S'))
    with Neighbours() as neighbours:
        page = Page.choose(settings, parameters)
        served = settings if page is None else replace(settings, page=(page.host, page.port))
        taken = overrides(served, path.expanduser().absolute(), shows_screen)
        if earlier is None:
            refuse_overridden(given, taken, params_file)
        parameters = ros_parameters.lay_over(parameters, taken)
        neighbours.refuse()

    # Nothing is left to be refused but the folder itself.
    with Interrupts() as interrupts:
        if earlier is None:
            folder = SessionFolder.create(path, hasattr(args, 'overwrite'), settings.to_json())
            write_atomically(folder.given_parameters, ros_parameters.blanked(given_parameters, TOKEN))
        else:
            folder = earlier
            folder.claim()
            if not set(given_settings(args)) <= {'test_episodes'}:
                folder.last_episode.unlink(missing_ok=True)  # whoever asks for something else wants it to go on
        ros_parameters.save(parameters, folder.parameters)
        print('The session begins.' if settings.blind else
              f'Session in {folder.path}: {settings.task}, {settings.preset}, tutor: {settings.teacher}.', flush=True)
        earlier_restarts = _earlier_restarts(folder)
        folder.write_settings(replace(settings, taught=False).to_json())
        folder.ending.unlink(missing_ok=True)
        with restored_terminal() if shows_screen else nullcontext():
            end, restarts, page_node = teach(folder, settings.tutor, shows_screen, page, interrupts, settings.blind)
        try:
            end = _conclude(folder, end, restarts + earlier_restarts, settings, interrupts)
            if end is End.DONE and page is not None and page_node is not None:
                _keep_open(page, page_node, interrupts)
        finally:
            if page_node is not None:
                page_node.interrupt()
                if not page_node.has_left(STOP_SECONDS):
                    end_by_force(page_node, print)
            folder.ending.unlink(missing_ok=True)
        return end.value


def _keep_open(page: Page, node: NodeProcess, interrupts: Interrupts) -> None:
    """Leave the page where it is until it is closed, or nobody looks at it any more."""
    print(f'The page stays open until it is closed there, or Ctrl-C: {page.address}', flush=True)
    until = time.monotonic() + PAGE_SECONDS
    while node.exit_code() is None and time.monotonic() < until and not interrupts.requested:
        time.sleep(POLL_SECONDS)


def _test_only(settings: Settings, folder: SessionFolder) -> int:
    """Go on with a session whose teaching is over; the exit code."""
    with Interrupts() as interrupts:
        folder.claim()
        folder.write_settings(settings.to_json())
        place = '' if settings.blind else f'Session in {folder.path}: '
        print(f'{place}the teaching is over, the robot is tested.', flush=True)
        return _conclude(folder, End.DONE, _earlier_restarts(folder), settings, interrupts).value


def _new_settings(args: argparse.Namespace) -> Settings:
    given = given_settings(args)
    if given.get('tutor') == 'sim':
        given.setdefault('episodes', EPISODES_OF_SIMULATED)
    return Settings().with_options(given).resolved()


def _resumed_settings(args: argparse.Namespace, folder: SessionFolder) -> Settings:
    """The settings of an earlier session, with what the options change in them."""
    refuse_options_of_new_sessions(args)
    content = folder.read_json(folder.settings)
    if content is None:
        raise ValueError(f'{folder.settings} is missing: it is not known how to go on; begin a new session')
    try:
        settings = Settings.from_json(content)
    except ValueError as error:
        raise ValueError(f'cannot use {folder.settings}: {error}; correct it, or begin a new session') from error
    return settings.resumed_with(given_settings(args)).resolved()


def _check_results(folder: SessionFolder) -> None:
    """Refuse results of an earlier session that could not be read after the teaching, either."""
    try:
        load_test(folder.test)
        _earlier_restarts(folder)
    except (ValueError, OSError) as error:
        raise ValueError(f'{error}; remove that file: it is written anew') from error


def _is_taught(settings: Settings, folder: SessionFolder, given: dict[str, Any]) -> bool:
    """Whether an earlier session is to go on with its test: that was broken off, or another one is asked for."""
    return settings.taught and settings.test_episodes > 0 and (
        set(given) <= {'test_episodes'} if given else not folder.test.exists())


def _earlier_restarts(folder: SessionFolder) -> int:
    """Restarts of nodes in the part of the session that was reported before.

    Raises:
        ValueError: the summary says something else.
        OSError: it cannot be read.
    """
    from shared_control_records.session.summary import earlier_restarts  # late: it reads bags, which takes a second
    return earlier_restarts(folder) or 0


def _conclude(folder: SessionFolder, end: End, restarts: int, settings: Settings, interrupts: Interrupts) -> End:
    """Keep whether the teaching came to its end, test and report, and say how to go on; how the session ended."""
    try:
        test = load_test(folder.test)
        if test is not None and folder.policy.exists() and test.policy != sha256(folder.policy):
            folder.test.unlink()  # the policy has learned since
        folder.write_settings(replace(settings, taught=end is End.DONE).to_json())
        end = _report(folder, end, restarts, settings, interrupts)
    except OSError as error:
        print(f'shared-control: {error}; what there is of the session is kept in {folder.path}', file=sys.stderr)
        end = End.FAILED
    finally:
        if end is not End.DONE:
            print('Stopped before the end.' if settings.blind else
                  'Stopped before the end. Go on with\n'
                  f'  shared-control session --resume {shlex.quote(str(folder.path))}', flush=True)
    return end


def _report(folder: SessionFolder, end: End, restarts: int, settings: Settings, interrupts: Interrupts) -> End:
    """Test the policy, complete the bag, write the report, and print what came of it; how the session ended."""
    # Imported late: torch and matplotlib take seconds, and the person wants to begin.
    from shared_control_records.session.report import write_report

    from .aftermath import describe_policy, tell_page, tell_summary, test_policy
    if end is not End.FAILED:
        describe_policy(folder)
    if not folder.policy.exists():
        print('No episode was learned: there is no policy.', flush=True)
    elif end is End.DONE and settings.test_episodes:
        try:
            test_policy(folder, settings.test_episodes, settings.physics, interrupts.check)
        except KeyboardInterrupt:
            end = End.STOPPED
    tell_page(folder, 'reporting')
    print('Writing the report ...', flush=True)
    keep_unfinished(folder.episodes)
    _complete_bag(folder, restarts)
    summary = write_report(folder, restarts)
    if not settings.blind:
        tell_summary(folder, summary)
    tell_page(folder, 'over', of=summary.autonomous_episodes, successes=summary.autonomous_success)
    return end


def _complete_bag(folder: SessionFolder, restarts: int) -> None:
    """Finish what a killed recorder left, and put the rest of the folder into the bag; the report needs neither."""
    try:
        if folder.bag.exists():
            recover(folder.bag)
        if any(folder.bag.glob('*.mcap')):
            annotate(folder.bag, RECORD, bag_metadata.pack(folder, restarts))
    except OSError as error:
        print(f'shared-control: {error}', file=sys.stderr)


def _require_terminal() -> None:
    if not _has_terminal():
        raise ValueError('there is no terminal to press keys in: use --tutor sim, or start the session from one')
    if not _can_draw():
        raise ValueError(f'TERM is {os.environ.get("TERM", "")!r}: no keys are read from such a terminal; set TERM '
                         'to what it is (xterm-256color), or use --tutor page')


def _can_draw() -> bool:
    return os.environ.get('TERM', '') not in ('', 'dumb')


def _has_terminal() -> bool:
    try:
        Path('/dev/tty').open('rb').close()
    except OSError:
        return False
    return sys.stdin.isatty()
