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

"""The agent on the running graph: simulator (unpaced) and controller are the real ones."""

import signal

import pytest
from ppo_agent_node.last_episode import LAST_EPISODE_NAME, LastEpisode
from ppo_agent_node.node import VOID_IN_A_ROW
from shared_control.run_folder import RunFolder
from shared_control_learning.episode_table import BROKEN_OFF, read_rows
from shared_control_learning.policy_file import POLICY_NAME, load_policy, read_description
from shared_control_ros import contract
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

EPISODE_TIMEOUT = 90.0


@pytest.fixture
def output(tmp_path):
    return tmp_path / 'learner'


@pytest.fixture
def graph(start_node):
    """The simulator as a node that can be killed."""
    start_node('torque_ctrl_node', enabled=True)
    return start_node('panda_sim_node', paced=False)


@pytest.fixture
def phases(observer):
    """The phases that the agent has published, as strings."""
    messages = observer.listen(contract.PHASE)
    return lambda: [m.data for m in messages]


@pytest.fixture
def finish(observer):
    """``finish()``: call learner/finish, known before it is needed, in an episode that is short; the answer."""
    client = observer.node.create_client(Trigger, contract.FINISH_SERVICE)

    def call():
        future = client.call_async(Trigger.Request())
        observer.spin(future.done, what='the learner answers')
        return future.result().message
    return call


def exit_code(observer, node, timeout=EPISODE_TIMEOUT):
    observer.spin(lambda: node.process.poll() is not None, timeout, f'the agent ends:\n{node.log()}')
    return node.process.returncode


def test_teaches_tests_and_keeps_everything(graph, start_node, observer, phases, output):
    listened = {t.name: observer.listen(t) for t in (
        contract.AGENT_WRENCH, contract.EPISODE, contract.EPISODE_RETURN, contract.SUCCESS, contract.TIME_LEFT)}
    agent = start_node('ppo_agent_node', episodes=1, episode_seconds=4.0, test_episodes=1, output=output,
                       seed=5)
    assert exit_code(observer, agent) == 0, agent.log()
    observer.spin_for(0.3)
    assert phases() == ['wait', 'teach', 'learn', 'test', 'done']
    assert [m.data for m in listened[contract.EPISODE.name]] == [1, 1]
    assert len(listened[contract.EPISODE_RETURN.name]) == 2
    assert 0.0 <= listened[contract.SUCCESS.name][0].data <= 1.0
    left = [m.data for m in listened[contract.TIME_LEFT.name]]
    assert left[:2] == pytest.approx([4.0, 3.9]) and max(left) == 10.0, 'each episode begins with its length'
    wrenches = listened[contract.AGENT_WRENCH.name]
    assert {m.header.frame_id for m in wrenches} == {contract.BASE_FRAME}
    assert all(m.header.stamp.nanosec % 10_000_000 == 0 for m in wrenches)
    assert wrenches[-1].wrench.torque.y == 0.0
    taught, tested = read_rows(output / 'episodes.csv')
    assert (taught['phase'], taught['steps'], tested['phase'], tested['steps']) == ('teach', '200', 'test', '500')
    learner = load_policy(output / 'policy.safetensors')
    assert (learner.episode, learner.seed, learner.name) == (1, 5, 'guided')
    assert float(taught['return']) == pytest.approx(listened[contract.EPISODE_RETURN.name][0].data, rel=1e-4)


def test_says_what_to_do_when_episodes_are_void_again_and_again(graph, start_node, observer, output):
    left = observer.listen(contract.TIME_LEFT)
    agent = start_node('ppo_agent_node', output=output, episode_seconds=5.0)
    simulator = graph
    for _ in range(VOID_IN_A_ROW):
        assert 'in a row were void' not in agent.log()
        left.clear()
        observer.spin(lambda: left and left[-1].data < 4.5, 60.0, 'an episode is under way')
        simulator.process.kill()
        simulator.process.wait()
        simulator = start_node('panda_sim_node')
    agent.wait_for_log(f'{VOID_IN_A_ROW} episodes in a row were void', 60.0)
    assert 'end other programs' in agent.log() and 'shared-control doctor' in agent.log()


def test_nothing_is_taught_while_the_controller_applies_nothing(start_node, observer, output):
    """A robot's time goes on all the same."""
    phases = observer.listen(contract.PHASE)
    start_node('panda_sim_node', mode='free_running')
    controller = start_node('torque_ctrl_node', prediction_horizon=0.004)
    agent = start_node('ppo_agent_node', output=output, episodes=1, episode_seconds=2.0)
    agent.wait_for_log('the episode is void: nothing on /target_wrench for 1.0 s', EPISODE_TIMEOUT)
    assert 'the controller is disabled or stopped, /controller/enable to go on' in agent.log()
    agent.wait_for_log('waiting for the controller: nothing comes on /target_wrench')
    observer.spin_for(3.0)
    assert agent.log().count('is void') == 1, 'nobody is kept busy with what nobody applies'
    assert observer.call(SetBool, contract.ENABLE_SERVICE, SetBool.Request(data=True)).success, controller.log()
    assert exit_code(observer, agent) == 0, agent.log()
    assert [m.data for m in phases] == ['wait', 'teach', 'wait', 'teach', 'learn', 'done']
    assert [row['phase'] for row in read_rows(output / 'episodes.csv')] == [BROKEN_OFF, 'teach']


def test_survives_the_simulator_and_itself(graph, start_node, observer, phases, finish, output):
    """Learner/finish, simulator killed in mid-episode, a pause by a person, agent killed, resumed, told to leave."""
    left, reports = observer.listen(contract.TIME_LEFT), observer.listen(contract.DIAGNOSTICS)
    agent = start_node('ppo_agent_node', output=output, episode_seconds=5.0)
    observer.spin(lambda: left and left[-1].data < 4.5, 120.0, 'an episode is under way')
    assert finish() == 'the teaching ends with this episode'
    graph.process.kill()
    graph.process.wait()
    start_node('panda_sim_node')
    agent.wait_for_log('the episode is void', 120.0)
    left.clear()
    observer.spin(lambda: left and left[-1].data < 4.5, 120.0, 'the next one is under way')
    observer.call(SetBool, contract.PAUSE_SERVICE, SetBool.Request(data=True))
    observer.spin_for(1.5)
    observer.call(SetBool, contract.PAUSE_SERVICE, SetBool.Request(data=False))
    assert exit_code(observer, agent) == 0, agent.log()
    assert phases() == ['wait', 'teach', 'wait', 'teach', 'learn', 'done'], 'its last episode was not void'
    assert agent.log().count('the episode is void') == 1
    assert any(r.status[0].name == '/ppo_agent_node' for r in reports)
    assert read_description(output / 'policy.safetensors')['episode'] == 1
    void, taught = read_rows(output / 'episodes.csv')
    assert (void['episode'], void['phase'], taught['phase']) == ('1', BROKEN_OFF, 'teach')
    assert 'the simulator was started anew' in void['reason'] and not taught['reason']
    assert 0.5 <= float(void['seconds']) < 5.0 == float(taught['seconds'])

    left.clear()
    killed = start_node('ppo_agent_node', output=output, episode_seconds=5.0)
    killed.wait_for_log('going on after episode 1', 120.0)
    observer.spin(lambda: left and left[-1].data < 3.9, 120.0)
    finish()
    killed.stop(signal.SIGKILL)

    wrenches = observer.listen(contract.AGENT_WRENCH)
    left.clear()
    resumed = start_node('ppo_agent_node', output=output, episode_seconds=5.0, resume=True)
    observer.spin(lambda: left and left[-1].data < 4.5, 120.0)
    assert resumed.stop(signal.SIGTERM) == 0
    observer.spin(lambda: wrenches[-1].wrench.torque.y == 0.0, what='a last moment of zero')
    assert 'stopped; 1 episodes are learned and kept' in resumed.log()
    assert 'going on after episode 1' in killed.log() and 'the teaching' not in killed.log(), 'all was done before'
    assert 'the teaching ends with episode 2, as somebody has asked; to go on with it, remove' in resumed.log()
    rows = read_rows(output / 'episodes.csv')
    assert [(r['episode'], r['phase']) for r in rows] == [
        ('1', BROKEN_OFF), ('1', 'teach'), ('2', BROKEN_OFF), ('2', BROKEN_OFF)]
    assert [r['reason'] for r in rows[2:]] == ['the learner was killed', 'the session was stopped']
    assert [float(r['seconds']) >= at_least for r, at_least in zip(rows[2:], (1.0, 0.5), strict=True)] == [True, True]


def test_an_episode_that_is_discarded_in_the_break_is_unlearned_and_taught_again(graph, start_node, observer, output):
    heard = {topic.name: observer.listen(topic) for topic in (contract.VERDICT, contract.EPISODE)}

    def verdicts():
        return [(message.key, message.value) for message in heard[contract.VERDICT.name]]
    say = observer.publisher(contract.HUMAN_VERDICT)

    def rows():
        taught = [row for row in read_rows(output / 'episodes.csv') if row['phase'] == 'teach']  # one may be void
        return [(row['episode'], row['verdict']) for row in taught]
    # A preset that learns at once: the break, in which that counts, is not to be over before.
    parameters = {'episodes': 1, 'episode_seconds': 2.0, 'output': output, 'break_seconds': 5.0,
                  'preset': 'identified_lqr'}
    agent = start_node('ppo_agent_node', **parameters)
    observer.spin(lambda: verdicts() == [('teach 1', '')], EPISODE_TIMEOUT, 'the first episode ends')
    for word in ('failure', 'discard'):
        say.publish(String(data=word))
    observer.spin(lambda: len(verdicts()) == 4, EPISODE_TIMEOUT, 'it ends again')
    assert 'episode 1 is discarded: it is unlearned' in agent.log()
    say.publish(String(data='discard'))
    observer.spin(lambda: rows() == [('1', 'discard')] * 2, what='it is discarded again')
    agent.stop(signal.SIGKILL)
    LastEpisode(output / LAST_EPISODE_NAME, {'episodes': 1, 'max_minutes': 45.0}).set(1)
    agent = start_node('ppo_agent_node', **parameters)
    observer.spin(lambda: len(verdicts()) == 6, EPISODE_TIMEOUT, 'it ends after the kill, which has not kept it')
    say.publish(String(data='success'))
    policy = output / 'policy.safetensors'
    good = [('1', 'discard'), ('1', 'discard'), ('1', 'success')]
    observer.spin(lambda: policy.exists() and rows() == good, what='it is learned and judged')
    assert load_policy(policy).episode == 1
    say.publish(String(data='discard'))
    assert exit_code(observer, agent) == 0, agent.log()
    assert 'episode 1 is discarded: it is unlearned' in agent.log() and 'taught again' not in agent.log()
    assert verdicts() == [('teach 1', word) for word in (
        '', 'failure', 'discard', '', 'discard', '', 'success', 'discard')]
    assert {message.data for message in heard[contract.EPISODE.name]} == {1}
    assert rows() == [('1', 'discard')] * 3 and not policy.exists()
    assert not (output / LAST_EPISODE_NAME).exists(), 'all is done'


@pytest.mark.parametrize(('parameters', 'words'), [
    ({'mode': 'test', 'test_episodes': 1, 'policy': '/nowhere/policy.safetensors'}, 'no policy file at /nowhere'),
    ({'mode': 'test', 'test_episodes': 1, 'policy': '/etc/hostname'}, '/etc/hostname is no policy'),
    ({'mode': 'test'}, "'test_episodes' must be at least 1"),
    ({'resume': True}, "'resume' is true, but"),
    ({'output': '/proc/nowhere'}, '/proc'),
    ({'preset': 'magic'}, "has no choice 'magic'"),
])
def test_unusable_parameters_are_one_clear_line(start_node, parameters, words):
    node = start_node('ppo_agent_node', **parameters)
    assert node.process.wait(60) == 2
    lines = [line for line in node.log().splitlines() if line.startswith('error: ')]
    assert len(lines) == 1
    assert words in lines[0]
    assert 'Traceback' not in node.log()


def test_what_is_not_done_is_said(graph, start_node, observer, output):
    """Teach when the time is used up; keep anything of a test."""
    for _ in range(2):
        agent = start_node('ppo_agent_node', output=output, max_minutes=0.1, episode_seconds=7.0)
        assert exit_code(observer, agent) == 0, agent.log()
        assert 'the teaching is over: its 0.1 minutes are used up' in agent.log()
    assert 'episode 2' not in agent.log()
    tested = start_node('ppo_agent_node', mode='test', policy=output / POLICY_NAME, output=output, test_episodes=1)
    tested.wait_for_log("parameter 'output' counts nothing in mode 'test'")


def test_the_folder_of_another_learner_is_refused(start_node, output):
    """One in another domain, whose role keeps nobody here from anything."""
    output.mkdir()
    other = RunFolder(output, 'run', own=(), mark='run.json', keys=())
    other.claim()
    node = start_node('ppo_agent_node', output=output, episodes=1)
    assert node.process.wait(60) == 2, node.log()
    assert f'error: the learner folder {output} is in use by another learner' in node.log()
    assert [path.name for path in output.iterdir()] == ['.lock'], 'nothing was written'
    other.release()


def test_a_preset_that_cannot_learn_the_task_is_said(start_node, observer):
    agent = start_node('ppo_agent_node', preset='lqr', task='plate')
    assert exit_code(observer, agent) == 2, 'no use to start it again'
    assert "error: parameter 'preset' is 'lqr', which cannot learn the task 'plate'" in agent.log()
