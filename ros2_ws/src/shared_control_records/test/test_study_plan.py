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

"""Plans of studies: what they hold, and what is said of wrong ones."""

import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest
from shared_control.teaching.profiles import profile
from shared_control_records.study.folder import StudyError, StudyFolder
from shared_control_records.study.job import seed_of_tests
from shared_control_records.study.plan import PlanError, draw_tutor, load_plan

EXAMPLES = Path(__file__).parents[4] / 'studies'
PLAN = """
seed: 3
participants:
  simulated: {expert: 1, low: 2}
conditions:
  coached: {episodes: 5}
  alone: {preset: autonomous, taught: false, episodes: 9, evaluate_every: 3}
"""
REAL = """
participants: {real: 4, consent: You may stop at any time.}
conditions: {coached: , thesis: , autonomous: {taught: false}}
"""


@pytest.fixture
def plan_file(tmp_path):
    def write(text):
        path = tmp_path / 'plan.yaml'
        path.write_text(text)
        return path

    return write


def test_every_participant_in_every_condition_from_one_seed(plan_file):
    plan = load_plan(plan_file(PLAN))
    assert [(p.number, p.group) for p in plan.participants] == [(1, 'expert'), (2, 'low'), (3, 'low')]
    assert [job.name for job in plan.jobs] == [
        'alone/p01', 'alone/p02', 'alone/p03', 'coached/p01', 'coached/p02', 'coached/p03']
    assert len({participant.seed for participant in plan.participants}) == 3
    assert load_plan(plan_file(PLAN)) == plan, 'the same file gives the same participants'
    assert load_plan(plan_file(PLAN.replace('seed: 3', 'seed: 4'))).participants != plan.participants


def test_tests_begin_alike_in_all_conditions_and_otherwise_in_a_study_of_another_seed(plan_file):
    plan, other = load_plan(plan_file(PLAN)), load_plan(plan_file(PLAN.replace('seed: 3', 'seed: 100')))
    seeds = [seed_of_tests(plan, job) for job in plan.jobs]
    assert seeds[:3] == seeds[3:] and len(set(seeds)) == 3
    assert not {*seeds} & {seed_of_tests(other, job) for job in other.jobs}


def test_a_condition_may_be_of_another_task(plan_file):
    coached, alone = load_plan(plan_file(PLAN.replace('episodes: 5', 'episodes: 5, task: plate'))).conditions
    assert (coached.task, coached.preset, alone.task) == ('plate', 'coached', '')


def test_conditions_have_a_physics_to_train_and_to_be_tested_in(plan_file):
    plan = load_plan(plan_file(PLAN.replace('episodes: 5', 'physics: mujoco').replace(
        'episodes: 9', 'tested_in: mujoco')))
    assert [(c.physics, c.tested_in) for c in plan.conditions] == [('mujoco', None), ('bullet', 'mujoco')]
    with pytest.raises(PlanError, match=r"conditions\.coached\.physics: no physics 'flat'"):
        load_plan(plan_file(PLAN.replace('episodes: 5', 'physics: flat')))


def test_simulated_participants_teach_what_they_know(plan_file, monkeypatch):
    monkeypatch.setattr('shared_control_records.study.plan_file.can_teach', lambda task: task.name != 'plate')
    one = PLAN.replace('episodes: 5', 'task: plate')
    with pytest.raises(PlanError, match=r'conditions\.coached: simulated tutors do not know .* the task plate'):
        load_plan(plan_file(one))
    load_plan(plan_file(one.replace('task: plate', 'task: plate, taught: false')))
    load_plan(plan_file(REAL.replace('{coached: ,', '{coached: {task: plate},')))


def test_a_plan_is_checked_without_loading_what_learns(plan_file):
    path = plan_file(PLAN.replace('episodes: 5', 'preset: lqr, taught: false'))
    subprocess.run([sys.executable, '-c', 'import sys; from pathlib import Path\n'
                    'from shared_control_records.study.plan import load_plan\n'
                    'load_plan(Path(sys.argv[1])); assert "torch" not in sys.modules', path], check=True)


def test_simulated_participants_differ_around_their_profile():
    drawn = [draw_tutor('high', 0.15, seed) for seed in range(200)]
    for field in fields(drawn[0]):
        base, values = getattr(profile('high'), field.name), [getattr(tutor, field.name) for tutor in drawn]
        if type(base) is float and base:
            assert len(set(values)) == 200
            assert sum(values) / 200 == pytest.approx(base, rel=0.06)
        else:
            assert set(values) == {base}
    assert draw_tutor('low', 0.0, 1) == profile('low')


def test_real_participants_take_the_conditions_in_turning_orders(plan_file):
    plan = load_plan(plan_file(REAL))
    assert plan.people.consent == 'You may stop at any time.' and plan.people.minutes == 45.0
    orders = [[condition.name for condition in plan.order(participant)] for participant in plan.participants]
    assert orders == [['coached', 'thesis'], ['thesis', 'coached']] * 2


@pytest.mark.parametrize(('old', 'new', 'said'), [
    ('seed: 3', 'sed: 3', "no key 'sed'; there are checkpoints, conditions, participants, seed, tests"),
    ('seed: 3', 'seed: -1', 'seed: Input should be greater than or equal to 0, found -1'),
    ('seed: 3', 'seed: 0x' + 'f' * 10_000, 'seed: Input should be less than 2147483648, found a very large number'),
    ('seed: 3', 'seed: ' + '9' * 10_000, 'Exceeds the limit'),
    ('seed: 3', 'seed: 2020-01-01', 'seed: Input should be a valid integer, found datetime.date(2020, 1, 1)'),
    ('expert: 1', 'expert: 0', 'participants.simulated.expert: Input should be greater than or equal to 1, found 0'),
    ('expert: 1', 'expert: 2000000000', 'participants.simulated.expert: Input should be less than or equal to 1000'),
    ('expert: 1', 'wizard: 1', "participants.simulated.wizard: no simulated tutor 'wizard'; there are expert"),
    ('episodes: 5', 'task: juggle', "no task 'juggle'; there are balance, detour, plate"),
    ('coached: {', 'coach: {', "conditions.coach.preset: no learner 'coach'; there are autonomous"),
    ('episodes: 5', 'episodes: five', "conditions.coached.episodes: Input should be a valid integer, found 'five'"),
    ('episodes: 5', 'epochs: 5', "conditions.coached: no key 'epochs'; there are episodes, evaluate_every, physics"),
    ('taught: false', 'taught: maybe', "conditions.alone.taught: Input should be a valid boolean, found 'maybe'"),
    ('conditions:', 'tests: [jump]\nconditions:', "tests.0: Input should be 'randomized', 'perturbation', 'traj"),
    ('conditions:', 'tests: []\ncheckpoints: [2]\nconditions:', 'checkpoints: a run that ends before one counts there'),
    ('taught: false', 'taught: true', 'conditions.alone: the preset autonomous has no tutor: say taught: false'),
    ('alone:', '../alone:', 'a condition is named by letters'),
    ('alone:', '1:', 'conditions.1: Input should be a valid string'),
    ('{expert: 1, low: 2}', '[expert]', 'participants.simulated: Input should be a valid dictionary'),
    ('{expert: 1, low: 2}', '{}', 'participants.simulated: Dictionary should have at least 1 item'),
    (PLAN, 'seed: 3\nparticipants: {simulated: {low: 1}}', 'conditions: is missing'),
    (PLAN, '- 1', 'should be keys with values, found [1]'),
    (PLAN, '', 'should be keys with values, found None'),
    (PLAN, 'a: [', 'plan.yaml'),
    (PLAN, '[' * 100_000, 'plan.yaml'),
    (PLAN, f'a: {"b" * 2**20}', 'more than 1048576 bytes'),
    ('conditions:', 'seed: 4\nseed: 5\nconditions:', "the key 'seed' stands there twice"),
    ('alone:', 'coached:', "the key 'coached' stands there twice"),
    (PLAN, 'a: &a [1]\nb: [*a, *a]', 'line 2: aliases'),
    ('episodes: 5', 'preset: lqr, task: plate', 'conditions.coached: lqr knows the task balance'),
    ('episodes: 5', 'preset: pd, task: detour', 'conditions.coached: pd knows the task balance'),
    ('episodes: 5', 'preset: identified_lqr, task: detour', 'conditions.coached: identified_lqr needs a task that'),
    ('episodes: 5', 'sharing: axes', 'conditions.coached: axes are divided between person and robot only where'),
    (PLAN, REAL.replace('{coached: ,', '{coached: {sharing: axes},'), 'conditions.coached: axes are divided'),
    (PLAN, REAL.replace('consent: You may stop at any time.', "consent: ' '"), 'participants.consent'),
    (PLAN, REAL.replace('You may stop at any time.', r'"\e[2J"'), 'consent: a text that a terminal shows'),
    (PLAN, REAL.replace('consent: You may stop at any time.', 'minutes: .nan'), 'participants.consent: is missing'),
    (PLAN, REAL.replace('real: 4', 'real: 4, spread: 0.1'), "participants: no key 'spread'"),
])
def test_a_wrong_plan_is_named_with_its_key(plan_file, old, new, said):
    path = plan_file(PLAN.replace(old, new))
    with pytest.raises(PlanError) as error:
        load_plan(path)
    assert said in str(error.value) and str(path) in str(error.value)


@pytest.mark.parametrize('text', [
    'seed: ' + 'x' * 100_000, 'x' * 100_000 + ': 1', 'tests: [' + ('[' * 50 + 'x, ' * 1000 + ']' * 50) + ']',
    'conditions: {' + 'x' * 100_000 + ': 3}', 'a: *' + 'x' * 100_000, 'a: !' + 'x' * 100_000 + ' 1',
    r'"\e]0;title\a": 1', r'seed: "\e[2J"'])
def test_what_is_said_of_a_wrong_plan_is_short_and_plain(plan_file, text):
    path = plan_file(text)
    with pytest.raises(PlanError) as error:
        load_plan(path)
    assert len(str(error.value)) < len(str(path)) + 1500 and '\x1b' not in str(error.value)


@pytest.mark.parametrize(('options', 'refused'), [
    ('[--params-file, own.yaml]', None), ('[--params-file=own.yaml, --no-screen]', None),
    ('[--tutor, page, --page, "127.0.0.1:9000"]', None),
    ('[--output, /elsewhere]', "'--output' is none of the options"), ('[--output=/elsewhere]', '--output=/elsewhere'),
    ('[--outp=/elsewhere]', '--outp=/elsewhere'), ('[--o, /elsewhere]', "'--o'"), ('[--overwrite]', '--overwrite'),
    ('[--no-screen, --resume, /elsewhere]', 'participants.session_options.1'), ('[--r=/elsewhere]', '--r=/elsewhere'),
    ('[--, x]', "'--'"), ('[--page, 8088]', 'session_options.1: Input should be a valid string'),
    ('--no-screen', 'session_options: Input should be a valid list'),
])
def test_options_of_sessions_name_no_other_folder(plan_file, options, refused):
    path = plan_file(REAL.replace('real: 4', f'real: 4, session_options: {options}'))
    if refused is None:
        assert load_plan(path).people.session_options[0].startswith('--')
    else:
        with pytest.raises(PlanError, match=re.escape(refused)):
            load_plan(path)


def test_a_missing_participant_is_said(plan_file):
    plan = load_plan(plan_file(REAL))
    with pytest.raises(PlanError, match='no participant 5: this study has the numbers 1 to 4'):
        plan.participant(5)


def test_a_folder_belongs_to_one_plan_and_one_process(plan_file, tmp_path):
    folder = StudyFolder(tmp_path / 'study')
    folder.begin(plan_file(PLAN))
    with pytest.raises(StudyError, match='running already'):
        StudyFolder(tmp_path / 'study').begin(plan_file(PLAN))
    del folder
    with pytest.raises(StudyError, match='begun with another plan'):
        StudyFolder(tmp_path / 'study').begin(plan_file(PLAN.replace('low: 2', 'low: 1')))


@pytest.mark.parametrize('path', sorted(EXAMPLES.glob('*.yaml')), ids=lambda path: path.name)
def test_the_examples_are_good_plans(path):
    assert load_plan(path).jobs


def test_the_examples_hold_the_thesis_study():
    plan = load_plan(EXAMPLES / 'thesis.yaml')
    assert len(plan.participants) == 24
    assert [condition.name for condition in plan.conditions] == ['coached', 'thesis', 'autonomous']
