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

"""Observation, reward and termination."""

import math
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from shared_control.robot.spec_file import panda
from shared_control.scene import Box
from shared_control.tasks.balance import BALANCE, THESIS, BalanceState
from shared_control.tasks.task import BallStarts

STATE = BalanceState(position_error=0.1, velocity=-0.15, pitch=0.05, ball_height=0.93, manipulability=0.07)


def test_default_observation_keeps_sign_and_scale():
    np.testing.assert_allclose(BALANCE.observe(STATE), [1.0, -1.0, 1.0], rtol=1e-6)


def test_thesis_observation_is_squeezed_by_its_own_extremes():
    observation = THESIS.observe(STATE)
    np.testing.assert_allclose(observation, [1.0, 0.0, 0.8], rtol=1e-6)
    still = replace(STATE, position_error=0.0, velocity=0.0, pitch=0.0)
    np.testing.assert_array_equal(THESIS.observe(still), [0, 0, 0])


def test_reward_terms_by_hand():
    """Equations (31)-(37) with the weights of the appendix."""
    terms = BALANCE.reward_terms(STATE)
    error = 0.1 ** 2 / 0.0642
    assert terms == pytest.approx({
        'R_alpha': -0.05 ** 2, 'R_V': -0.333 * 0.15 ** 2, 'R_kw': 0.5 * 0.07 ** 2, 'R_P': -10 * error,
        'R_Pe': math.exp(-20 * error)})
    thesis = THESIS.reward_terms(STATE)
    assert thesis['R_kw'] == pytest.approx(0.5 * (1 - 0.07 ** 2))


def test_margin_counts_beyond_the_largest_error():
    terms = BALANCE.reward_terms(replace(STATE, position_error=0.3, velocity=0.0))
    assert terms['R_V'] == pytest.approx(-0.333 * 5)


def test_a_fallen_ball_ends_it():
    task = BALANCE
    fallen = replace(STATE, ball_height=0.8359)
    assert task.failed(fallen) and not task.failed(STATE)
    assert task.reward_terms(fallen) == {'fall': -5000.0}


def test_starts_follow_their_seed():
    one, two = BallStarts(BALANCE, 3), BallStarts(BALANCE, 4)
    first = [one.next()[0] for _ in range(200)]
    assert first != [two.next()[0] for _ in range(200)]
    two.seed(3)
    assert first == [two.next()[0] for _ in range(200)]
    assert -0.6 <= min(first) < -0.59 and -0.31 < max(first) <= -0.3


def test_the_scene_is_that_of_the_urdf():
    links = ElementTree.parse(panda().urdf).getroot().iter('link')
    tray = next(link for link in links if link.get('name') == panda().tool_frame)
    for kind in ('visual', 'collision'):
        boxes = [(shape.find('origin').get('xyz'), shape.find('geometry/box').get('size')) for shape in tray.iter(kind)]
        assert [Box(*(tuple(map(float, text.split())) for text in box)) for box in boxes] == list(BALANCE.scene.boxes)


@pytest.mark.parametrize(('field', 'value'), [('action_scale', 0.0), ('moment_limit', math.inf),
                                              ('observation_scales', (0.1, 0.0, 0.05))])
def test_settings_that_cannot_be_are_refused_by_name(field, value):
    with pytest.raises(ValueError, match=field):
        replace(BALANCE, **{field: value})
