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

"""From tracks to figures, tables, files: with tracks whose answers are known."""

import argparse
import json

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from shared_control.command_line import write_json
from shared_control.tasks.balance import BALANCE
from shared_control_learning.episode_table import TABLE_NAME
from shared_control_learning.evaluation.result import ProtocolResult
from shared_control_learning.evaluation.statistics import curve, episode_figures, mean_and_sem, policy_figures
from shared_control_learning.policy_file import POLICY_NAME, PolicyFileError, save_policy
from shared_control_learning.presets import COACHED, preset_for
from shared_control_learning.training import RUN_NAME
from shared_control_records.evaluation.command import add_command
from shared_control_records.evaluation.figures import plots
from shared_control_records.evaluation.policies import load_policies
from shared_control_records.evaluation.tables import as_json, text_table, write_csv
from shared_control_records.evaluation.transfer import transfer_plot, transfer_table

STEPS = 500


def constant(*errors, fallen_after=None, test='randomized'):
    """Episodes with the ball at rest at constant errors, m; the last one may lose it."""
    error = np.repeat(np.array(errors)[:, None], STEPS, axis=1)
    tracks = [error, 0 * error, 0 * error, 0 * error - 2.0, 0 * error + 0.07]
    fallen = np.zeros(len(errors), bool)
    if fallen_after is not None:
        fallen[-1] = True
        for track in tracks:
            track[-1, fallen_after:] = np.nan
    return ProtocolResult(test, np.arange(1, STEPS + 1) * 0.02, *tracks, fallen, np.array([
        BALANCE.succeeded(row, 0 * row, fell) for row, fell in zip(error, fallen, strict=True)]))


def test_figures_of_episodes_end_where_the_ball_fell():
    kept, fallen = episode_figures(constant(-0.01, 0.1, fallen_after=200))
    assert (kept['kept'], kept['success'], fallen['kept'], fallen['success']) == (1, 1, 0, 0)
    assert kept['position_error'] == pytest.approx(0.01) and fallen['position_error_max'] == pytest.approx(0.1)
    assert kept['agent_moment'] == 2.0 and kept['one_minus_k_w_squared'] == pytest.approx(1 - 0.07 ** 2)


def test_sem_is_the_standard_error_of_what_is_known():
    mean, sem = mean_and_sem(np.array([[1.0, 1.0, np.nan], [3.0, np.nan, np.nan], [5.0, 2.0, np.nan]]))
    np.testing.assert_allclose(mean, [3, 1.5, np.nan])
    np.testing.assert_allclose(sem, [np.std([1, 3, 5], ddof=1) / 3 ** 0.5, np.std([1, 2], ddof=1) / 2 ** 0.5, np.nan])


def test_curves_are_over_policies_when_there_are_several():
    one, other = constant(0.01, -0.03), constant(0.05, 0.05)
    mean, sem = curve([one], 'position_error')
    assert mean[0] == pytest.approx(-0.01) and sem[0] == pytest.approx(0.02)
    mean, sem = curve([one, other], 'position_error')
    assert mean[0] == pytest.approx(0.02) and sem[0] == pytest.approx(0.03)
    assert curve([one, other], 'position_error', absolute=True)[0][0] == pytest.approx(0.035)


def test_the_table_counts_and_averages():
    table = text_table({'a': [constant(0.01, 0.01)], 'b': [constant(0.03, 0.03, fallen_after=100)]})
    a, b, mean, sem = (line.split() for line in table.splitlines()[2:])
    assert a[1:4] == ['2/2', '2/2', '10.0'] and b[1:4] == ['1/2', '0/2', '30.0']
    assert mean[1:4] == ['75%', '50%', '20.0'] and sem[4] == '10.0'


def test_files_hold_every_sample_once(tmp_path):
    results = {'a': [constant(0.01, 0.02)], 'b': [constant(0.03, 0.04, fallen_after=100)]}
    write_csv(results, 'randomized', tmp_path)
    episodes = pd.read_csv(tmp_path / 'randomized_episodes.csv')
    assert list(episodes.position_error.round(4)) == [0.01, 0.02, 0.03, 0.04]
    tracks = pd.read_csv(tmp_path / 'randomized_tracks.csv')
    assert len(tracks) == 3 * STEPS + 100
    assert set(tracks[tracks.policy == 'b'].groupby('episode').size()) == {STEPS, 100}
    means = pd.read_csv(tmp_path / 'randomized_mean.csv')
    assert means.position_error_mean.iloc[-1] == pytest.approx(np.mean([0.015, 0.03]))
    write_json({'seed': 3, **as_json(results)}, tmp_path / 'new' / 'r.json')
    content = json.loads((tmp_path / 'new' / 'r.json').read_text())
    test = content['tests']['randomized']
    assert content['seed'] == 3 and test['over_policies']['count'] == 2
    assert test['policies']['b']['mean'] == policy_figures(results['b'][0])


def test_tests_may_be_written_into_the_folder_of_a_run(tmp_path):
    for name in (TABLE_NAME, RUN_NAME, POLICY_NAME):
        (tmp_path / name).write_text("the run's")
    write_csv({'a': [constant(0.01, 0.02)]}, 'randomized', tmp_path)
    assert {(tmp_path / name).read_text() for name in (TABLE_NAME, RUN_NAME, POLICY_NAME)} == {"the run's"}


def test_tests_of_several_protocols_are_side_by_side_in_a_folder(tmp_path):
    protocols = {'randomized': ['randomized'], 'perturbation': ['perturbation'], 'transfer': ['transfer: as taught'],
                 'trajectory': ['trajectory 0.25 Hz', 'trajectory 0.5 Hz']}
    written = {}
    for protocol, tests in protocols.items():
        write_csv({'a': [constant(0.01, test=test) for test in tests]}, protocol, tmp_path)
        found = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
        assert written.items() <= found.items()
        assert set(pd.read_csv(tmp_path / f'{protocol}_episodes.csv').test) == set(tests)
        written = found


@pytest.mark.parametrize(('test', 'numbers'), [('perturbation', ['fig18', 'fig19']), ('trajectory 0.5 Hz', ['fig23'])])
def test_figures_bear_the_numbers_of_the_thesis(test, numbers):
    result = constant(0.01, 0.02, test=test)
    found = list(plots([result] * 5))
    assert [plot.name[:5] for plot in found[:-1]] == numbers
    for plot in found:
        figure = Figure(layout='constrained')
        plot.draw(figure)
        legend = [text.get_text() for text in figure.legends[0].get_texts()]
        assert legend == ['mean over 5 policies', '± standard error'] + (['push'] if test == 'perturbation' else [])
        assert plot.caption.startswith(f'Test {test}: 5 policies, 10 episodes.') and 'standard error' in plot.caption


def test_the_mean_of_two_has_no_band_that_looks_certain():
    plot = next(iter(plots([constant(0.01, 0.02, test='perturbation')] * 2)))
    figure = Figure(layout='constrained')
    plot.draw(figure)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ['mean over 2 policies', 'push']
    assert 'standard error' not in plot.caption


def transferred(*errors):
    """A policy on two arms: as taught with the first errors, and with the second ones."""
    return [constant(*those, test=f'transfer: {name}')
            for those, name in zip(errors, ('as taught', 'odd'), strict=True)]


def test_the_test_on_other_arms_is_a_line_a_change():
    results = {'a': transferred((0.01, 0.01), (0.01, 0.05)), 'b': transferred((0.004, 0.004), (0.07, 0.05))}
    _, _, taught, odd = (line.split() for line in transfer_table(results).splitlines())
    assert taught == ['as', 'taught', '2/2', '100%', '100%', '7.0', '10.0']
    assert odd == ['odd', '0/2', '25%', '0%', '45.0', '60.0']
    assert transfer_table({'a': results['a']}).splitlines()[-1].split() == ['odd', '50%', '30.0']


def test_the_test_on_other_arms_is_drawn_and_written(tmp_path):
    results = {'a': transferred((0.01, 0.01), (0.01, 0.05))}
    figure = Figure(layout='constrained')
    transfer_plot(results).draw(figure)
    bars, dots = figure.axes
    assert [label.get_text() for label in bars.get_yticklabels()] == ['as taught', 'odd']
    assert [bar.get_width() for bar in bars.patches] == [100.0, 50.0]
    assert [line.get_xdata()[0] for line in dots.lines] == pytest.approx([10.0, 30.0])
    write_csv(results, 'transfer', tmp_path)
    assert (tmp_path / 'transfer_as_taught_tracks.csv').exists()


@pytest.fixture
def session(tmp_path):
    """Folders with a policy each: as a session has it, and as a training run has it."""
    for place in ('s/learner', 'run'):
        (tmp_path / place).mkdir(parents=True)
        save_policy(COACHED.make(1), tmp_path / place / 'policy.safetensors')
    return tmp_path


def test_policies_are_found_in_folders_and_named_by_what_differs(session):
    assert list(load_policies([session / 's', session / 'run' / 'policy.safetensors'])) == [
        's', 'run/policy.safetensors']
    assert list(load_policies([session / 'run'])) == ['run']
    for other in ('s/../s', 's/learner', 's/learner/policy.safetensors'):
        with pytest.raises(ValueError, match=rf'{session}/s/learner/policy\.safetensors is given twice'):
            load_policies([session / 's', session / 'run', session / other])
    with pytest.raises(PolicyFileError, match='no policy in'):
        load_policies([session])


def test_policies_of_several_tasks_are_refused_before_one_is_tested(session, monkeypatch):
    (session / 'plate').mkdir()
    save_policy(preset_for('plate').make(1), session / 'plate' / 'policy.safetensors')
    monkeypatch.setattr('shared_control_learning.evaluation.run.run_protocol', None)
    with pytest.raises(ValueError, match=r'\(s: balance, plate: plate\): test those of each task apart'):
        evaluate(session / 's', session / 'plate')


def evaluate(*arguments):
    parser = argparse.ArgumentParser()
    add_command(parser.add_subparsers())
    args = parser.parse_args(['evaluate', *map(str, arguments)])
    return args.run(args)


def test_the_command_tests_a_policy(session, capsys):
    assert evaluate(session / 's', '--test-episodes', 1, '--physics', 'mujoco', '--json', session / 'r.json',
                    '--output', session / 'out') == 0
    assert 'randomized' in capsys.readouterr().out
    assert json.loads((session / 'r.json').read_text())['tests']['randomized']['over_policies']['sem'] is None
    assert (session / 'out' / 'fig16_randomized_position_error.svg').exists()


@pytest.mark.parametrize('seed', [-1, 2**31])
def test_a_seed_that_is_none_is_named_before_a_policy_is_read(tmp_path, seed):
    with pytest.raises(ValueError, match=rf'--seed is {seed}, expected 0 to 2147483647'):
        evaluate(tmp_path / 'nothing', '--seed', seed)


def test_the_command_decides_early(session, capsys):
    assert evaluate(session / 's', '--until-known', '--json', session / 'r.json') == 0
    assert 's: does not pass' in capsys.readouterr().out
    assert json.loads((session / 'r.json').read_text())['passes'] == {'s': False}
    with pytest.raises(ValueError, match='--until-known'):
        evaluate(session / 's', '--until-known', '--protocol', 'perturbation')
