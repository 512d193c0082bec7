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

"""Testing a policy by several processes at once."""

import multiprocessing
from dataclasses import replace

import pytest
from shared_control.env import SharedControlEnv
from shared_control_learning.evaluation.evaluate import as_tested, passes
from shared_control_learning.evaluation.parallel_test import ParallelTest
from shared_control_learning.policy_file import POLICY_NAME
from shared_control_learning.presets import preset
from shared_control_learning.training import train
from shared_control_sim.local_plant import LocalPlant

SKILLED, UNSKILLED = (preset(name) for name in ('pd', 'autonomous'))
SHORT = replace(UNSKILLED, task=replace(UNSKILLED.task, episode_seconds=2.0))


@pytest.fixture
def env():
    env = SharedControlEnv(LocalPlant(SKILLED.task, physics='mujoco'), as_tested(SKILLED.task))
    yield env
    env.close()


@pytest.fixture
def parallel():
    parallel = ParallelTest(SKILLED.task, 'mujoco', 3)
    yield parallel
    parallel.close()
    assert not multiprocessing.active_children()


def test_a_run_is_the_same_by_one_process_and_by_several(tmp_path):
    alone, together = (
        train(SHORT, None, 1, 2, physics='mujoco', folder=tmp_path / str(processes), processes=processes)
        for processes in (1, 2))
    assert len(alone.tests) == 2 and alone.tests == together.tests
    one, several = ((tmp_path / name / POLICY_NAME).read_bytes() for name in ('1', '2'))
    assert one == several
    assert not multiprocessing.active_children()


def test_the_answer_is_that_of_one_process_even_when_helpers_are_killed(env, parallel):
    for learner, expected in ((UNSKILLED.make(0), False), (SKILLED.make(0), True)):
        assert passes(learner.act, env, 3) is parallel.passes(learner, env, 3) is expected
    for helper in multiprocessing.active_children():
        helper.kill()
    assert parallel.passes(SKILLED.make(0), env, 3) is True
    assert parallel.passes(UNSKILLED.make(0), env, 3) is False
