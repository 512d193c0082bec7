"""What comes from outside is used, or refused by the error that the docstring names: files and messages by chance."""

import json
from contextlib import contextmanager, suppress
from dataclasses import asdict
from itertools import pairwise

import numpy as np
import pytest
import yaml
from geometry_msgs.msg import WrenchStamped
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from shared_control.keys import HUMAN_MOMENT_LIMIT, Key, KeyPresses
from shared_control.robot.spec_file import RobotFileError, load_robot, panda
from shared_control.tasks.balance import BALANCE
from shared_control.teaching.key_device import KeyDevice
from shared_control_bringup import parameters
from shared_control_bringup.settings import Settings
from shared_control_learning.episode_table import EpisodeTable, read_rows
from shared_control_learning.policy_file import PolicyFileError, load_policy, save_policy
from shared_control_learning.presets import preset
from shared_control_learning.training import TrainingError, TrainingRun, read_run
from shared_control_records.bag import BagError, recover
from shared_control_records.bag.reader import BagReadError, read_bag
from shared_control_records.bag.writer import BagWriter
from shared_control_records.session.episodes import read_episodes
from shared_control_records.session.final_test import load_test
from shared_control_records.study.plan import PlanError, load_plan
from shared_control_records.study.progress import Progress, ProgressError
from shared_control_ros import contract
from shared_control_ros.fast_loop import Polled
from shared_control_ros.joints import joint_positions
from shared_control_ros.robot_inputs import TorqueInput
from shared_control_ros.torque_command import torque_command
from shared_control_ros.wrenches import LARGEST, moment_of
from shared_control_testing.sessions import STORE, lesson, record
from teleop_key_node.keyboard import Keyboard
from teleop_key_node.sources import Sources
from torque_ctrl_node.joint_states import JointStateReader
from torque_ctrl_node.stop_record import StopRecord

QUICK = settings(max_examples=150, deadline=None, derandomize=True, database=None,
                 suppress_health_check=[HealthCheck.function_scoped_fixture])
SLOW = settings(QUICK, max_examples=25)

SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20)
JSON = st.recursive(SCALARS, lambda inner: (
    st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=12), inner, max_size=4)), max_leaves=12)
INT32 = st.integers(-2**31, 2**31 - 1)
DEEP = 20_000 * '['


def changed(content, data):
    """A copy of a JSON object in which something has another value, another type, another name, or is gone."""
    content = json.loads(json.dumps(content))
    where = content
    while True:
        assume(where)
        key = data.draw(st.sampled_from(list(where) if isinstance(where, dict) else range(len(where))))
        if isinstance(where[key], dict | list) and where[key] and data.draw(st.booleans()):
            where = where[key]
            continue
        if data.draw(st.integers(0, 4)) == 0:
            del where[key]
        else:
            where[key] = data.draw(JSON)
        return content


@contextmanager
def refused_by(*errors, naming):
    """Nothing is raised, or one of these errors, whose message has ``naming`` in it and no escape sequence."""
    try:
        yield
    except errors as error:
        told = str(error)
    else:
        return
    assert str(naming) in told
    assert '\x1b' not in told


def garbled(whole: bytes, data) -> bytes:
    """The bytes cut short, or with some of them changed."""
    raw = bytearray(whole)
    for _ in range(data.draw(st.integers(0, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    return bytes(raw[:data.draw(st.integers(0, len(raw)))] if data.draw(st.booleans()) else raw)


@QUICK
@given(st.lists(st.lists(INT32, max_size=8), max_size=8))
def test_buttons(states):
    presses = KeyPresses()
    for buttons in states:
        try:
            pressed = presses.update(buttons)
        except ValueError:
            assert len(buttons) < 3 or not set(buttons[:len(Key)]) <= {0, 1}
        else:
            assert all(buttons[key] == 1 for key in pressed)


@QUICK
@given(st.lists(st.tuples(st.sampled_from('ab'), st.lists(st.floats(width=32), max_size=4),
                          st.lists(st.integers(-1, 2), max_size=6), st.integers(0, 2**62), st.floats(0.0, 1e6))))
def test_what_any_source_of_keys_sends_is_a_moment_within_the_limit(states):
    sources = Sources(KeyDevice(BALANCE), timeout=0.5)
    for source, axes, buttons, now_ns, now in states:
        with suppress(ValueError):
            sources.hear(source, axes, buttons, now_ns, now)
        sources.drop_silent(now_ns, now)
        assert np.abs(sources.moment).max() <= HUMAN_MOMENT_LIMIT


@QUICK
@given(st.binary(max_size=60), st.lists(st.integers(0, 60), max_size=4))
def test_bytes_of_a_terminal_mean_the_same_in_any_pieces(typed, cuts):
    places = [0, *sorted(min(cut, len(typed)) for cut in cuts), len(typed)]
    keyboard = Keyboard()
    in_pieces = [stroke for first, end in pairwise(places) for stroke in keyboard.strokes(typed[first:end])]
    assert in_pieces == Keyboard().strokes(typed)


@QUICK
@given(st.text(max_size=15), st.floats(), st.floats())
def test_wrenches(frame, m_x, m_y):
    wrench = WrenchStamped()
    wrench.header.frame_id = frame.replace('\0', '').encode('utf-8', 'ignore').decode()
    wrench.wrench.torque.x, wrench.wrench.torque.y = m_x, m_y
    try:
        moment = moment_of(wrench, frame='' if not frame else 'panda_link0')
    except ValueError:
        assert frame or not abs(m_y) <= LARGEST
    else:
        assert np.isfinite(moment).all()


@QUICK
@given(st.data())
def test_joint_states(data):
    spec = panda()
    whole = serialize_message(JointState(
        name=list(spec.joints), position=spec.home.tolist(), velocity=[0.0] * spec.dof, effort=[0.0] * spec.dof))
    reader = JointStateReader(spec)
    reader.read(whole)
    try:
        values = reader.read(garbled(whole, data))
    except ValueError:
        return
    assert all(value.shape == (spec.dof,) and np.isfinite(value).all() for value in values)


@QUICK
@given(st.data())
def test_positions_of_joints(data):
    spec = panda()
    names = data.draw(st.lists(st.sampled_from([*spec.joints, '', 'x']), max_size=12))
    message = JointState(name=names, position=data.draw(st.lists(st.floats(), max_size=12)))
    with suppress(ValueError):
        assert np.isfinite(joint_positions(message, spec)).all()


@QUICK
@given(st.data())
def test_torques(torques, data):
    """What is no command of finite torques, or answers another tick, is none."""
    whole = serialize_message(torque_command([1.0, -2.0, 3.0, 0.0, 0.5, 0.25, 0.125], 10**18))
    assert torques().read(whole, 10**18) is not None and torques().read(whole, 10**18 + 1) is None
    torque = torques().read(garbled(whole, data), 10**18)
    assert torque is None or (torque.shape == (7,) and np.isfinite(torque).all())


@QUICK
@given(st.data())
def test_what_the_wire_brings_is_taken_or_dropped(wire, data):
    """Garbled bytes on a topic are no error of the node that takes messages from it."""
    publisher, polled = wire()
    publisher.publish(garbled(serialize_message(WrenchStamped()), data))
    publisher.publish(WrenchStamped())
    polled.wait_ready(0.1)
    while (message := polled.take()) is not None:
        assert isinstance(message, WrenchStamped)


@pytest.fixture(scope='class')
def torques(observer):
    torques = TorqueInput(observer.node, 7, 0.1)
    return lambda: torques


@pytest.fixture(scope='class')
def wire(observer):
    topic = contract.AGENT_WRENCH
    polled, publisher = Polled(observer.node, topic, depth=10), observer.publisher(topic)
    observer.spin(publisher.get_subscription_count)
    return lambda: (publisher, polled)


@pytest.fixture(scope='module')
def scratch(tmp_path_factory):
    return tmp_path_factory.mktemp('hostile')


PLAN = {'title': 'A study', 'seed': 1, 'conditions': {'a': {'preset': 'coached'}, 'b': {'preset': 'autonomous'}},
        'simulated': {'participants': 2, 'tutors': ['expert']}, 'episodes': 3}


@QUICK
@given(st.data())
def test_plans(scratch, data):
    path = scratch / 'plan.yaml'
    text = yaml.safe_dump(changed(PLAN, data)) if data.draw(st.booleans()) else data.draw(st.text(max_size=80))
    path.write_text(text.encode('utf-8', 'replace').decode())
    with refused_by(PlanError, naming=path):
        assert load_plan(path).jobs


@QUICK
@given(st.data())
def test_parameter_files(scratch, data):
    path = scratch / 'parameters.yaml'
    content = {'panda_sim_node': {'ros__parameters': {'paced': False}},
               '/**': {'ros__parameters': {'use_sim_time': True}}}
    text = yaml.safe_dump(changed(content, data)) if data.draw(st.booleans()) else data.draw(st.text(max_size=80))
    path.write_text(text.encode('utf-8', 'replace').decode())
    with refused_by(ValueError, naming=path):
        assert parameters.load(path)


@QUICK
@given(st.data())
def test_robot_files(scratch, data):
    path = scratch / 'robot.yaml'
    path.write_bytes(garbled(yaml.safe_dump({'urdf': 'x.urdf', 'joints': ['a'], 'base_frame': 'b'}).encode(), data))
    with pytest.raises(RobotFileError):
        load_robot(str(path))


@SLOW
@given(st.data())
def test_settings_of_a_session(data):
    try:
        found = Settings.from_json(changed(Settings(tutor='sim').to_json(), data))
    except ValueError:
        return
    Settings.from_json(json.loads(json.dumps(found.to_json())))


@QUICK
@given(st.data())
def test_runs(scratch, data):
    whole = asdict(TrainingRun(
        'coached', {'name': 'expert'}, 0, tests=[(1, True)], returns=[1.0], intervention_rates=[0.5]))
    (scratch / 'run.json').write_text(json.dumps(changed(whole, data)))
    with refused_by(TrainingError, naming='run.json'):
        run = read_run(scratch)
        assert run.skilled is None or run.skilled >= 0


TABLE = """episode,phase,steps,seconds,return,fallen,human_share,settled_position_error,learn_seconds
1,teach,200,4.0,-12.5,0,0.5,0.01,0.2
1,broken off,100,2.0,-3.5,0,0.5,0.01,0
2,teach,200,4.0,1.5,1,0.25,0.1,0.2
"""


@QUICK
@given(st.data())
def test_tables_of_episodes(scratch, data):
    path = scratch / 'episodes.csv'
    path.write_bytes(garbled(TABLE.encode(), data))
    (scratch / 'unfinished.csv').write_bytes(garbled(TABLE.encode(), data))
    with refused_by(ValueError, naming=path):
        for row in read_episodes(path):
            assert isinstance(row.number, int)
    with refused_by(ValueError, naming=scratch):
        assert EpisodeTable(path, taught=2, live=True).taught_seconds is not None
        read_rows(path)


FINAL_TEST = {
    'successes': 1, 'position_error_max': 0.03, 'velocity_max': 0.02, 'sample_period': 0.1, 'policy': '', 'episodes': [
        {'success': True, 'kept': True, 'position_error': 0.01, 'velocity': 0.01, 'ball_start': 0.1, 'track': [0.1]}]}


@QUICK
@given(st.data())
def test_results_of_tests(scratch, data):
    path = scratch / 'test.json'
    path.write_text(data.draw(st.sampled_from([DEEP, json.dumps(changed(FINAL_TEST, data))])))
    with refused_by(ValueError, naming=path):
        test = load_test(path)
        assert 0 <= test.successes <= len(test.episodes)


@QUICK
@given(st.data())
def test_progress_of_people(scratch, data):
    whole = {'consented': None, 'practised': True, 'taught': ['a'], 'tlx': {'a': {'mental': 50.0}}}
    (scratch / 'progress.json').write_text(data.draw(st.sampled_from([DEEP, json.dumps(changed(whole, data))])))
    with refused_by(ProgressError, naming='progress.json'):
        Progress.of(scratch)


@QUICK
@given(st.data())
def test_a_record_of_a_stop_that_is_damaged_is_one(tmp_path_factory, data):
    with pytest.MonkeyPatch.context() as patch:
        home = tmp_path_factory.mktemp('home')
        patch.setenv('ROS_HOME', str(home))
        record = StopRecord(42, '/hostile')
        record.keep()
        kept, = home.rglob('*.json')
        kept.write_bytes(garbled(kept.read_bytes(), data) if data.draw(st.booleans()) else DEEP.encode())
        assert isinstance(StopRecord(42, '/hostile').is_on(), bool)
        kept.write_bytes(DEEP.encode())
        assert StopRecord(42, '/hostile').is_on()


@pytest.fixture(scope='module')
def policy(scratch):
    path = scratch / 'whole.safetensors'
    save_policy(preset('coached').make(), path)
    return path.read_bytes()


@QUICK
@given(st.data())
def test_policies(scratch, policy, data):
    path = scratch / 'policy.safetensors'
    how = data.draw(st.integers(0, 3))
    size = int.from_bytes(policy[:8], 'little')
    if how < 2:
        header = json.loads(policy[8:8 + size])
        name, = header['__metadata__']
        header['__metadata__'][name] = DEEP if how else json.dumps(
            changed(json.loads(header['__metadata__'][name]), data))
        text = json.dumps(header).encode()
        path.write_bytes(len(text).to_bytes(8, 'little') + text + policy[8 + size:])
    else:
        path.write_bytes(garbled(policy, data))
    with refused_by(PolicyFileError, naming=path):
        learner = load_policy(path)
        action = learner.act(np.zeros(learner.task.observation_size, np.float32))
        assert np.isfinite(action).all()
        assert np.abs(action).max() <= 1.0


@pytest.fixture(scope='module')
def bag(scratch):
    """A bag as the recorder writes it: its file, and the bytes of that."""
    folder = scratch / 'bag'
    writer = BagWriter(folder)
    for topic, received_ns, content in sorted(record([lesson(steps=20)]).messages, key=lambda entry: entry[1]):
        channel = writer.add_topic(topic.full_name, topic.type, STORE.generate_msgdef(topic.type)[0], '', '[]')
        writer.write(channel, bytes(STORE.serialize_cdr(content, topic.type)), received_ns, received_ns)
    writer.finish()
    file, = folder.glob('*.mcap')
    content = file.read_bytes()
    return lambda: (file, content)  # a function, since Hypothesis prints the values of fixtures


@QUICK
@given(st.lists(st.tuples(st.integers(-2**63, 2**64), st.integers(-10**9, 10**9), st.integers(0, 2**64)), min_size=1))
def test_times_and_counts_that_garbled_packets_name(scratch, messages):
    writer = BagWriter(scratch / 'times')
    channel = writer.add_topic('/clock', 'rosgraph_msgs/msg/Clock', '', '', '[]')
    for sent, received, sequence in messages:
        writer.write(channel, b'', sent, received, sequence)
    writer.finish()
    with writer.path.open('rb') as file:
        read = sorted(message.publish_time for _, _, message in make_reader(file).iter_messages())
    writer.path.unlink()
    assert read == sorted(sent if 0 <= sent < 2**63 else max(received, 0) for sent, received, _ in messages)


@SLOW
@given(st.data())
def test_bags(bag, data):
    file, whole = bag()
    file.write_bytes(garbled(whole, data))
    for attempt in (read_bag, recover, read_bag):
        with refused_by(BagReadError, BagError, naming=file.parent):
            attempt(file.parent)
