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

"""What a person says of episodes, in what is made of a bag."""

import json

import pandas as pd
import pytest
from shared_control import contract
from shared_control.verdict import Verdict, episode_key, split_episode_key
from shared_control_records.bag.ball_tracks import episode_tracks
from shared_control_records.bag.checks import check_bag
from shared_control_records.bag.reader import read_bag
from shared_control_records.export.frames import episode_frames
from shared_control_records.export.lerobot import write_lerobot
from shared_control_records.export.parquet import write_parquet
from shared_control_records.session.bag_report import write_bag_report
from shared_control_testing import sessions as made

STEPS = 50
EPISODE_NS = 20 * STEPS * made.MS


def say(recording, at_ns, key, verdict):
    recording.add(contract.VERDICT, at_ns, made.message(contract.VERDICT.type, key=key, value=verdict))


@pytest.fixture
def recording():
    """Four episodes: a success, one that is discarded and taken back, and one that is discarded and taught again."""
    recording = made.record([made.lesson(STEPS, seed=seed) for seed in range(4)])
    for episode in recording.of(contract.EPISODE)[3:]:
        episode.data = 3
    ends = [at for topic, at, _ in recording.messages if topic == contract.EPISODE_RETURN]
    for number, at in zip((1, 2, 3, 3), ends, strict=True):
        say(recording, at + made.MS, f'teach {number}', '')
    for at, key, verdict in (
            (ends[0] + EPISODE_NS // 2, 'teach 1', 'success'), (ends[1] + 2 * made.MS, 'teach 2', 'discard'),
            (ends[1] + EPISODE_NS // 2, 'teach 2', ''), (ends[2] + 2 * made.MS, 'teach 3', 'discard')):
        say(recording, at, key, verdict)
    return recording


@pytest.fixture
def bag(recording, tmp_path):
    return read_bag(recording.write(tmp_path / 'session' / 'bag'))


def test_the_last_word_on_an_episode_counts_and_not_on_the_next_of_its_name(bag):
    assert [(track.number, track.verdict) for track in episode_tracks(bag)] == [
        (1, Verdict.SUCCESS), (2, Verdict.NONE), (3, Verdict.DISCARD), (3, Verdict.NONE)]


def test_a_discarded_episode_is_exported_nowhere(bag, tmp_path):
    frames = episode_frames(bag)
    assert [(episode.number, episode.verdict) for episode in frames] == [
        (1, Verdict.SUCCESS), (2, Verdict.NONE), (3, Verdict.NONE)]
    write_parquet(frames, tmp_path / 'one.parquet')
    table = pd.read_parquet(tmp_path / 'one.parquet')
    assert len(table) == 3 * STEPS and set(table[table.episode == 1].verdict) == {'success'}
    write_lerobot(frames, tmp_path / 'set')
    episodes = pd.read_parquet(tmp_path / 'set/meta/episodes/chunk-000/file-000.parquet')
    assert episodes.verdict.tolist() == ['success', '', '']
    assert episodes.outcome.tolist() == 3 * ['failure'], 'the task calls none a success'
    data = pd.read_parquet(tmp_path / 'set/data/chunk-000/file-000.parquet')
    assert data.groupby('episode_index')['next.success'].sum().tolist() == [1, 0, 0], "the person's word goes first"


def test_a_bag_of_discarded_episodes_alone_is_named(tmp_path):
    recording = made.record([made.lesson(STEPS)])
    say(recording, recording.messages[-1][1] + made.MS, 'teach 1', 'discard')
    bag = read_bag(recording.write(tmp_path / 'bag'))
    with pytest.raises(ValueError, match='no finished episode that was not discarded'):
        episode_frames(bag)


def test_reports_count_it_apart_and_say_so(recording, tmp_path):
    page = write_bag_report(recording.write(tmp_path / 'bag'), tmp_path / 'out')
    summary = json.loads((page.parent / 'summary.json').read_text())
    assert (summary['episodes_taught'], summary['episodes_discarded']) == (3, 1)
    text = page.read_text()
    assert 'The person said' in text and '<td>discarded</td>' in text and '<td>success</td>' in text


def test_a_garbled_verdict_counts_as_unusable_and_old_bags_lack_none(recording, tmp_path):
    say(recording, recording.messages[0][1], 'teach 1', 'splendid')
    bag = read_bag(recording.write(tmp_path / 'one'))
    assert bag.unusable == {contract.VERDICT.full_name: 1}
    old = read_bag(recording.write(tmp_path / 'old', without=(contract.VERDICT, contract.HUMAN_VERDICT)))
    assert [track.verdict for track in episode_tracks(old)] == 4 * [Verdict.NONE]
    assert not any('verdict' in what for what in check_bag(old))


def test_a_word_that_comes_twice_is_taken_back():
    assert Verdict.NONE.after(Verdict.SUCCESS) is Verdict.SUCCESS
    assert Verdict.SUCCESS.after(Verdict.FAILURE) is Verdict.FAILURE
    assert Verdict.FAILURE.after(Verdict.FAILURE) is Verdict.NONE
    assert split_episode_key(episode_key('test', 12)) == ('test', 12)
    for garbled in ('', 'teach', 'teach x'):
        with pytest.raises(ValueError, match='invalid literal'):
            split_episode_key(garbled)
