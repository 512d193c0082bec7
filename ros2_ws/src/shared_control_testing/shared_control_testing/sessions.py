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

"""Sessions as the graph would have left them, made up for tests."""

import csv
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from shared_control import contract
from shared_control.contract import Topic, answer_label
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import panda

STORE = get_typestore(Stores.ROS2_JAZZY)
START_NS = 1_795_354_200_000_000_000
MS = 1_000_000
APPLIED = (contract.APPLIED_WRENCH, contract.HUMAN_APPLIED, contract.AGENT_APPLIED)
"""What the controller publishes of the moments that it used: the sum and its parts."""


def message(kind: str, **fields: Any) -> Any:
    """A message by its type's name, as in ``std_msgs/msg/Int32``."""
    return STORE.types[kind](**fields)


def stamp(ns: int) -> Any:
    """A time."""
    return message('builtin_interfaces/msg/Time', sec=ns // 1_000_000_000, nanosec=ns % 1_000_000_000)


def header(ns: int, frame: str = contract.BASE_FRAME) -> Any:
    """A header."""
    return message('std_msgs/msg/Header', stamp=stamp(ns), frame_id=frame)


def vector(x: float, y: float, z: float) -> Any:
    """A vector."""
    return message('geometry_msgs/msg/Vector3', x=float(x), y=float(y), z=float(z))


def wrench(ns: int, m_y: float, frame: str = contract.BASE_FRAME) -> Any:
    """A moment."""
    return message('geometry_msgs/msg/WrenchStamped', header=header(ns, frame), wrench=message(
        'geometry_msgs/msg/Wrench', force=vector(0, 0, 0), torque=vector(0, m_y, 0)))


def joint_state(ns: int, q: np.ndarray, qd: np.ndarray, effort: np.ndarray) -> Any:
    """Joints."""
    return message('sensor_msgs/msg/JointState', header=header(ns), name=list(panda().joints), position=q, velocity=qd,
                   effort=effort)


def command(ns: int, torque: np.ndarray) -> Any:
    """Torques that answer the joint states of a stamp."""
    dimension = message('std_msgs/msg/MultiArrayDimension', label=answer_label(ns), size=len(torque),
                        stride=len(torque))
    return message('std_msgs/msg/Float64MultiArray', data=torque,
                   layout=message('std_msgs/msg/MultiArrayLayout', dim=[dimension], data_offset=0))


def ball(ns: int, x: float) -> Any:
    """A ball on the tray."""
    pose = message('geometry_msgs/msg/Pose', position=message('geometry_msgs/msg/Point', x=float(x), y=0.0, z=0.93),
                   orientation=message('geometry_msgs/msg/Quaternion', x=0.0, y=0.0, z=0.0, w=1.0))
    twist = message('geometry_msgs/msg/Twist', linear=vector(0, 0, 0), angular=vector(0, 0, 0))
    return message(
        'nav_msgs/msg/Odometry', header=header(ns), child_frame_id='ball',
        pose=message('geometry_msgs/msg/PoseWithCovariance', pose=pose, covariance=np.zeros(36)),
        twist=message('geometry_msgs/msg/TwistWithCovariance', twist=twist, covariance=np.zeros(36)))


def keys(ns: int, source: str, buttons: tuple[int, ...], axes: tuple[float, ...] = ()) -> Any:
    """States of keys, and of a stick."""
    return message('sensor_msgs/msg/Joy', header=header(ns, source), axes=np.array(axes, np.float32),
                   buttons=np.array(buttons, np.int32))


def status(ns: int, node: str, **values: Any) -> Any:
    """A report on /diagnostics."""
    pairs = [message('diagnostic_msgs/msg/KeyValue', key=key, value=str(value)) for key, value in values.items()]
    return message('diagnostic_msgs/msg/DiagnosticArray', header=header(ns), status=[message(
        'diagnostic_msgs/msg/DiagnosticStatus', level=0, name=f'/{node}', message='ok', hardware_id='', values=pairs)])


@dataclass
class Lesson:
    """An episode at 50 Hz."""

    position_error: np.ndarray
    """(steps,), m"""
    m_y_human: np.ndarray
    """(steps,), N m"""
    m_y_agent: np.ndarray
    """(steps,), N m"""
    episode_return: float = -100.0
    fallen: bool = False


def lesson(steps: int = 100, seed: int = 0) -> Lesson:
    """A ball that comes to rest, helped by a human at first."""
    random = np.random.default_rng(seed)
    seconds = np.arange(steps) * 0.02
    human = np.where(seconds < 1.0, random.choice([-5.0, 5.0]), 0.0)
    return Lesson(0.15 * np.exp(-seconds) * np.cos(3 * seconds + seed), human, random.normal(0, 3, steps))


@dataclass
class Recording:
    """What a bag holds: (topic, received ns, message or its bytes), changed by tests before it is written."""

    messages: list[tuple[Topic, int, Any]] = field(default_factory=list)

    def add(self, topic: Topic, received_ns: int, content: Any) -> None:
        """One more message."""
        self.messages.append((topic, received_ns, content))

    def drop(self, topic: Topic, first: int, count: int) -> None:
        """Forget some messages of a topic."""
        indices = [i for i, entry in enumerate(self.messages) if entry[0] == topic][first:first + count]
        self.messages = [entry for i, entry in enumerate(self.messages) if i not in set(indices)]

    def of(self, topic: Topic) -> list[Any]:
        """The messages of a topic."""
        return [content for sent_on, _, content in self.messages if sent_on == topic]

    def write(self, path: Path, without: tuple[Topic, ...] = ()) -> Path:
        """Write the bag."""
        with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            connections = {topic: writer.add_connection(topic.full_name, topic.type, typestore=STORE)
                           for topic in contract.BAG_TOPICS if topic not in without}
            for topic, received_ns, content in sorted(self.messages, key=lambda entry: entry[1]):
                if topic not in without:
                    raw = content if isinstance(content, bytes) else STORE.serialize_cdr(content, topic.type)
                    writer.write(connections[topic], received_ns, raw)
        return path


def record(lessons: list[Lesson], start_ns: int = START_NS, delay_ms: int = 2) -> Recording:
    """A session of the paced graph without a fault; the wall clock is the robot's time.

    Args:
        delay_ms: of the agent's and the human's messages; the controller takes them up a millisecond later.
    """
    recording = Recording()
    tray_x = float(RobotModel().tray_pose(panda().home)[0][0])
    effort = np.full(panda().dof, 7.0)
    tick = 0
    agent, human, used = 0.0, 0.0, (0.0, 0.0, 0.0)
    ticks = sum(20 * len(one.position_error) for one in lessons)
    for number, one in enumerate(lessons, start=1):
        at = start_ns + tick * MS
        recording.add(contract.EPISODE, at, message(contract.EPISODE.type, data=number))
        recording.add(contract.PHASE, at, message(contract.PHASE.type, data='teach'))
        for own_tick in range(20 * len(one.position_error)):
            at = start_ns + tick * MS
            step, phase = divmod(own_tick, 20)
            if phase == 0:
                sent = at + delay_ms * MS
                recording.add(contract.AGENT_WRENCH, sent, wrench(at, one.m_y_agent[step]))
                recording.add(contract.HUMAN_WRENCH, sent, wrench(at, one.m_y_human[step]))
            if phase == delay_ms + 1:
                agent, human = one.m_y_agent[step], one.m_y_human[step]
            if tick % 10 == 0:
                recording.add(contract.CLOCK, at, message(contract.CLOCK.type, clock=stamp(at)))
                recording.add(contract.BALL, at + 1000, ball(at, tray_x - one.position_error[step]))
            velocity = np.full(panda().dof, 0.0 if own_tick == 0 else 0.01)
            recording.add(contract.JOINT_STATES, at + 10, joint_state(at, panda().home, velocity, effort))
            effort = np.full(panda().dof, 7.0) + tick * 1e-6
            recording.add(contract.EFFORT_COMMANDS, at + 500_000, command(at, effort))
            before, used = used, (min(max(agent + human, -20.0), 20.0), human, agent)
            if used != before or tick % 10 == 0:
                for topic, moment in zip(APPLIED, used, strict=True):
                    recording.add(topic, at + 600_000, wrench(at, moment))
            if tick % 100 == 0:
                recording.add(contract.KEYS, at, keys(at, 'tutor', (int(tick % 200 == 0), 0, 0)))
            if tick % 1000 == 999 or tick == ticks - 1:
                recording.add(contract.DIAGNOSTICS, at, simulator_status(at, tick + 1))
            tick += 1
        recording.add(contract.EPISODE_RETURN, at + 900_000,
                      message(contract.EPISODE_RETURN.type, data=one.episode_return))
    return recording


def simulator_status(ns: int, ticks: int, node: str = 'panda_sim_node') -> Any:
    """What a simulator reports of itself."""
    return status(ns, node, ticks=ticks, tick_p50_ms='0.61', tick_p99_ms='0.93', late_ticks=ticks // 100,
                  running_seconds=f'{ticks * 1.001e-3:.3f}', simulated_seconds=f'{ticks * 1e-3:.3f}')


def write_episodes(path: Path, lessons: list[Lesson]) -> None:
    """The agent's table."""
    with path.open('w', newline='') as file:
        writer = csv.writer(file)
        writer.writerow(('episode', 'phase', 'steps', 'seconds', 'return', 'R_P', 'fallen', 'human_share'))
        for number, one in enumerate(lessons, start=1):
            both = np.abs(one.m_y_human) + np.abs(one.m_y_agent)
            share = float(np.mean(np.abs(one.m_y_human) / np.maximum(both, 1e-9)))
            steps = len(one.position_error)
            writer.writerow((number, 'teach', steps, steps * 0.02, one.episode_return, -1.0, int(one.fallen), share))


def write_settings(path: Path, tutor: str = 'simulated: expert') -> None:
    """The options."""
    path.write_text(json.dumps({'task': 'balance', 'preset': 'coached', 'tutor': tutor, 'seed': 0}))
