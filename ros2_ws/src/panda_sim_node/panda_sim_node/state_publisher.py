"""What the simulated robot publishes: joints, ball, clock."""

import numpy as np
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from shared_control.robot.limits import DOF, JOINT_NAMES
from shared_control.world.ball_on_tray import BallOnTrayWorld
from shared_control_ros import contract
from shared_control_ros.stamps import set_ns

TICKS_PER_BALL = 10
"""The ball's odometry, the clock and the throttled joint states go out at 100 Hz."""


class StatePublisher:
    """Publishes a world's state; the messages are made once and filled in again and again."""

    def __init__(self, node: Node, world: BallOnTrayWorld):
        self._world = world
        self._joints = JointState(
            name=list(JOINT_NAMES), position=[0.0] * DOF, velocity=[0.0] * DOF, effort=[0.0] * DOF)
        self._joints.header.frame_id = contract.BASE_FRAME
        self._position = np.frombuffer(self._joints.position)
        self._velocity = np.frombuffer(self._joints.velocity)
        self._effort = np.frombuffer(self._joints.effort)
        # The ball's frame sits at its centre with the axes of the base: which way a ball has turned is of no use,
        # and so the twist, which belongs to this frame, has the base's axes.
        self._ball = Odometry(child_frame_id=contract.BALL_FRAME)
        self._ball.header.frame_id = contract.BASE_FRAME
        self._clock = Clock()
        self._joints_publisher = node.create_publisher(
            contract.JOINT_STATES.msg_type, contract.JOINT_STATES.name, contract.JOINT_STATES.qos)
        self._publish_throttled = node.create_publisher(
            contract.JOINT_STATES_THROTTLE.msg_type, contract.JOINT_STATES_THROTTLE.name,
            contract.JOINT_STATES_THROTTLE.qos).publish
        self._publish_ball = node.create_publisher(
            contract.BALL.msg_type, contract.BALL.name, contract.BALL.qos).publish
        self._publish_clock = node.create_publisher(
            contract.CLOCK.msg_type, contract.CLOCK.name, contract.CLOCK.qos).publish

    def publish(self, tick: int, stamp_ns: int) -> None:
        """The state at a tick: joints at each, ball and clock at every tenth."""
        with_ball = tick % TICKS_PER_BALL == 0
        if with_ball:
            set_ns(self._clock.clock, stamp_ns)
            self._publish_clock(self._clock)
        set_ns(self._joints.header.stamp, stamp_ns)
        self._position[:], self._velocity[:] = self._world.joint_state()
        self._effort[:] = self._world.effort
        self._joints_publisher.publish(self._joints)
        if with_ball:
            self._publish_throttled(self._joints)
            self._fill_ball(stamp_ns)
            self._publish_ball(self._ball)

    def _fill_ball(self, stamp_ns: int) -> None:
        position, _, velocity, spin = self._world.ball_state()
        set_ns(self._ball.header.stamp, stamp_ns)
        pose, twist = self._ball.pose.pose, self._ball.twist.twist
        pose.position.x, pose.position.y, pose.position.z = position
        twist.linear.x, twist.linear.y, twist.linear.z = velocity
        twist.angular.x, twist.angular.y, twist.angular.z = spin

    def flush(self) -> None:
        """Wait a moment until everybody has what was sent: a recorder may lag behind."""
        self._joints_publisher.wait_for_all_acked(Duration(seconds=1))
