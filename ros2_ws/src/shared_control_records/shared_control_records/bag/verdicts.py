"""What a person said of the episodes of a bag."""

from collections.abc import Sequence

from shared_control.verdict import Verdict

from .reader import Bag


def last_verdicts(bag: Bag, episodes: Sequence[tuple[int, str]]) -> list[Verdict]:
    """What was said last of each episode.

    Args:
        episodes: in their order; the recorder's time of each start or end, ns, and its name (``episode_key``). One that
            was taught again goes by the same name as before.
    """
    next_ns: dict[str, int] = {}
    found = []
    for since_ns, key in reversed(episodes):
        until_ns = next_ns.get(key, bag.end_ns + 1)
        said = [judgement.verdict for judgement in bag.judgements
                if judgement.episode == key and since_ns <= judgement.received_ns < until_ns]
        found.append(said[-1] if said else Verdict.NONE)
        next_ns[key] = since_ns
    return found[::-1]
