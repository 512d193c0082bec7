"""Sessions as a person starts them: real keys in a real pty, and what is said when something is wrong."""

import time

import pytest
from shared_control_bringup import parameters
from shared_control_records.bag.reader import read_bag


def test_a_person_teaches_from_a_terminal(start_session, unpaced, tmp_path, summary_of):
    """Real keys in a real pty, M_yh on the topic, the tray tilts and the ball rolls, and the person says when."""
    folder = tmp_path / 'session'
    content = parameters.load(unpaced)
    content['panda_sim_node']['paced'] = True  # all keys are to be pressed within the first episode
    content['ppo_agent_node']['episode_seconds'] = 20.0
    parameters.save(content, unpaced)
    session = start_session('--tutor', 'keyboard', '--test-episodes', 1, '--params-file', unpaced,
                            '--output', folder, terminal=True)
    session.expect('PRACTICE')
    session.type(b'q')
    session.expect('the teaching has not begun')
    session.type(b'\r')
    session.expect('TEACH')
    session.expect('time left')
    session.type(b'\x1b[D')
    session.expect('+5.0')
    session.expect('left side down')
    time.sleep(0.5)  # the moment is held for a while
    session.press_again(b'q', 'Press q again')
    session.press_again(b'q', 'go on teaching')
    session.expect('Writing the report')
    session.process.wait(120)
    assert session.process.returncode == 0, session.shown[-3000:]

    bag = read_bag(folder / 'bag')
    assert {press.source for press in bag.presses} == {'terminal'}
    held = bag.human.moment[:, 0] == 5.0
    assert held.sum() > 10
    counted = bag.human_applied.moment[:, 0] == 5.0
    assert counted.any() and set(bag.human_applied.stamp_ns[counted]) <= set(bag.applied.stamp_ns)
    assert bag.agent_applied.moment.any()
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
