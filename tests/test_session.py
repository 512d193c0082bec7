"""Whole sessions on the live graph."""

import json
import os
import signal
from collections import defaultdict

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from shared_control.learning.episode_table import read_rows
from shared_control.learning.policy_file import read_description
from shared_control.report.bag_report import write_bag_report
from shared_control.session.bag import read_bag
from shared_control_ros import contract

NODES = ('panda_sim_node', 'torque_ctrl_node', 'teleop_key_node', 'sim_tutor_node', 'session_recorder_node',
         'ppo_agent_node')


def episodes_taught(folder):
    return sum(row['phase'] == 'teach' for row in read_rows(folder / 'learner' / 'episodes.csv'))


def check_bag_with_rosbags(bag):
    """Every topic of the contract, and no tick missing, read by a library that knows nothing of ours."""
    stamps = []
    with AnyReader([bag]) as reader:
        types = {connection.topic: connection.msgtype for connection in reader.connections}
        for topic in contract.TOPICS:
            name = '/' + topic.name.lstrip('/')
            package, kind = types[name].split('/msg/')
            assert topic.msg_type.__module__.startswith(package) and topic.msg_type.__name__ == kind
        wanted = [c for c in reader.connections if c.topic == '/joint_states']
        for connection, _, raw in reader.messages(wanted):
            stamp = reader.deserialize(raw, connection.msgtype).header.stamp
            stamps.append(stamp.sec * 1000 + stamp.nanosec // 1_000_000)
    steps = np.diff(stamps)
    assert set(steps) <= {0, 1}, 'a step of 0 is a tick that was published again'


def count_with_mcap(bag):
    """Messages of each topic, read by another library still."""
    counts = defaultdict(int)
    for file in sorted(bag.glob('*.mcap')):
        with file.open('rb') as stream:
            for _, channel, _ in make_reader(stream).iter_messages():
                counts[channel.topic] += 1
    return counts


def test_a_session_is_interrupted_resumed_and_reported(start_session, unpaced, tmp_path, wait_until, summary_of):
    folder = tmp_path / 'session'
    session = start_session('--tutor', 'sim', '--episodes', 2, '--test-episodes', 2, '--params-file', unpaced,
                            '--output', folder)
    wait_until(lambda: episodes_taught(folder) == 1, 'the first episode')
    session.process.send_signal(signal.SIGINT)
    said = session.output()
    assert session.process.returncode == 130
    assert f'--resume {folder}' in said and 'Traceback' not in said
    assert summary_of(folder)['episodes_taught'] == 1

    session = start_session('--resume', folder)
    said = session.output()
    assert session.process.returncode == 0, said
    assert 'simulated' in said and 'robot alone' in said
    assert episodes_taught(folder) == 2
    assert [row['episode'] for row in read_rows(folder / 'learner' / 'episodes.csv')][:2] == ['1', '2']
    assert read_description(folder / 'learner' / 'policy.safetensors')['episode'] == 2
    for name in ('learner/policy.json', 'parameters.yaml', 'settings.json', 'test.json', 'report.html', 'picture.png'):
        assert (folder / name).stat().st_size > 0
    summary = summary_of(folder)
    assert summary['simulated_tutor'] is True and summary['key_presses'] > 0
    assert summary['autonomous_episodes'] == 2 and summary['control_rate_hz'] > 0
    files = sorted((folder / 'bag').glob('*.mcap'))
    assert len(files) == 2, 'one for each run'

    again = json.loads((write_bag_report(folder / 'bag', tmp_path / 'again').parent / 'summary.json').read_text())
    assert {name for name in summary if again[name] != summary[name]} == {'picture', 'report'}, 'from the bag alone'

    counts = count_with_mcap(folder / 'bag')
    assert counts['/joint_states'] > 40_000 and counts['/human/keys'] > 0
    second = tmp_path / 'second'
    second.mkdir()
    (second / 'bag_1.mcap').symlink_to(files[1])
    check_bag_with_rosbags(second / 'bag_1.mcap')  # alone: between the runs time went on
    assert (folder / 'bag' / 'metadata.yaml').is_file()
    assert [finding for finding in summary['bag_checks'] if 'M_y' in finding] == []


def test_any_node_may_be_killed_in_mid_episode(start_session, unpaced, tmp_path, wait_until, summary_of):
    folder = tmp_path / 'session'
    session = start_session('--tutor', 'sim', '--episodes', 3, '--test-episodes', 0, '--params-file', unpaced,
                            '--output', folder)
    wait_until(lambda: episodes_taught(folder) == 1, 'the first episode')
    log = folder / 'log' / 'session.log'
    for name in NODES:
        os.kill(session.node(name), signal.SIGKILL)
        wait_until(lambda name=name: f'{name} died (signal 9)' in log.read_text(), f'the restart of {name}')
    said = session.output(timeout=240)
    assert session.process.returncode == 0, said
    assert episodes_taught(folder) == 3
    assert read_description(folder / 'learner' / 'policy.safetensors')['episode'] == 3
    assert summary_of(folder)['restarts'] == len(NODES)
    bag = read_bag(folder / 'bag')
    assert len(bag.joint_states.stamp_ns) > 30_000


def test_a_person_teaches_from_a_terminal(start_session, unpaced, tmp_path, summary_of):
    """Real keys in a real pty, M_yh on the topic, the tray tilts and the ball rolls, and the person says when."""
    folder = tmp_path / 'session'
    session = start_session('--tutor', 'keyboard', '--test-episodes', 1, '--params-file', unpaced,
                            '--output', folder, terminal=True)
    session.expect('TEACH')
    session.expect('time left')
    session.type(b'\x1b[D')
    session.expect('+5.0')
    session.type(b'a')
    session.expect('+10.0')
    session.expect('left side down')
    session.type(b'q')
    session.expect('TEST')
    session.process.wait(120)
    assert session.process.returncode == 0, session.shown[-3000:]

    bag = read_bag(folder / 'bag')
    assert {press.source for press in bag.presses} == {'terminal'}
    held = bag.human.m_y == 10.0
    assert held.sum() > 10
    begin, end = bag.human.stamp_ns[held][[0, -1]]
    during = (bag.ball.stamp_ns >= begin) & (bag.ball.stamp_ns <= end)
    x = bag.ball.position[during, 0]
    assert x[-1] > x[0] or x[-1] > -0.32, 'the ball rolls to +x, the left of the picture, or lies at its end'
    assert summary_of(folder)['simulated_tutor'] is False


@pytest.mark.parametrize(('arguments', 'said'), [
    (['--tutor', 'keyboard'], 'there is no terminal to press keys in'),
    (['--tutor', 'sim', '--params-file', 'nowhere.yaml'], 'nowhere.yaml'),
    (['--resume', 'nowhere'], 'there is no session folder'),
    (['--preset', 'magic'], "invalid choice: 'magic'"),
])
def test_wrong_options_are_named(start_session, tmp_path, arguments, said):
    session = start_session('--output', tmp_path / 'session', *arguments)
    output = session.output()
    assert session.process.returncode == 2
    assert said in output and 'Traceback' not in output


def test_a_folder_that_cannot_be_written_is_named(start_session, tmp_path):
    (tmp_path / 'file').write_text('')
    session = start_session('--tutor', 'sim', '--output', tmp_path / 'file' / 'session')
    output = session.output()
    assert session.process.returncode == 2
    assert 'cannot write the session folder' in output and 'Traceback' not in output


def test_a_corrupt_policy_ends_the_session_and_stays_as_it_is(start_session, unpaced, tmp_path, wait_until):
    folder = tmp_path / 'session'
    session = start_session('--tutor', 'sim', '--episodes', 1, '--params-file', unpaced, '--output', folder)
    wait_until((folder / 'settings.json').exists, 'the settings')
    session.process.send_signal(signal.SIGINT)
    session.output()
    policy = folder / 'learner' / 'policy.safetensors'
    policy.write_bytes(b'not a policy')
    session = start_session('--resume', folder)
    output = session.output()
    assert session.process.returncode == 1, output
    assert 'policy.safetensors' in output and 'Traceback' not in output
    assert policy.read_bytes() == b'not a policy'
