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
    assert {number: signal.getsignal(number) for number in SIGNALS} == before


def test_nohup_holds():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Interrupts() as interrupts:
            os.kill(os.getpid(), signal.SIGHUP)
            interrupts.check()
    finally:
        signal.signal(signal.SIGHUP, before)
