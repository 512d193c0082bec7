"""Nodes take what ``ros2 run`` hands on: namespaces, remappings, parameter files, use_sim_time."""

import subprocess
import sys
from pathlib import Path

import pytest
from rcl_interfaces.srv import GetParameters
from shared_control.processes import leave_with_the_parent
from shared_control_bringup import parameters
from shared_control_ros import contract
from shared_control_ros.contract import Topic
from shared_control_ros.stamps import to_ns
from std_srvs.srv import SetBool, Trigger

MARBLE = Topic('/robot1/marble', contract.BALL.msg_type, contract.BALL.qos)
HUMAN_WRENCH = Topic('/robot1/human/target_wrench', contract.HUMAN_WRENCH.msg_type, contract.HUMAN_WRENCH.qos)


@pytest.fixture(scope='module')
def params_file(tmp_path_factory):
    """The file of a session with one value changed."""
    path = tmp_path_factory.mktemp('parameters') / 'mine.yaml'
    path.write_text(parameters.DEFAULTS.read_text().replace('seed: 0', 'seed: 41'))
    return path


@pytest.fixture(scope='class')
def graph(observer, params_file):
    """Simulator, controller and keys as ``ros2 run`` starts them, in the namespace /robot1."""
    arguments = ['--ros-args', '-r', '__ns:=/robot1', '--params-file', str(params_file)]
    started = [
        subprocess.Popen([Path(sys.executable).parent / name, *arguments, *more], stdin=subprocess.DEVNULL,
                         start_new_session=True, preexec_fn=leave_with_the_parent)
        for name, more in (('torque_ctrl_node', ['-p', 'enabled:=true']),
                           ('panda_sim_node', ['-r', 'ball:=marble', '-p', 'ball_mass:=0.2']),
                           ('teleop_key_node', ['-p', 'screen:=off']))]
    yield observer
    for process in started:
        process.terminate()
    assert [process.wait(60) for process in started] == [0, 0, 0]


class TestInANamespace:
    def test_the_loop_runs_under_names_that_are_moved(self, graph):
        balls = graph.listen(MARBLE)
        graph.spin(lambda: len(balls) > 20, what=MARBLE.name)
        assert to_ns(balls[-1].header.stamp) > to_ns(balls[0].header.stamp)
        topics = dict(graph.node.get_topic_names_and_types())
        assert '/robot1/joint_states' in topics and '/joint_states' not in topics and '/robot1/ball' not in topics

    def test_services_move_along(self, graph):
        assert graph.call(SetBool, '/robot1/simulator/pause', SetBool.Request(data=True)).message == 'paused'
        assert graph.call(SetBool, '/robot1/simulator/pause', SetBool.Request(data=False)).success
        assert graph.call(Trigger, '/robot1/simulator/reset', Trigger.Request()).success

    @pytest.mark.parametrize(('node', 'name', 'value'), [
        ('panda_sim_node', 'seed', 41),  # file
        ('panda_sim_node', 'ball_mass', 0.2),  # -p
        ('torque_ctrl_node', 'enabled', True),  # -p
        ('teleop_key_node', 'use_sim_time', True),  # file
    ])
    def test_parameters_come_from_file_and_command_line(self, graph, node, name, value):
        response = graph.call(GetParameters, f'/robot1/{node}/get_parameters', GetParameters.Request(names=[name]))
        given = response.values[0]
        assert value in (given.integer_value, given.double_value, given.bool_value)

    def test_clock_stays_where_everybody_looks_for_it(self, graph):
        """With use_sim_time the keys' node stamps by the simulation's clock, which goes on in steps of 10 ms."""
        clocks, wrenches = graph.listen(contract.CLOCK), graph.listen(HUMAN_WRENCH)
        graph.spin(lambda: len(clocks) > 20 and len(wrenches) > 5, what='/clock and wrenches')
        newest = to_ns(clocks[-1].clock)
        for wrench in wrenches:
            assert to_ns(wrench.header.stamp) % 10_000_000 == 0
            assert abs(newest - to_ns(wrench.header.stamp)) < 1_000_000_000


@pytest.mark.parametrize(('arguments', 'said'), [
    (['-p', 'moment_limit:=5.0'], "torque_ctrl_node takes no '-p' 'moment_limit:=5.0': parameters and remappings"),
    (['--ros-args', 'moment_limit:=5.0'], "ROS cannot begin with these arguments: ['moment_limit:=5.0']"),
    (['--ros-args', '-p', 'moment_limit=5.0'], 'moment_limit=5.0'),
    (['--ros-args', '--params-file', 'nowhere.yaml'], 'Error opening YAML file'),
])
def test_arguments_that_mean_nothing_are_refused_in_a_line(domain_id, arguments, said):
    """The controller went on with its defaults, or ended with a traceback."""
    node = subprocess.run([Path(sys.executable).parent / 'torque_ctrl_node', *arguments], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=60)
    assert node.returncode == 2
    line = node.stderr.splitlines()[-1]
    assert line.startswith('error: ') and said in line and 'Traceback' not in node.stderr
