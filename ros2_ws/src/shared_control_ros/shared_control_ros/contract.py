"""The topics of the graph: names, types and quality of service (design, section 3)."""

from dataclasses import dataclass

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, Joy
from std_msgs.msg import Bool, Float64, Float64MultiArray, Int32, String

BASE_FRAME = 'panda_link0'
BALL_FRAME = 'ball'


def qos(depth: int = 1) -> QoSProfile:
    """Reliable and volatile: nothing is latched. ``depth`` is how many messages may wait."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.VOLATILE)


def qos_latched(depth: int = 100) -> QoSProfile:
    """Reliable and transient local, for the scalars of learning, which a late joiner must see."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(frozen=True)
class Topic:
    """One topic of the contract. Its name is relative, so that a namespace or a remapping reaches it."""

    name: str
    msg_type: type
    qos: QoSProfile
    """What publishers offer. A second's worth of messages, so that a recorder loses none."""


JOINT_STATES = Topic('joint_states', JointState, qos(1000))
JOINT_STATES_THROTTLE = Topic('joint_states_throttle', JointState, qos(100))
"""Every tenth of them, for those who need no more: each reader of the 1 kHz topic makes the robot's tick longer. (On a
robot that does not publish it, ``topic_tools throttle messages joint_states 100`` does.) A bag has the whole topic."""
EFFORT_COMMANDS = Topic('effort_controller/commands', Float64MultiArray, qos(1000))
KEYS = Topic('human/keys', Joy, qos(50))
HUMAN_WRENCH = Topic('human/target_wrench', WrenchStamped, qos(50))
AGENT_WRENCH = Topic('agent/target_wrench', WrenchStamped, qos(50))
APPLIED_WRENCH = Topic('target_wrench', WrenchStamped, qos(1000))
BALL = Topic('ball', Odometry, qos(100))
DISTURBANCE = Topic('disturbance', WrenchStamped, qos(10))
EMERGENCY_STOP = Topic('emergency_stop', Bool, qos(10))
"""True stops the controller, whoever says so; false changes nothing."""
DIAGNOSTICS = Topic('diagnostics', DiagnosticArray, qos(10))
CLOCK = Topic('/clock', Clock, qos(100))
"""Absolute: rclpy looks for it there, whatever the namespace."""


EPISODE = Topic('training/episode', Int32, qos_latched())
PHASE = Topic('training/phase', String, qos_latched())
TIME_LEFT = Topic('training/time_left', Float64, qos_latched(1))
EPISODE_RETURN = Topic('training/episode_return', Float64, qos_latched())
HUMAN_SHARE = Topic('training/human_share', Float64, qos_latched(1))
SUCCESS = Topic('training/success', Float64, qos_latched())

TOPICS = (
    JOINT_STATES, EFFORT_COMMANDS, KEYS, HUMAN_WRENCH, AGENT_WRENCH, APPLIED_WRENCH, BALL,
    DISTURBANCE, EMERGENCY_STOP, DIAGNOSTICS, CLOCK, EPISODE, PHASE, TIME_LEFT, EPISODE_RETURN, HUMAN_SHARE, SUCCESS)
"""Every topic of the contract; a recorder records these."""

RESET_SERVICE = 'panda_sim_node/reset'
PAUSE_SERVICE = 'panda_sim_node/pause'
ENABLE_SERVICE = 'torque_ctrl_node/enable'
FINISH_SERVICE = 'ppo_agent_node/finish'
START_SERVICE = 'ppo_agent_node/start'
REPEAT_SERVICE = 'ppo_agent_node/repeat'
