"""A command that is asked to leave, by whatever signal, ends as by Ctrl-C and says how to go on."""

import signal
import subprocess
import sys

import pytest
from shared_control_learning.episode_table import TABLE_NAME, read_rows


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGHUP])
def test_a_training(number, tmp_path, wait_until):
    folder = tmp_path / 'run'
    training = subprocess.Popen([sys.executable, '-m', 'shared_control', 'train', '--evaluate-every', '0',
                                 '--episodes', '1000', '--output', str(folder)], stderr=subprocess.PIPE,
                                stdout=subprocess.DEVNULL, text=True)

    def has_taught():
        assert training.poll() is None
        return read_rows(folder / TABLE_NAME)

    try:
        wait_until(has_taught, 'the first episode')
        training.send_signal(number)
        said = training.communicate(timeout=120.0)[1]
    finally:
        training.kill()
    assert training.returncode == 130
    assert f'stopped; go on with: shared-control train --resume {folder}' in said
    assert 'leaked' not in said and 'Traceback' not in said
