"""How long learning takes, tests included: from nothing to skilled, by one process and by all cores; and its pauses.

    python benchmarks/bench.py --only learning       # three seeds
    python benchmarks/training.py --seeds 12         # a quarter of an hour: a seed may need more episodes by chance
"""

import json
import os
import statistics
import time
from collections.abc import Sequence
from typing import Any

from shared_control.command_line import script_parser
from shared_control.teaching.profiles import profile
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.presets import preset
from shared_control_learning.training import TrainingRun, train

SEEDS = 3
EPISODES = 40
PHYSICS = ('bullet', 'mujoco')


class _Pauses(Callbacks):
    """Notes how long each update took."""

    def __init__(self) -> None:
        self.seconds: list[float] = []

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        self.seconds.append(episode.learn_seconds)


def measure(seeds: int = SEEDS) -> dict[str, Any]:
    """Wall times, s, of the median seed with the least and the most (``train``; below ``mujoco`` with MuJoCo, elsewhere
    with PyBullet), and pauses of all coached episodes (``learn``).

    A seed is run with the one physics and at once with the other. ``in_bullets``: the processor's seconds of all seeds
    with MuJoCo, in those with PyBullet; ``episode_in_bullets``: the same for an episode with its test, since a seed may
    need more episodes with the one than with the other. ``coached_by_all_cores``: the same runs, tested by all cores.
    """
    pauses = _Pauses()
    figures: dict[str, Any] = {'mujoco': {}}
    for name, tutor, callbacks in (('coached', profile('expert'), pauses), ('autonomous', None, Callbacks())):
        runs: dict[str, list[TrainingRun]] = {physics: [] for physics in PHYSICS}
        seconds = dict.fromkeys(PHYSICS, 0.0)
        for seed in range(seeds):
            for physics in PHYSICS:
                started = time.process_time()
                runs[physics].append(train(preset(name), tutor, seed, EPISODES, physics=physics, callbacks=callbacks))
                seconds[physics] += time.process_time() - started
        figures |= _figures(name, runs['bullet'])
        figures['mujoco'] |= _figures(name, runs['mujoco'])
        ratio = seconds['mujoco'] / seconds['bullet']
        episodes = sum(run.episodes for run in runs['mujoco']) / sum(run.episodes for run in runs['bullet'])
        figures['mujoco'] |= {f'{name}_in_bullets': round(ratio, 3),
                              f'{name}_episode_in_bullets': round(ratio / episodes, 3)}
    together = [train(preset('coached'), profile('expert'), seed, EPISODES, processes=len(os.sched_getaffinity(0)))
                for seed in range(seeds)]
    figures |= _figures('coached_by_all_cores', together)
    return {'train': figures, 'learn': {
        'pause_s': round(statistics.median(pauses.seconds), 3), 'pause_s_max': round(max(pauses.seconds), 3)}}


def _figures(name: str, runs: Sequence[TrainingRun]) -> dict[str, Any]:
    seconds = sorted(round(run.seconds, 1) for run in runs)
    return {f'{name}_to_skilled_s': statistics.median(seconds),
            f'{name}_to_skilled_s_min_max': [seconds[0], seconds[-1]],
            f'{name}_episodes': [run.skilled for run in runs]}


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--seeds', type=int, default=SEEDS, metavar='N', help='runs of each')
    print(json.dumps(measure(parser.parse_args().seeds), indent=2))


if __name__ == '__main__':
    main()
