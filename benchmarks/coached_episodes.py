"""Episodes that a simulated tutor needs to teach the robot: the table of docs/learning.md.

In process on the PyBullet plant. After every episode the policy is tested alone by the randomised protocol (20
episodes of 10 s, new starts each time); it is skilled at the second test in a row that it passes. The tutors are
simulated, no people take part.

    python benchmarks/coached_episodes.py --preset coached --tutor expert --seeds 8
"""

import argparse
import json
import statistics
from pathlib import Path
from typing import Any

from shared_control.envs.balance_env import BalanceEnv
from shared_control.envs.local_plant import LocalPlant
from shared_control.human.profiles import PROFILES, profile
from shared_control.human.tutor import SimulatedTutor
from shared_control.learning.evaluate import passes, test_settings
from shared_control.learning.hooks import Hooks
from shared_control.learning.learn import learn, make_learner
from shared_control.learning.presets import PRESETS, preset
from shared_control.learning.record import EpisodeRecord
from shared_control.seeds import episode_seed

TEST_SEED = 1_000_000
"""Added to the run's seed: tests draw other ball starts than the teaching."""


class TestAfterEveryEpisode(Hooks):
    """Tests the learner alone until it has passed twice in a row."""

    def __init__(self, learner: Any, env: BalanceEnv, seed: int):
        self._learner, self._env, self._seed = learner, env, seed
        self.passed: list[bool] = []
        self.intervention: list[float] = []

    @property
    def skilled(self) -> bool:
        """Whether the last two tests were passed."""
        return self.passed[-2:] == [True, True]

    def stop(self) -> bool:
        """See :class:`Hooks`."""
        return self.skilled

    def episode_learned(self, record: EpisodeRecord) -> None:
        """See :class:`Hooks`."""
        self.intervention.append(round(record.intervention_rate, 3))
        self.passed.append(passes(self._learner.act, self._env, episode_seed(TEST_SEED + self._seed, record.episode)))


def teach(preset_name: str, tutor: str, seed: int, episodes: int) -> dict[str, Any]:
    """One run."""
    chosen = preset(preset_name)
    learner = make_learner(chosen, seed)
    person = None if tutor == 'none' else SimulatedTutor(profile(tutor), seed)
    env = BalanceEnv(LocalPlant(person, chosen.task.moment_limit), chosen.task)
    test_env = BalanceEnv(LocalPlant(None, chosen.task.moment_limit), test_settings(chosen.task))
    watch = TestAfterEveryEpisode(learner, test_env, seed)
    learn(learner, env, episodes, watch)
    env.close()
    test_env.close()
    first = watch.passed.index(True) + 1 if True in watch.passed else None
    return {'seed': seed, 'first_pass': first, 'skilled': len(watch.passed) if watch.skilled else None,
            'passed': watch.passed, 'intervention_rate': watch.intervention}


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--preset', choices=tuple(PRESETS), default='coached')
    parser.add_argument('--tutor', choices=(*PROFILES, 'none'), default='expert')
    parser.add_argument('--seeds', type=int, default=8)
    parser.add_argument('--episodes', type=int, default=20, help='give up after this many')
    parser.add_argument('--output', type=Path, default=Path('out/coached_episodes.json'))
    args = parser.parse_args()
    runs = []
    for seed in range(args.seeds):
        runs.append(teach(args.preset, args.tutor, seed, args.episodes))
        print(runs[-1], flush=True)
    for key in ('first_pass', 'skilled'):
        reached = [run[key] for run in runs if run[key] is not None]
        print(f'{key}: {len(reached)} of {len(runs)} seeds' + (
            f', median {statistics.median(reached)} episodes, {min(reached)} to {max(reached)}' if reached else ''))
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps({'preset': args.preset, 'tutor': args.tutor, 'runs': runs}, indent=2) + '\n')


if __name__ == '__main__':
    main()
