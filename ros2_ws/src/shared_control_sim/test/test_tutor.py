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

"""The simulated tutor: what it sees, when it presses, that it helps, and that it lets go."""

from dataclasses import replace

import numpy as np
import pytest
from shared_control.env import SharedControlEnv
from shared_control.keys import Key, KeyMoment
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance import BALANCE
from shared_control.teaching.picture import Picture
from shared_control.teaching.profiles import EXPERT, PROFILES, in_episode, profile
from shared_control.teaching.tutor import TILT_OF_MOMENT, SimulatedTutor
from shared_control.teaching.tutors import TUTOR_NAMES, make_tutor, tutor_named
from shared_control_sim.local_plant import LocalPlant

SHARP_EYED = replace(EXPERT, position_noise=0.0, velocity_noise=0.0, pitch_noise=0.0)


def seen(error=0.0, velocity=0.0):
    return Picture(*(np.array([value]) for value in (error, velocity, 0.0)))


OFF_CENTRE, CENTRED = seen(0.15), seen()


def presses(tutor, picture_at, seconds=5.0):
    """(time, key) of what the tutor presses; its keys tilt the tray, but the ball goes its own way."""
    keys, pressed = KeyMoment(), []
    for step in range(round(seconds / POLICY_PERIOD)):
        now = step * POLICY_PERIOD
        picture = picture_at(now)
        picture = replace(picture, tilt=picture.tilt + TILT_OF_MOMENT * keys.moment)
        key = tutor.key(now, picture, keys.moment)
        if key is not None:
            keys.press(key)
            pressed.append((now, key))
    return pressed


def test_unknown_profile_is_refused_with_the_names_of_all():
    with pytest.raises(ValueError, match='expert, high, low, adapting, sham'):
        profile('genius')


@pytest.mark.parametrize('name', PROFILES)
def test_nobody_presses_faster_than_the_profile_says(name):
    tutor = SimulatedTutor(profile(name), seed=1)
    times = [t for t, _ in presses(tutor, lambda t: seen(0.15 * np.sin(4 * t), 0.5 * np.cos(4 * t)), 20.0)]
    assert len(times) > 5
    assert np.diff(times).min() >= 1.0 / profile(name).key_rate - 1e-6


def test_reacts_after_the_reaction_time_and_to_the_right_side():
    tutor = SimulatedTutor(SHARP_EYED, seed=1)
    for picture, key in ((OFF_CENTRE, Key.LEFT), (seen(-0.15), Key.RIGHT)):
        tutor.reset(1)
        time, pressed = presses(tutor, lambda t, p=picture: p if t >= 1.0 else CENTRED)[0]
        assert pressed is key
        assert 1.0 + EXPERT.reaction_time <= time < 1.0 + EXPERT.reaction_time + 2 * POLICY_PERIOD


def test_lets_go_of_a_ball_at_rest_in_the_centre():
    tutor = SimulatedTutor(SHARP_EYED, seed=1)
    pressed = presses(tutor, lambda t: OFF_CENTRE if t < 1.0 else CENTRED, seconds=6.0)
    keys = KeyMoment()
    for _, key in pressed:
        keys.press(key)
    assert float(keys.moment[0]) == 0.0
    assert pressed[-1][0] < 4.5


def test_a_ball_that_rests_beside_the_centre_wears_out_patience():
    beside = seen(0.025)
    pressed, never = (
        presses(SimulatedTutor(replace(SHARP_EYED, patience=patience, generosity=0.0), seed=1), lambda t: beside, 8.0)
        for patience in (EXPERT.patience, 0.0))
    assert [key for _, key in pressed][:1] == [Key.LEFT]
    assert never == []


def test_an_adapting_tutor_becomes_an_expert():
    adapting = profile('adapting')
    assert in_episode(adapting, 1) == replace(profile('low'), adapts_within=adapting.adapts_within)
    assert in_episode(adapting, adapting.adapts_within + 1) == adapting
    assert EXPERT.reaction_time < in_episode(adapting, 3).reaction_time < profile('low').reaction_time


def test_sham_does_not_look():
    pictures = (lambda t: CENTRED), (lambda t: OFF_CENTRE)
    assert len({tuple(presses(SimulatedTutor(profile('sham'), seed=3), picture)) for picture in pictures}) == 1


@pytest.mark.parametrize('seed', range(4))
@pytest.mark.parametrize('name', TUTOR_NAMES)
def test_a_later_episode_is_the_same_in_a_run_that_was_taken_up_again(name, seed):
    def swings(now):
        return seen(0.15 * np.sin(now), 0.15 * np.cos(now))

    without_a_break = make_tutor(tutor_named(name, seed), BALANCE)
    for episode in (1, 2):
        without_a_break.reset(episode)
        presses(without_a_break, lambda t: CENTRED)
    without_a_break.reset(3)
    taken_up = make_tutor(tutor_named(name, seed), BALANCE, episodes=2)
    taken_up.reset(3)
    assert presses(taken_up, swings, 15.0) == presses(without_a_break, swings, 15.0)


def test_a_seed_makes_the_same_tutor():
    def run(seed):
        return presses(SimulatedTutor(profile('low'), seed), lambda t: seen(0.1 * np.sin(2 * t)), 20.0)

    assert run(5) == run(5)
    assert run(5) != run(6)


def episode(robot, tutor, seed):
    """Position errors (m) and M_yh (N m) of an episode."""
    env = SharedControlEnv(LocalPlant(person=tutor))
    observation, _ = env.reset(seed=seed)
    errors, moments = [], []
    for _ in range(400):
        observation, _, _, _, info = env.step(robot(observation))
        errors.append(info['state'].position_error)
        moments.append(info['human'][0])
    env.close()
    return np.array(errors), np.array(moments)


def test_keeps_the_ball_off_the_walls_for_a_robot_that_does_nothing():
    def idle(_):
        return np.zeros(1)

    errors, moments = episode(idle, SimulatedTutor(EXPERT), seed=2)
    assert np.abs(errors[200:]).mean() < 0.5 * np.abs(episode(idle, None, seed=2)[0][200:]).mean()
    assert set(moments) <= {-10.0, -5.0, 0.0, 5.0, 10.0}


def test_helps_a_good_robot_less_than_one_that_does_nothing(good_robot):
    def share(robot):
        return (episode(robot, SimulatedTutor(EXPERT), seed=2)[1] != 0).mean()

    assert share(good_robot) < 0.7 * share(lambda _: np.zeros(1))
