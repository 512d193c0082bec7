"""Settings for what we compare ourselves with, searched for as hard as our own.

    nice -n 10 python benchmarks/tune.py alone            # PPO with nobody on detour: two core hours
    nice -n 10 python benchmarks/tune.py dcoach pvp sac_interventions        # on balance, with tuning families
    python benchmarks/tune.py --table                     # run nothing: print what there is

Settings are drawn at random (Bergstra and Bengio, 2012), those in use among them, and the better ones go on for longer
and with more seeds and tutors (successive halving: Jamieson and Talwalkar, 2016). Better: more successes of a
randomised test in the end, then less |position error|. In MuJoCo, for the time; with seeds from 100 on and families
marked *tuning*, so that nothing is tuned on what is reported. A run that is stopped goes on when the command is given
again (out/tune). All tutors are simulated.
"""

import json
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from learning import randomized_test
from shared_control.command_line import script_parser, write_json
from shared_control.control.sharing import Sharing
from shared_control.plugins import TASKS, load
from shared_control.teaching.tutors import tutor_named
from shared_control_learning.baselines.presets import DCOACH, PVP, SAC_INTERVENTIONS
from shared_control_learning.evaluation.evaluate import TEST_SEED
from shared_control_learning.policy_file import POLICY_NAME, load_policy
from shared_control_learning.presets import Preset
from shared_control_learning.settings import PpoSettings
from shared_control_learning.training import train
from tasks import ALONE_NETWORK
from tqdm import tqdm
from workers import add_workers, worker_pool

PHYSICS = 'mujoco'
FIRST_SEED = 100


class Rung(NamedTuple):
    """How many settings get how much."""

    settings: int
    episodes: int
    seeds: int


class Candidate(NamedTuple):
    """Settings, and a way of sharing, that are compared."""

    preset: Preset
    sharing: str
    drawn: dict[str, Any]
    """How they differ from those in use."""


@dataclass(frozen=True)
class Subject:
    """Whose settings are searched for."""

    preset: Preset
    """With the settings in use."""
    given: Callable[[Any, dict[str, Any]], Any]
    """The settings with other numbers in them."""
    choices: dict[str, tuple[Any, ...]]
    rungs: tuple[Rung, ...]
    first: tuple[dict[str, Any], ...] = ({},)
    """Compared before what is drawn."""
    tutors: tuple[str | None, ...] = ('predictive', 'bang_bang')
    sharings: tuple[str, ...] = ('additive',)
    """The first is the one in use."""
    tested_every: int = 1
    """Episodes."""

    def candidates(self) -> list[Candidate]:
        """All that is compared, the same each time."""
        random = np.random.default_rng(0)
        drawn = [*self.first]
        while len(drawn) < self.rungs[0].settings:
            drawn.append({name: of[random.integers(len(of))] for name, of in self.choices.items()})
        return [Candidate(replace(self.preset, settings=self.given(self.preset.settings, numbers)),
                          self.sharings[number % len(self.sharings)], numbers) for number, numbers in enumerate(drawn)]


def _network(settings: Any, drawn: dict[str, Any]) -> Any:
    """PPO's settings, with a value function as large as the policy."""
    if not drawn:
        return settings
    return replace(settings, ppo=PpoSettings(**drawn, value_hidden=drawn['hidden']))


_ALONE = {
    'hidden': ((32, 32), (64, 64)),
    'learning_rate': (3e-4, 1e-3, 3e-3, 1e-2),
    'learning_rate_end': (0.0, 1.0),
    'initial_std': (0.4, 0.6, 1.0),
    'std_decay': (0.98, 0.99, 0.995, None),
    'std_min': (0.05, 0.2),
    'noise_seconds': (0.0, 0.5, 1.0, 2.0),
    'gamma': (0.99, 0.995, 0.998),
    'gae_lambda': (0.9, 0.95, 0.98),
    'epochs': (5, 10, 20, 40),
    'batch_size': (64, 125, 250),
    'entropy_weight': (0.0, 0.003, 0.01),
    'max_gradient_norm': (0.5, 5.0),
}
_OFF_POLICY = {
    'hidden': ((32, 32), (64, 64), (128, 128)),
    'learning_rate': (3e-4, 1e-3, 3e-3),
    'batch_size': (64, 128, 256),
    'updates_a_step': (0.5, 1.0, 2.0),
    'gamma': (0.95, 0.98, 0.99),
    'tau': (0.005, 0.02),
    'noise_seconds': (0.0, 0.5),
}
_OFF_POLICY_FIRST = {
    'hidden': (64, 64), 'learning_rate': 1e-3, 'batch_size': 128, 'updates_a_step': 1.0, 'gamma': 0.99, 'tau': 0.005,
    'noise_seconds': 0.5}
"""What was in use before the search."""
_BALANCE = (Rung(16, 6, 1), Rung(5, 10, 2), Rung(2, 10, 6))
SUBJECTS = {
    'alone': Subject(
        replace(ALONE_NETWORK, task=load(TASKS, 'detour')()), _network, _ALONE,
        (Rung(24, 100, 1), Rung(8, 300, 2), Rung(3, 300, 4)),
        ({}, {'hidden': (64, 64), 'initial_std': 1.0, 'std_decay': None, 'learning_rate': 3e-4, 'batch_size': 64}),
        tutors=(None,), tested_every=10),
    'dcoach': Subject(
        DCOACH, lambda settings, drawn: replace(settings, **drawn),
        {'hidden': ((), (16, 16), (32, 32)), 'error': (0.1, 0.25, 0.5, 1.0),
         'learning_rate': (0.001, 0.003, 0.01, 0.03), 'memory': (500, 1000, 3000), 'batch_size': (16, 32, 64),
         'replay_every': (1, 5, 10)}, _BALANCE,
        ({'hidden': (32, 32), 'error': 0.5, 'learning_rate': 0.003, 'memory': 3000, 'batch_size': 32,
          'replay_every': 10},), sharings=('additive', 'override')),
    'pvp': Subject(
        PVP, lambda settings, drawn: replace(settings, **drawn),
        {**_OFF_POLICY, 'exploring_std': (0.05, 0.1, 0.2)}, _BALANCE, ({**_OFF_POLICY_FIRST, 'exploring_std': 0.1},),
        sharings=('override',)),
    'sac_interventions': Subject(
        SAC_INTERVENTIONS, lambda settings, drawn: replace(settings, **drawn),
        {**_OFF_POLICY, 'initial_entropy_weight': (0.01, 0.1, 0.5)}, _BALANCE,
        ({**_OFF_POLICY_FIRST, 'initial_entropy_weight': 0.1},), sharings=('override',)),
}
"""By the argument."""


def run(candidate: Candidate, tutor: str | None, seed: int, episodes: int, tested_every: int,
        folder: Path) -> dict[str, Any]:
    """A policy of ``episodes``, or its result when it was made before; a shorter run goes on."""
    done = folder / f'{episodes}.json'
    if not done.exists():
        task = candidate.preset.task
        training = train(
            candidate.preset, None if tutor is None else tutor_named(tutor, seed), seed, episodes, physics=PHYSICS,
            folder=folder, evaluate_every=tested_every, sharing=Sharing(candidate.sharing))
        test = randomized_test(load_policy(folder / POLICY_NAME).act, task, TEST_SEED + seed, PHYSICS)
        write_json({
            'skilled': training.skilled, 'tests_passed': sum(passed for _, passed in training.tests),
            'successes': test.successes, 'position_error': test.mean_position_error}, done)
    return dict(json.loads(done.read_text()))


def order(runs: list[dict[str, Any]]) -> tuple[float, float]:
    """What settings are sorted by: those with the most successes first, then those that end nearest."""
    return (-float(np.mean([r['successes'] for r in runs])), float(np.mean([r['position_error'] for r in runs])))


def tell(rung: Rung, results: dict[int, list[dict[str, Any]]], candidates: list[Candidate]) -> None:
    """Print a rung, the best first."""
    print(f'{rung.episodes} episodes, seeds {FIRST_SEED} to {FIRST_SEED + rung.seeds - 1}')
    for number in sorted(results, key=lambda n: order(results[n])):
        runs = results[number]
        print(f'  {number:2}, {candidates[number].sharing}: succeed of 20: {[r["successes"] for r in runs]}, '
              f'off at the end, mm: {[round(1e3 * r["position_error"]) for r in runs]}, skilled after: '
              f'{[r["skilled"] for r in runs]}', flush=True)


def search(name: str, pool: ProcessPoolExecutor, output: Path, table: bool) -> None:
    """All rungs of a subject."""
    subject = SUBJECTS[name]
    candidates = subject.candidates()
    left = list(range(len(candidates)))
    print(name)
    for rung in subject.rungs:
        left = left[:rung.settings]
        wanted = [(n, tutor, seed) for seed in range(FIRST_SEED, FIRST_SEED + rung.seeds) for tutor in subject.tutors
                  for n in left]
        folders = {key: output / name / f'{key[0]:02}' / f'{key[1] or "nobody"}-{key[2]}' for key in wanted}
        done = [key for key in wanted if (folders[key] / f'{rung.episodes}.json').exists()]
        is_whole = not table or len(done) == len(wanted)
        wanted = done if table else wanted
        futures = [pool.submit(run, candidates[n], tutor, seed, rung.episodes, subject.tested_every,
                               folders[n, tutor, seed]) for n, tutor, seed in wanted]
        results: dict[int, list[dict[str, Any]]] = {}
        for (n, *_), future in zip(wanted, tqdm(futures, unit='run', disable=None), strict=True):
            results.setdefault(n, []).append(future.result())
        tell(rung, results, candidates)
        if not is_whole:
            print('  more is left to do')
            return
        left = sorted(results, key=lambda n: order(results[n]))
    print(f'best: {left[0]}, {candidates[left[0]].sharing}, {asdict(candidates[left[0]].preset.settings)}')


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('subjects', nargs='*', metavar='NAME', help=f'of {", ".join(SUBJECTS)} (default: all)')
    add_workers(parser)
    parser.add_argument('--output', type=Path, default=Path('out/tune'), metavar='FOLDER', help='folder of the runs')
    parser.add_argument('--table', action='store_true', help='run nothing: print what there is')
    args = parser.parse_args()
    for name in args.subjects:
        if name not in SUBJECTS:
            parser.error(f'no {name}; there are {", ".join(SUBJECTS)}')
    with worker_pool(args.workers) as pool:
        for name in args.subjects or SUBJECTS:
            search(name, pool, args.output, args.table)


if __name__ == '__main__':
    main()
