"""What a session says that it waits for."""

import time

import pytest
from shared_control_bringup import parameters
from shared_control_bringup.node_process import NodeProcess
from shared_control_bringup.waits import LONGEST, Seen, Waits, wait_of
from shared_control_ros import contract
from std_msgs.msg import String

LONG = 1000.0


@pytest.mark.parametrize(('seen', 'what'), [
    (Seen(starting=('torque_ctrl_node',), phase='teach'), 'torque_ctrl_node to start'),
    (Seen(phase_age=LONG), 'ppo_agent_node to begin'),
    (Seen(phase='wait', phase_age=LONG, tick_age=LONG), 'an episode to begin'),
    (Seen(phase='teach', tick_age=LONG), 'a tick of the simulation'),
    (Seen(phase='practice', tick_age=LONG), 'a tick of the simulation'),
    (Seen(phase='teach', tick_age=LONG, paused=True), 'a person: it is paused'),
    (Seen(phase='learn', phase_age=LONG, tick_age=LONG), 'the robot to learn from the episode'),
    (Seen(phase='test', episode_age=LONG), 'an episode to come to its end')])
def test_what_takes_too_long_is_named(seen, what):
    assert wait_of(seen).what == what


@pytest.mark.parametrize('seen', [
    Seen(), Seen(phase='teach', phase_age=LONG), Seen(phase='learn', phase_age=LONGEST['learn'] / 2, tick_age=LONG),
    Seen(phase='done', phase_age=LONG, tick_age=LONG, episode_age=LONG), Seen(phase='practice', episode_age=LONG)])
def test_what_goes_on_is_no_wait(seen):
    assert wait_of(seen) is None


def test_a_simulator_without_a_controller_is_said_with_its_newest_warning(domain_id, observer, tmp_path):
    file = tmp_path / 'parameters.yaml'
    parameters.save(parameters.load(), file)
    simulator = NodeProcess('panda_sim_node', file, tmp_path / 'panda_sim_node.log')
    said = []
    published = observer.listen(contract.WAITING)
    waits = Waits([simulator], said.append)
    phase = observer.node.create_publisher(String, contract.PHASE.name, contract.PHASE.qos)
    simulator.start()
    waits.open()
    try:
        phase.publish(String(data='teach'))
        deadline = time.monotonic() + 60.0
        while not any('no torque on' in message.data for message in published):
            assert time.monotonic() < deadline, said
            waits.poll()
            observer.spin_for(0.1)
        what, why = published[-1].data.split('\n')
        assert what.startswith('for a tick of the simulation since ')
        assert why.startswith('panda_sim_node: no torque on /effort_controller/commands')
        assert any(line.startswith('waiting for a tick of the simulation since') for line in said)
        phase.publish(String(data='done'))
        while published[-1].data:
            assert time.monotonic() < deadline, said
            waits.poll()
            observer.spin_for(0.1)
    finally:
        waits.close()
        simulator.interrupt()
        simulator.wait(10.0)


def test_the_newest_warning_of_a_node_is_found_in_its_log(tmp_path):
    node = NodeProcess('torque_ctrl_node', tmp_path / 'none.yaml', tmp_path / 'log')
    assert node.newest_warning() is None
    ticks = 1000 * '[INFO] [8.0] [torque_ctrl_node]: tick\n'
    node.log.write_text(f'[WARN] [7.5] [torque_ctrl_node]: too late\n{ticks}')
    assert node.newest_warning() is None, 'long ago'
    with node.log.open('a') as log:
        log.write('[WARN] [9.5] [torque_ctrl_node]: no wrench\n[ERROR] [10.5] [torque_ctrl_node]: stopped\n'
                  '[INFO] [11.0] [torque_ctrl_node]: ready\n')
    assert node.newest_warning() == (10.5, 'stopped')
