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

"""Robots from their files: the Panda's numbers to the bit, and errors that name the file and the key."""

from itertools import pairwise

import numpy as np
import pytest
import yaml
from shared_control.robot.model import RobotModel
from shared_control.robot.possible import PossibleStates
from shared_control.robot.spec_file import RobotFileError, load_robot, panda
from shared_control.robot.specs import PANDA


def test_the_panda_is_the_one_of_the_thesis():
    assert panda().dof == 7 and panda().joints == tuple(f'panda_joint{i}' for i in range(1, 8))
    np.testing.assert_array_equal(panda().home, np.deg2rad([0.0, -90.0, 0.0, -90.0, 0.0, 179.0, 90.0]))
    np.testing.assert_array_equal(panda().q_max, [2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973])
    np.testing.assert_array_equal(panda().gains['task'].kd, [25.0, 700.0, 25.0, 800.0, 25.0, 25.0, 10.0])
    assert panda().torque_rate_max == 1000.0 and set(panda().gains) == {'task', 'high', 'low'}
    np.testing.assert_array_equal(panda().clamp_torque(np.full(7, -1e9)), -panda().torque_max)


def test_a_robot_is_found_by_name_or_by_path(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text(PANDA.read_text())
    mine = load_robot(str(path))
    assert (mine.name, panda().name) == ('mine', 'panda')
    assert RobotModel(mine).pin_model.nq == mine.dof
    assert load_robot('panda') is panda()
    with pytest.raises(ValueError, match=r"no robot 'nobody'; there are .*panda"):
        load_robot('nobody')


def test_a_urdf_lies_beside_the_file(tmp_path):
    (tmp_path / 'arm.urdf').write_bytes(panda().urdf.read_bytes())
    path = tmp_path / 'mine.yaml'
    path.write_text(yaml.safe_dump(yaml.safe_load(PANDA.read_text()) | {'urdf': 'arm.urdf'}))
    assert load_robot(str(path)).urdf == tmp_path / 'arm.urdf'


def test_a_state_is_possible_far_beyond_the_limits_of_the_robot():
    """A fall, a blow, a driver that measures: the arm is still to be brought to rest."""
    robot = panda()
    assert PossibleStates(robot).fault(robot.q_max + 50.0, -100.0 * robot.qd_max, 2.5 * robot.torque_max) == ''
    assert PossibleStates(robot).fault(robot.q_min - 50.0) == ''


@pytest.mark.parametrize(('quantity', 'value', 'said'), [
    (0, -100.0, 'position of panda_joint3 is -100 rad, which no arm has: at most 66 are possible'),
    (1, 1e160, 'velocity of panda_joint3 is 1e+160 rad/s, which no arm has: at most 2175 are possible'),
    (2, 1000.0, 'effort of panda_joint3 is 1000 N m, which no arm has: at most 261 are possible'),
    (1, np.nan, 'velocity of panda_joint3 is nan rad/s, which no arm has: at most 2175 are possible'),
    (2, -np.inf, 'effort of panda_joint3 is -inf N m, which no arm has: at most 261 are possible')])
def test_a_state_that_no_arm_can_be_in_is_named(quantity, value, said):
    state = [panda().home.copy(), np.zeros(7), np.zeros(7)]
    state[quantity][2] = value
    assert PossibleStates(panda()).fault(*state) == said


@pytest.mark.parametrize('kind', ['continuous', 'floating'])
def test_joints_without_limits_are_refused(tmp_path, kind):
    urdf = panda().urdf.read_text()
    (tmp_path / 'arm.urdf').write_text(urdf.replace('type="revolute"', f'type="{kind}"', 1))
    path = tmp_path / 'mine.yaml'
    path.write_text(yaml.safe_dump(yaml.safe_load(PANDA.read_text()) | {'urdf': 'arm.urdf'}))
    with pytest.raises(RobotFileError, match=f"mine.yaml: joints: 'panda_joint1' of .*arm.urdf is {kind}; joints must"):
        load_robot(str(path))


def joint_of_urdf(name, kind, parent):
    """A joint and the link behind it, which has its name."""
    return (f'<link name="{name}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{name}"/>'
            '<limit lower="-1" upper="1" effort="9" velocity="9"/></joint>')


def test_the_order_of_joints_is_the_models_at_forks_too(tmp_path):
    (tmp_path / 'forked.urdf').write_text('<robot name="forked"><link name="root"/>' + ''.join(
        joint_of_urdf(*joint) for joint in (
            ('z', 'revolute', 'root'), ('y', 'fixed', 'root'), ('b', 'revolute', 'y'), ('c', 'revolute', 'b'),
            ('a', 'prismatic', 'y'))) + '</robot>')
    joints, ones = ['a', 'b', 'c', 'z'], [1.0] * 4
    path = tmp_path / 'forked.yaml'
    content = {'urdf': 'forked.urdf', 'joints': joints, 'base_frame': 'root', 'tool_frame': 'c', 'torque_rate_max': 1.0,
               'gains': {'task': {'kp': ones, 'kd': ones}}, 'q_min': [-1.0] * 4, 'home': [0.0] * 4,
               **dict.fromkeys(('q_max', 'qd_max', 'qdd_max', 'torque_max'), ones)}
    path.write_text(yaml.safe_dump(content))
    assert RobotModel(load_robot(str(path))).pin_model.nq == 4
    path = tmp_path / 'other.yaml'
    path.write_text(yaml.safe_dump(content | {'joints': ['z', *joints[:3]]}))
    with pytest.raises(RobotFileError, match='another order'):
        load_robot(str(path))


SEVEN = [1.0] * 7


@pytest.mark.parametrize(('change', 'message'), [
    ({'urdf': 'nowhere.urdf'}, r'urdf: there is no file .*nowhere\.urdf'),
    ({'urdf': 'package://no_such_package/arm.urdf'}, "urdf: there is no Python package 'no_such_package'"),
    ({'urdf': 3}, 'urdf: expected a text'),
    ({'joints': ['elbow']}, "joints: 'elbow' is no movable joint of .*panda_tray.urdf"),
    ({'joints': ['panda_joint1']}, "joints: 'panda_joint2' of .* is missing: it moves, too"),
    ({'joints': ['panda_joint1'] * 7}, 'joints: a name occurs twice'),
    ({'joints': []}, 'joints: expected a list of names'),
    ({'joints': list(reversed(panda().joints))},
     r"joints: they are in another order than in .*, from its root on: \['panda_joint1', 'panda_joint2',"),
    ({'tool_frame': 'gripper'}, "tool_frame: .* has no link 'gripper'"),
    ({'base_frame': 'world'}, "base_frame: .* has no link 'world'"),
    ({'base_frame': 'panda_link3'}, "base_frame: .* root is 'panda_link0'"),
    ({'q_max': SEVEN[1:]}, 'q_max: has 6 numbers for 7 joints'),
    ({'q_max': [-9.0, *SEVEN[1:]]}, 'q_min: is not below q_max at panda_joint1'),
    ({'home_deg': [0.0, 500.0, *SEVEN[2:]]}, 'home: is not between q_min and q_max at panda_joint2'),
    ({'home': SEVEN}, 'home_deg: is given beside home'),
    ({'qd_max': [*SEVEN[1:], float('nan')]}, 'qd_max: a number is not finite'),
    ({'qdd_max': [*SEVEN[1:], 'fast']}, 'qdd_max: expected a list of numbers'),
    ({'torque_max': [*SEVEN[1:], 0.0]}, 'torque_max: is not above 0 at panda_joint7'),
    ({'torque_rate_max': -1.0}, 'torque_rate_max: expected a finite number above 0'),
    ({'gains': {'soft': {'kp': SEVEN, 'kd': SEVEN}}}, "gains: expected gains by name, 'task' among them"),
    ({'gains': {'task': {'kp': SEVEN}}}, 'gains.task: expected kp and kd'),
    ({'gains': {'task': {'kp': SEVEN, 'kd': [*SEVEN[1:], -1.0]}}}, 'gains.task.kd: a gain is not above 0'),
    ({'gains': {'task': {'kp': SEVEN, 'kd': SEVEN}, 3: {'kp': SEVEN, 'kd': SEVEN}}}, 'gains: expected gains by name'),
    ({'torque_rate_max': 10**400}, 'torque_rate_max: expected a finite number above 0'),
    ({'q_max': [*SEVEN[1:], 10**400]}, 'q_max: a number is not finite, or above 1000000'),
    ({'q_max_deg': [*SEVEN[1:], 1e300]}, 'q_max_deg: is given beside q_max'),
    ({'urdf': 'x' * 5000}, 'urdf: .*too long'),
    ({'urdf': '~nobody_of_that_name/arm.urdf'}, 'urdf: '),
    ({'colour': 'white'}, 'colour: there is no such key; there are base_frame'),
])
def test_what_is_wrong_is_named_with_file_and_key(tmp_path, change, message):
    path = tmp_path / 'broken.yaml'
    path.write_text(yaml.safe_dump(yaml.safe_load(PANDA.read_text()) | change))
    with pytest.raises(RobotFileError, match=rf'broken\.yaml: {message}'):
        load_robot(str(path))


@pytest.mark.parametrize(('text', 'message'), [
    ('[' * 3000, 'cannot read the robot file'),
    ('q_min: [' + '1' * 5000 + ']', 'cannot read the robot file'),
    ('#' * 2**21, 'more than 1048576 bytes'),
    ('a: &a {b: 1}\nc: {<<: *a}', 'line 2: merge keys'),
    ('joints: &a [*a, *a]', 'joints: expected a list of names'),
    ('"\\e[31mred": 1', r'\\x1b\[31mred: there is no such key'),
    ('joints: ["\\e[31mred", 1]', 'joints: expected a list of names'),
    ('urdf: "\\e[31mred"', 'is missing'),
    ('!%1b[31mred {}', 'cannot read the robot file'),
    ('a: {b: {c: {d: {e: [' + '1, ' * 10_000 + ']}}}}', 'a: there is no such key'),
])
def test_what_a_strange_file_says_is_told_short_and_harmless(tmp_path, text, message):
    path = tmp_path / 'strange.yaml'
    path.write_text(text)
    with pytest.raises(RobotFileError, match=message) as error:
        load_robot(str(path))
    assert '\x1b' not in str(error.value) and len(str(error.value)) < 1000


@pytest.mark.parametrize('change', [
    {'urdf': '\x1b[31mred.urdf'}, {'base_frame': '\x1b[31mred'}, {'joints': ['\x1b[31mred']},
    {'gains': {'task': {'kp': SEVEN, 'kd': SEVEN}, '\x1b[31mred': {'kp': 1, 'kd': 2}}}])
def test_control_characters_of_a_file_reach_no_terminal(tmp_path, change):
    path = tmp_path / 'strange.yaml'
    path.write_text(yaml.safe_dump(yaml.safe_load(PANDA.read_text()) | change))
    with pytest.raises(RobotFileError, match=r'\\x1b\[31mred') as error:
        load_robot(str(path))
    assert '\x1b' not in str(error.value)


def test_a_key_that_stands_twice_is_named(tmp_path):
    (tmp_path / 'twice.yaml').write_text(f'{PANDA.read_text()}\ntorque_rate_max: 500.0\n')
    with pytest.raises(RobotFileError, match=r"twice\.yaml: line \d+: the key 'torque_rate_max' stands there twice"):
        load_robot(str(tmp_path / 'twice.yaml'))


@pytest.mark.parametrize('levels', [9, 30])
def test_aliases_are_not_expanded(tmp_path, levels):
    path = tmp_path / 'bomb.yaml'
    names = [f'l{level}' for level in range(levels)]
    path.write_text('joints:\n- &l0 [x, x]\n' + ''.join(
        f'- &{name} [{", ".join(9 * [f"*{below}"])}]\n' for below, name in pairwise(names)))
    with pytest.raises(RobotFileError, match='joints: expected a list of names') as error:
        load_robot(str(path))
    assert len(str(error.value)) < 1000


def test_a_missing_key_or_file_is_named(tmp_path):
    path = tmp_path / 'broken.yaml'
    content = yaml.safe_load(PANDA.read_text())
    del content['home_deg']
    path.write_text(yaml.safe_dump(content))
    with pytest.raises(RobotFileError, match=r'broken\.yaml: home: is missing'):
        load_robot(str(path))
    with pytest.raises(RobotFileError, match=r'cannot read the robot file .*nothing\.yaml'):
        load_robot(str(tmp_path / 'nothing.yaml'))
