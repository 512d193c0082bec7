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
