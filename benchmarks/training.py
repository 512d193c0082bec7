"""How long learning takes on one core: from nothing to skilled, tests included, and the pause after an episode."""

import statistics
from typing import Any

from shared_control.teaching.profiles import profile
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.presets import preset
from shared_control_learning.training import train

SEEDS = range(3)
EPISODES = 40


class _Pauses(Callbacks):
    """Notes how long each update took."""

    def __init__(self) -> None:
        self.seconds: list[float] = []

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        self.seconds.append(episode.learn_seconds)


def measure() -> dict[str, Any]:
    """Wall times, s, of the median seed with the least and the most (``train``), and pauses of all coached episodes
    (``learn``)."""
    pauses = _Pauses()
    figures: dict[str, Any] = {}
    for name, tutor, callbacks in (('coached', profile('expert'), pauses), ('autonomous', None, Callbacks())):
        runs = [train(preset(name), tutor, seed, EPISODES, callbacks=callbacks) for seed in SEEDS]
        seconds = sorted(round(run.seconds, 1) for run in runs)
        figures[f'{name}_to_skilled_s'] = statistics.median(seconds)
        figures[f'{name}_to_skilled_s_min_max'] = [seconds[0], seconds[-1]]
        figures[f'{name}_episodes'] = [run.skilled for run in runs]
    return {'train': figures, 'learn': {
        'pause_s': round(statistics.median(pauses.seconds), 3), 'pause_s_max': round(max(pauses.seconds), 3)}}
