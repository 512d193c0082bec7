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

"""The table of :mod:`shared_control.contract` for rclpy: message types and QoS profiles."""

import importlib
from dataclasses import dataclass
from functools import cache

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from shared_control import contract as table

BASE_FRAME = table.BASE_FRAME
BALL_FRAME = table.BALL_FRAME
RECORDER_DEPTH = table.RECORDER_DEPTH


def qos(depth: int = 1) -> QoSProfile:
    """Reliable and volatile: nothing is latched. ``depth`` is how many messages may wait."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.VOLATILE)


def qos_unreliable(depth: int = 1) -> QoSProfile:
    """Best effort: of a subscription, for which every publisher will do, a reliable one, too."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.VOLATILE)


def qos_latched(depth: int = 100) -> QoSProfile:
    """Reliable and transient local, for the scalars of learning, which a late joiner must see."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(frozen=True)
class Topic:
    """One topic. Its name is relative, so that a namespace or a remapping reaches it."""

    name: str
    msg_type: type
    qos: QoSProfile
    """What publishers offer."""

    @property
    def full_name(self) -> str:
        """The name in a graph without a namespace."""
        return '/' + self.name.removeprefix('/')


@cache
def ros_topic(entry: table.Topic) -> Topic:
    """An entry of the table with its message type and its publishers' quality of service."""
    package, folder, name = entry.type.split('/')
    msg_type = getattr(importlib.import_module(f'{package}.{folder}'), name)
    return Topic(entry.name, msg_type, qos_latched(entry.depth) if entry.latched else qos(entry.depth))


JOINT_STATES = ros_topic(table.JOINT_STATES)
JOINT_STATES_THROTTLE = ros_topic(table.JOINT_STATES_THROTTLE)
EFFORT_COMMANDS = ros_topic(table.EFFORT_COMMANDS)
KEYS = ros_topic(table.KEYS)
JOY = ros_topic(table.JOY)
HUMAN_VERDICT = ros_topic(table.HUMAN_VERDICT)
HUMAN_WRENCH = ros_topic(table.HUMAN_WRENCH)
AGENT_WRENCH = ros_topic(table.AGENT_WRENCH)
APPLIED_WRENCH = ros_topic(table.APPLIED_WRENCH)
HUMAN_APPLIED = ros_topic(table.HUMAN_APPLIED)
AGENT_APPLIED = ros_topic(table.AGENT_APPLIED)
BALL = ros_topic(table.BALL)
DISTURBANCE = ros_topic(table.DISTURBANCE)
EMERGENCY_STOP = ros_topic(table.EMERGENCY_STOP)
DIAGNOSTICS = ros_topic(table.DIAGNOSTICS)
CLOCK = ros_topic(table.CLOCK)
EPISODE = ros_topic(table.EPISODE)
PHASE = ros_topic(table.PHASE)
TIME_LEFT = ros_topic(table.TIME_LEFT)
EPISODE_RETURN = ros_topic(table.EPISODE_RETURN)
HUMAN_SHARE = ros_topic(table.HUMAN_SHARE)
SUCCESS = ros_topic(table.SUCCESS)
RESTS_LEFT = ros_topic(table.RESTS_LEFT)
VERDICT = ros_topic(table.VERDICT)
WAITING = ros_topic(table.WAITING)

TRAINING = tuple(map(ros_topic, table.TRAINING))
TOPICS = tuple(map(ros_topic, table.TOPICS))
BAG_TOPICS = tuple(map(ros_topic, table.BAG_TOPICS))
"""What a recorder records."""

RESET_SERVICE = table.RESET.name
PAUSE_SERVICE = table.PAUSE.name
REST_SERVICE = table.REST.name
SEED_SERVICE = table.SEED.name
START_SERVICE = table.LEARNER_START.name
REPEAT_SERVICE = table.LEARNER_REPEAT.name
FINISH_SERVICE = table.LEARNER_FINISH.name
KEEP_TEACHING_SERVICE = table.LEARNER_KEEP_TEACHING.name
ENABLE_SERVICE = table.CONTROLLER_ENABLE.name
EMERGENCY_STOP_SERVICE = table.CONTROLLER_STOP.name
RESET_EMERGENCY_STOP_SERVICE = table.CONTROLLER_RESET.name
ROBOT_ENABLE_SERVICE = table.ROBOT_ENABLE.name
ERROR_RECOVERY_SERVICE = table.ROBOT_RECOVERY.name
