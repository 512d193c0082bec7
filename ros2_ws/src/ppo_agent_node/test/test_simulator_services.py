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

"""The agent's requests to a simulator that refuses, or does not answer."""

import threading

import pytest
from ppo_agent_node import simulator as simulator_module
from ppo_agent_node.simulator import Simulator
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from shared_control.plant import PlantInterrupted
from shared_control_ros import contract
from std_srvs.srv import SetBool, Trigger


class Services:
    """A simulator's services, answered as the test says."""

    def __init__(self, context):
        self.node = Node('panda_sim_node', context=context)
        self.reset_succeeds = self.seed_succeeds = self.rest_succeeds = True
        self.asked = []
        self.node.create_service(Trigger, contract.RESET_SERVICE, self._on_reset)
        self.node.create_service(SetBool, contract.REST_SERVICE, self._on_rest)
        self.node.create_service(SetParameters, contract.SEED_SERVICE, self._on_seed)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)
        self._thread = threading.Thread(target=self._executor.spin)
        self._thread.start()

    def _on_reset(self, _, response):
        self.asked.append('reset')
        response.success, response.message = self.reset_succeeds, 'the world is broken'
        return response

    def _on_rest(self, _, response):
        response.success = self.rest_succeeds
        return response

    def _on_seed(self, request, response):
        response.results = [SetParametersResult(successful=self.seed_succeeds, reason='no such seed')
                            for _ in request.parameters]
        return response

    def close(self):
        self._executor.shutdown()
        self._thread.join()


@pytest.fixture
def services(observer):
    made = Services(observer.context)
    yield made
    made.close()


@pytest.fixture
def simulator(services, agent):
    return Simulator(*agent)


class TestAnswers:
    """Each answer is looked at."""

    def test_what_is_done_is_done(self, simulator, services):
        simulator.reset(5, lambda: None)
        simulator.rest(False, lambda: None)
        assert services.asked == ['reset']

    def test_a_refused_reset_makes_the_episode_void(self, simulator, services):
        services.reset_succeeds = False
        with pytest.raises(PlantInterrupted, match='/simulator/reset was refused: the world is broken'):
            simulator.reset(None, lambda: None)

    def test_a_refused_seed_makes_the_episode_void(self, simulator, services):
        services.seed_succeeds = False
        with pytest.raises(PlantInterrupted, match='/simulator/set_parameters was refused: no such seed'):
            simulator.reset(5, lambda: None)
        assert services.asked == []

    def test_a_robot_need_not_stand_still(self, simulator, services):
        services.rest_succeeds = False
        simulator.rest(True, lambda: None)


def test_time_is_counted_not_rounds(monkeypatch, observer):
    """Beside /clock a round of the executor ends after 10 ms instead of 50."""
    now, asked = 0.0, []

    class Unanswered:
        def done(self):
            return False

    class Client:
        service_name = '/simulator/reset'

        def service_is_ready(self):
            return True

        def call_async(self, _):
            asked.append(now)
            return Unanswered()

        def remove_pending_request(self, _):
            pass

    class ShortRounds:
        def spin_once(self, _):
            nonlocal now
            now += 0.01

    def attend():
        if len(asked) == 2:
            raise KeyboardInterrupt

    simulator = Simulator(observer.node, ShortRounds())
    monkeypatch.setattr(simulator, '_reset', Client())
    monkeypatch.setattr(simulator_module.time, 'monotonic', lambda: now)
    with pytest.raises(KeyboardInterrupt):
        simulator.reset(None, attend)
    assert asked[1] - asked[0] >= simulator_module.ANSWER_SECONDS
