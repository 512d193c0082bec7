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

"""Tasks by their ids in Gymnasium."""

import subprocess
import sys

import gymnasium
import numpy as np
import pytest
import shared_control  # noqa: F401 - it registers the ids
from gymnasium.utils.env_checker import check_env
from shared_control.gymnasium_ids import gymnasium_id

BALANCE_ID = 'shared_control/Balance-v0'


@pytest.mark.filterwarnings('ignore:.*render modes.*')
@pytest.mark.parametrize('arguments', [{}, {'tutor': 'low', 'physics': 'mujoco', 'episode_seconds': 3.0}])
def test_gymnasium_accepts_it(arguments):
    env = gymnasium.make(BALANCE_ID, **arguments)
    check_env(env.unwrapped)
    env.close()


def test_arguments_reach_the_task_and_the_tutor():
    env = gymnasium.make(BALANCE_ID, tutor='expert', episode_seconds=2.0, action_scale=4.0, moment_limit=6.0)
    env.reset(seed=3)
    steps, human = 0, 0.0
    truncated = False
    while not truncated:
        *_, truncated, info = env.step(np.ones(1, np.float32))
        human = max(human, abs(info['human'][0]))
        steps += 1
        assert info['agent'][0] == 4.0 and abs(info['applied'][0]) <= 6.0
    assert steps == 100 and human > 0.0
    env.close()


@pytest.mark.parametrize(('arguments', 'said'), [
    ({'tutor': 'nobody'}, "no simulated tutor 'nobody'"), ({'physics': 'flat'}, "no world 'flat'"),
    ({'action_scale': -1.0}, 'action_scale is -1.0'), ({'gravity': 1.0}, "argument 'gravity'")])
def test_wrong_arguments_are_named(arguments, said):
    with pytest.raises((ValueError, TypeError), match=said):
        gymnasium.make(BALANCE_ID, **arguments)


@pytest.mark.parametrize('imports', ['shared_control, gymnasium', 'gymnasium, shared_control'])
def test_it_is_registered_in_either_order_and_loads_no_simulator(imports):
    code = (f'import {imports}, sys; print({BALANCE_ID!r} in gymnasium.registry, '
            "bool({'pybullet', 'mujoco'} & set(sys.modules)))")
    assert subprocess.check_output([sys.executable, '-c', code], text=True).split() == ['True', 'False']


def test_ids_of_other_names():
    assert gymnasium_id('two_axis') == 'shared_control/TwoAxis-v0'
