"""Fixtures of this folder: whole sessions in processes of their own, in a terminal or without one."""

import importlib
import json
import sys
import time
from pathlib import Path

import pytest
from shared_control_bringup import parameters
from shared_control_learning.episode_table import read_rows
from shared_control_testing.live_session import Session
from shared_control_testing.nodes import *  # noqa: F403
from shared_control_testing.page import served
from shared_control_testing.terminal import Terminal
from teleop_key_node.keyboard import HeldKeys

BENCHMARKS = Path(__file__).parents[1] / 'benchmarks'
NO_REPETITION = 8 * HeldKeys.REPEATS_WITHIN
"""Sooner, a key that is pressed again would be the terminal's repetition; s, on a busy machine, too."""
LONGEST = ('test_session_person.py', 'test_session_resume.py', 'test_session_faults.py')


def pytest_collection_modifyitems(items):
    """Begin with the longest of this folder, so that no process is left with one of them in the end."""
    here = Path(__file__).parent
    items.sort(key=lambda item: item.path.parent == here and (item.path.name not in LONGEST) + 1)


@pytest.fixture(scope='module')
def load_benchmark():
    """``load_benchmark(name)``: that script of benchmarks/ as a module."""
    before = set(sys.modules)
    sys.path.insert(0, str(BENCHMARKS))  # as for a script, which imports others from its folder
    yield importlib.import_module
    sys.path.remove(str(BENCHMARKS))
    for name in set(sys.modules) - before:
        if Path(getattr(sys.modules[name], '__file__', None) or '').parent == BENCHMARKS:
            del sys.modules[name]


class TerminalSession(Session, Terminal):
    """The same in a terminal."""

    def __init__(self, arguments: list[str]):
        Terminal.__init__(self)
        Session.__init__(self, arguments, **self.popen_options())
        self._typed_at = 0
        self.watch()

    def type(self, keys: bytes) -> None:
        """Press keys."""
        self._typed_at = len(self.shown)
        Terminal.type(self, keys)

    def expect(self, text: str, timeout: float = 120.0) -> None:
        """Wait until ``text`` has been shown since the last keys; what stays on the screen is drawn once only."""
        deadline = time.monotonic() + timeout
        while not self._has_shown(text):
            assert time.monotonic() < deadline, f'{text!r} is not on the screen; last: {self.shown[-2000:]!r}'

    def press_again(self, key: bytes, text: str) -> None:
        """Press a key that was pressed before, until ``text`` is shown.

        Where nobody has read the terminal for a second, it may have been held for all of it: no press is counted then.
        """
        for _ in range(20):
            time.sleep(NO_REPETITION)
            self.type(key)
            answered_by = time.monotonic() + 10.0  # a screen that is late must not have it pressed twice
            while time.monotonic() < answered_by:
                if self._has_shown(text):
                    return
        raise AssertionError(f'{text!r} is not on the screen; last: {self.shown[-2000:]!r}')

    def _has_shown(self, text: str) -> bool:
        assert self.process.poll() is None, f'the session ended: {self.shown[-2000:]}'
        time.sleep(0.02)
        return text in self.shown[self._typed_at:]

    def close(self) -> None:
        Session.close(self)
        Terminal.close(self)


@pytest.fixture
def unpaced(tmp_path) -> Path:
    """A parameter file for sessions that need not last as long as they would in real time."""
    content = parameters.load()
    content['panda_sim_node']['paced'] = False
    content['ppo_agent_node'] |= {'test_episodes': 1, 'episode_seconds': 4.0}
    path = tmp_path / 'unpaced.yaml'
    parameters.save(content, path)
    return path


@pytest.fixture(scope='class')
def page_session(domain_id, tmp_path_factory):
    """A session taught on the page, then tested alone once on the graph and once off it: process, address, folder."""
    scratch = tmp_path_factory.mktemp('session')
    parameters_file = scratch / 'one_test.yaml'
    parameters_file.write_text('ppo_agent_node: {ros__parameters: {test_episodes: 1}}')
    with served('session', '--tutor', 'page', '--test-episodes', '1', '--params-file', str(parameters_file),
                '--output', str(scratch / 'session')) as session:
        yield *session, scratch / 'session'


@pytest.fixture
def start_session(domain_id, tmp_path):
    """``start_session(*arguments, terminal=False)``: a session that is ended with the test."""
    sessions = []

    def start(*arguments: object, terminal: bool = False):
        kind = TerminalSession if terminal else Session
        sessions.append(kind([str(argument) for argument in arguments]))
        return sessions[-1]

    yield start
    for session in sessions:
        session.close()


@pytest.fixture
def wait_until():
    """``wait_until(condition, what)``"""
    def wait(condition, what: str, timeout: float = 180.0) -> None:
        deadline = time.monotonic() + timeout
        while not condition():
            assert time.monotonic() < deadline, f'waited {timeout} s in vain for {what}'
            time.sleep(0.1)

    return wait


@pytest.fixture
def episodes_taught():
    """How many a session's folder tells of."""
    return lambda folder: sum(row['phase'] == 'teach' for row in read_rows(folder / 'learner' / 'episodes.csv'))


@pytest.fixture
def summary_of():
    """The figures of a session's folder."""
    return lambda folder: json.loads((folder / 'summary.json').read_text())
