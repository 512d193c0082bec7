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

"""The population of simulated tutors: individuals drawn of families, on one axis and on two."""

from dataclasses import asdict, dataclass, fields, replace
from typing import ClassVar

import numpy as np
import pytest
from shared_control.env import SharedControlEnv
from shared_control.keys import HUMAN_MOMENT_LIMIT, KEYSTROKE, Key, KeyMap, KeyMoment
from shared_control.rates import POLICY_PERIOD
from shared_control.tasks.balance import BALANCE, Balance
from shared_control.teaching.families import FAMILIES, Use
from shared_control.teaching.individual import Individual
from shared_control.teaching.picture import Picture
from shared_control.teaching.tutors import make_tutor, tutor_named
from shared_control_sim.local_plant import LocalPlant

DRAWN = [name for name in FAMILIES if isinstance(tutor_named(name), Individual)]
ADVERSARIES = ['contrary', 'opposed']
HELPING = [name for name in FAMILIES if FAMILIES[name].use is not Use.CONTROL and name not in ADVERSARIES]


@dataclass(frozen=True)
class TwoMoments(Balance):
    """The tray of `balance`, tilted about both axes."""

    axes: ClassVar[tuple[int, ...]] = (3, 4)
    keys: ClassVar[KeyMap] = {Key.UP: (0, 1.0), Key.DOWN: (0, -1.0), Key.LEFT: (1, 1.0), Key.RIGHT: (1, -1.0)}

    @property
    def scale(self):
        return np.full(2, self.action_scale)

    @property
    def limit(self):
        return np.full(2, self.moment_limit)


def at_the_keys(who, seed=1):
    return make_tutor(who, BALANCE, seed)


def presses(tutor, errors_at, task=BALANCE, seconds=6.0):
    """(time, key) of what a tutor presses while the ball goes its own way."""
    keys, pressed = KeyMoment(task.keys), []
    for step in range(round(seconds / POLICY_PERIOD)):
        now = step * POLICY_PERIOD
        error = np.array(errors_at(now), float)
        key = tutor.key(now, Picture(error, np.zeros_like(error), np.zeros_like(error)), keys.moment)
        if key is not None:
            keys.press(key)
            pressed.append((now, key))
    return pressed


def careful(name, **changes):
    """An individual without lapses, wrong keys and errors of perception."""
    return replace(tutor_named(name, 1), lapses=0.0, wrong_keys=0.0, position_noise=0.0, velocity_noise=0.0,
                   delay_spread=0.01, learns_within=0, fatigue=0.0, habit='hold', hands_over=False, **changes)


@pytest.mark.parametrize('name', FAMILIES)
def test_a_seed_draws_one_individual_of_a_family(name):
    drawn = [tutor_named(name, seed) for seed in range(40)]
    assert drawn[0] == tutor_named(name, 0)
    assert len({str(asdict(who)) for who in drawn}) == 40
    runs = [presses(at_the_keys(drawn[0], seed), lambda t: [0.1 * np.sin(2 * t)]) for seed in (1, 1, 2)]
    assert runs[0] == runs[1]


def test_individuals_of_a_family_differ_in_everything_but_their_law():
    drawn = [tutor_named('reactive', seed) for seed in range(60)]
    same = {f.name for f in fields(Individual) if len({getattr(who, f.name) for who in drawn}) == 1}
    assert same == {'family', 'law'}
    assert {who.habit for who in drawn} == {'hold', 'tap', 'forget'}
    assert {who.hands_over for who in drawn} == {True, False}


@pytest.mark.parametrize('name', DRAWN)
def test_nobody_presses_faster_than_a_hand(name):
    who = tutor_named(name, 5)
    times = [t for t, _ in presses(at_the_keys(who, 5), lambda t: [0.15 * np.sin(3 * t)], seconds=20.0)]
    assert len(times) > 5
    assert np.diff(times).min() >= 1.0 / who.key_rate - 1e-6


@pytest.mark.parametrize('name', [name for name in HELPING if name in DRAWN])
def test_who_watches_presses_towards_the_goal_after_a_delay(name):
    for error, key in ((0.12, Key.LEFT), (-0.12, Key.RIGHT)):
        who = careful(name, dead_band=0.01)
        time, pressed = presses(at_the_keys(who, 1), lambda t, e=error: [e if t >= 1.0 else 0.0])[0]
        assert pressed is key
        assert time >= 1.0 + 0.9 * who.delay


@pytest.mark.parametrize('name', ADVERSARIES)
def test_an_adversary_presses_the_other_way(name):
    assert presses(at_the_keys(careful(name, dead_band=0.01), 1), lambda t: [0.12])[0][1] is Key.RIGHT


def test_who_is_blind_does_the_same_whatever_there_is_to_see():
    assert len({tuple(presses(at_the_keys(careful('blind')), lambda t, e=error: [e])) for error in (0.0, 0.1)}) == 1


def test_wrong_keys_lapses_and_taps_show():
    def keys(**changes):
        return [key for _, key in presses(at_the_keys(replace(careful('reactive'), **changes), 3), lambda t: [0.12],
                                          seconds=30.0)]

    assert Key.RIGHT not in keys(habit='tap') and Key.RIGHT in keys(habit='tap', wrong_keys=0.5)
    assert keys(habit='tap').count(Key.SPACE) > 10 > len(keys())
    assert not keys(lapses=60_000.0, lapse_seconds=1000.0)


def test_who_hands_over_leaves_more_to_a_robot_that_does_well():
    def small_slips(t):
        return [0.025 if t % 6.0 > 3.0 and t > 12.0 else 0.0]

    who = careful('reactive', dead_band=0.02, stiffness=0.9)
    helps, leaves = (len(presses(at_the_keys(replace(who, hands_over=hands_over), 1), small_slips, seconds=30.0))
                     for hands_over in (False, True))
    assert helps > 0 and leaves == 0


def test_two_axes_have_four_keys():
    who = careful('reactive', dead_band=0.01)
    for errors, key in (((0.12, 0.0), Key.UP), ((-0.12, 0.0), Key.DOWN), ((0.0, 0.12), Key.LEFT),
                        ((0.02, -0.12), Key.RIGHT)):
        assert presses(make_tutor(who, TwoMoments(), 1), lambda t, e=errors: e, TwoMoments())[0][1] is key


def test_a_positive_moment_rolls_the_ball_forward_about_either_axis():
    task = TwoMoments()
    tutor, plant = make_tutor(careful('reactive'), task), LocalPlant(task)
    for axis in range(2):
        start = tutor.look(plant.reset(3))
        moment = np.zeros(2)
        moment[axis] = 6.0
        for _ in range(12):
            state = plant.advance(moment)
        after = tutor.look(state)
        assert after.tilt[axis] > start.tilt[axis] + 0.01
        assert after.velocity[axis] > 0.02
    plant.close()


def test_a_family_teaches_in_an_environment():
    env = SharedControlEnv(LocalPlant(person=at_the_keys(tutor_named('crossover', 2), 2)))
    env.reset(seed=2)
    held = np.array([env.step(np.zeros(1))[-1]['human'][0] for _ in range(300)])
    env.close()
    assert set(held) <= {-10.0, -5.0, 0.0, 5.0, 10.0} and held.any()


def test_an_unknown_name_is_refused_with_all_names():
    with pytest.raises(ValueError, match=r'wizard.*expert.*crossover'):
        tutor_named('wizard')


def test_a_stick_holds_what_is_wanted_as_late_as_the_keys_and_no_more_than_they():
    who = careful('reactive', dead_band=0.01, stiffness=0.3, lead=0.0)
    tutor = make_tutor(who, BALANCE, 1, hand='stick')
    plant = LocalPlant(BALANCE, tutor)
    tutor.reset(1)
    state = plant.reset(3)
    moments = np.array([tutor.moment(state) for _ in range(100)])[:, 0]
    plant.close()
    first = int(np.flatnonzero(moments)[0]) * POLICY_PERIOD
    assert who.delay * 0.9 <= first <= who.delay * 1.1 + 2 * POLICY_PERIOD
    assert (np.diff(np.abs(moments)) >= 0.0).all(), 'the hand goes there and stays'
    assert 0.0 < abs(moments[-1]) < HUMAN_MOMENT_LIMIT and abs(moments[-1]) % KEYSTROKE > 0.01, 'any moment'
    assert np.sign(moments[-1]) == np.sign(tutor.look(state).position_error[0])
    with pytest.raises(ValueError, match='know keys alone'):
        make_tutor(tutor_named('expert'), BALANCE, hand='stick')
