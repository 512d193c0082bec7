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

"""Which episode a verdict is about, and which verdicts are refused."""

import pytest
from ppo_agent_node.training_topics import TrainingTopics
from ppo_agent_node.verdicts import Verdicts
from shared_control.verdict import Verdict
from shared_control_learning.episode import Episode
from shared_control_learning.presets import preset
from shared_control_ros import contract
from std_msgs.msg import String

TASK = preset('coached').task


class Counting(Verdicts):
    """Counts what it has heard."""

    count = 0

    def _judge(self, word):
        self.count += 1
        super()._judge(word)


@pytest.fixture
def judge(observer):
    """``judge(word)``: say it, and wait until it was heard; with what is heard of it."""
    heard = observer.listen(contract.VERDICT)
    said = observer.publisher(contract.HUMAN_VERDICT)
    changed = []
    verdicts = Counting(observer.node, TrainingTopics(observer.node), changed.append)

    def judge(word):
        known = verdicts.count
        said.publish(String(data=word))
        observer.spin(lambda: verdicts.poll() or verdicts.count > known, what='the word to arrive')
    observer.spin(said.get_subscription_count, what='the subscription')
    judge.verdicts, judge.changed = verdicts, changed
    judge.expect = lambda *expected: observer.spin(
        lambda: [(message.key, message.value) for message in heard] == list(expected), what=f'{expected}')
    return judge


def test_the_last_episode_that_has_ended_is_judged(judge):
    judge('success')
    one, two = Episode(TASK, 1), Episode(TASK, 2)
    judge.verdicts.episode_ended(one)
    judge('success')
    judge('failure')
    judge.verdicts.episode_ended(two)
    judge('discard')
    judge('discard')
    judge('splendid')
    assert (one.verdict, two.verdict) == (Verdict.FAILURE, Verdict.NONE)
    judge.verdicts.close()
    judge('success')
    assert two.verdict is Verdict.NONE, 'it is settled'
    assert judge.changed == [one, one, two, two]
    judge.expect(('teach 1', ''), ('teach 1', 'success'), ('teach 1', 'failure'), ('teach 2', ''),
                 ('teach 2', 'discard'), ('teach 2', ''))


def test_episodes_of_a_test_all_count(judge):
    judge.verdicts.episode_ended(tested := Episode(TASK, 3, 'test'))
    judge('discard')
    assert tested.verdict is Verdict.NONE
    judge('failure')
    assert tested.verdict is Verdict.FAILURE
