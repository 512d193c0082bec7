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

"""Reading a session's bag into arrays."""

import shlex
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection
from rosbags.rosbag2.reader import DirectoryReader, Reader
from rosbags.rosbag2.storage_mcap import McapReader
from rosbags.typesys import Stores, get_typestore
from shared_control import contract
from shared_control.contract import Topic
from shared_control.keys import PressesBySource, has_let_go
from shared_control.printable import ECHO_MAX, cut, escaped
from shared_control.robot.spec import RobotSpec
from shared_control.robot.spec_file import panda
from shared_control.sticks import StickMoment
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task
from shared_control.verdict import Verdict

from .chunks import Block, OutOfOrder, check_sizes, read_blocks
from .fast_decode import BulkTopic, Columns, Row, command_layout, joint_state_layout, odometry_layout, wrench_layout
from .files import BagReadError, bag_files, check_is_bag
from .metadata import is_finished, unlisted_files
from .recorded import BallTrack, Commands, JointStates, Judgement, Press, Series, Status, Ticks, Wrenches
from .task import recorded_task, reported_task
from .ticks import JointStateRows, digests, to_ns
from .unpack import check_message

_WRENCHES = (
    contract.HUMAN_WRENCH, contract.AGENT_WRENCH, contract.APPLIED_WRENCH, contract.HUMAN_APPLIED,
    contract.AGENT_APPLIED)
_AFTER_STAMP = 12
"""Where the rest of a message begins that begins with a stamp, bytes."""
_SMALLEST_WRENCH = 64
_SMALLEST_ODOMETRY = 12 + 8 * (7 + 36 + 6 + 36)


@dataclass(frozen=True, eq=False)
class Bag:
    """A session's bag."""

    path: Path
    task: Task
    """What was learned."""
    start_ns: int
    """When the first message was received."""
    end_ns: int
    """When the last message was received."""
    counts: dict[str, int]
    """Messages by topic; a topic that was recorded and stayed silent has 0. Without the graph's namespace."""
    unusable: dict[str, int]
    """Messages that could not be used, by topic."""
    ticks: Ticks
    joint_states: JointStates
    commands: Commands
    human: Wrenches
    """What the person asked for."""
    agent: Wrenches
    """What the agent asked for."""
    applied: Wrenches
    """The sum, as the controller applied it."""
    human_applied: Wrenches
    """What counted of the person's moment."""
    agent_applied: Wrenches
    """What counted of the agent's moment."""
    ball: BallTrack
    training: dict[Topic, Series]
    """By topic: those of ``contract.TRAINING``."""
    presses: list[Press]
    devices: list[str]
    """What was used on ``/human/keys``, in the order of first use: ``keys (terminal)``, ``stick (joy)``."""
    judgements: list[Judgement]
    statuses: dict[str, list[Status]]
    """Reports on /diagnostics, by the name of the node."""


def read_bag(path: Path, task: Task | None = None, robot: RobotSpec | None = None, *, every_tick: bool = False) -> Bag:
    """Read a bag of ``robot`` (the Panda when not given): a rosbag2 folder or a single MCAP file.

    Args:
        task: along whose axes moments are taken from wrenches; when not given the one that the session kept, or
            that its nodes reported, or ``balance``.
        every_tick: keep the joint states of every tick, 0.7 GB an hour, and not those of every 10 ms alone.

    Raises:
        BagReadError: there is none, or it was not finished, or it is damaged.
    """
    path = Path(path)
    with _opened(path) as reader:
        namespace = recorded_namespace(path, [connection.topic for connection in reader.connections])
        task = task or _task(path, reader)
        collector = partial(_Collector, reader, namespace, task, panda() if robot is None else robot, every_tick)
        with suppress(OutOfOrder):
            return _by_chunks(collector()).finish(path)
        return _by_messages(collector()).finish(path)  # rare, and a third of the speed


def read_task(path: Path) -> Task:
    """What was learned in a bag, as :func:`read_bag` has it when it is not told, without reading the bag.

    Raises:
        BagReadError: there is none, or it was not finished, or it is damaged.
    """
    with _opened(path) as reader:
        return _task(path, reader)


def _task(path: Path, reader: AnyReader) -> Task:
    return recorded_task(path) or reported_task(reader) or BALANCE


@contextmanager
def _opened(path: Path) -> Iterator[AnyReader]:
    """Open a bag, and turn whatever goes wrong with it into a :class:`BagReadError`."""
    try:
        _check_finished(path)
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
            _check_sizes(reader)
            yield reader
    except BagReadError:
        raise
    except Exception as error:  # a damaged file makes rosbags and the decompressor raise errors of many kinds
        raise BagReadError(f'cannot read the bag {path}: {escaped(str(error)) or type(error).__name__}') from error


def _check_finished(path: Path) -> None:
    check_is_bag(path)
    files, folder = (bag_files(path), path) if path.is_dir() else ([path], path.parent)
    what = ''
    if torn := [file.name for file in files if not is_finished(file)]:
        what = f'{", ".join(torn)} has no index'
    elif path.is_dir() and not (path / 'metadata.yaml').is_file():
        what = 'it has no metadata.yaml'
    elif path.is_dir() and (unlisted := [file.name for file in unlisted_files(path)]):
        what = f'its metadata.yaml does not name {", ".join(unlisted)}'
    if what:
        raise BagReadError(f'the recording of the bag {path} was not finished: {what}; '
                           f'`shared-control recover {shlex.quote(str(folder))}` finishes it')


def _check_sizes(reader: AnyReader) -> None:
    """Refuse what would take all memory, before rosbags unpacks whatever is there.

    Raises:
        ReaderError: a chunk would; the message names file and place.
        UnpackError: a message that is compressed by itself would.
    """
    for file in _storages(reader):
        if isinstance(file, McapReader):
            check_sizes(file)
        if _is_packed_by_message(reader):
            for _, _, raw in file.messages(file.connections):
                check_message(raw)


def recorded_namespace(bag: Path, topics: Iterable[str]) -> str:
    """The namespace of the robot whose topics a bag has, as in ``/robot1``; empty when it has none.

    Raises:
        BagReadError: it has several robots.
    """
    ending = contract.JOINT_STATES.full_name
    found = sorted({topic.removesuffix(ending) for topic in topics if topic.endswith(ending)})
    if '' in found or not found:
        return ''
    if len(found) > 1:
        robots = escaped(cut(', '.join(found), ECHO_MAX))
        raise BagReadError(f'the bag {bag} has the topics of several robots ({robots}): make a bag of each '
                           'with `ros2 bag convert`')
    return found[0]


def _by_chunks(collector: '_Collector') -> '_Collector':
    """Add what the bag's files hold, whole chunks at a time.

    Raises:
        OutOfOrder: its messages must be added one by one.
    """
    if _is_packed_by_message(collector.reader):
        raise OutOfOrder
    for file in _storages(collector.reader):
        if not isinstance(file, McapReader) or (file.metadata.message_count and not file.chunks):
            raise OutOfOrder
        collector.add_file(file)
    return collector


def _storage(reader: AnyReader) -> Any:
    opened, = reader.readers
    assert isinstance(opened, Reader)
    return opened.storage


def _storages(reader: AnyReader) -> list[Any]:
    """What reads the files of an open bag, one each."""
    storage = _storage(reader)
    return storage.storages if isinstance(storage, DirectoryReader) else [storage]


def _is_packed_by_message(reader: AnyReader) -> bool:
    return _storage(reader).metadata.compression_mode == 'message'


def _by_messages(collector: '_Collector') -> '_Collector':
    """Add what the bag holds, a message at a time."""
    for connection, received_ns, raw in collector.reader.messages():
        collector.add(connection, received_ns, raw)
    return collector


class _Collector:
    """Sorts the messages of a bag by topic, decoding them."""

    def __init__(self, reader: AnyReader, namespace: str, task: Task, robot: RobotSpec,
                 every_tick: bool):
        self.reader, self._namespace, self._task, self._robot = reader, namespace, task, robot
        self._counts = Counter({self._relative(connection.topic): 0 for connection in reader.connections})
        self._unusable: Counter[str] = Counter()
        self._joint_rows = JointStateRows(every_tick)
        self._commands = Columns()
        self._wrench_rows = {topic.full_name: Columns() for topic in _WRENCHES}
        self._bulk = {
            contract.JOINT_STATES.full_name: BulkTopic(
                self._joint_state, joint_state_layout(robot.dof), 24 + 24 * robot.dof, self._joint_rows.add),
            contract.EFFORT_COMMANDS.full_name: BulkTopic(
                self._command, command_layout(robot.dof), 4 + 8 * robot.dof,
                lambda times, row: self._commands.add(times, (digests(row[0]),))),
            contract.BALL.full_name: BulkTopic(
                self._odometry, odometry_layout, _SMALLEST_ODOMETRY,
                lambda times, row: self._ball.add(times, (to_ns(row[0]), *row[1:]))),
            **{name: BulkTopic(self._wrench, wrench_layout, _SMALLEST_WRENCH, partial(self._add_wrenches, rows))
               for name, rows in self._wrench_rows.items()}}
        self._ball = Columns()
        self._rows: dict[str, list[tuple[int, Any]]] = {topic.full_name: [] for topic in contract.TRAINING}
        # They raise ValueError for what cannot be used.
        self._one_by_one: dict[str, Callable[[int, Any], None]] = {
            **{topic: partial(self._add_value, topic) for topic in self._rows},
            contract.KEYS.full_name: self._add_keys, contract.VERDICT.full_name: self._add_judgement,
            contract.DIAGNOSTICS.full_name: self._add_statuses}
        self._keys = PressesBySource()
        self._keys_before: bytes | None = None
        """What followed the stamp of the last usable message of keys."""
        self._presses: list[Press] = []
        self._stick = StickMoment()
        self._devices: dict[str, None] = {}
        self._judgements: list[Judgement] = []
        self._statuses: dict[str, list[Status]] = {}
        self._times: list[int] = []
        self._set_back_ns = 0

    def _relative(self, topic: str) -> str:
        """The name of a topic in a graph without a namespace."""
        return topic.removeprefix(self._namespace) if topic.startswith(self._namespace + '/') else topic

    def add(self, connection: Connection, received_ns: int, raw: bytes) -> None:
        """One message."""
        topic = self._relative(connection.topic)
        received_ns = self._running_on(received_ns)
        self._counts[topic] += 1
        self._times = [self._times[0] if self._times else received_ns, received_ns]
        if topic in self._bulk:
            self._bulk[topic].add(received_ns, raw)
        elif topic in self._one_by_one:
            self._add_one(topic, connection.msgtype, received_ns, raw)

    def add_file(self, storage: McapReader) -> None:
        """All messages of a file, which come after those of the files before.

        Raises:
            OutOfOrder: they must be added one by one.
        """
        for index, blocks in enumerate(blocks for blocks in read_blocks(storage) if blocks):
            if index == 0:
                self._running_on(min(int(block.received_ns[0]) for block in blocks))
            for block in blocks:
                self._add_block(block)

    def _add_block(self, block: Block) -> None:
        topic = self._relative(block.connection.topic)
        times = block.received_ns + self._set_back_ns
        self._counts[topic] += len(times)
        ends = [*self._times, int(times[0]), int(times[-1])]
        self._times = [min(ends), max(ends)]
        if topic in self._bulk:
            self._bulk[topic].add_all(times, block.content, block.starts, block.sizes)
        elif topic in self._one_by_one:
            for received_ns, start, size in zip(times.tolist(), block.starts, block.sizes, strict=True):
                self._add_one(topic, block.connection.msgtype, received_ns, block.content[start:start + size])

    def _add_one(self, topic: str, msgtype: str, received_ns: int, raw: bytes) -> None:
        if topic == contract.KEYS.full_name and raw[_AFTER_STAMP:] == self._keys_before:
            return  # a source repeats what is down many times a second
        message = self._message(raw, msgtype)
        try:
            if message is None:
                raise ValueError
            self._one_by_one[topic](received_ns, message)
        except ValueError:
            self._unusable[topic] += 1
            return
        if topic == contract.KEYS.full_name:
            self._keys_before = raw[_AFTER_STAMP:]

    def _running_on(self, received_ns: int) -> int:
        """The recorder's time, which runs on where its clock was set back between two files of a bag."""
        if self._times and received_ns + self._set_back_ns < self._times[-1]:
            self._set_back_ns = self._times[-1] - received_ns
        return received_ns + self._set_back_ns

    def _message(self, raw: bytes, msgtype: str) -> Any:
        """A message, or None when its bytes are garbled: anybody can have published it, and the others count."""
        try:
            return self.reader.deserialize(raw, msgtype)
        except Exception:  # rosbags raises errors of many kinds
            return None

    def finish(self, path: Path) -> Bag:
        """Everything as arrays."""
        start_ns, end_ns = self._times or (0, 0)
        for topic, bulk in self._bulk.items():
            bulk.finish()
            self._unusable[topic] += bulk.unusable
        no_joints = np.empty((0, self._robot.dof))
        return Bag(
            path=path, task=self._task, start_ns=start_ns, end_ns=end_ns, counts=dict(self._counts),
            ticks=Ticks(*_joined(self._joint_rows.ticks, _no_stamps(), np.empty(0, bool), np.empty(0, np.uint64))),
            joint_states=JointStates(*_joined(self._joint_rows.states, _no_stamps(), no_joints, no_joints, no_joints)),
            commands=Commands(*_joined(self._commands, np.empty(0, np.uint64))),
            human=self._wrenches(contract.HUMAN_WRENCH), agent=self._wrenches(contract.AGENT_WRENCH),
            applied=self._wrenches(contract.APPLIED_WRENCH),
            human_applied=self._wrenches(contract.HUMAN_APPLIED),
            agent_applied=self._wrenches(contract.AGENT_APPLIED),
            ball=BallTrack(*_joined(self._ball, _no_stamps(), np.empty((0, 3)), np.empty((0, 3)))),
            training={topic: self._series(topic) for topic in contract.TRAINING},
            presses=self._presses, devices=list(self._devices),
            judgements=self._judgements, statuses=self._statuses, unusable=dict(+self._unusable))

    def _series(self, topic: Topic) -> Series:
        rows = self._rows[topic.full_name]
        return Series(*(np.array(column) for column in zip(*rows, strict=True))) if rows else Series(
            _no_stamps(), np.empty(0))

    def _wrenches(self, topic: Topic) -> Wrenches:
        return Wrenches(*_joined(self._wrench_rows[topic.full_name], _no_stamps(), np.empty((0, len(self._task.axes)))))

    def _joint_state(self, raw: bytes) -> Row | None:
        message = self._message(raw, contract.JOINT_STATES.type)
        if message is None or tuple(message.name) != self._robot.joints or not all(
                len(values) == self._robot.dof for values in (message.position, message.velocity, message.effort)):
            return None
        stamp = message.header.stamp
        return np.array([stamp.sec, stamp.nanosec]), message.position, message.velocity, message.effort

    def _wrench(self, raw: bytes) -> Row | None:
        message = self._message(raw, contract.APPLIED_WRENCH.type)
        if message is None or message.header.frame_id != self._robot.base_frame:
            return None
        stamp, force, torque = message.header.stamp, message.wrench.force, message.wrench.torque
        return (np.array([stamp.sec, stamp.nanosec]), np.array([force.x, force.y, force.z]),
                np.array([torque.x, torque.y, torque.z]))

    def _command(self, raw: bytes) -> Row | None:
        message = self._message(raw, contract.EFFORT_COMMANDS.type)
        if message is None or len(message.data) != self._robot.dof:
            return None
        label = message.layout.dim[0].label.encode() if message.layout.dim else b''
        return (message.data, np.frombuffer(label, np.uint8)) if label else (message.data,)

    def _add_wrenches(self, rows: Columns, times: np.ndarray, columns: Row) -> None:
        stamp, force, torque = columns
        rows.add(times, (to_ns(stamp), np.hstack((force, torque))[:, self._task.axes]))

    def _odometry(self, raw: bytes) -> Row | None:
        message = self._message(raw, contract.BALL.type)
        if message is None:
            return None
        stamp, position, velocity = message.header.stamp, message.pose.pose.position, message.twist.twist.linear
        return (np.array([stamp.sec, stamp.nanosec]), np.array([position.x, position.y, position.z]),
                np.array([velocity.x, velocity.y, velocity.z]))

    def _add_value(self, topic: str, received_ns: int, message: Any) -> None:
        self._rows[topic].append((received_ns, message.data))

    def _add_keys(self, received_ns: int, message: Any) -> None:
        source = message.header.frame_id
        if has_let_go(message.axes, message.buttons):
            self._keys.forget(source)
            return
        pressed = self._keys.update(source, message.buttons.tolist())
        is_held = any(self._stick.of([axis]).any() for axis in message.axes.tolist())
        self._presses += [Press(received_ns, source, key) for key in pressed]
        for kind, is_used in (('keys', pressed), ('stick', is_held)):
            if is_used:
                self._devices.setdefault(f'{kind} ({source})')

    def _add_judgement(self, received_ns: int, message: Any) -> None:
        self._judgements.append(Judgement(received_ns, message.key, Verdict(message.value)))

    def _add_statuses(self, received_ns: int, message: Any) -> None:
        for status in message.status:
            values = {value.key: value.value for value in status.values}
            self._statuses.setdefault(status.name.removeprefix(self._namespace).lstrip('/'), []).append(
                Status(received_ns, status.level == 0, status.message, values))


def _joined(rows: Columns, *empty: np.ndarray) -> tuple[np.ndarray, ...]:
    """Times and fields of all rows; without any, those of ``empty``."""
    return tuple(rows.finish()) or (_no_stamps(), *empty)


def _no_stamps() -> np.ndarray:
    return np.empty(0, np.int64)
