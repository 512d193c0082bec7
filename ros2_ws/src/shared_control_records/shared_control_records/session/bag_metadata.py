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

"""What a session's folder holds beside its bag, kept in the bag, so that the bag alone gives the same report.

A session puts it behind the messages as a metadata record of the MCAP file
(``shared_control_records.bag.annotate``).
"""

import json
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from shared_control import contract
from shared_control.files import write_atomically
from shared_control.keys import PAGE, TERMINAL, TUTOR
from shared_control.rates import POLICY_PERIOD
from shared_control_learning.episode_table import BROKEN_OFF

from ..bag.ball_tracks import EpisodeTrack, broken_off, episode_tracks
from ..bag.reader import Bag
from ..bag.task import session_record
from .episodes import EpisodeRow, write_episodes
from .folder import SessionFolder

TUTOR_OF_KEYS = {TUTOR: 'simulated: unknown', TERMINAL: 'keyboard', PAGE: 'keyboard'}
"""Who taught, by the source of the keys in a bag that does not say it."""
SECRETS = ('token',)
"""Parameters that are nobody else's business."""


def pack(folder: SessionFolder, restarts: int) -> dict[str, str]:
    """The content of the record for a session that has ended.

    Bags are handed to others: no absolute path is in it, which would name a person's home, and no token.
    """
    packed = {_key(folder, path): path.read_text(encoding='utf-8') for path in _files(folder) if path.is_file()}
    for path, read, write in ((folder.parameters, yaml.safe_load, partial(yaml.safe_dump, sort_keys=False)),
                              (folder.settings, json.loads, partial(json.dumps, indent=2))):
        text = packed.pop(_key(folder, path), None)
        if text is not None:
            with suppress(yaml.YAMLError, ValueError):  # somebody has damaged it: what it says is not known
                packed[_key(folder, path)] = write(_for_others(read(text), folder.path))
    return {**packed, _key(folder, folder.summary): json.dumps({'restarts': restarts})}


def _for_others(value: Any, folder: Path) -> Any:
    """Settings without secrets; a path within the session's folder relative to it, of others the last name alone."""
    if isinstance(value, dict):
        return {key: _for_others(content, folder) for key, content in value.items() if key not in SECRETS}
    if isinstance(value, list):
        return [_for_others(content, folder) for content in value]
    if isinstance(value, str) and value.startswith(('/', '~')):
        path = Path(value)
        return str(path.relative_to(folder)) if path.is_relative_to(folder) else path.name
    return value


def unpack(bag: Bag, folder: SessionFolder) -> None:
    """Lay out in ``folder`` what a report needs: what the bag's record holds, or what its topics tell.

    Files that are not a session's are left in the bag.
    """
    packed = session_record(bag.path)
    for path in (*_files(folder), folder.summary):
        if _key(folder, path) in packed:
            write_atomically(path, packed[_key(folder, path)].encode())
    if _key(folder, folder.settings) not in packed:
        sources = [press.source for press in bag.presses]
        tutor = next((TUTOR_OF_KEYS[source] for source in sources if source in TUTOR_OF_KEYS), None)
        write_atomically(folder.settings, json.dumps({'tutor': tutor}).encode())
    if _key(folder, folder.episodes) not in packed:
        unlearned = [EpisodeRow(number, BROKEN_OFF, round(seconds, 3), None, None, None)
                     for number, seconds in broken_off(bag)]
        write_episodes([*(_row(bag, track) for track in episode_tracks(bag)), *unlearned], folder.episodes)


def _row(bag: Bag, track: EpisodeTrack) -> EpisodeRow:
    """An episode as the topics tell it."""
    until_ns = track.received_ns[1]
    returns, shares = bag.training[contract.EPISODE_RETURN], bag.training[contract.HUMAN_SHARE]
    ended = returns.received_ns.searchsorted(until_ns)
    shared = shares.received_ns.searchsorted(until_ns) - 1
    return EpisodeRow(
        number=track.number, phase=track.phase, seconds=float(track.seconds[-1]),
        episode_return=float(returns.values[ended]) if ended < len(returns.values) else None,
        fallen=track.failed, human_share=float(shares.values[shared]) if shared >= 0 else None,
        intervention_rate=_intervention_rate(bag, track), verdict=track.verdict)


def _intervention_rate(bag: Bag, track: EpisodeTrack) -> float | None:
    """Part of an episode's policy steps in which a moment of the human counted."""
    if not len(bag.human_applied.moment):
        return None
    stamps = np.arange(track.start_ns, track.end_ns, round(POLICY_PERIOD * 1e9))
    return float((bag.human_applied.moment_at(stamps) != 0.0).any(axis=1).mean())


def _files(folder: SessionFolder) -> tuple[Path, ...]:
    return folder.settings, folder.parameters, folder.episodes, folder.test


def _key(folder: SessionFolder, path: Path) -> str:
    return path.relative_to(folder.path).as_posix()
