"""Every command of the workspace explains itself."""

import os
import re
import subprocess
import sys
from importlib.metadata import entry_points, version
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[1] / 'ros2_ws' / 'src'
SCRIPTS = sorted(name for setup in SOURCES.glob('*/setup.py')
                 for name in re.findall(r"'(\S+) = \S+:main'", setup.read_text()))
SUBCOMMANDS = sorted(entry_point.name for entry_point in entry_points(group='shared_control.commands'))


HEAVY = {'numpy', 'rclpy', 'pinocchio', 'torch', 'stable_baselines3', 'gymnasium', 'pybullet', 'mujoco', 'pandas',
         'pyarrow', 'matplotlib', 'scipy', 'mcap', 'rosbags', 'pydantic', 'nicegui', 'fastapi', 'jinja2'}
"""What no `--help` waits for: it takes 0.1 s (numpy) to 2 s (torch) to import."""


@pytest.fixture(scope='module')
def helps():
    """What each command answers to ``--help``, and the modules that it imported for that."""
    folder = Path(sys.executable).parent
    commands = {name: [name] for name in SCRIPTS} | {name: ['shared-control', name] for name in SUBCOMMANDS}
    found = {}
    for name, (script, *arguments) in commands.items():
        done = subprocess.run([sys.executable, '-X', 'importtime', folder / script, *arguments, '--help'],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
        imports = {line.rpartition('|')[2].strip() for line in done.stderr.splitlines() if '|' in line}
        found[name] = done.stdout, done.stderr, done.returncode, imports
    return found


@pytest.mark.parametrize('name', SCRIPTS)
def test_a_script_explains_itself_and_does_nothing_else(helps, name):
    output, errors, code, _ = helps[name]
    assert code == 0 and 'Traceback' not in errors
    assert output.startswith(f'usage: {name} ') and '--version' in output and 'Examples:\n' in output
    assert '`' not in output
    if name.endswith('_node'):
        assert '--ros-args' in output and f'\n  ros2 run {executables()[name]} {name}' in output


@pytest.mark.parametrize('name', SCRIPTS)
def test_a_script_says_its_version(name):
    done = subprocess.run([Path(sys.executable).parent / name, '--version'], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (0, f'{name} {version("shared-control")}\n')


def executables():
    """The package of each executable, as for ``ros2 run``."""
    return {name: setup.parent.name for setup in SOURCES.glob('*/setup.py')
            for name in re.findall(r"'(\S+) = \S+:main'", setup.read_text())}


def test_a_node_shows_its_parameters_with_their_defaults(helps):
    output = ' '.join(helps['teleop_key_node'][0].split())
    assert 'keystroke Change of M_yh at one press. [N m] (0.0 to 200.0) (default: 5.0)' in output  # of a constant
    assert 'in_session' in output and '(default: false)' in output


@pytest.mark.parametrize('name', SUBCOMMANDS)
def test_a_subcommand_explains_itself(helps, name):
    output, _, code, _ = helps[name]
    assert code == 0
    assert f'usage: shared-control {name}' in output


@pytest.mark.parametrize('name', [*SCRIPTS, *SUBCOMMANDS])
def test_help_waits_for_nothing_heavy(helps, name):
    imports = helps[name][-1]
    assert 'argparse' in imports or 'ast' in imports, 'the list of imports was not understood'
    assert not HEAVY & {module.partition('.')[0] for module in imports}


def test_who_does_not_learn_loads_no_torch():
    modules = ('shared_control_bringup.session', 'shared_control_bringup.recorder.node', 'panda_sim_node.node',
               'teleop_key_node.node', 'teach_page_node.node', 'teach_page_node.recording',
               'shared_control_nodes.tutor.node', 'shared_control_records.session.report',
               'shared_control_records.study_report.report', 'shared_control_records.export.lerobot',
               'shared_control_records.validation.run')
    loaded = subprocess.run([sys.executable, '-c', f'import {", ".join(modules)}, sys; print(*sys.modules)'],
                            capture_output=True, text=True, check=True).stdout.split()
    assert {*modules} <= {*loaded} and 'torch' not in loaded


def test_what_only_an_extra_brings_is_asked_for_when_it_is_used(tmp_path):
    """Teaching, reports and tests of a policy do without; a command that needs it says what to install."""
    without = 'import sys; sys.modules.update(dict.fromkeys(("pyarrow", "tensorboard", "nicegui"))); '
    modules = ('shared_control_bringup.command', 'shared_control_bringup.session', 'ppo_agent_node.node',
               'shared_control_learning.train_command', 'shared_control_records.evaluation.policies',
               'shared_control_records.report_command', 'shared_control_records.study_report.report')
    subprocess.run([sys.executable, '-c', f'{without}import {", ".join(modules)}'], check=True)
    done = subprocess.run(
        [sys.executable, '-c', f'{without}from shared_control.cli import main; sys.exit(main())', 'export', tmp_path],
        check=False, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == (
        "shared-control: the command needs the module 'pyarrow', which is not installed: "
        'pip install "shared-control[export]"\n')


def test_physics_that_only_an_extra_brings_are_asked_for(tmp_path):
    without = 'import sys; sys.modules["mujoco"] = None; '
    done = subprocess.run(
        [sys.executable, '-c', f'{without}from shared_control.cli import main; sys.exit(main())', 'train', '--physics',
         'mujoco', '--output', tmp_path / 'run'], check=False, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == (
        "shared-control: the world 'mujoco' needs the module 'mujoco', which is not installed: "
        'pip install "shared-control[mujoco]"\n')
    assert not (tmp_path / 'run').exists()


def test_the_shell_of_a_notebook_is_as_good_as_any(tmp_path):
    done = subprocess.run(
        [Path(sys.executable).parent / 'shared-control', 'report', tmp_path / 'nowhere'], check=False, text=True,
        capture_output=True, env={**os.environ, 'MPLBACKEND': 'module://matplotlib_inline.backend_inline'}, timeout=60)
    assert 'backend' not in done.stderr and 'nowhere' in done.stderr


@pytest.mark.parametrize('closed', ['<&-', '>&-', '2>&-', '<&- >&- 2>&-'])
def test_a_command_without_standard_streams_does_what_it_would(closed):
    done = subprocess.run(
        ['sh', '-c', f'"$0" tutors low --individuals 1 {closed}', Path(sys.executable).parent / 'shared-control'],
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0 and 'Error' not in done.stderr


@pytest.mark.parametrize(('arguments', 'said'), [
    ([], 'commands:'), (['--version'], f'shared-control {version("shared-control")}')])
def test_the_command_alone_helps_and_says_its_version(arguments, said):
    done = subprocess.run([Path(sys.executable).parent / 'shared-control', *arguments], capture_output=True, text=True,
                          timeout=60, check=False)
    assert done.returncode == 0 and said in done.stdout


def test_libraries_print_nothing_into_our_output():
    modules = ('shared_control_sim.bullet', 'shared_control_learning.training', 'shared_control_records.session.report')
    done = subprocess.run([sys.executable, '-c', f'import {", ".join(modules)}'], capture_output=True, text=True,
                          check=True)
    assert (done.stdout, done.stderr) == ('', '')
