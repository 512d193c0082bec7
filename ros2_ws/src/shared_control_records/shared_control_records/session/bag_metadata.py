"""What a session's folder holds beside its bag, kept in the bag, so that the bag alone gives the same report.

A session puts it behind the messages as a metadata record of the MCAP file
(``shared_control_records.bag.annotate``).
"""

import json
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader
from shared_control import contract
from shared_control.files import write_atomically
from shared_control.tasks.balance import BALANCE

from ..bag.ball_tracks import EpisodeTrack, episode_tracks
from ..bag.reader import Bag, BagReadError
from .episodes import EpisodeRow, write_episodes
from .folder import SessionFolder

RECORD = 'shared_control_session'
"""Name of the metadata record; its keys are paths within the folder, its values the files' text."""
TUTOR_OF_KEYS = {'tutor': 'simulated: unknown', 'terminal': 'keyboard', 'page': 'keyboard'}
"""Who taught, by the source of the keys in a bag that does not say it."""


def pack(folder: SessionFolder, restarts: int) -> dict[str, str]:
    """The content of the record for a session that has ended."""
    packed = {_key(folder, path): path.read_text() for path in _files(folder) if path.is_file()}
    return {**packed, _key(folder, folder.summary): json.dumps({'restarts': restarts})}


def unpack(bag: Bag, folder: SessionFolder) -> None:
    """Lay out in ``folder`` what a report needs: what the bag's record holds, or what its topics tell.

    Files that are not a session's are left in the bag.
    """
    packed = _read(bag.path)
    for path in (*_files(folder), folder.summary):
        if _key(folder, path) in packed:
            write_atomically(path, packed[_key(folder, path)].encode())
    if _key(folder, folder.settings) not in packed:
        sources = [press.source for press in bag.presses]
        tutor = next((TUTOR_OF_KEYS[source] for source in sources if source in TUTOR_OF_KEYS), None)
        write_atomically(folder.settings, json.dumps({'tutor': tutor}).encode())
    if _key(folder, folder.episodes) not in packed:
        write_episodes([_row(bag, track) for track in episode_tracks(bag)], folder.episodes)


def _row(bag: Bag, track: EpisodeTrack) -> EpisodeRow:
    """An episode as the topics tell it."""
    first, last = bag.ball.stamp_ns.searchsorted((track.start_ns, track.end_ns))
    until_ns = bag.ball.received_ns[last]
    returns, shares = bag.training[contract.EPISODE_RETURN], bag.training[contract.HUMAN_SHARE]
    ended = returns.received_ns.searchsorted(until_ns)
    shared = shares.received_ns.searchsorted(until_ns) - 1
    return EpisodeRow(
        number=track.number, phase=track.phase, seconds=float(track.seconds[-1]),
        episode_return=float(returns.values[ended]) if ended < len(returns.values) else None,
        fallen=bool((bag.ball.position[first:last + 1, 2] < BALANCE.fallen_below).any()),
        human_share=float(shares.values[shared]) if shared >= 0 else None)


def _files(folder: SessionFolder) -> tuple[Path, ...]:
    return folder.settings, folder.parameters, folder.episodes, folder.test


def _key(folder: SessionFolder, path: Path) -> str:
    return path.relative_to(folder.path).as_posix()


def _read(bag: Path) -> dict[str, str]:
    """The record of the last file that has one; empty when none has."""
    found: dict[str, str] = {}
    for path in sorted(bag.glob('*.mcap'), key=lambda file: (len(file.name), file.name)) if bag.is_dir() else [bag]:
        try:
            with path.open('rb') as file:
                found = next((record.metadata for record in make_reader(file).iter_metadata()
                              if record.name == RECORD), found)
        except (McapError, OSError, ValueError) as error:
            raise BagReadError(f'cannot read {path}: {error or type(error).__name__}') from error
    return found
