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

"""The table of episodes, taken up again."""

import numpy as np
import pytest
from shared_control.tasks.balance import BALANCE
from shared_control_learning.episode import Episode
from shared_control_learning.episode_table import (
    BROKEN_OFF,
    KILLED,
    UNFINISHED_NAME,
    EpisodeTable,
    keep_unfinished,
    read_rows,
)

TABLE = """episode,phase,seconds,learn_seconds
1,teach,15.0,0.5
2,teach,3.0,0.25
3,teach,15.0,0.5
1,test,10.0,0.0
"""


def test_the_time_of_teaching_goes_on_where_it_was(tmp_path):
    path = tmp_path / 'episodes.csv'
    assert EpisodeTable(path).taught_seconds == 0.0
    path.write_text(TABLE)
    # The third row is of an episode that was not learned from before the run was killed; a test is no teaching.
    assert EpisodeTable(path, taught=2).taught_seconds == pytest.approx(18.75)


@pytest.fixture
def episode():
    """``episode(number, seconds)``"""
    def make(number, seconds):
        made = Episode(BALANCE, number)
        steps = round(seconds / 0.02)
        made.rewards, made.position_error, made.velocity = [0.0] * steps, [0.0] * steps, [0.0] * steps
        made.human = made.agent = made.applied = [np.zeros(1)] * steps
        return made
    return make


def kept(path):
    return [(row['episode'], row['phase'], float(row['seconds'])) for row in read_rows(path)]


def test_what_a_person_taught_in_vain_is_kept_and_counts(tmp_path, episode):
    path = tmp_path / 'episodes.csv'
    table = EpisodeTable(path, live=True)
    table.break_off(episode(1, 0.0), 'not begun')
    table.break_off(episode(1, 4.0), 'repeated')
    table.append(episode(1, 15.0))
    table.append(episode(2, 15.0))  # killed before the learner was saved
    table = EpisodeTable(path, taught=1, live=True)
    rows = [('1', BROKEN_OFF, 4.0), ('1', 'teach', 15.0), ('2', BROKEN_OFF, 15.0)]
    assert kept(path) == rows and table.taught_seconds == 34.0
    table.under_way(episode(2, 7.0))
    table.under_way(episode(2, 8.0))  # killed in mid-episode
    table = EpisodeTable(path, taught=1, live=True)
    assert kept(path) == [*rows, ('2', BROKEN_OFF, 8.0)] and table.taught_seconds == 42.0
    assert kept(path) == [*rows, ('2', BROKEN_OFF, 8.0)] and not (tmp_path / UNFINISHED_NAME).exists()


@pytest.mark.parametrize('taught', [0, 1])
def test_an_episode_whose_end_a_killed_learner_did_not_see_has_its_row_when_the_session_ends(tmp_path, episode, taught):
    path = tmp_path / 'episodes.csv'
    keep_unfinished(path)  # there was no episode at all
    table = EpisodeTable(path, live=True)
    for number in range(1, taught + 1):
        table.append(episode(number, 15.0))
    table.under_way(episode(taught + 1, 8.0))
    for _ in range(2):
        keep_unfinished(path)
        assert kept(path)[taught:] == [(str(taught + 1), BROKEN_OFF, 8.0)]
    assert read_rows(path)[-1]['reason'] == KILLED and not (tmp_path / UNFINISHED_NAME).exists()
    assert EpisodeTable(path, taught=taught, live=True).taught_seconds == 15.0 * taught + 8.0


@pytest.mark.parametrize('end', ['append', 'break_off'])
def test_an_episode_that_has_its_row_is_not_kept_twice(tmp_path, episode, end):
    path = tmp_path / 'episodes.csv'
    table = EpisodeTable(path, live=True)
    table.under_way(episode(1, 6.0))
    unfinished = (tmp_path / UNFINISHED_NAME).read_bytes()
    getattr(table, end)(episode(1, 6.0), *(['stopped'] if end == 'break_off' else []))
    before = kept(path)
    (tmp_path / UNFINISHED_NAME).write_bytes(unfinished)  # killed between the one and the other
    keep_unfinished(path)
    assert kept(path) == before
    EpisodeTable(path, taught=1, live=True)
    assert kept(path) == before


@pytest.mark.parametrize('damage', ['episode,phase\nx,teach\n', 'episode,phase,seconds\n1,teach\n', 'a,b\n1,2\n',
                                    'episode,phase,seconds\n1,teach,x\n', '\0\n\0\n'])
def test_a_damaged_table_is_named(tmp_path, damage):
    path = tmp_path / 'episodes.csv'
    path.write_text(damage)
    with pytest.raises(ValueError, match=r'episodes\.csv is no table of episodes'):
        EpisodeTable(path, live=True)
