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

"""A terminal that a killed node has left as it wanted it."""

import os
import pty
import termios
import tty

from shared_control_bringup.terminal import restored_terminal


def test_what_a_killed_node_has_left_is_put_back():
    ours, theirs = pty.openpty()
    before = termios.tcgetattr(theirs)
    with restored_terminal(os.ttyname(theirs)):
        tty.setraw(theirs)
    assert termios.tcgetattr(theirs) == before
    assert b'\x1b[?1049l' in os.read(ours, 1024), 'the screen of before'
    with restored_terminal(os.ttyname(theirs)):
        os.write(theirs, b'as it was')
    assert os.read(ours, 1024) == b'as it was'
    os.close(ours)
    os.close(theirs)


def test_none_is_needed():
    with restored_terminal('/nowhere'):
        pass
