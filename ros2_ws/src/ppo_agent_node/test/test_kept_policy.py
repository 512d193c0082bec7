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

"""The policy file while an episode may still be discarded."""

import pytest
from ppo_agent_node.kept_policy import KeptPolicy
from shared_control_learning.policy_file import load_policy
from shared_control_learning.presets import preset


@pytest.fixture
def learner():
    return preset('coached').make(0)


def test_a_discarded_episode_is_in_the_file_no_more_and_may_come_back(learner, tmp_path):
    path = tmp_path / 'policy.safetensors'
    kept = KeptPolicy(path)
    learner.episode = 1
    kept.learned(learner)
    kept.drop_last()
    assert not path.exists(), 'a learner that has learned nothing is none'
    kept.keep_last()
    assert load_policy(path).episode == 1
    kept.settle()
    learner.episode = 2
    kept.learned(learner)
    for change, episode in ((kept.drop_last, 1), (kept.drop_last, 1), (kept.keep_last, 2)):
        change()
        assert load_policy(path).episode == episode
    kept.settle()
    kept.drop_last()
    assert load_policy(path).episode == 2, 'what is said later is a label alone'
