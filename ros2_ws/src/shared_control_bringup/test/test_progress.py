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

"""Lines about finished episodes."""

from shared_control_bringup.progress import EpisodePrinter

HEAD = 'episode,phase,return,human_share,fallen,settled_position_error\n'


def test_tells_each_finished_episode_once(tmp_path):
    path, said = tmp_path / 'episodes.csv', []
    printer = EpisodePrinter(path, said.append)
    printer.poll()
    path.write_text(HEAD + '1,teach,-12.5,0.5,1,0.1\n2,teach,300.25,0.25,0,0.0')
    printer.poll()
    assert len(said) == 1 and 'the ball fell' in said[0]
    path.write_text(HEAD + '1,teach,-12.5,0.5,1,0.1\n2,teach,300.25,0.25,0,0.004\n')
    printer.poll()
    printer.poll()
    assert len(said) == 2 and '4.0 mm' in said[1] and '25%' in said[1]


def test_an_episode_that_was_broken_off_and_rows_that_are_gone(tmp_path):
    path, said = tmp_path / 'episodes.csv', []
    path.write_text(HEAD + '1,test,1,0,0,0.1\n2,test,1,0,0,0.1\n')
    printer = EpisodePrinter(path, said.append)
    path.write_text('')
    printer.poll()
    path.write_text('episode,phase,seconds,reason\n1,broken off,4.25,\n1,broken off,1.0,it was repeated\n')
    printer.poll()
    assert said == ['teach   1: broken off after 4.2 s', 'teach   1: broken off after 1.0 s: it was repeated']


def test_what_an_earlier_run_wrote_is_not_told_again(tmp_path):
    path, said = tmp_path / 'episodes.csv', []
    path.write_text(HEAD + '1,teach,1,0,0,0.1\n')
    EpisodePrinter(path, said.append).poll()
    assert said == []
