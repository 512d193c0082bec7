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

"""The running tutor, shown a ball by a test that is the robot."""

import time

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from shared_control.keys import Key, KeyMoment, KeyPresses
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns
from std_msgs.msg import Int32, String


class Scene:
    """A still arm, a ball at rest, and keys that make M_yh as teleop_key_node would."""

    def __init__(self, observer):
        self.observer = observer
        self.heard = observer.listen(contract.KEYS)
        self.balls = observer.publisher(contract.BALL)
        self.joints = observer.publisher(contract.JOINT_STATES_THROTTLE)
        self.human = observer.publisher(contract.HUMAN_WRENCH)
        self.phases = observer.publisher(contract.PHASE)
        self.episodes = observer.publisher(contract.EPISODE)
        self.now_ns = time.time_ns() // 20_000_000 * 20_000_000
        self.moment, self._presses, self._read = KeyMoment(), KeyPresses(), 0
        self.pressed = []
        observer.spin(lambda: self.balls.get_subscription_count() and self.heard)

    def enter(self, phase, episode=1):
        self.episodes.publish(Int32(data=episode))
        self.phases.publish(String(data=phase))
        self.observer.spin_for(0.2)

    def show(self, error, seconds):
        """Show a ball ``error`` m off the centre for some time; the keys that were pressed."""
        before = len(self.pressed)
        for _ in range(round(seconds / 0.02)):
            self.now_ns += 20_000_000
            joints = JointState(name=list(panda().joints), position=panda().home.tolist())
            ball, wrench = Odometry(), WrenchStamped()
            for message in (joints, ball, wrench):
                message.header.frame_id = contract.BASE_FRAME
                set_ns(message.header.stamp, self.now_ns)
            ball.pose.pose.position.x = BALANCE.scene.home[0] - error
            wrench.wrench.torque.y = float(self.moment.moment[0])
            self.joints.publish(joints)
            self.human.publish(wrench)
            self.balls.publish(ball)
            self.observer.spin_for(0.02)
            for joy in self.heard[self._read:]:
                for key in self._presses.update(joy.buttons):
                    self.moment.press(key)
                    self.pressed.append(key)
            self._read = len(self.heard)
        return self.pressed[before:]


@pytest.fixture
def scene(start_node, observer):
    start_node('sim_tutor_node', seed=1)
    return Scene(observer)


def test_presses_keys_only_while_the_robot_is_taught(scene):
    assert scene.show(0.15, 1.0) == []
    for phase in ('wait', 'learn', 'test', 'done'):
        scene.enter(phase)
        assert scene.show(0.15, 0.6) == []
    scene.enter('teach')
    assert scene.show(0.15, 1.5)[0] is Key.LEFT
    scene.show(float('nan'), 0.1)
    scene.show(1e160, 0.1)
    scene.enter('teach', episode=2)
    scene.moment.release()
    assert scene.show(-0.15, 1.5)[0] is Key.RIGHT
    assert {joy.header.frame_id for joy in scene.heard} == {'tutor'}


def test_repeats_the_state_of_its_keys_even_when_time_stands_still(scene):
    scene.observer.spin_for(0.5)
    count = len(scene.heard)
    scene.observer.spin_for(2.0)
    assert len(scene.heard) - count >= 20
    assert all(list(joy.buttons) == [0, 0, 0] for joy in scene.heard)


def test_reports_itself_and_lets_go_when_it_leaves(start_node, observer):
    node = start_node('sim_tutor_node', profile='low')
    heard, reports = observer.listen(contract.KEYS), observer.listen(contract.DIAGNOSTICS)
    observer.spin(lambda: heard and reports)
    assert reports[0].status[0].name == '/sim_tutor_node'
    assert node.stop() == 0
    observer.spin_for(0.2)
    assert not np.any(heard[-1].buttons)


def test_goes_on_when_it_is_told_of_an_impossible_episode(start_node, observer):
    node = start_node('sim_tutor_node', profile='low')
    scene = Scene(observer)
    scene.enter('teach', episode=-1)
    assert scene.show(0.15, 1.5)[0] is Key.LEFT
    assert 'dropped a message on /training/episode: there is no episode -1' in node.log()


def test_unknown_profile_is_one_clear_line(start_node):
    node = start_node('sim_tutor_node', profile='genius')
    assert node.process.wait(60) == 2
    assert "parameter 'profile' has no choice 'genius'" in node.log()
