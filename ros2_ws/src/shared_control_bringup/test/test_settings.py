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

"""What the options of a session say, and what they may say when it goes on."""

import argparse
import json
import math

import pytest
from shared_control_bringup.options import add_options, given_settings
from shared_control_bringup.settings import Settings


def options(*arguments):
    parser = argparse.ArgumentParser()
    add_options(parser)
    return given_settings(parser.parse_args([str(argument) for argument in arguments]))


@pytest.mark.parametrize('given', [
    {'episodes': -1}, {'episodes': 100_001}, {'minutes': 0.0}, {'minutes': -3.0}, {'minutes': math.nan},
    {'minutes': math.inf}, {'test_episodes': -1}, {'seed': -1}, {'seed': 2**31}, {'page': ('127.0.0.1', 65536)},
    {'preset': 'magic'}, {'task': 'juggle'}, {'tutor': 'dog'}, {'profile': 'perfect'}, {'sharing': 'half'}])
def test_values_that_no_session_can_run_with_are_refused_by_name(given):
    with pytest.raises(ValueError, match='--' + next(iter(given)).replace('_', '-')):
        Settings(**given)


def test_only_what_is_given_is_known():
    assert options() == {}
    assert options('--tutor', 'page', '--page', '0.0.0.0:0') == {'tutor': 'page', 'page': ('0.0.0.0', 0)}
    assert options('--no-screen', '--minutes', 3) == {'screen': False, 'minutes': 3.0}


@pytest.mark.parametrize('given', [('--profile', 'low'), ('--page', '127.0.0.1:0')])
def test_an_option_of_another_tutor_is_refused(given):
    with pytest.raises(ValueError, match=f'{given[0]} belongs to --tutor'):
        Settings().with_options(options(*given))


@pytest.mark.parametrize('settings', [
    Settings(), Settings(tutor='sim', profile='low', seed=7), Settings(tutor='page', page=('::1', 0), screen=False),
    Settings(tutor='none', earlier_tutors=('keyboard',), sharing='override')])
def test_settings_are_read_back(settings):
    assert Settings.from_json(json.loads(json.dumps(settings.to_json()))) == settings


@pytest.mark.parametrize(('name', 'value'), [
    ('episodes', 'many'), ('test_episodes', 2.5), ('seed', 1.5), ('seed', True), ('verdicts', 'no'), ('minutes', '45'),
    ('earlier_tutors', 5), ('earlier_tutors', [5]), ('page', ['127.0.0.1']), ('page', 8088), ('task', None),
    ('tutor', 5)])
def test_a_value_of_the_wrong_type_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=f'^{name}'):
        Settings.from_json({name: value})


def test_a_whole_number_may_stand_for_one_with_a_point():
    minutes = Settings.from_json({'minutes': 45}).minutes
    assert (minutes, type(minutes)) == (45.0, float), 'as tools in JavaScript write it'


def test_files_that_are_no_settings_are_refused():
    with pytest.raises(ValueError, match='--preset has no choice'):
        Settings.from_json({'preset': 'magic'})


def test_a_session_goes_on_with_other_options():
    earlier = Settings(tutor='sim', profile='low', episodes=5)
    settings = earlier.resumed_with(options('--episodes', 9, '--minutes', 2, '--test-episodes', 3, '--no-screen'))
    assert settings == Settings(
        tutor='sim', profile='low', episodes=9, minutes=2.0, test_episodes=3, screen=False)
    assert earlier.resumed_with({}) == earlier


def test_who_taught_before_is_not_forgotten():
    settings = Settings(tutor='sim', profile='low').resumed_with(options('--profile', 'expert'))
    settings = settings.resumed_with(options('--tutor', 'keyboard'))
    assert settings.to_json()['earlier_tutors'] == ('simulated: low', 'simulated: expert')


@pytest.mark.parametrize('given', [('--preset', 'thesis'), ('--task', 'plate'), ('--physics', 'mujoco'), ('--seed', 3)])
def test_what_the_learner_was_made_with_cannot_change(given):
    with pytest.raises(ValueError, match=f'{given[0]} cannot change in a session that goes on'):
        Settings().resumed_with(options(*given))


def test_axes_are_divided_where_there_are_two():
    assert Settings(task='plate', sharing='axes').resolved().sharing == 'axes'
    with pytest.raises(ValueError, match='plate'):
        Settings(sharing='axes').resolved()
