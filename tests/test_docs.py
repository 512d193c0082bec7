"""The documentation says what the code says."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from shared_control.contract_tables import services, topics
from shared_control_ros.processes import node_environment

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / 'ros2_ws' / 'src'
PAGES = sorted([*ROOT.glob('*.md'), *ROOT.glob('docs/**/*.md'), *ROOT.glob('examples/*/*.md'),
                *SOURCES.glob('*/README.md')])


def name_of(page):
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize('table', [topics, services])
def test_the_contract_page_has_the_tables_of_the_code(table):
    page = (ROOT / 'docs' / 'contract.md').read_text()
    assert f'\n{table()}\n' in page, f'python -m shared_control.contract_tables {table.__name__}'


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_a_page_names_the_variable_that_restricts_dds(page, monkeypatch):
    monkeypatch.delenv('ROS_AUTOMATIC_DISCOVERY_RANGE', raising=False)
    monkeypatch.delenv('FASTRTPS_DEFAULT_PROFILES_FILE', raising=False)
    assert set(re.findall(r'\w+_PROFILES_FILE', page.read_text())) <= node_environment().keys()


def test_the_errors_of_troubleshooting_are_those_of_the_code():
    nodes = (node for path in [*SOURCES.glob('*/*/**/*.py'), ROOT / 'tools' / 'check_machine.py']
             for node in ast.walk(ast.parse(path.read_text())))
    strings = ' '.join(node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str))
    quoted = re.findall(r'^> (.+)$', (ROOT / 'docs' / 'how_to' / 'troubleshooting.md').read_text(), re.MULTILINE)
    assert len(quoted) == 4
    for message in quoted:
        longest = max(re.split(r'error: |/effort_controller/commands|[\d.]+ s', message), key=len).strip()
        assert longest in strings, message


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_links_lead_somewhere(page):
    for target in re.findall(r'\]\(([^)#:]+)(?:#[^)]*)?\)', page.read_text()):
        assert (page.parent / target).exists(), target


@pytest.mark.parametrize('page', PAGES, ids=name_of)
def test_ros_commands_name_what_exists(page):
    text = page.read_text()
    for package, executable in re.findall(r'ros2 run ([a-z]\w+) (\w+)', text):
        if package not in ('plotjuggler', 'joy'):
            assert re.search(rf"'{executable} = ", (SOURCES / package / 'setup.py').read_text())
    for file, rest in re.findall(r'ros2 launch shared_control_bringup (\w+\.launch\.py)([^\n#]*)', text):
        bringup = SOURCES / 'shared_control_bringup'
        source = (bringup / 'launch' / file).read_text() + (bringup / bringup.name / 'launching.py').read_text()
        for argument in re.findall(r'(\w+):=', rest):
            assert re.search(rf"DeclareLaunchArgument\(\s*'{argument}'", source), argument


@pytest.mark.parametrize(('page', 'says'), [('README.md', ''), ('docs/tutorial/first_policy.md', 'of 20 alone')])
def test_the_python_of_a_page_runs(page, says, tmp_path):
    code = re.findall(r'```python\n(.*?)```', (ROOT / page).read_text(), re.DOTALL)
    assert len(code) == 1
    code = code[0].replace('episodes=10', 'episodes=1')  # which runs the same lines
    done = subprocess.run([sys.executable, '-c', code], check=True, timeout=600, cwd=tmp_path, capture_output=True,
                          text=True)
    assert says in done.stdout


def test_the_site_builds_without_a_warning(tmp_path):
    # Without what is in modules in the tables of contents, which are made anew for each page: a fifth of the time.
    done = subprocess.run([sys.executable, '-m', 'sphinx', '-b', 'html', '--fail-on-warning', '--keep-going', '--quiet',
                           '-D', 'toc_object_entries=0', ROOT / 'docs', tmp_path],
                          capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    generated = tmp_path / 'reference' / 'generated'
    assert 'panda_sim_node' in (generated / 'parameters.html').read_text()
    for name in ('shared_control.control.sharing.Sharing', 'shared_control_ros.fast_loop.Polled'):
        page = (generated / f'api_{name.split(".")[0]}.html').read_text()
        assert f'id="{name}"' in page and '.. py:' not in page


def test_the_workflow_runs_what_ci_runs_and_targets_that_exist():
    text = (ROOT / '.github' / 'workflows' / 'ci.yml').read_text()
    steps = [step.get('run', '') for job in yaml.safe_load(text)['jobs'].values() for step in job['steps']]
    assert '.ci/run' in steps
    targets = re.findall(r'^([a-z]+):', (ROOT / 'Makefile').read_text(), re.MULTILINE)
    assert set(re.findall(r'make ([a-z]+)$', '\n'.join(steps), re.MULTILINE)) <= set(targets)
