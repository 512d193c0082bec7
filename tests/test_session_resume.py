"""A whole session on the live graph, interrupted and resumed; its bag read by libraries that know nothing of ours."""

import json
import signal
from collections import defaultdict

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from shared_control import contract
from shared_control_learning.episode_table import BROKEN_OFF, read_rows
from shared_control_learning.policy_file import read_description
from shared_control_records.session.bag_report import write_bag_report


def check_bag_with_rosbags(bag, restarts):
    """Every topic of the contract, and no tick missing, read by a library that knows nothing of ours.

    Args:
        restarts: of nodes that stood still, on a machine where others kept them from running: there ticks are missing.
    """
    stamps = []
    with AnyReader([bag]) as reader:
        types = {connection.topic: connection.msgtype for connection in reader.connections}
        assert types == {topic.full_name: topic.type for topic in contract.BAG_TOPICS}
        wanted = [c for c in reader.connections if c.topic == '/joint_states']
        for connection, _, raw in reader.messages(wanted):
            stamp = reader.deserialize(raw, connection.msgtype).header.stamp
            stamps.append(stamp.sec * 1000 + stamp.nanosec // 1_000_000)
    steps = np.diff(stamps)
    assert restarts or set(steps) <= {0, 1}, 'a step of 0 is a tick that was published again'


def count_with_mcap(bag):
    """Messages of each topic, read by another library still."""
    counts = defaultdict(int)
    for file in sorted(bag.glob('*.mcap')):
        with file.open('rb') as stream:
            for _, channel, _ in make_reader(stream).iter_messages():
                counts[channel.topic] += 1
    return counts


def test_a_session_is_interrupted_resumed_and_reported(start_session, unpaced, tmp_path, wait_until, summary_of,
                                                       episodes_taught):
    folder = tmp_path / 'session'
    session = start_session('--tutor', 'sim', '--episodes', 5, '--test-episodes', 1, '--params-file', unpaced,
                            '--output', folder)
    wait_until(lambda: episodes_taught(folder), 'the first episode')
    session.process.send_signal(signal.SIGINT)
    said = session.output()
    assert session.process.returncode == 130
    assert f'--resume {folder}' in said and 'Traceback' not in said
    taught = summary_of(folder)['episodes_taught']
    assert 1 <= taught < 5

    session = start_session('--resume', folder)
    said = session.output()
    assert session.process.returncode == 0, said
    assert 'simulated' in said and 'robot alone' in said
    assert episodes_taught(folder) == 5
    rows = read_rows(folder / 'learner' / 'episodes.csv')
    assert [row['episode'] for row in rows if row['phase'] == 'teach'] == ['1', '2', '3', '4', '5']
    assert read_description(folder / 'learner' / 'policy.safetensors')['episode'] == 5
    for name in ('learner/policy.json', 'parameters.yaml', 'settings.json', 'test.json', 'report.html', 'picture.png'):
        assert (folder / name).stat().st_size > 0
    summary = summary_of(folder)
    assert summary['episodes_broken_off'] == sum(row['phase'] == BROKEN_OFF for row in rows)
    assert summary['taught_s'] == pytest.approx(sum(float(row['seconds']) for row in rows if row['phase'] != 'test'))
    assert summary['simulated_tutor'] is True and summary['key_presses'] > 0
    assert summary['autonomous_episodes'] == 1 and summary['control_rate_hz'] > 0
    files = sorted((folder / 'bag').glob('*.mcap'))
    assert len(files) == 2, 'one for each run'

    again = json.loads((write_bag_report(folder / 'bag', tmp_path / 'again').parent / 'summary.json').read_text())
    assert again == summary, 'from the bag alone'

    counts = count_with_mcap(folder / 'bag')
    assert counts['/joint_states'] > 4000 and counts['/human/keys'] > 0
    second = tmp_path / 'second'
    second.mkdir()
    (second / 'bag_1.mcap').symlink_to(files[1])
    check_bag_with_rosbags(second / 'bag_1.mcap', summary['restarts'])  # alone: between the runs time went on
    assert (folder / 'bag' / 'metadata.yaml').is_file()
    assert [finding for finding in summary['bag_checks'] if 'M_y' in finding] == []

    policy = folder / 'learner' / 'policy.safetensors'
    policy.write_bytes(b'not a policy')
    session = start_session('--resume', folder, '--episodes', 6)
    said = session.output()
    assert session.process.returncode == 1, said
    assert 'policy.safetensors' in said and 'Traceback' not in said
    assert policy.read_bytes() == b'not a policy', 'a corrupt policy ends the session and stays as it is'
