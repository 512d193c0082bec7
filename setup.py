"""One distribution for pip of all packages of the workspace, with extras by weight of dependencies.

What a package holds, needs and offers stands once, in its own ``setup.py`` below ``ros2_ws/src``, from which colcon
builds the same sources. Versions stand once, in ``requirements.txt``.
"""

import os
import re
from contextlib import contextmanager
from distutils.core import run_setup
from pathlib import Path

from setuptools import setup  # isort: split - and brings distutils, which Python has no more since 3.12

ROOT = Path(__file__).parent
SOURCES = Path('ros2_ws') / 'src'

BASE = ('panda_tray_description', 'shared_control')
"""What everybody needs: robot, controller, tasks."""
EXTRAS = {
    'ros': ('shared_control_ros', 'torque_ctrl_node', 'teleop_key_node', 'shared_control_nodes'),
    'sim': ('shared_control_sim',),
    'mujoco': ('shared_control_sim',),
    'learn': ('shared_control_sim', 'shared_control_learning'),
    'study': ('shared_control_sim', 'shared_control_learning', 'shared_control_records'),
    'export': ('shared_control_sim', 'shared_control_learning', 'shared_control_records'),
    'tensorboard': ('shared_control_sim', 'shared_control_learning'),
    'page': ('shared_control_ros', 'teach_page_node'),
}
"""Packages whose dependencies an extra brings, and those of their own extra of that name; ``all`` brings those of all
packages, and of all these extras."""
NOT_INSTALLED = ('shared_control_testing',)
"""For the tests of the workspace alone."""
DOCS = ('sphinx', 'myst-parser', 'furo', 'sphinxcontrib-mermaid')
"""What builds the documentation's site: for developers, and in no other extra."""
OF_ROS = {'rclpy': ('ros-jazzy-rclpy[fastrtps]', 'ros-jazzy-common-interfaces', 'ros-rmw-fastrtps-cpp')}
"""Distributions on PyPI of what ROS calls a package."""


@contextmanager
def _within(folder):
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def _packages():
    """The packages of the workspace by name, as their own setup.py describes them."""
    found = {}
    for path in sorted((ROOT / SOURCES).glob('*/setup.py')):
        if path.parent.name not in NOT_INSTALLED:
            with _within(path.parent):
                found[path.parent.name] = run_setup('setup.py', stop_after='init')
    return found


def _normalized(name):
    return re.sub(r'[-_.]+', '-', name).lower()


def _pins():
    """Pinned requirements by normalized name."""
    lines = (ROOT / 'requirements.txt').read_text().splitlines()
    return {_normalized(re.split(r'[\[=]', line)[0]): line for line in lines if '==' in line}


def _requirements(packages, names, extras=()):
    """What the packages called ``names`` need from others, their own ``extras`` included, pinned."""
    pins, own = _pins(), {_normalized(name) for name in (*packages, *NOT_INSTALLED)}
    wanted = {package: [*packages[package].install_requires,
                        *(name for extra in extras for name in packages[package].extras_require.get(extra, ()))]
              for package in names}
    needed = {name for package in names for requirement in wanted[package]
              for name in OF_ROS.get(requirement, (requirement,))}
    return sorted(pins[_normalized(re.split(r'\[', name)[0])] for name in needed if _normalized(name) not in own)


def _entry_points(packages):
    merged = {}
    for package in packages.values():
        for group, lines in (package.entry_points or {}).items():
            merged.setdefault(group, []).extend(lines)
    return merged


PACKAGES = _packages()
setup(
    packages=[name for package in PACKAGES.values() for name in package.packages],
    package_dir={name: str(SOURCES / name / name) for name in PACKAGES},
    package_data={key: value for package in PACKAGES.values() for key, value in (package.package_data or {}).items()},
    install_requires=_requirements(PACKAGES, BASE),
    extras_require={
        **{extra: _requirements(PACKAGES, names, (extra,)) for extra, names in EXTRAS.items()},
        'docs': [_pins()[name] for name in DOCS],
        'view': [*_requirements(PACKAGES, EXTRAS['study']), 'rerun-sdk==0.41.0'],
        'all': _requirements(PACKAGES, PACKAGES, EXTRAS)},
    entry_points=_entry_points(PACKAGES),
)
