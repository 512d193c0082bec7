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

"""An episode that a person discards: the learner is as if it had never been, and the table still tells of it."""

from dataclasses import replace

import pytest
import torch
from shared_control.env import SharedControlEnv
from shared_control.teaching.profiles import profile
from shared_control.teaching.tutors import make_tutor
from shared_control.verdict import Verdict
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.episode_table import BROKEN_OFF, EpisodeTable, read_rows
from shared_control_learning.learn import learn
from shared_control_learning.presets import preset
from shared_control_sim.local_plant import LocalPlant

SECONDS = 1.0


class Discard(Callbacks):
    """Discards the first try of an episode."""

    def __init__(self, number=None):
        self.number = number
        self.taught, self.unlearned = [], []

    def learning_started(self, episode):
        self.taught.append(episode.number)

    def episode_learned(self, episode, figures):
        if episode.number == self.number and self.number not in self.unlearned:
            episode.verdict = Verdict.DISCARD

    def episode_unlearned(self, episode):
        self.unlearned.append(episode.number)


def taught(name, callbacks):
    chosen = preset(name)
    learner = replace(chosen, task=replace(chosen.task, episode_seconds=SECONDS)).make(3)
    env = SharedControlEnv(LocalPlant(learner.task, make_tutor(profile('expert'), learner.task, 3)), learner.task)
    learn(learner, env, 3, callbacks)
    env.close()
    return learner


@pytest.mark.parametrize('name', ['coached', 'guided'])
def test_the_learner_goes_on_as_if_it_had_never_been(name):
    discard = Discard(2)
    whole, parts = taught(name, Discard()), taught(name, discard)
    assert discard.taught == [1, 2, 2, 3] and discard.unlearned == [2]
    assert whole.episode == parts.episode == 3
    for key, tensor in whole.tensors().items():
        assert torch.equal(tensor, parts.tensors()[key]), key


def test_the_first_can_be_discarded():
    discard = Discard(1)
    assert taught('coached', discard).episode == 3
    assert discard.taught == [1, 1, 2, 3]


def test_who_discards_it_and_stops_at_once_means_both():
    class Stopped(Discard):
        def episode_learned(self, episode, figures):
            super().episode_learned(episode, figures)
            if episode.verdict:
                raise KeyboardInterrupt

    stopped, learner = Stopped(2), preset('coached').make(3)
    task = replace(learner.task, episode_seconds=SECONDS)
    env = SharedControlEnv(LocalPlant(task, make_tutor(profile('expert'), task, 3)), task)
    with pytest.raises(KeyboardInterrupt):
        learn(learner, env, 3, stopped)
    env.close()
    assert learner.episode == 1 and stopped.unlearned == [2]


def episode(number, verdict=Verdict.NONE):
    made = Episode(preset('coached').task, number, verdict=verdict)
    for name in ('human', 'agent', 'position_error', 'velocity', 'rewards'):
        getattr(made, name).append(torch.zeros(1).numpy() if name in ('human', 'agent') else 0.0)
    return made


def test_the_table_has_verdicts_that_come_late_and_change(tmp_path):
    table = EpisodeTable(tmp_path / 'episodes.csv')
    first, second = episode(1), episode(2)
    for one in (first, second):
        table.append(one)
        for one.verdict in (Verdict.SUCCESS, Verdict.NONE, Verdict.FAILURE):
            table.amend(one)
    first.verdict = Verdict.DISCARD
    table.amend(first)  # no longer the last
    assert [row['verdict'] for row in read_rows(tmp_path / 'episodes.csv')] == ['failure', 'failure']


def test_a_discarded_row_outlives_a_resumption(tmp_path):
    table = EpisodeTable(tmp_path / 'episodes.csv')
    for one in (episode(1), episode(2, Verdict.DISCARD), episode(2)):
        table.append(one)
    table = EpisodeTable(tmp_path / 'episodes.csv', taught=1, live=True)
    rows = read_rows(tmp_path / 'episodes.csv')
    assert [(row['episode'], row['phase'], row['verdict']) for row in rows] == [
        ('1', 'teach', ''), ('2', 'teach', 'discard'), ('2', BROKEN_OFF, '')]
    assert table.taught_seconds == pytest.approx(3 * 0.02)


def test_a_table_of_before_verdicts_is_gone_on_with(tmp_path):
    path = tmp_path / 'episodes.csv'
    row = episode(1).row()
    del row['verdict'], row['reason']
    path.write_text(f'{",".join(row)}\n{",".join(map(str, row.values()))}\n')
    EpisodeTable(path, taught=1).append(episode(2, Verdict.SUCCESS))
    assert [row['verdict'] for row in read_rows(path)] == ['', 'success']
