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

"""Which node publishes, subscribes to, serves and calls what: who is to be allowed what on a secured graph."""

from dataclasses import dataclass

from . import contract
from .contract import Topic

DISPLAYED = (
    contract.JOINT_STATES_THROTTLE, contract.BALL, contract.HUMAN_WRENCH, contract.AGENT_WRENCH,
    contract.APPLIED_WRENCH, contract.HUMAN_APPLIED, contract.AGENT_APPLIED)
SIMULATOR = (contract.RESET_SERVICE, contract.PAUSE_SERVICE, contract.REST_SERVICE, contract.SEED_SERVICE)
CONTROLLER = (
    contract.ENABLE_SERVICE, contract.EMERGENCY_STOP_SERVICE, contract.RESET_EMERGENCY_STOP_SERVICE)
LEARNER = (contract.START_SERVICE, contract.REPEAT_SERVICE, contract.FINISH_SERVICE, contract.KEEP_TEACHING_SERVICE)
ROBOT = (contract.JOINT_STATES, contract.JOINT_STATES_THROTTLE, contract.DIAGNOSTICS)


@dataclass(frozen=True)
class Interface:
    """What one node does beside what every node does (its log, its parameters, the clock).

    Names are relative to the namespace; ``~`` is the node's own.
    """

    publishes: tuple[Topic | str, ...] = ()
    subscribes: tuple[Topic | str, ...] = ()
    serves: tuple[str, ...] = ()
    calls: tuple[str, ...] = ()


INTERFACES = {
    'panda_sim_node': Interface(
        publishes=(*ROBOT, contract.BALL, contract.CLOCK),
        subscribes=(contract.EFFORT_COMMANDS, contract.DISTURBANCE),
        serves=SIMULATOR),
    'mock_panda_node': Interface(
        publishes=(*ROBOT, contract.BALL, contract.CLOCK),
        subscribes=(contract.EFFORT_COMMANDS, contract.DISTURBANCE),
        serves=(*SIMULATOR, contract.ROBOT_ENABLE_SERVICE, contract.ERROR_RECOVERY_SERVICE)),
    'panda_bridge_node': Interface(
        publishes=ROBOT, subscribes=(contract.EFFORT_COMMANDS,),
        serves=(contract.ROBOT_ENABLE_SERVICE, contract.ERROR_RECOVERY_SERVICE)),
    'torque_ctrl_node': Interface(
        publishes=(contract.EFFORT_COMMANDS, contract.APPLIED_WRENCH, contract.HUMAN_APPLIED, contract.AGENT_APPLIED,
                   contract.DIAGNOSTICS),
        subscribes=(contract.JOINT_STATES, contract.HUMAN_WRENCH, contract.AGENT_WRENCH, contract.EMERGENCY_STOP,
                    contract.DIAGNOSTICS),
        serves=CONTROLLER),
    'teleop_key_node': Interface(
        publishes=(contract.HUMAN_WRENCH, contract.KEYS, contract.HUMAN_VERDICT, contract.DIAGNOSTICS),
        subscribes=(contract.JOY, contract.KEYS, *DISPLAYED, *contract.TRAINING, contract.VERDICT, contract.WAITING,
                    contract.DIAGNOSTICS),
        calls=(contract.PAUSE_SERVICE, *LEARNER)),
    'ppo_agent_node': Interface(
        publishes=(contract.AGENT_WRENCH, contract.DIAGNOSTICS, *contract.TRAINING, contract.VERDICT),
        subscribes=(contract.BALL, contract.JOINT_STATES_THROTTLE, contract.HUMAN_APPLIED, contract.AGENT_APPLIED,
                    contract.APPLIED_WRENCH, contract.HUMAN_VERDICT),
        serves=LEARNER,
        calls=(contract.RESET_SERVICE, contract.REST_SERVICE, contract.SEED_SERVICE)),
    'sim_tutor_node': Interface(
        publishes=(contract.KEYS, contract.DIAGNOSTICS),
        subscribes=(contract.BALL, contract.JOINT_STATES_THROTTLE, contract.HUMAN_WRENCH, contract.EPISODE,
                    contract.PHASE)),
    'teach_page_node': Interface(
        publishes=(contract.KEYS, contract.HUMAN_VERDICT, contract.DIAGNOSTICS),
        subscribes=(contract.KEYS, *DISPLAYED, *contract.TRAINING, contract.VERDICT, contract.WAITING,
                    contract.DIAGNOSTICS),
        calls=(contract.PAUSE_SERVICE, *LEARNER)),
    'session_recorder_node': Interface(publishes=(contract.DIAGNOSTICS,), subscribes=contract.BAG_TOPICS),
    'robot_view_node': Interface(
        publishes=('robot_description', 'markers', '/tf', contract.DIAGNOSTICS), subscribes=DISPLAYED),
    'session': Interface(
        publishes=(contract.WAITING, contract.DIAGNOSTICS),
        subscribes=(contract.PHASE, contract.EPISODE_RETURN, contract.DIAGNOSTICS)),
    'operator': Interface(
        publishes=(contract.EMERGENCY_STOP, contract.DISTURBANCE, contract.HUMAN_VERDICT),
        subscribes=contract.TOPICS,
        calls=(*CONTROLLER, contract.ROBOT_ENABLE_SERVICE, contract.ERROR_RECOVERY_SERVICE, contract.RESET_SERVICE,
               contract.PAUSE_SERVICE, contract.FINISH_SERVICE, contract.KEEP_TEACHING_SERVICE)),
}
"""By name of the node; ``operator`` is a person with the ros2 command."""
