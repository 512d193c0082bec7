"""What installations weigh and how long pip takes: the controller alone, teaching without the page, all, development.

Each goes into an empty environment, one after the other, from a copy of the sources: minutes and a GB or two. Seconds
are those of pip with its cache and its indexes as they are on this machine. Megabytes are the files of all packages
that are there in the end, without pip itself: as pip leaves them, and after ``tools/slim_environment.py``. Whether what
is left works is seen each time (``pip check``, what the installation is for), and that nothing came along that is not
for it.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
SOURCES = ('Makefile', 'setup.py', 'pyproject.toml', 'requirements.txt', 'README.md', 'LICENSE', 'tools', 'ros2_ws/src')
OF_DEVELOPERS = ('pytest', 'hypothesis', 'selenium', 'mypy', 'ruff', 'import-linter', 'sphinx', 'colcon-core')
HEAVY = ('torch', 'stable-baselines3', 'pybullet', 'mujoco-core', 'pandas', 'pyarrow', 'matplotlib', 'nicegui')
"""Distributions that have no place on a robot's computer."""
ANSWERS = 500
"""Torques that the mock robot must get."""
HEAVIEST = 6
LIST = """
import importlib.metadata, json, os
sizes = {}
for distribution in importlib.metadata.distributions():
    paths = [distribution.locate_file(file) for file in distribution.files or ()]
    found = [os.stat(path) for path in paths if os.path.isfile(path)]
    # A file under several names counts once.
    sizes[distribution.metadata['Name']] = sum({(one.st_dev, one.st_ino): one.st_size for one in found}.values())
del sizes['pip']
print(json.dumps(sizes))
"""


@dataclass(frozen=True)
class Installation:
    """One of those that the documentation names."""

    command: str
    """In a clone of the repository."""
    extras: str | None
    """Of the distribution; None for that of developers."""
    without: tuple[str, ...]
    """Distributions that are not for it."""
    works: Callable[[Path], int | bool]
    """Whether what its interpreter starts does what it is for."""


def install(installation: Installation, folder: Path) -> tuple[Path, float]:
    """An environment in ``folder``: its interpreter, and the seconds that it took."""
    sources, environment = folder / 'sources', folder / 'venv'
    for part in SOURCES:  # a copy, since a build leaves files beside what it builds
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        (sources / part).parent.mkdir(parents=True, exist_ok=True)
        copy(ROOT / part, sources / part)
    python = environment / 'bin' / 'python'
    began = time.monotonic()
    if installation.extras is None:
        _run('make', '--silent', '-C', sources, f'PYTHON={sys.executable}', f'VENV={environment}', 'setup')
    else:
        venv.create(environment, with_pip=True)
        # Python 3.11 puts it into every environment, 3.12 into none.
        _run(python, '-m', 'pip', 'uninstall', '--quiet', '--yes', 'setuptools')
        _run(python, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check',
             f'{sources}[{installation.extras}]')
    return python, time.monotonic() - began


def sizes(python: Path) -> dict[str, int]:
    """Bytes of every distribution of an environment but pip, the heaviest first."""
    bytes_of = json.loads(_run(python, '-c', LIST))
    return dict(sorted(bytes_of.items(), key=lambda item: -item[1]))


def extras_mb() -> dict[str, int]:
    """What each extra brings, with the core, by the packages of this environment, if all of them are here."""
    found = {}
    for extra in ('', *distribution('shared-control').metadata.get_all('Provides-Extra', ())):
        wanted, needed = [('shared-control', extra)], set()
        try:
            while wanted:
                name, of_extra = wanted.pop()
                for line in distribution(name).requires or ():
                    requirement = Requirement(line)
                    if requirement.marker is None or requirement.marker.evaluate({'extra': of_extra}):
                        new = {(requirement.name, each) for each in ('', *requirement.extras)} - needed
                        needed |= new
                        wanted += new
        except PackageNotFoundError:
            continue
        own = {canonicalize_name(name) for name, _ in needed}
        found[extra or 'core'] = round(sum(
            size for name, size in sizes(Path(sys.executable)).items() if canonicalize_name(name) in own) / 1e6)
    return found


def answers(python: Path) -> int:
    """How many torques the controller of that environment sends to a mock robot of this one, up to ``ANSWERS``."""
    from shared_control_ros import contract
    from shared_control_testing.nodes import Observer, free_domain, running_nodes
    from std_srvs.srv import SetBool
    with free_domain() as domain, tempfile.TemporaryDirectory() as logs, running_nodes(Path(logs)) as start:
        start('mock_panda_node')
        start('torque_ctrl_node', python=str(python), robot_compensates_gravity=True, prediction_horizon=0.004)
        observer = Observer(domain)
        try:
            torques = observer.listen(contract.EFFORT_COMMANDS)
            # Enabled by hand, as on a robot; it refuses until it has seen where the joints are.
            while not observer.call(SetBool, contract.ENABLE_SERVICE, SetBool.Request(data=True)).success:
                observer.spin_for(0.2)
            observer.spin(lambda: len(torques) >= ANSWERS, 60.0, 'torques')
            return len(torques)
        finally:
            observer.close()


def teaches(python: Path) -> bool:
    """Whether the session explains itself, and an episode is taught there in one process."""
    command = python.with_name('shared-control')
    with tempfile.TemporaryDirectory() as folder:
        _run(command, 'session', '--help')
        _run(command, 'train', '--episodes', '1', '--evaluate-every', '0', '--output', f'{folder}/run')
        return (Path(folder) / 'run' / 'policy.safetensors').is_file()


def shows(python: Path) -> bool:
    """Whether it teaches, and the page can be loaded."""
    _run(python, '-c', 'import teach_page_node.__main__, nicegui')
    return teaches(python)


def tests(python: Path) -> bool:
    """Whether pytest finds tests to run with these packages."""
    return 'test' in _run(python, '-m', 'pytest', '--collect-only', '-q',
                          ROOT / 'ros2_ws' / 'src' / 'shared_control' / 'test')


INSTALLATIONS = {
    'controller': Installation('pip install ".[ros]"', 'ros', (*HEAVY, *OF_DEVELOPERS), answers),
    'teach': Installation('pip install ".[ros,study]"', 'ros,study', ('nicegui', *OF_DEVELOPERS), teaches),
    'all': Installation('pip install ".[all]"', 'all', OF_DEVELOPERS, shows),
    'developer': Installation('make setup', None, (), tests),
}


def measured(installation: Installation) -> dict[str, Any]:
    """The figures of one of them, whose environment is removed again.

    Raises:
        RuntimeError: something came along that is not for it, or what was installed does not work once it is slim.
    """
    with tempfile.TemporaryDirectory() as folder:
        python, seconds = install(installation, Path(folder))
        found = sizes(python)
        _run(python, ROOT / 'tools' / 'slim_environment.py')
        left = sizes(python)
        if installation.extras is not None:
            # Not that of developers: there the fixtures ask for each package by the name that colcon knows it by.
            _run(python, '-m', 'pip', 'check')
        heavy = sorted(set(map(str.lower, found)) & set(installation.without))
        if heavy:
            raise RuntimeError(f'{installation.command} brings {", ".join(heavy)}')
        works = installation.works(python)
        if not works:
            raise RuntimeError(f'{installation.command}: {installation.works.__name__} says no')
        versions = json.loads(_run(python, '-m', 'pip', 'list', '--format', 'json'))
    total, slim = (sum(each.values()) / 1e6 for each in (found, left))
    return {
        'command': installation.command, 'seconds': round(seconds), 'mb': round(total),
        'mb_slim': round(slim), 'packages': len(found), installation.works.__name__: works,
        'torch': {one['name']: one['version'] for one in versions}.get('torch'),
        'heaviest_mb': {name: round(size / 1e6) for name, size in list(left.items())[:HEAVIEST]}}


def measure() -> dict[str, Any]:
    """``seconds``, ``mb``, ``mb_slim``, ``packages``, ``heaviest_mb`` (slim) by installation; ``extras_mb``."""
    found: dict[str, Any] = {'extras_mb': extras_mb()}
    for name, installation in INSTALLATIONS.items():
        found[name] = figures = measured(installation)
        print(f'{installation.command}: {figures["mb"]} MB, {figures["mb_slim"]} slim, in '
              f'{figures["packages"]} packages, {figures["seconds"]} s', flush=True)
    return found


def _run(*command: object) -> str:
    """What a command prints.

    Raises:
        RuntimeError: it failed; the message is its own.
    """
    done = subprocess.run([str(part) for part in command], cwd=tempfile.gettempdir(), capture_output=True, text=True,
                          check=False)
    if done.returncode:
        raise RuntimeError(f'{" ".join(map(str, command))}\n{done.stdout}{done.stderr}')
    return done.stdout
