"""The set to start from: the same bytes twice, read by what reads sessions, with a card that says what is in it."""

import subprocess
import sys
from pathlib import Path

import pandas as pd
from shared_control_records.bag.reader import read_bag
from shared_control_records.export.frames import episode_frames

ROOT = Path(__file__).parents[1]


def test_the_same_command_gives_the_same_bytes(tmp_path):
    for name in ('one', 'two'):
        subprocess.run([sys.executable, ROOT / 'tools' / 'data_set.py', tmp_path / name, '--quick'], check=True,
                       capture_output=True, timeout=600)
    sums = (tmp_path / 'one' / 'SHA256SUMS').read_text()
    assert sums == (tmp_path / 'two' / 'SHA256SUMS').read_text()
    assert {Path(line.split()[1]).parts[0] for line in sums.splitlines()} == {'README.md', 'bags', 'lerobot'}
    card = (tmp_path / 'one' / 'README.md').read_text()
    for task, axes in (('balance', 1), ('plate', 2), ('detour', 2)):
        bag = read_bag(tmp_path / 'one' / 'bags' / f'{task}_predictive')
        frames = episode_frames(bag)
        assert bag.task.name == task and all(frame.applied.shape[1] == axes for frame in frames)
        assert all(frame.human is not None and frame.human.any() for frame in frames)
        table = pd.read_parquet(tmp_path / 'one' / 'lerobot' / task / 'meta/episodes/chunk-000/file-000.parquet')
        assert table.length.tolist() == [len(frame) for frame in frames]
        assert f'| {task}_predictive | {task} | predictive |' in card
    assert 'Every tutor is simulated' in card
