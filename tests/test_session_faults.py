"""Sessions on the live graph whose nodes are killed in mid-episode."""

import os
import signal

from shared_control_learning.policy_file import read_description
from shared_control_records.bag.reader import read_bag

NODES = ('panda_sim_node', 'torque_ctrl_node', 'teleop_key_node', 'sim_tutor_node', 'session_recorder_node',
         'ppo_agent_node')


def test_any_node_may_be_killed_in_mid_episode(start_session, unpaced, tmp_path, wait_until, summary_of,
                                               episodes_taught):
    folder = tmp_path / 'session'
    session = start_session('--tutor', 'sim', '--episodes', 5, '--test-episodes', 0, '--params-file', unpaced,
                            '--output', folder)
    wait_until(lambda: episodes_taught(folder), 'the first episode')
    log = folder / 'log' / 'session.log'
    for name in NODES:
        os.kill(session.node(name), signal.SIGKILL)
        wait_until(lambda name=name: f'{name} died (signal 9)' in log.read_text(), f'the restart of {name}')
    said = session.output()
    assert session.process.returncode == 0, said
    assert episodes_taught(folder) == 5
    assert read_description(folder / 'learner' / 'policy.safetensors')['episode'] == 5
    assert summary_of(folder)['restarts'] >= len(NODES)  # a watchdog adds to them where the disk stands still
    bag = read_bag(folder / 'bag')
    assert len(bag.joint_states.stamp_ns) > 3000
