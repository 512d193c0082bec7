"""What a recorder that is started again gets told once more."""

from collections.abc import Iterable
from pathlib import Path

from mcap.reader import make_reader


def last_sent(files: list[Path], topics: Iterable[str]) -> dict[str, int]:
    """When the newest message of each of these topics in a bag's files was sent, ns; one without any is left out.

    Publishers of a latched topic repeat what they said to every new subscriber. Whatever is not newer than this is
    in the bag already.
    """
    missing = set(topics)
    found: dict[str, int] = {}
    for path in reversed(files):
        with path.open('rb') as file:
            reader = make_reader(file)
            for topic in sorted(missing):
                newest = next(reader.iter_messages(topic, reverse=True), None)
                if newest is not None:
                    found[topic] = newest[2].publish_time
                    missing.remove(topic)
    return found
