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

"""The end of the teaching that somebody has asked for."""

import json

import pytest
from ppo_agent_node.last_episode import LastEpisode

WANTED = {'episodes': 0, 'max_minutes': 45.0}


def test_an_agent_that_is_killed_knows_it_again_until_all_is_done(tmp_path):
    path = tmp_path / 'last_episode.json'
    last = LastEpisode(path, WANTED)
    assert last.number is None and not last.is_learned(5)
    last.set(3)
    again = LastEpisode(path, WANTED)
    assert again.number == 3 and not again.is_learned(2) and again.is_learned(3)
    again.set(0)
    assert LastEpisode(path, WANTED).is_learned(2), 'it was the last, and is discarded'
    again.forget()
    assert LastEpisode(path, WANTED).number is None


@pytest.mark.parametrize('other', [{'episodes': 20}, {'max_minutes': 60.0}])
def test_who_wants_something_else_goes_on_teaching(tmp_path, other):
    path = tmp_path / 'last_episode.json'
    LastEpisode(path, WANTED).set(0)
    assert LastEpisode(path, {**WANTED, **other}).number is None


@pytest.mark.parametrize('content', [
    '', '[]', '{"last_episode": 1}', f'{{"last_episode": "x", "wanted": {json.dumps(WANTED)}}}', '[' * 10_000])
def test_a_damaged_file_is_named_with_what_to_do(tmp_path, content):
    path = tmp_path / 'last_episode.json'
    path.write_text(content)
    with pytest.raises(ValueError, match=r'last_episode\.json .*remove it'):
        LastEpisode(path, WANTED)


def test_without_a_folder_nothing_is_kept():
    last = LastEpisode(None, WANTED)
    last.set(0)
    assert last.is_learned(0)
    last.forget()
    assert last.number is None
