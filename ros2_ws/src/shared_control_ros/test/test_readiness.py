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

"""The line by which a node says that it is ready."""

import os

from shared_control_ros.readiness import DONE, READY, READY_FD, ReadyPipe


def test_lines_go_through_the_pipe_that_was_handed_over(monkeypatch):
    ours, theirs = os.pipe()
    os.set_inheritable(theirs, True)
    monkeypatch.setenv(READY_FD, str(theirs))
    pipe = ReadyPipe()
    assert READY_FD not in os.environ and not os.get_inheritable(theirs), 'its own children are not concerned'
    pipe.tell(READY)
    assert os.read(ours, 64) == READY
    pipe.tell(DONE)
    os.close(theirs)
    assert os.read(ours, 64) == DONE and os.read(ours, 64) == b''
    os.close(ours)


def test_nobody_needs_to_wait(monkeypatch):
    monkeypatch.delenv(READY_FD, raising=False)
    ReadyPipe().tell(READY)
    for handed_on_without_a_pipe in ('987654', '-1', 'three'):
        monkeypatch.setenv(READY_FD, handed_on_without_a_pipe)
        ReadyPipe().tell(READY)
    ours, theirs = os.pipe()
    os.close(ours)
    monkeypatch.setenv(READY_FD, str(theirs))
    ReadyPipe().tell(READY)
    os.close(theirs)
