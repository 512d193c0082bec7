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

"""Signals to a session."""

import os
import signal

import pytest
from shared_control_bringup.interrupts import SIGNALS, Interrupts


@pytest.mark.parametrize('number', SIGNALS)
def test_signals_are_noted_however_many_come(number):
    before = {number: signal.getsignal(number) for number in SIGNALS}
    with Interrupts() as interrupts:
        interrupts.check()
        for _ in range(3):
            os.kill(os.getpid(), number)
        with pytest.raises(KeyboardInterrupt):
            interrupts.check()
        assert interrupts.count == 3 and interrupts.requested
    assert {number: signal.getsignal(number) for number in SIGNALS} == before


def test_nohup_holds():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Interrupts() as interrupts:
            os.kill(os.getpid(), signal.SIGHUP)
            interrupts.check()
    finally:
        signal.signal(signal.SIGHUP, before)
