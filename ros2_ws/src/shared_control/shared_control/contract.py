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

"""The contract of the graph as data: its topics, services and frames.

``shared_control_ros.contract`` adds rclpy's types; :mod:`shared_control.contract_tables` prints it as text.
"""

from dataclasses import dataclass

BASE_FRAME = 'panda_link0'
BALL_FRAME = 'ball'
_TRIGGER = 'std_srvs/srv/Trigger'
_SET_BOOL = 'std_srvs/srv/SetBool'
RECORDER_DEPTH = 2000
"""Messages of each topic that may wait for a recorder: two seconds of a 1 kHz topic."""


@dataclass(frozen=True)
class Topic:
    """One topic. Quality of service: reliable, keep last."""

    name: str
    """Relative, so that a namespace or a remapping reaches it."""
    type: str
    depth: int
    """What publishers offer: a second's worth of messages, so that a recorder loses none."""
    publishers: str
    subscribers: str
    rate: str
    what: str
    latched: bool = False
    """Transient local, for those who join late; else volatile."""
    in_bag: bool = True

    @property
    def full_name(self) -> str:
        """The name in a graph without a namespace, as bags have it."""
        return '/' + self.name.removeprefix('/')


@dataclass(frozen=True)
class Service:
    """One service."""

    name: str
    """Relative, and of the role that serves it: a node of another name takes the role as it is."""
    type: str
    server: str
    what: str


JOINT_STATES = Topic(
    'joint_states', 'sensor_msgs/msg/JointState', 1000, 'robot', 'controller, recorder', '1 kHz',
    'rad, rad/s; `effort`: the torque applied last, N m')
JOINT_STATES_THROTTLE = Topic(
    'joint_states_throttle', 'sensor_msgs/msg/JointState', 100, 'robot', 'agent, tutor, screens, views', '100 Hz',
    'those with a stamp that is a multiple of 10 ms; not in bags', in_bag=False)
"""For those who need no more: each reader of the 1 kHz topic makes the robot's tick longer. (On a robot that does not
publish it, ``topic_tools throttle messages joint_states 100`` does.)"""
EFFORT_COMMANDS = Topic(
    'effort_controller/commands', 'std_msgs/msg/Float64MultiArray', 1000, 'controller', 'robot', '1 kHz',
    '7 torques, N m; `label`: stamp of the joint states that they answer, ns')
ANSWER_DIGITS = 19
"""How many digits that stamp has, zeros in front; enough until the year 2286. It is not negative."""
KEYS = Topic(
    'human/keys', 'sensor_msgs/msg/Joy', 50, 'any source of keys', 'teleop', 'on event, 10 Hz or more',
    'buttons = left, right, space, up, down; axes of a stick = left, up')
JOY = Topic(
    'joy', 'sensor_msgs/msg/Joy', 50, 'joy_node, spacenav, ...', 'teleop', '10 Hz or more',
    'a gamepad or the like as its driver has it; teleop says on `/human/keys` what it means')
HUMAN_VERDICT = Topic(
    'human/verdict', 'std_msgs/msg/String', 10, 'terminal, page, buttons of a Joy', 'agent', 'on event',
    'of the last episode that has ended: `success`, `failure`, `discard`; the same again takes it back')
HUMAN_WRENCH = Topic(
    'human/target_wrench', 'geometry_msgs/msg/WrenchStamped', 50, 'teleop', 'controller, agent, tutor',
    '50 Hz, zero included', "moment along the task's axes, N m")
AGENT_WRENCH = Topic(
    'agent/target_wrench', 'geometry_msgs/msg/WrenchStamped', 50, 'agent', 'controller, screens', '50 Hz',
    "moment along the task's axes, N m")
APPLIED_WRENCH = Topic(
    'target_wrench', 'geometry_msgs/msg/WrenchStamped', 1000, 'controller', 'agent, screens', 'on change, 100 Hz',
    'their sum as applied, N m')
HUMAN_APPLIED = Topic(
    'human/applied_wrench', 'geometry_msgs/msg/WrenchStamped', 1000, 'controller', 'agent, screens',
    'with `/target_wrench`',
    "M_yh as it counted in the sum, N m: the person's part, faded when stale, before the sum is clamped")
AGENT_APPLIED = Topic(
    'agent/applied_wrench', 'geometry_msgs/msg/WrenchStamped', 1000, 'controller', 'agent, screens',
    'with `/target_wrench`', "M_yai as it counted in the sum, N m: the agent's part, likewise")
BALL = Topic(
    'ball', 'nav_msgs/msg/Odometry', 100, 'robot', 'agent, tutor, screens, views', '100 Hz',
    'm, m/s in `panda_link0`')
DISTURBANCE = Topic(
    'disturbance', 'geometry_msgs/msg/WrenchStamped', 10, 'tests', 'simulator', 'on event', 'force at the tray, N')
EMERGENCY_STOP = Topic(
    'emergency_stop', 'std_msgs/msg/Bool', 10, 'anybody', 'controller', 'on event',
    'true stops; false changes nothing')
DIAGNOSTICS = Topic(
    'diagnostics', 'diagnostic_msgs/msg/DiagnosticArray', 10, 'all nodes', '', '1 Hz',
    'period p50 and p99, overruns, what is silent; of simulator and controller the task; of a simulator, at once, '
    'whether it is `paused`; of a robot, whether it `compensates_gravity`')
CLOCK = Topic('/clock', 'rosgraph_msgs/msg/Clock', 100, 'simulator', 'all', '100 Hz', 'simulation time')
"""Absolute: rclpy expects it there, whatever the namespace."""
EPISODE = Topic(
    'training/episode', 'std_msgs/msg/Int32', 100, 'agent', '', 'start of an episode', 'from 1', latched=True)
PHASE = Topic(
    'training/phase', 'std_msgs/msg/String', 100, 'agent', '', 'on change',
    '`practice`, `teach`, `learn`, `test`, `wait`, `done`', latched=True)
TIME_LEFT = Topic(
    'training/time_left', 'std_msgs/msg/Float64', 1, 'agent', '', '10 Hz',
    's, of the episode, at its begin all of it; in `learn` and `wait` until the next one begins', latched=True)
EPISODE_RETURN = Topic(
    'training/episode_return', 'std_msgs/msg/Float64', 100, 'agent', '', 'end of an episode',
    'sum of the unscaled reward', latched=True)
HUMAN_SHARE = Topic(
    'training/human_share', 'std_msgs/msg/Float64', 1, 'agent', '', '10 Hz',
    r'0..1: mean of \|M_yh\| / (\|M_yh\| + \|M_yai\|) over the episode so far', latched=True)
RESTS_LEFT = Topic(
    'training/rests_left', 'std_msgs/msg/Int32', 100, 'agent', 'screens', 'on change, in practice',
    'how often the ball still has to be brought to rest before the teaching can begin', latched=True)
SUCCESS = Topic('training/success', 'std_msgs/msg/Float64', 100, 'agent', '', 'end of a test', '0..1', latched=True)
VERDICT = Topic(
    'training/verdict', 'diagnostic_msgs/msg/KeyValue', 100, 'agent', 'screens',
    'end of an episode, and on change',
    "a person's verdict as it counts; key: the episode, `teach 4`; value: `success`, `failure`, `discard`, "
    'or empty',
    latched=True)
WAITING = Topic(
    'session/waiting', 'std_msgs/msg/String', 1, 'session', 'screens', 'on change, then 1 Hz',
    'what the session waits for and since when; in a second line what holds it up (an emergency stop, and what ends '
    'it) or the newest warning about it; empty: nothing. Not in bags',
    latched=True, in_bag=False)

TRAINING = (EPISODE, PHASE, TIME_LEFT, EPISODE_RETURN, HUMAN_SHARE, SUCCESS, RESTS_LEFT)
"""Series of a number or a text."""
TOPICS = (
    JOINT_STATES, JOINT_STATES_THROTTLE, EFFORT_COMMANDS, KEYS, JOY, HUMAN_VERDICT, HUMAN_WRENCH, AGENT_WRENCH,
    APPLIED_WRENCH, HUMAN_APPLIED, AGENT_APPLIED, BALL, DISTURBANCE, EMERGENCY_STOP, DIAGNOSTICS, CLOCK, *TRAINING,
    VERDICT, WAITING)
BAG_TOPICS = tuple(topic for topic in TOPICS if topic.in_bag)
"""What a recorder records."""

RESET = Service(
    'simulator/reset', _TRIGGER, 'simulator, mock',
    'arm to the reference, ball dropped anew; refused in an episode of a learner (`learner/repeat` starts it over)')
PAUSE = Service(
    'simulator/pause', _SET_BOOL, 'simulator, mock', 'for people: time stands still, or goes on; refused by a robot')
REST = Service(
    'simulator/rest', _SET_BOOL, 'simulator, mock',
    'for the learner: the same, and a pause that a person asks for meanwhile stays; ends by itself when the '
    'learner has left')
SEED = Service(
    'simulator/set_parameters', 'rcl_interfaces/srv/SetParameters', 'simulator, mock',
    '`seed` alone: begins the sequence of ball starts anew')
LEARNER_START = Service('learner/start', _TRIGGER, 'agent', 'end the practice, teach')
LEARNER_REPEAT = Service('learner/repeat', _TRIGGER, 'agent', 'the episode is void: start it over, with the same ball')
LEARNER_FINISH = Service(
    'learner/finish', _TRIGGER, 'agent',
    'end the teaching after this episode, begun anew if it is void; then test, and leave')
LEARNER_KEEP_TEACHING = Service(
    'learner/keep_teaching', _TRIGGER, 'agent', 'take `learner/finish` back, while the episode lasts')
CONTROLLER_ENABLE = Service('controller/enable', _SET_BOOL, 'controller', 'send torques, or none')
CONTROLLER_STOP = Service(
    'controller/emergency_stop', _TRIGGER, 'controller', 'disable, until it is reset; wins over `controller/enable`')
CONTROLLER_RESET = Service(
    'controller/reset_emergency_stop', _TRIGGER, 'controller', 'the emergency stop is over; still disabled')
ROBOT_ENABLE = Service('robot/enable', _SET_BOOL, 'bridge, mock', 'move the arm, or let it hold itself')
ROBOT_RECOVERY = Service('robot/error_recovery', _TRIGGER, 'bridge, mock', 'leave a reflex stop')

SERVICES = (
    RESET, PAUSE, REST, SEED, LEARNER_START, LEARNER_REPEAT, LEARNER_FINISH, LEARNER_KEEP_TEACHING, CONTROLLER_ENABLE,
    CONTROLLER_STOP, CONTROLLER_RESET, ROBOT_ENABLE, ROBOT_RECOVERY)


def answer_label(stamp_ns: int) -> str:
    """What the dimension of a torque command is called that answers joint states of a stamp, ns."""
    return str(stamp_ns).zfill(ANSWER_DIGITS)
