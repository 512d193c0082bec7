"""Every command in the documentation is run by a test, or listed as run by hand with its date."""

import re
import shlex
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *ROOT.glob('docs/**/*.md')])
PROGRAMS = ('make', 'shared-control', 'python', 'ros2', 'docker', 'colcon')
BY_HAND = ROOT / 'docs' / 'run_by_hand.md'
TESTS = [*ROOT.glob('tests/*.py'), *ROOT.glob('ros2_ws/src/*/test/**/*.py'), ROOT / '.ci' / 'run',
         *ROOT.glob('ros2_ws/src/shared_control_testing/shared_control_testing/**/*.py')]


def commands():
    """What stands indented or fenced in a page and begins with one of our programs: page, command."""
    found = []
    for page in PAGES:
        if page == BY_HAND or 'generated' in page.parts:
            continue
        for line in re.findall(r'^(?: {4,}|\t)(\S.*)$', page.read_text(), re.MULTILINE):
            command = re.sub(r'\s+#.*$', '', line).removeprefix('.venv/bin/').strip()
            program = command.split(' ')[0]
            if program in PROGRAMS or program.endswith('_node'):
                found.append((page, command))
    return found


def key(command):
    """The part of a command by which it is recognised: program, and subcommand, target, module or node."""
    words = shlex.split(command.rstrip('\\'), comments=True)
    if words[0].endswith('_node'):
        return words[0]
    if words[:2] == ['ros2', 'run']:
        return words[3]
    if words[:2] in (['ros2', 'launch'], ['ros2', 'service'], ['ros2', 'security']):
        return ' '.join(words[:2] + [words[3] if words[1] == 'launch' else words[2]])
    return ' '.join(words[:3] if words[:2] == ['python', '-m'] else words[:2])


def by_hand():
    """Keys of the commands that are listed as run by hand."""
    return dict(re.findall(r'^\| `([^`]+)` \| (\S+) \|', BY_HAND.read_text(), re.MULTILINE))


def run_by_a_test():
    """Keys of what tests start: nodes and subcommands by name, modules by ``-m``, what .ci/run makes."""
    text = '\n'.join(path.read_text() for path in TESTS)
    nodes = set(re.findall(r'[\'"](\w+_node)[\'"]', text))
    subcommands = {f'shared-control {name}' for name in re.findall(r"(?:'shared[-_]control', |\bserve\()'(\w+)'", text)}
    modules = {f'python -m {name}' for name in re.findall(r"'-m', '([\w.]+)'", text)}
    made = {f'make {name}' for name in re.findall(r'^make (\w+)', (ROOT / '.ci' / 'run').read_text(), re.MULTILINE)}
    return nodes | subcommands | modules | made


def test_there_are_commands():
    assert len(commands()) > 30


@pytest.mark.parametrize('found', sorted({key(command) for _, command in commands()}))
def test_a_command_is_run(found):
    listed = by_hand()
    assert found in run_by_a_test() or found in listed, (
        f'{found!r}: no test runs it; run it, and list it in {BY_HAND.relative_to(ROOT)}')


def test_the_list_says_when_and_names_nothing_else():
    listed = by_hand()
    assert all(re.fullmatch(r'20\d\d-\d\d-\d\d|not', date) for date in listed.values())
    assert set(listed) <= {key(command) for _, command in commands()}
