"""Trained in one physics, tested in the other: whether a policy that was taught in PyBullet does as well in MuJoCo, and
the other way round. The table of docs/how_to/world.md.

    nice -n 10 python benchmarks/engines.py                        # balance, 5 seeds; goes on where it was stopped
    nice -n 10 python benchmarks/engines.py --tasks plate detour

Each policy is taught by the simulated expert until it is skilled, and then has the same randomised test, of 20 episodes
with the same ball starts, in both.
"""

import json
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from learning import randomized_test
from shared_control.command_line import script_parser, write_json
from shared_control.plugins import TASKS, names
from shared_control.tasks.task import settled
from shared_control.teaching.profiles import EXPERT
from shared_control_learning.evaluation.evaluate import TEST_SEED
from shared_control_learning.policy_file import POLICY_NAME, load_policy
from shared_control_learning.presets import preset_for
from shared_control_learning.training import train

PHYSICS = ('bullet', 'mujoco')
EPISODES = 30
"""At most."""


def run(task: str, trained_in: str, seed: int, folder: Path) -> dict[str, Any]:
    """A policy, and its test in each physics; the result of an earlier call when there is one."""
    done = folder / 'result.json'
    if not done.exists():
        training = train(preset_for(task), EXPERT, seed, EPISODES, physics=trained_in, folder=folder)
        result = {'skilled': training.skilled, 'seconds': training.seconds,
                  'tests': {physics: tested(folder, physics, seed) for physics in PHYSICS}}
        write_json(result, done)
    return dict(json.loads(done.read_text()))


def tested(folder: Path, physics: str, seed: int) -> dict[str, list[Any]]:
    """Of each episode of the test: whether it succeeded, and how far off the ball was at the end, m."""
    learner = load_policy(folder / POLICY_NAME)
    episodes = randomized_test(learner.act, learner.task, TEST_SEED + seed, physics).episodes
    return {'success': [bool(episode.success) for episode in episodes],
            'position_error': [float(settled(np.array(episode.position_error))) for episode in episodes]}


def row(task: str, trained_in: str, runs: list[dict[str, Any]]) -> str:
    """A line of the table: a condition's policies in each physics, and how their episodes differ."""
    success, off = ({physics: np.array([run['tests'][physics][figure] for run in runs]) for physics in PHYSICS}
                    for figure in ('success', 'position_error'))
    skilled = ', '.join('-' if run['skilled'] is None else str(run['skilled']) for run in runs)
    cells = [f'{success[p].sum()} of {success[p].size}; {1e3 * off[p].mean():.2f} '
             f'[{1e3 * off[p].mean(axis=1).min():.2f}, {1e3 * off[p].mean(axis=1).max():.2f}]' for p in PHYSICS]
    verdicts = (success['bullet'] != success['mujoco']).sum()
    apart = 1e3 * np.abs(off['bullet'] - off['mujoco'])
    return ' '.join(('|', ' | '.join((
        task, trained_in, skilled, *cells, str(verdicts), f'{np.median(apart):.2f}, {apart.max():.2f}')), '|'))


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--tasks', nargs='+', choices=names(TASKS), default=['balance'], help='what is learned')
    parser.add_argument('--seeds', type=int, default=5, metavar='N', help='policies of each kind')
    parser.add_argument('--output', type=Path, default=Path('out/engines'), metavar='FOLDER',
                        help='folder of the policies')
    args = parser.parse_args()
    print('| task | trained in | episodes to skilled | in PyBullet: succeed; off, mm | in MuJoCo | other verdicts '
          '| an episode differs by, mm: median, most |\n|---|---|---|---|---|---|---|')
    for task, trained_in in product(args.tasks, PHYSICS):
        runs = [run(task, trained_in, seed, args.output / f'{task}-{trained_in}' / f'{seed:03}')
                for seed in range(args.seeds)]
        print(row(task, trained_in, runs), flush=True)


if __name__ == '__main__':
    main()
