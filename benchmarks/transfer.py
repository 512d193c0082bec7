"""Policies on arms that are not as they were when they were taught, and how many episodes of teaching bring them back.

Takes the policies that benchmarks/learning.py has left, tests each under each change, and teaches those that do not
pass any more on the changed arm, with a simulated tutor, until they are skilled again (19 of 20, twice in a row). A run
that is stopped goes on when the command is given again.

    python benchmarks/learning.py --conditions guided-expert
    python benchmarks/transfer.py out/learning/guided-expert           # the changes of docs/explanation/learning.md
    python benchmarks/transfer.py out/learning/guided-expert --all --no-teaching
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
from shared_control.command_line import script_parser
from shared_control.env import SharedControlEnv
from shared_control.files import write_atomically
from shared_control.teaching.tutors import make_tutor, tutor_named
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.evaluation.evaluate import TEST_SEED, as_tested
from shared_control_learning.evaluation.statistics import policy_figures
from shared_control_learning.evaluation.transfer import run_transfer
from shared_control_learning.learn import learn
from shared_control_learning.policy_file import POLICY_NAME, load_policy
from shared_control_learning.training import passes_now
from shared_control_sim.changed_plant import ChangedPlant, senses_of
from shared_control_sim.changes import CHANGES, change_named
from tqdm import tqdm
from workers import add_workers, worker_pool

ASKED = ('as taught', 'tray askew by -1 deg', 'tray askew by +1 deg', "FER's inertias in the controller",
         'ball of 0.6 kg', 'friction of 0.5 N m in the joints', 'seen 40 ms late with noise')
TUTOR = 'expert'
TAUGHT_AGAIN = 10
"""Episodes on the changed arm, at most."""


class _UntilSkilled(Callbacks):
    """Tests after every episode; stops at the second test in a row that was passed."""

    def __init__(self, learner: Any, env: SharedControlEnv, seed: int):
        self._learner, self._env, self._seed = learner, env, seed
        self._started = learner.episode
        self._passed = False
        self.skilled: int | None = None

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        passed = passes_now(self._learner, self._env, self._seed)
        if passed and self._passed:
            self.skilled = episode.number - self._started
        self._passed = passed

    def should_stop(self) -> bool:
        """See :class:`Callbacks`."""
        return self.skilled is not None


def again_by(tutor: str) -> str:
    """Under which name a result has what a tutor needed to teach the policy again."""
    return 'again' if tutor == TUTOR else f'again by {tutor}'


def run(folder: Path, change_name: str, tutor: str, teaching: bool) -> dict[str, Any]:
    """One policy under one change: its tests, and what each tutor needed that has taught it again."""
    done = folder / 'transfer' / f'{change_name.replace(" ", "_")}.json'
    result = json.loads(done.read_text()) if done.exists() else {}
    change, seed = change_named(change_name), int(folder.name)
    if not result:
        learner = load_policy(folder / POLICY_NAME)
        figures = policy_figures(run_transfer(
            learner.act, learner.task, seed=TEST_SEED + seed, changes=[change])[0])
        result = {'success': figures['success'], 'error': figures['position_error_settled']}
    if teaching and result['success'] < 0.95 and again_by(tutor) not in result:
        result[again_by(tutor)] = taught_again(folder, change_name, tutor, seed)
    done.parent.mkdir(exist_ok=True)
    write_atomically(done, (json.dumps(result) + '\n').encode())
    return result


def taught_again(folder: Path, change_name: str, tutor: str, seed: int) -> int | None:
    """Episodes of further teaching on the changed arm until it is skilled there; None when they do not suffice."""
    change, learner = change_named(change_name), load_policy(folder / POLICY_NAME)
    task = learner.task
    person = make_tutor(tutor_named(tutor, seed), task, seed, learner.episode)
    env = SharedControlEnv(ChangedPlant(task, change, person), task, senses=senses_of(change))
    test_env = SharedControlEnv(ChangedPlant(task, change), as_tested(task), senses=senses_of(change))
    watch = _UntilSkilled(learner, test_env, seed)
    learn(learner, env, learner.episode + TAUGHT_AGAIN, watch)
    env.close()
    test_env.close()
    return watch.skilled


def tell(change: str, results: list[dict[str, Any]], tutor: str) -> None:
    """Print a change, and how a tutor did."""
    again = [r[again_by(tutor)] for r in results if again_by(tutor) in r]
    known = sorted(float('inf') if n is None else n for n in again)
    print(f'{change}: {sum(r["success"] >= 0.95 for r in results)} of {len(results)} pass, median |error| '
          f'{1e3 * np.median([r["error"] for r in results]):.1f} mm'
          + (f'; taught again: {len(known)}, skilled after {np.median(known):g} episodes (slowest {known[-1]:g})'
             if known else ''), flush=True)


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('folders', type=Path, nargs='+', metavar='FOLDER',
                        help='of a condition of benchmarks/learning.py')
    parser.add_argument('--all', action='store_true', help='every change of "shared-control evaluate"')
    parser.add_argument('--tutor', default=TUTOR, metavar='NAME', help='profile or family that teaches again')
    parser.add_argument('--no-teaching', action='store_true', help='tests alone')
    add_workers(parser)
    args = parser.parse_args()
    changes = [change.name for change in CHANGES] if args.all else ASKED
    with worker_pool(args.workers) as pool:
        for folder in args.folders:
            runs = sorted(path.parent for path in folder.glob(f'*/{POLICY_NAME}'))
            print(f'{folder}: {len(runs)} policies; the tutor is simulated')
            table = {}
            for change in changes:
                futures = [pool.submit(run, path, change, args.tutor, not args.no_teaching) for path in runs]
                table[change] = [future.result() for future in tqdm(futures, desc=change, unit='policy', disable=None)]
                tell(change, table[change], args.tutor)
            write_atomically(folder / 'transfer.json', (json.dumps(table, indent=2) + '\n').encode())


if __name__ == '__main__':
    main()
