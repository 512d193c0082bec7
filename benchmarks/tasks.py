"""What a teacher is worth on each task: episodes to skilled, taught by the simulated expert and alone, beside an LQR.

    nice -n 10 python benchmarks/tasks.py --seeds 24            # all; goes on where it was stopped (out/tasks)
    python benchmarks/tasks.py --conditions detour-taught --seeds 3

- ``taught``: by the simulated expert (its way-points on ``detour``), by the preset of the task.
- ``coached``: the same by the preset ``coached``.
- ``nobody``: the preset of the task with nobody.
- ``alone``: PPO with nobody, a network of 64 x 64 where a linear law is not enough; tested every fifth episode.
- ``LQR``: a linear model fitted by least squares to one episode of random moments, and the linear-quadratic regulator
  of that model to the goal. No learning beyond that episode.
- ``human``: the expert alone, with a robot that gives no moment.

Skilled: 19 of 20 randomised episodes, in two tests in a row. All tutors are simulated.
"""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from learning import median_with_interval, randomized_test, shown
from shared_control.command_line import script_parser, write_json
from shared_control.env import SharedControlEnv
from shared_control.plugins import TASKS, load
from shared_control.seeds import episode_seed
from shared_control.tasks.task import Task, settled
from shared_control.teaching.profiles import EXPERT
from shared_control.teaching.tutors import Who, make_tutor
from shared_control_learning.baselines.lqr import regulator
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.evaluation.evaluate import SUCCESSES_NEEDED, TEST_SEED, Act
from shared_control_learning.learn import run_episode
from shared_control_learning.policy_file import POLICY_NAME, load_policy
from shared_control_learning.presets import AUTONOMOUS, PpoPreset, Preset, preset_for
from shared_control_learning.settings import PpoSettings
from shared_control_learning.training import train
from shared_control_sim.local_plant import LocalPlant
from tqdm import tqdm
from workers import add_workers, worker_pool

TAUGHT_EPISODES = 30
"""At most."""
ALONE_EPISODES = 300
"""At most, as the issue asks."""
ALONE_TESTED_EVERY = 5
ALONE_NETWORK = PpoPreset('autonomous', AUTONOMOUS.task, replace(AUTONOMOUS.settings, ppo=PpoSettings(
    hidden=(64, 64), value_hidden=(64, 64), initial_std=0.6, std_decay=None, learning_rate=3e-3, gamma=0.995,
    entropy_weight=0.003)), taught=False)
"""The best of the search ``benchmarks/tune.py alone``."""


def taught(task: Task, seed: int, folder: Path) -> dict[str, Any]:
    """The preset of the task, with the expert at the keys."""
    return learned(preset_for(task.name), EXPERT, seed, folder)


def coached(task: Task, seed: int, folder: Path) -> dict[str, Any]:
    """The preset ``coached``, with the expert at the keys."""
    return learned(preset_for(task.name, 'coached'), EXPERT, seed, folder)


def nobody(task: Task, seed: int, folder: Path) -> dict[str, Any]:
    """The preset of the task, with nobody at the keys."""
    return learned(preset_for(task.name), None, seed, folder)


def alone(task: Task, seed: int, folder: Path) -> dict[str, Any]:
    """PPO with nobody."""
    chosen: Preset = replace(AUTONOMOUS if task.preset != 'coached_network' else ALONE_NETWORK, task=task)
    return learned(chosen, None, seed, folder, ALONE_EPISODES, ALONE_TESTED_EVERY)


def learned(preset: Preset, tutor: Who | None, seed: int, folder: Path, episodes: int = TAUGHT_EPISODES,
            evaluate_every: int = 1) -> dict[str, Any]:
    """A policy, taught or not, and its randomised test in the end."""
    training = train(preset, tutor, seed, episodes, folder=folder, evaluate_every=evaluate_every)
    learner = load_policy(folder / POLICY_NAME)
    return {'skilled': training.skilled, 'episodes': training.episodes, 'held': training.intervention_rates,
            **final_test(learner.act, learner.task, seed)}


def final_test(act: Act, task: Task, seed: int, callbacks: Callbacks | None = None) -> dict[str, Any]:
    """What is kept of the randomised test of ``act``; ``callbacks`` are called for its episodes."""
    test = randomized_test(act, task, TEST_SEED + seed, callbacks=callbacks)
    return {'successes': test.successes, 'position_error': test.mean_position_error}


class FittedRegulator(Callbacks):
    """``u = moment - gain ([o, u_before] - rest)``; before an episode there was no moment.

    Args:
        gain: (k, n + k), of the observation and the action before.
        rest: (n + k,), what rests at the goal.
        moment: (k,), the action that keeps it there.
    """

    def __init__(self, gain: np.ndarray, rest: np.ndarray, moment: np.ndarray):
        self._gain, self._rest, self._moment = gain, rest, moment
        self._last = np.zeros_like(moment)

    def episode_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._last = np.zeros_like(self._moment)

    def act(self, observation: np.ndarray) -> np.ndarray:
        """The action, (k,), at an observation, (n,)."""
        state = np.concatenate((observation, self._last))
        self._last = np.clip(self._moment - self._gain @ (state - self._rest), -1.0, 1.0)
        return self._last


def fitted_regulator(task: Task, seed: int, folder: Path) -> dict[str, Any]:
    """Least squares on one episode, and the LQR of what was found; the goal is a state of rest."""
    random = np.random.default_rng(seed)
    env = SharedControlEnv(LocalPlant(task), task)
    episode = Episode(task)
    k = len(task.axes)
    action = np.zeros(k)

    def explore(_: np.ndarray) -> np.ndarray:
        nonlocal action
        action = 0.95 * action + 0.3 * random.standard_normal(k)
        return np.clip(action, -1.0, 1.0)

    run_episode(explore, env, episode_seed(seed, 1), episode, Callbacks())
    env.close()
    seen = np.array([*episode.observations, episode.last_observation], float)
    before = np.array([episode.agent[0] * 0.0, *episode.agent[:-1]]) / task.scale
    states = np.hstack((seen[:-1], before))
    given = np.array(episode.agent) / task.scale
    following = np.hstack((seen[1:], given))
    solution, *_ = np.linalg.lstsq(np.hstack((states, given, np.ones((len(states), 1)))), following, rcond=None)
    n = states.shape[1]
    a, b, c = solution[:n].T, solution[n:-1].T, solution[-1]
    # What rests at the goal: x = a x + b u + c with the first numbers, the way to the centre and velocity, given.
    fixed = 2 * k
    wanted = np.zeros(fixed)
    wanted[:k] = -np.array([*task.scene.goal][-k:]) / 0.1 if k > 1 else 0.0
    unknown, *_ = np.linalg.lstsq(
        np.hstack((a[:, fixed:] - np.eye(n)[:, fixed:], b)), (np.eye(n)[:, :fixed] - a[:, :fixed]) @ wanted - c,
        rcond=None)
    rest, moment = np.concatenate((wanted, unknown[:n - fixed])), unknown[n - fixed:]
    weights = np.diag([1.0] * k + [0.3] * k + [0.01] * (n - fixed))
    fitted = FittedRegulator(regulator(a, b, weights, 0.1 * np.eye(k)), rest, moment)
    return {'skilled': None, 'episodes': 1, **final_test(fitted.act, task, seed, fitted)}


def human(task: Task, seed: int, folder: Path) -> dict[str, Any]:
    """The expert alone."""
    env = SharedControlEnv(LocalPlant(task, make_tutor(EXPERT, task, seed)), task)
    episodes = []
    for number in range(1, 6):
        episodes.append(Episode(task, number))
        run_episode(lambda _: np.zeros(len(task.axes)), env, episode_seed(seed, number), episodes[-1], Callbacks())
    env.close()
    return {'skilled': None, 'episodes': 0, 'successes': 4 * sum(episode.success for episode in episodes),
            'position_error': float(np.mean([settled(np.array(e.position_error)) for e in episodes]))}


WAYS = {'taught': taught, 'coached': coached, 'nobody': nobody, 'alone': alone, 'LQR': fitted_regulator,
        'human': human}
CONDITIONS = [f'{task}-{way}' for task in ('balance', 'plate', 'detour') for way in WAYS
              if task != 'detour' or way not in ('coached', 'nobody')]  # its preset learns from corrections


def run(name: str, seed: int, output: Path) -> dict[str, Any]:
    """One run, or its result when it was done before."""
    task, way = name.split('-')
    folder = output / name / f'{seed:03}'
    done = folder / 'result.json'
    if not done.exists():
        result = WAYS[way](load(TASKS, task)(), seed, folder)
        write_json(result, done)
    return dict(json.loads(done.read_text()))


def row(name: str, results: list[dict[str, Any]]) -> str:
    """A line of the table: medians with 95 % intervals, a run that was never skilled counted as infinite."""
    skilled = [np.inf if r['skilled'] is None else r['skilled'] for r in results]
    learns = not name.endswith(('LQR', 'human'))
    episodes = f'{shown(median_with_interval(skilled), 3)}, {max(skilled):g}' if learns else '-'
    passed = sum(r['successes'] >= SUCCESSES_NEEDED for r in results)
    off = median_with_interval([1e3 * r['position_error'] for r in results])
    return f'{name:16} {len(results):>5}  {episodes:22} {passed:>6}  {shown(off, 3)}'


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--conditions', nargs='+', choices=CONDITIONS, default=CONDITIONS, metavar='NAME',
                        help=f'of {", ".join(CONDITIONS)} (default: all)')
    parser.add_argument('--seeds', type=int, default=24, metavar='N', help='runs of each condition')
    add_workers(parser)
    parser.add_argument('--output', type=Path, default=Path('out/tasks'), metavar='FOLDER', help='folder of the runs')
    parser.add_argument('--table', action='store_true', help='run nothing: print what there is')
    args = parser.parse_args()
    results: dict[str, list[dict[str, Any]]] = {name: [] for name in args.conditions}
    wanted = [(name, seed) for seed in range(args.seeds) for name in args.conditions
              if not args.table or (args.output / name / f'{seed:03}' / 'result.json').exists()]
    with worker_pool(args.workers) as pool:
        futures = [pool.submit(run, name, seed, args.output) for name, seed in wanted]
        for (name, _), future in zip(wanted, tqdm(futures, unit='run', disable=None), strict=True):
            results[name].append(future.result())
    print(f'{"":16} {"seeds":>5}  {"episodes, slowest":22} {"passed":>6}  off at the end, mm')
    for name, found in results.items():
        if found:
            print(row(name, found))


if __name__ == '__main__':
    main()
