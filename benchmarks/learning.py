"""How many episodes it takes to teach the robot: the table of docs/explanation/learning.md.

In process on the PyBullet plant. After every episode the policy is tested alone (20 episodes of 10 s, new starts each
time); it is skilled at the second test in a row that it passes. Runs with the same seed share ball starts and first
weights, so conditions are paired. The tutors are simulated, no people take part. A run that is stopped goes on when
the command is given again, and one that fewer --episodes ended when more are asked for.

    python benchmarks/learning.py                              # all conditions but thesis-*, 24 seeds: hours
    python benchmarks/learning.py --conditions guided-reactive guided-crossover guided-blind    # families of tutors
    python benchmarks/learning.py --conditions coached-expert --seeds 8
    python benchmarks/learning.py --conditions coached-expert --retention      # 20 further episodes without the tutor
    python benchmarks/learning.py --conditions coached-expert-10 autonomous-10 # ten episodes each, skilled or not
    python benchmarks/learning.py --conditions autonomous guided-blind --episodes 10 --against autonomous
"""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import bootstrap
from shared_control.command_line import script_parser, write_json
from shared_control.env import SharedControlEnv
from shared_control.files import write_atomically
from shared_control.tasks.task import Task
from shared_control.teaching.families import FAMILIES
from shared_control.teaching.tutors import tutor_named
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.evaluation.evaluate import Act, Evaluation, as_tested, evaluate
from shared_control_learning.learn import learn
from shared_control_learning.policy_file import POLICY_NAME, load_policy
from shared_control_learning.presets import preset
from shared_control_learning.training import TEST_OFFSET, passes_now, train
from shared_control_sim.local_plant import LocalPlant
from tqdm import tqdm
from workers import add_workers, worker_pool

RETENTION_EPISODES = 20
RETENTION_TESTED_EVERY = 5


@dataclass(frozen=True)
class Condition:
    """Who teaches what, for how long."""

    preset: str
    tutor: str | None = None
    episodes: int = 20
    human_only: bool = False
    evaluate_every: int = 1
    until_skilled: bool = True


CONDITIONS = {
    'guided-expert': Condition('guided', 'expert', 10),
    'guided-nobody': Condition('guided', None, 10),
    **{f'guided-{family}': Condition('guided', family, 10) for family in FAMILIES},
    **{f'coached-{family}': Condition('coached', family, 10) for family in FAMILIES},
    'coached-expert': Condition('coached', 'expert'),
    'coached-high': Condition('coached', 'high'),
    'coached-low': Condition('coached', 'low'),
    'coached-adapting': Condition('coached', 'adapting'),
    'coached-sham': Condition('coached', 'sham'),
    'coached-nobody': Condition('coached'),
    'autonomous': Condition('autonomous', episodes=40),
    'coached-expert-10': Condition('coached', 'expert', 10, evaluate_every=0, until_skilled=False),
    'autonomous-10': Condition('autonomous', None, 10, evaluate_every=0, until_skilled=False),
    'thesis-expert': Condition('thesis', 'expert', 800, evaluate_every=5),
    'thesis-nobody': Condition('thesis', None, 800, evaluate_every=5),
    'thesis-human-only': Condition('thesis', 'expert', 800, human_only=True, evaluate_every=5),
}
BY_DEFAULT = [name for name in CONDITIONS if not name.startswith('thesis')]


def run(name: str, seed: int, folder: Path, limit: int | None, retention: bool) -> dict[str, Any]:
    """One run, and what became of its policy; one that was ended sooner by a smaller ``limit`` goes on."""
    condition, done = CONDITIONS[name], folder / 'result.json'
    episodes = min(condition.episodes, limit or condition.episodes)
    result = json.loads(done.read_text()) if done.exists() else None
    if result is None or (result['skilled'] is None and result['episodes'] < episodes):
        result = taught(condition, seed, folder, episodes)
        write_json(result, done)
    if retention and result['skilled'] is not None and 'retention' not in result:
        result['retention'] = retained(folder / POLICY_NAME, seed)
        write_json(result, done)
    return result


def taught(condition: Condition, seed: int, folder: Path, episodes: int) -> dict[str, Any]:
    """Teach a policy for at most so many episodes, earlier ones included, and test it."""
    training = train(
        preset(condition.preset), None if condition.tutor is None else tutor_named(condition.tutor, seed), seed,
        episodes, human_only=condition.human_only, folder=folder, evaluate_every=condition.evaluate_every,
        until_skilled=condition.until_skilled)
    return {
        'seed': seed, 'skilled': training.skilled, 'first_pass': training.first_pass, 'episodes': training.episodes,
        'intervention_rates': training.intervention_rates, 'seconds': training.seconds,
        **final_test(folder / POLICY_NAME, seed)}


def final_test(policy: Path, seed: int) -> dict[str, float]:
    """The randomised test of a policy."""
    learner = load_policy(policy)
    test = randomized_test(learner.act, learner.task, TEST_OFFSET + seed)
    return {'successes': test.successes, 'position_error': test.mean_position_error, 'velocity': test.mean_velocity}


def randomized_test(act: Act, task: Task, seed: int, physics: str = 'bullet', callbacks: Callbacks | None = None,
                    ) -> Evaluation:
    """The randomised test of ``act``, with the ball starts of ``seed``; ``callbacks`` are called for its episodes."""
    env = SharedControlEnv(LocalPlant(task, physics=physics), as_tested(task))
    test = evaluate(act, env, seed=seed, callbacks=callbacks)
    env.close()
    return test


class _TestNowAndThen(Callbacks):
    """Tests after every few episodes."""

    def __init__(self, learner: Any, env: SharedControlEnv, seed: int):
        self._learner, self._env, self._seed = learner, env, seed
        self._skilled = learner.episode
        self.passed: list[bool] = []

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        if (episode.number - self._skilled) % RETENTION_TESTED_EVERY == 0:
            self.passed.append(passes_now(self._learner, self._env, self._seed))


def retained(policy: Path, seed: int) -> list[bool]:
    """Go on learning without the tutor: whether the policy passed whenever it was tested."""
    learner = load_policy(policy)
    task = learner.task
    env, test_env = (SharedControlEnv(LocalPlant(task), s) for s in (task, as_tested(task)))
    watch = _TestNowAndThen(learner, test_env, seed)
    learn(learner, env, learner.episode + RETENTION_EPISODES, watch)
    env.close()
    test_env.close()
    return watch.passed


def with_interval(values: np.ndarray, statistic: Callable[..., Any]) -> list[float]:
    """A statistic and its 95 % bootstrap interval."""
    middle = low = high = statistic(values)
    if len(set(values)) > 1:
        low, high = bootstrap((values,), statistic, method='percentile', rng=0).confidence_interval
    return [float(middle), float(low), float(high)]


def shown(figures: list[float], digits: int = 4) -> str:
    """A statistic and its interval, as :func:`with_interval` gives them, in a line."""
    middle, low, high = (f'{figure:.{digits}g}' for figure in figures)
    return f'{middle} [{low}, {high}]'


def median_with_interval(values: list[float]) -> list[float]:
    """Median and its 95 % bootstrap interval; runs that never got there count as infinite."""
    finite = np.where(np.isinf(values), 1e9, values)
    return [float('inf') if v >= 1e8 else v for v in with_interval(finite, np.median)]


def describe(name: str, runs: list[dict[str, Any]]) -> dict[str, Any]:
    """The row of a condition."""
    position, velocity = ([1e3 * r[key] for r in runs] for key in ('position_error', 'velocity'))
    row = {
        'condition': name, 'seeds': len(runs), 'successes': median_with_interval([r['successes'] for r in runs]),
        'position_error_mm': median_with_interval(position), 'position_error_sd_mm': float(np.std(position)),
        'velocity_mm_s': median_with_interval(velocity), 'velocity_sd_mm_s': float(np.std(velocity)),
        'intervention_first': float(np.mean([r['intervention_rates'][0] for r in runs])),
        'intervention_last': float(np.mean([r['intervention_rates'][-1] for r in runs])),
        'seconds': median_with_interval([r['seconds'] for r in runs])}
    if CONDITIONS[name].until_skilled:
        skilled = [float('inf') if r['skilled'] is None else float(r['skilled']) for r in runs]
        row |= {'episodes_to_skilled': median_with_interval(skilled), 'slowest': max(skilled),
                'censored': int(np.isinf(skilled).sum())}
    if any('retention' in r for r in runs):
        kept = [all(r['retention']) for r in runs if 'retention' in r]
        row['retained'] = f'{sum(kept)} of {len(kept)}'
    return row


def share_skilled_against(runs: list[dict[str, Any]], others: list[dict[str, Any]], episodes: int) -> list[float]:
    """How much larger the share of runs is that were skilled within ``episodes`` than that of ``others`` with the same
    seeds, and its 95 % bootstrap interval."""
    own, other = ({run['seed']: float(run['skilled'] is not None and run['skilled'] <= episodes) for run in some}
                  for some in (runs, others))
    paired = np.array([own[seed] - other[seed] for seed in sorted(own.keys() & other.keys())])
    return with_interval(paired, np.mean)


def compare(rows: list[dict[str, Any]], reference: str) -> None:
    """Add to each row, and print, how its condition fares against ``reference`` at the same number of episodes."""
    others = next(row['runs'] for row in rows if row['condition'] == reference)
    for row in rows:
        if row['condition'] == reference or 'censored' not in row:
            continue
        episodes = min(CONDITIONS[name].episodes for name in (row['condition'], reference))
        row['skilled_against'] = {'reference': reference, 'episodes': episodes,
                                  'difference': share_skilled_against(row['runs'], others, episodes)}
        difference, low, high = row['skilled_against']['difference']
        print(f'{row["condition"]}: share skilled within {episodes} episodes, less that of {reference}, paired: '
              f'{difference:+.2f} [{low:+.2f}, {high:+.2f}]')


def tell(row: dict[str, Any]) -> None:
    """Print a condition."""
    episodes = f'{CONDITIONS[row["condition"]].episodes} episodes each'
    if 'censored' in row:
        episodes = (f'{row["censored"]} never skilled; episodes to skilled {shown(row["episodes_to_skilled"])}, '
                    f'slowest {row["slowest"]:g}')
    print(f'{row["condition"]}: {row["seeds"]} seeds, {episodes}; at the end {shown(row["successes"])} of 20 succeed, '
          f'|position error| {shown(row["position_error_mm"])} mm (SD {row["position_error_sd_mm"]:.2g}), |velocity| '
          f'{shown(row["velocity_mm_s"])} mm/s (SD {row["velocity_sd_mm_s"]:.2g}); human holds '
          f'{row["intervention_first"]:.0%} of the first, {row["intervention_last"]:.0%} of the last episode; '
          f'{shown(row["seconds"])} s', flush=True)
    if 'retained' in row:
        print(f'{"":{len(row["condition"])}}  keeps it for {RETENTION_EPISODES} episodes without the tutor, '
              f'tested every {RETENTION_TESTED_EVERY}: '
              f'{row["retained"]}', flush=True)


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--conditions', nargs='+', choices=tuple(CONDITIONS), default=BY_DEFAULT, metavar='NAME',
                        help=f'of {", ".join(CONDITIONS)} (default: all but thesis-*)')
    parser.add_argument('--seeds', type=int, default=24, metavar='N', help='runs of each condition')
    parser.add_argument('--episodes', type=int, metavar='N',
                        help='at most so many (default: as many as the condition has)')
    parser.add_argument('--retention', action='store_true', help='20 further episodes without the tutor')
    parser.add_argument('--against', choices=tuple(CONDITIONS), metavar='NAME',
                        help='compare all others with this one of the conditions (default: no comparison)')
    add_workers(parser)
    parser.add_argument('--output', type=Path, default=Path('out/learning'), metavar='FOLDER',
                        help='folder of the runs')
    args = parser.parse_args()
    if args.against is not None and args.against not in args.conditions:
        parser.error(f'--against {args.against}: it is not among the --conditions')
    rows: list[dict[str, Any]] = []
    with worker_pool(args.workers) as pool:
        for name in args.conditions:
            futures = [pool.submit(run, name, seed, args.output / name / f'{seed:03}', args.episodes, args.retention)
                       for seed in range(args.seeds)]
            runs = [future.result() for future in tqdm(futures, desc=name, unit='run', disable=None)]
            rows.append({**describe(name, runs), 'runs': runs})
            tell(rows[-1])
            write(rows, args.output)
    if args.against is not None:
        compare(rows, args.against)
        write(rows, args.output)


def write(rows: list[dict[str, Any]], folder: Path) -> None:
    """The table so far."""
    table = {'tutors': 'simulated', 'conditions': rows}
    write_atomically(folder / 'learning.json', (json.dumps(table, indent=2) + '\n').encode())


if __name__ == '__main__':
    main()
