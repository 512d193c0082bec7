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

"""The agent's view of a robot whose ball a camera sees."""

import threading
import time

import numpy as np
import pytest
from nav_msgs.msg import Odometry
from ppo_agent_node.graph_plant import GraphPlant
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from shared_control.plant import PlantInterrupted
from shared_control.robot.spec_file import panda
from shared_control.tasks.balance import BALANCE
from shared_control_ros import contract
from shared_control_ros.fast_loop import Background
from shared_control_ros.joint_state_publisher import THROTTLED_PERIOD_NS, JointStatePublisher
from shared_control_ros.stamps import set_ns
from std_srvs.srv import SetBool, Trigger

MS = 1_000_000
CAMERA_NS = 50 * MS
"""How long a camera takes until it tells of a ball."""


class RobotBesideACamera:
    """Its time goes on whatever it is asked for; states a millisecond, and balls that come late."""

    def __init__(self, context):
        self.node = Node('robot', context=context)
        self._background = Background(self.node)
        self._joints = JointStatePublisher(self.node, panda())
        self._balls = self.node.create_publisher(contract.BALL.msg_type, contract.BALL.name, contract.BALL.qos)
        self.node.create_service(Trigger, contract.RESET_SERVICE, self._on_reset)
        self.node.create_service(SetBool, contract.REST_SERVICE, lambda _, response: response)
        self.node.create_service(SetParameters, contract.SEED_SERVICE, self._on_seed)
        self._ends = False
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _on_reset(self, _, response):
        response.success = True
        return response

    def _on_seed(self, request, response):
        response.results = [SetParametersResult(successful=True) for _ in request.parameters]
        return response

    def _run(self):
        ball = Odometry()
        ball.header.frame_id = contract.BASE_FRAME
        stamp_ns = time.time_ns() // MS * MS
        while not self._ends:
            stamp_ns += MS
            time.sleep(max(0.0, (stamp_ns - time.time_ns()) * 1e-9))
            self._joints.publish(stamp_ns, panda().home, np.zeros(7), np.zeros(7))
            if (stamp_ns - CAMERA_NS) % THROTTLED_PERIOD_NS == 0:
                set_ns(ball.header.stamp, stamp_ns - CAMERA_NS)
                self._balls.publish(ball)
                self._background.poll()

    def close(self):
        self._ends = True
        self._thread.join()
        self._background.close()
        self.node.destroy_node()


@pytest.fixture
def robot(observer):
    robot = RobotBesideACamera(observer.context)
    yield robot
    robot.close()


@pytest.fixture
def plant(agent):
    node, background = agent
    plant = GraphPlant(node, BALANCE.axes, background, lambda: None)
    yield plant
    plant.close()


def test_an_episode_begins_with_the_joints_of_a_ball_that_was_on_its_way(robot, plant):
    for _ in range(20):
        try:
            state = plant.reset(None)
            plant.advance(np.zeros(1))
        except PlantInterrupted:  # a busy machine: other tests run beside this one
            continue
        assert state.q.tolist() == panda().home.tolist()
        return
    pytest.fail('no episode begins')
