"""Every command of the workspace explains itself."""

import re
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from shared_control import cli

SOURCES = Path(__file__).parents[1] / 'ros2_ws' / 'src'
SCRIPTS = sorted(name for setup in SOURCES.glob('*/setup.py')
                 for name in re.findall(r"'(\S+) = \S+:main'", setup.read_text()))
SUBCOMMANDS = sorted(entry_point.name for entry_point in entry_points(group='shared_control.commands'))


@pytest.fixture(scope='module')
def helps():
    """What each console script says to ``--help``; all are started at once, since importing torch takes a while."""
    folder = Path(sys.executable).parent
    running = {name: subprocess.Popen([folder / name, '--help'], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True) for name in SCRIPTS}
    return {name: (*process.communicate(timeout=120), process.returncode) for name, process in running.items()}


@pytest.mark.parametrize('name', SCRIPTS)
def test_a_script_explains_itself_and_does_nothing_else(helps, name):
    output, errors, code = helps[name]
    assert code == 0 and 'Traceback' not in errors
    expected = '--ros-args' if name.endswith('_node') else 'usage:'
    assert expected in output and len(output.splitlines()) >= 3


@pytest.mark.parametrize('name', SUBCOMMANDS)
def test_a_subcommand_explains_itself(name, monkeypatch, capsys):
    monkeypatch.setattr(sys, 'argv', ['shared-control', name, '--help'])
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 0
    assert f'usage: shared-control {name}' in capsys.readouterr().out
