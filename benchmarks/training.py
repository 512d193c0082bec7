"""How long learning takes, tests included: from nothing to skilled, by one process and by all cores; and its pauses."""

import os
import statistics
from collections.abc import Sequence
from typing import Any

from shared_control.teaching.profiles import profile
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.presets import preset
from shared_control_learning.training import TrainingRun, train

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
    """Wall times, s, of the median seed with the least and the most (``train``; below ``mujoco`` with MuJoCo, elsewhere
    with PyBullet), and pauses of all coached episodes (``learn``).

    A seed is run with the one physics and at once with the other. ``in_bullets``: what all seeds take with MuJoCo, in
    what they take with PyBullet; ``episode_in_bullets``: the same for an episode with its test, since a seed may need
    more episodes with the one than with the other. ``coached_by_all_cores``: the same runs, tested by all cores.
    """
    pauses = _Pauses()
    figures: dict[str, Any] = {'mujoco': {}}
    for name, tutor, callbacks in (('coached', profile('expert'), pauses), ('autonomous', None, Callbacks())):
        runs = [[train(preset(name), tutor, seed, EPISODES, physics=physics, callbacks=callbacks)
                 for physics in ('bullet', 'mujoco')] for seed in SEEDS]
        bullet, mujoco = zip(*runs, strict=True)
        figures |= _figures(name, bullet)
        figures['mujoco'] |= _figures(name, mujoco)
        ratio = sum(run.seconds for run in mujoco) / sum(run.seconds for run in bullet)
        episodes = sum(run.episodes for run in mujoco) / sum(run.episodes for run in bullet)
        figures['mujoco'] |= {f'{name}_in_bullets': round(ratio, 3),
                              f'{name}_episode_in_bullets': round(ratio / episodes, 3)}
    together = [train(preset('coached'), profile('expert'), seed, EPISODES, processes=len(os.sched_getaffinity(0)))
                for seed in SEEDS]
    figures |= _figures('coached_by_all_cores', together)
    return {'train': figures, 'learn': {
        'pause_s': round(statistics.median(pauses.seconds), 3), 'pause_s_max': round(max(pauses.seconds), 3)}}


def _figures(name: str, runs: Sequence[TrainingRun]) -> dict[str, Any]:
    seconds = sorted(round(run.seconds, 1) for run in runs)
    return {f'{name}_to_skilled_s': statistics.median(seconds),
            f'{name}_to_skilled_s_min_max': [seconds[0], seconds[-1]],
            f'{name}_episodes': [run.skilled for run in runs]}
