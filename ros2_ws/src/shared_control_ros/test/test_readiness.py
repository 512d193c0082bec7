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

import pytest
from shared_control_ros.readiness import READY_FD, tell_ready


def test_a_line_goes_through_the_pipe_and_closes_it(monkeypatch):
    ours, theirs = os.pipe()
    monkeypatch.setenv(READY_FD, str(theirs))
    tell_ready()
    assert os.read(ours, 64) == b'ready\n' and os.read(ours, 64) == b''
    assert READY_FD not in os.environ, 'its own children are not concerned'
    os.close(ours)


def test_nobody_needs_to_wait(monkeypatch):
    monkeypatch.delenv(READY_FD, raising=False)
    tell_ready()
    monkeypatch.setenv(READY_FD, '987654')
    tell_ready()
    ours, theirs = os.pipe()
    os.close(ours)
    monkeypatch.setenv(READY_FD, str(theirs))
    tell_ready()
    with pytest.raises(OSError):
        os.fstat(theirs)
