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

"""What the command tells Rerun of a session, with or without Rerun installed."""

import sys
from types import SimpleNamespace

from shared_control.cli import main
from shared_control_testing import sessions as made


def test_a_recording_has_the_same_name_wherever_the_session_lies(tmp_path, monkeypatch):
    names = []

    class Stream:
        def __init__(self, application, recording_id):
            names.append((application, recording_id))

        def save(self, path, default_blueprint):
            pass

        def flush(self):
            pass

    monkeypatch.setitem(sys.modules, 'rerun', SimpleNamespace(RecordingStream=Stream))
    monkeypatch.setitem(sys.modules, 'shared_control_records.view.recording', SimpleNamespace(
        blueprint=lambda bag: None, log_bag=lambda bag, recording: None))
    bag = made.record([made.lesson(50)]).write(tmp_path / 'home' / 'bag')
    for _ in range(2):
        monkeypatch.setattr('sys.argv', ['shared-control', 'view', str(bag), '--output', str(tmp_path / 'x.rrd')])
        assert main() == 0
        bag = bag.rename(tmp_path / 'elsewhere')
    assert names[0] == names[1] and str(tmp_path) not in str(names)
