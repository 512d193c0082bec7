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

"""Reading a robot from its file, found by name or by path (docs/how_to/robot.md)."""

from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import yaml

from ..plugins import ROBOTS, load
from ..printable import ECHO_MAX, REASON_MAX, cut, escaped, shortened
from ..strict_yaml import StrictLoader
from .spec import Gains, RobotSpec

_VECTORS = ('q_min', 'q_max', 'qd_max', 'qdd_max', 'torque_max', 'home')
"""Numbers for each joint; angles may be in degrees under ``<name>_deg``."""
_ANGLES = ('q_min', 'q_max', 'qd_max', 'qdd_max', 'home')
_POSITIVE = ('qd_max', 'qdd_max', 'torque_max')
_TEXTS = ('urdf', 'base_frame', 'tool_frame')
_PACKAGE = 'package://'
_ONE_NUMBER = ('revolute', 'prismatic')
"""Types of joints whose position is one number within limits."""
SIZE_MAX = 2**20
"""Bytes; a robot takes less than two thousand."""
LARGEST = 1e6
"""The bound of all numbers: angles, rates, torques, gains."""


class RobotFileError(ValueError):
    """A robot's file cannot be used; the message names the file and the key."""


@cache
def load_robot(name_or_path: str) -> RobotSpec:
    """A robot by name (entry point of the group ``shared_control.robots``) or by the path of its YAML file.

    The entry point gives the path of a file, or a function that returns one. What ends in .yaml or .yml or has a
    slash in it is a path. The URDF is a path, relative to the file, or ``package://NAME/path`` in a Python package.

    Raises:
        ValueError: no robot has that name.
        RobotFileError: the file cannot be read or used.
    """
    if is_path(name_or_path):
        return _read(Path(name_or_path).expanduser(), Path(name_or_path).stem)
    found = load(ROBOTS, name_or_path)
    return _read(Path(found() if callable(found) else found), name_or_path)


def is_path(name_or_path: str) -> bool:
    """Whether :func:`load_robot` takes it as a path."""
    return '/' in name_or_path or Path(name_or_path).suffix in ('.yaml', '.yml')


def panda() -> RobotSpec:
    """The robot of the thesis, and the one that is meant where none is named."""
    return load_robot('panda')


def _read(path: Path, name: str) -> RobotSpec:
    try:
        with path.open('rb') as file:
            text = file.read(SIZE_MAX + 1)
        if len(text) > SIZE_MAX:
            raise ValueError(f'more than {SIZE_MAX} bytes are no robot')
        content = yaml.load(text.decode(), _Loader)
    except (OSError, ValueError, yaml.YAMLError, RecursionError) as error:
        raise RobotFileError(escaped(f'cannot read the robot file {path}: {cut(str(error), REASON_MAX)}')) from error
    return _File(path, content).spec(name)


class _Loader(StrictLoader):
    """YAML without merge keys: robots need none, and a few of them can stand for more than a memory holds."""

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        for key, _ in node.value:
            if key.tag == 'tag:yaml.org,2002:merge':
                raise ValueError(f'line {key.start_mark.line + 1}: merge keys (<<) are not for robots')


class _File:
    """The content of a file, taken apart with errors that name the file and the key."""

    def __init__(self, path: Path, content: Any):
        self._path = path
        if not isinstance(content, dict):
            raise RobotFileError(f'{path}: expected keys and values, got {type(content).__name__}')
        known = {*_TEXTS, *_VECTORS, *(f'{key}_deg' for key in _ANGLES), 'joints', 'torque_rate_max', 'gains'}
        if unknown := [key for key in content if key not in known]:
            key = shortened(unknown[0]).strip('\'"')
            raise self._error(key, f'there is no such key; there are {", ".join(sorted(known))}')
        self._content = content

    def _error(self, key: object, what: str) -> RobotFileError:
        return RobotFileError(escaped(f'{self._path}: {cut(str(key), ECHO_MAX)}: {cut(what, REASON_MAX)}'))

    def spec(self, name: str) -> RobotSpec:
        """The whole file, checked."""
        joints = self._joints()
        urdf = self._urdf(self._text('urdf'))
        base_frame, tool_frame = self._text('base_frame'), self._text('tool_frame')
        self._check_urdf(urdf, joints, base_frame, tool_frame)
        vectors: dict[str, Any] = {key: self._vector(key, len(joints)) for key in _VECTORS}
        self._check_limits(vectors, joints)
        return RobotSpec(
            name, urdf, joints, base_frame, tool_frame, torque_rate_max=self._rate(), gains=self._gains(len(joints)),
            **vectors)

    def _get(self, key: str) -> Any:
        if key not in self._content:
            raise self._error(key, 'is missing')
        return self._content[key]

    def _text(self, key: str) -> str:
        value = self._get(key)
        if not isinstance(value, str) or not value:
            raise self._error(key, f'expected a text, got {shortened(value)}')
        return value

    def _joints(self) -> tuple[str, ...]:
        joints = self._get('joints')
        if not isinstance(joints, list) or not joints or not all(isinstance(joint, str) for joint in joints):
            raise self._error('joints', f'expected a list of names, got {shortened(joints)}')
        if len(set(joints)) < len(joints):
            raise self._error('joints', f'a name occurs twice among {shortened(joints)}')
        return tuple(joints)

    def _urdf(self, text: str) -> Path:
        try:
            if not text.startswith(_PACKAGE):
                path = self._path.parent / Path(text).expanduser()
            else:
                package, _, inside = text.removeprefix(_PACKAGE).partition('/')
                if not package.isidentifier() or find_spec(package) is None:
                    raise self._error('urdf', f'there is no Python package {shortened(package)}')
                path = Path(str(files(package) / inside))
            is_there = path.is_file()
        except (OSError, RuntimeError) as error:  # a name that is too long, ~ of nobody
            raise self._error('urdf', str(error)) from error
        if not is_there:
            raise self._error('urdf', f'there is no file {path}')
        return path

    def _check_urdf(self, urdf: Path, joints: tuple[str, ...], base_frame: str, tool_frame: str) -> None:
        try:
            robot = ElementTree.parse(urdf).getroot()
        except (ElementTree.ParseError, ValueError, LookupError) as error:  # the latter of encodings
            raise self._error('urdf', f'{urdf} is not XML: {error}') from error
        movable = [str(joint.get('name')) for joint in robot.iter('joint') if joint.get('type') not in (None, 'fixed')]
        if missing := [joint for joint in joints if joint not in movable]:
            raise self._error('joints', f'{shortened(missing[0])} is no movable joint of {urdf}, which has {movable}')
        if others := [joint for joint in movable if joint not in joints]:
            raise self._error('joints', f'{shortened(others[0])} of {urdf} is missing: it moves, too')
        links = {str(link.get('name')) for link in robot.findall('link')}
        for key, frame in (('base_frame', base_frame), ('tool_frame', tool_frame)):
            if frame not in links:
                raise self._error(key, f'{urdf} has no link {shortened(frame)}')
        children = {child.get('link') for child in robot.iterfind('joint/child')}
        if base_frame in children:
            root = ', '.join(map(repr, links - children))
            raise self._error(
                'base_frame', f'{shortened(base_frame)} hangs on another link of {urdf}, whose root is {root}')
        for joint in robot.iter('joint'):
            if joint.get('type') not in (None, 'fixed', *_ONE_NUMBER):
                raise self._error('joints', f'{shortened(joint.get("name"))} of {urdf} is {joint.get("type")}; joints '
                                  f'must be {" or ".join(_ONE_NUMBER)}, which have limits')
        if (order := _order(robot, base_frame)) != list(joints):
            raise self._error('joints', f'they are in another order than in {urdf}, from its root on: {order}')

    def _numbers(self, key: str, value: Any, count: int) -> np.ndarray:
        """Numbers of at most ``LARGEST``, one a joint."""
        if not isinstance(value, list) or not all(type(number) in (int, float) for number in value):
            raise self._error(key, f'expected a list of numbers, got {shortened(value)}')
        if len(value) != count:
            raise self._error(key, f'has {len(value)} numbers for {count} joints')
        if not all(abs(number) <= LARGEST for number in value):
            raise self._error(key, f'a number is not finite, or above {LARGEST:.0f}: {shortened(value)}')
        return np.array(value, float)

    def _vector(self, key: str, count: int) -> np.ndarray:
        degrees = f'{key}_deg'
        if degrees not in self._content:
            return self._numbers(key, self._get(key), count)
        if key in self._content:
            raise self._error(degrees, f'is given beside {key}: one of them, please')
        return np.deg2rad(self._numbers(degrees, self._content[degrees], count))

    def _check_limits(self, vectors: dict[str, np.ndarray], joints: tuple[str, ...]) -> None:
        def refuse(wrong: np.ndarray, key: str, what: str) -> None:
            if wrong.any():
                raise self._error(key, f'{what} at {joints[int(wrong.argmax())]}')

        low, high, home = vectors['q_min'], vectors['q_max'], vectors['home']
        refuse(low >= high, 'q_min', 'is not below q_max')
        refuse((home < low) | (home > high), 'home', 'is not between q_min and q_max')
        for key in _POSITIVE:
            refuse(vectors[key] <= 0.0, key, 'is not above 0')

    def _rate(self) -> float:
        rate = self._get('torque_rate_max')
        if type(rate) not in (int, float) or not 0.0 < rate <= LARGEST:
            raise self._error(
                'torque_rate_max',
                f'expected a finite number above 0, at most {LARGEST:.0f}, got {shortened(rate)}')
        return float(rate)

    def _gains(self, count: int) -> dict[str, Gains]:
        gains = self._get('gains')
        if not isinstance(gains, dict) or 'task' not in gains or not all(isinstance(name, str) for name in gains):
            raise self._error('gains', "expected gains by name, 'task' among them")
        return {name: self._gain(f'gains.{name}', entry, count) for name, entry in gains.items()}

    def _gain(self, key: str, entry: Any, count: int) -> Gains:
        if not isinstance(entry, dict) or set(entry) != {'kp', 'kd'}:
            raise self._error(key, f'expected kp and kd, got {shortened(entry)}')
        values = {part: self._numbers(f'{key}.{part}', entry[part], count) for part in ('kp', 'kd')}
        for part, numbers in values.items():
            if (numbers <= 0.0).any():
                raise self._error(f'{key}.{part}', 'a gain is not above 0')
        return Gains(**values)


def _order(robot: ElementTree.Element, root: str) -> list[str]:
    """The movable joints as pinocchio orders them: from the root on, at a fork by name, each branch to its end."""
    below: dict[str | None, list[tuple[str, str, bool]]] = {}
    for joint in robot.findall('joint'):
        parent, child = joint.find('parent'), joint.find('child')
        if parent is not None and child is not None:
            below.setdefault(parent.get('link'), []).append(
                (str(joint.get('name')), str(child.get('link')), joint.get('type') != 'fixed'))
    order, ahead = [], sorted(below.pop(root, []), reverse=True)
    while ahead:
        name, link, moves = ahead.pop()
        order += [name] if moves else []
        ahead += sorted(below.pop(link, []), reverse=True)
    return order
