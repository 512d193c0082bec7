# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Teaching in process, without a graph: what ``shared-control train`` and studies run."""

import json
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ConfigDict, TypeAdapter, with_config
from shared_control.control.sharing import ADDITIVE, Sharing
from shared_control.env import SharedControlEnv
from shared_control.files import write_atomically
from shared_control.plugins import WORLDS, load
from shared_control.seeds import episode_seed
from shared_control.teaching.picture import can_teach
from shared_control.teaching.tutors import Who, make_tutor
from shared_control_sim.local_plant import LocalPlant
from stable_baselines3.common.logger import Logger, configure

from .callbacks import Callbacks
from .episode import Episode
from .episode_table import TABLE_NAME, EpisodeTable
from .evaluation.evaluate import as_tested, passes
from .evaluation.parallel_test import ParallelTest
from .learn import learn
from .learner import Learner
from .policy_file import POLICY_NAME, load_policy, save_policy
from .presets import Preset
from .wrong_content import what_is_wrong

RUN_NAME = 'run.json'
TENSORBOARD_NAME = 'tensorboard'

TEST_OFFSET = 1_000_000
"""Added to the run's seed: tests draw other ball starts than the teaching."""


class TrainingError(ValueError):
    """A folder holds no run, or another one than was asked for; the message says which."""


@with_config(ConfigDict(extra='forbid'))
@dataclass
class TrainingRun:
    """What was taught, by whom, and how well it went."""

    preset: str
    tutor: dict[str, Any] | None
    """The tutor's profile, or the individual; None when there was nobody."""
    seed: int
    human_only: bool = False
    """The agent's moment was not applied (4.7)."""
    physics: str = 'bullet'
    """What it was taught and tested in."""
    sharing: str = ADDITIVE.way
    """What counted of the two moments (:mod:`shared_control.control.sharing`)."""
    tests: list[tuple[int, bool]] = field(default_factory=list)
    """After how many episodes the policy was tested alone, and whether it passed."""
    returns: list[float] = field(default_factory=list)
    """Return of each episode, unscaled."""
    intervention_rates: list[float] = field(default_factory=list)
    """Part of each episode in which the human held a moment, 0..1."""
    presses: list[int] = field(default_factory=list)
    """How often the human's moment changed in each episode."""
    interventions: list[int] = field(default_factory=list)
    """How often the human began to hold a moment in each episode."""
    noise_shares: list[float] = field(default_factory=list)
    """What part of the moments of each episode was exploring (:meth:`.episode.Episode.noise_share`), 0..1."""
    seconds: float = 0.0
    """Wall time spent."""

    @property
    def episodes(self) -> int:
        """Episodes taught."""
        return len(self.returns)

    @property
    def first_pass(self) -> int | None:
        """Episodes taught when the policy passed for the first time; None: not yet."""
        return next((episode for episode, passed in self.tests if passed), None)

    @property
    def skilled(self) -> int | None:
        """Episodes to skilled: those taught when the policy had passed twice in a row; None: not yet."""
        pairs = zip(self.tests, self.tests[1:], strict=False)
        return next((episode for (_, before), (episode, now) in pairs if before and now), None)


_TRAINING_RUN = TypeAdapter(TrainingRun)


def train(preset: Preset, tutor: Who | None, seed: int, episodes: int, *, until_skilled: bool = True,
          human_only: bool = False, physics: str = 'bullet', folder: Path | None = None, tensorboard: bool = False,
          evaluate_every: int = 1, sharing: Sharing = ADDITIVE, callbacks: Callbacks | None = None,
          processes: int = 1) -> TrainingRun:
    """Teach a policy in this process, by a simulated tutor or by nobody.

    A run that was stopped goes on from its folder, and ends as if it had never stopped.

    Args:
        preset: what is learned, and how.
        tutor: who helps; nobody when None.
        seed: of weights, exploration, ball starts and tutor.
        episodes: at most so many, those of an earlier part of the run included.
        until_skilled: stop when the policy has passed two tests in a row.
        human_only: the agent's moment is not applied (4.7).
        physics: its name (entry point of the group ``shared_control.worlds``).
        folder: for policy, table and run; nothing is kept when None.
        tensorboard: write logs for TensorBoard there, too.
        evaluate_every: test after so many episodes each, 0: never.
        sharing: what counts of the two moments.
        callbacks: called for the episodes, each after its test.
        processes: test by so many at once, five at the most, with the same results. A script that asks for more than
            one must be guarded by ``if __name__ == '__main__'``.

    Raises:
        TrainingError: ``folder`` holds another run, or one whose policy is missing.
        PolicyFileError: ``folder`` holds an unusable policy, or what was learned is too large for one.
        ValueError: it cannot be done (:func:`new_learner`).
    """
    learner = new_learner(preset, tutor, seed, physics, sharing)
    run = TrainingRun(
        preset.name, None if tutor is None else asdict(tutor), seed, human_only, physics, sharing.way)
    if folder is not None:
        learner, run = _resumed(learner, run, folder)
    person = None if tutor is None else make_tutor(tutor, preset.task, seed, learner.episode)
    env = SharedControlEnv(LocalPlant(preset.task, person, physics, sharing=sharing), preset.task, human_only)
    test_env = SharedControlEnv(LocalPlant(preset.task, physics=physics), as_tested(preset.task))
    helpers = ParallelTest(preset.task, physics, processes) if processes > 1 and evaluate_every else None
    try:
        learn(learner, env, episodes, _Keeper(
            learner, run, folder, tensorboard, test_env, helpers, evaluate_every, until_skilled,
            callbacks or Callbacks()))
    finally:
        if helpers is not None:
            helpers.close()
        env.close()
        test_env.close()
    return run


def new_learner(preset: Preset, tutor: Who | None, seed: int, physics: str = 'bullet',
                sharing: Sharing = ADDITIVE) -> Learner:
    """A learner that has learned nothing yet, for a run that can be done; arguments as those of :func:`train`.

    Raises:
        ValueError: it cannot be done: the preset does not learn such a task, it cannot be shared like this, there is no
            such physics, or there is a tutor and the task has other axes than tutors know.
    """
    preset.check(sharing)
    if tutor is not None and not can_teach(preset.task):
        raise ValueError(f'simulated tutors do not know the axes of the task {preset.task.name}: train without one')
    load(WORLDS, physics)
    return preset.make(seed)


def passes_now(learner: Learner, test_env: SharedControlEnv, seed: int, helpers: ParallelTest | None = None) -> bool:
    """Whether the learner of the run ``seed`` passes the test that belongs to the episodes it has learned from."""
    test = episode_seed(TEST_OFFSET + seed, learner.episode)
    return passes(learner.act, test_env, test) if helpers is None else helpers.passes(learner, test_env, test)


def read_run(folder: Path) -> TrainingRun:
    """The run in ``folder``, as far as it got.

    Raises:
        TrainingError: there is none, or it cannot be read.
    """
    path = folder / RUN_NAME
    try:
        return _TRAINING_RUN.validate_json(path.read_bytes())
    except (OSError, ValueError) as error:
        raise TrainingError(f'{path} is no run: {what_is_wrong(error)}') from error


def _resumed(learner: Learner, run: TrainingRun, folder: Path) -> tuple[Learner, TrainingRun]:
    """The learner and the run in ``folder``, or those given when there are none yet."""
    folder.mkdir(parents=True, exist_ok=True)
    policy = folder / POLICY_NAME
    if not policy.exists() and not (folder / RUN_NAME).exists():
        _write_run(run, folder)  # from now on the folder is known as a run's, however early this one is killed
        return learner, run
    stored = read_run(folder)
    for name in ('preset', 'tutor', 'seed', 'human_only', 'physics', 'sharing'):
        _check_same(folder, name, getattr(stored, name), getattr(run, name))
    if not policy.exists():
        if stored.episodes > 1:  # the first is written down a moment before its policy is, and can be taught again
            raise TrainingError(f'{policy} is missing, though {folder / RUN_NAME} has {stored.episodes} episodes: put '
                                'it back, or begin anew in another folder or by --overwrite')
        return learner, run
    asked, learner = learner, load_policy(policy)
    _check_same(folder, 'task', learner.task.name, asked.task.name)
    # The policy is written last: an episode that it has not learned from is taught anew.
    stored.tests = [test for test in stored.tests if test[0] <= learner.episode]
    for figures in (stored.returns, stored.intervention_rates, stored.presses, stored.interventions,
                    stored.noise_shares):
        del figures[learner.episode:]
    return learner, stored


def _check_same(folder: Path, what: str, stored: object, asked: object) -> None:
    if stored != asked:
        raise TrainingError(f'{folder} holds a run with {what} {stored!r}, asked for {asked!r}: ask for the same, or '
                            'name another folder')


def _write_run(run: TrainingRun, folder: Path) -> None:
    write_atomically(folder / RUN_NAME, (json.dumps(asdict(run), indent=2) + '\n').encode())


class _Keeper(Callbacks):
    """Tests, keeps and passes on after each episode."""

    def __init__(self, learner: Learner, run: TrainingRun, folder: Path | None, tensorboard: bool,
                 test_env: SharedControlEnv, helpers: ParallelTest | None, evaluate_every: int, until_skilled: bool,
                 watcher: Callbacks):
        self._learner, self._run, self._folder = learner, run, folder
        self._test_env, self._helpers = test_env, helpers
        self._evaluate_every, self._until_skilled, self._watcher = evaluate_every, until_skilled, watcher
        self._started = time.monotonic() - run.seconds
        self._logger = configure(str(folder / TENSORBOARD_NAME), ['tensorboard']) if folder and tensorboard else None
        self._noise_share = 0.0
        """What of the last episode was exploring."""
        if folder is not None:
            self._table = EpisodeTable(folder / TABLE_NAME, learner.episode)

    def should_stop(self) -> bool:
        """See :class:`Callbacks`."""
        return (self._until_skilled and self._run.skilled is not None) or self._watcher.should_stop()

    def episode_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._watcher.episode_started(episode)

    def stepped(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._watcher.stepped(episode)

    def learning_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._noise_share = episode.noise_share(self._learner.act)
        self._watcher.learning_started(episode)

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        run = self._run
        run.returns.append(episode.episode_return)
        run.intervention_rates.append(episode.intervention_rate)
        run.presses.append(episode.presses)
        run.interventions.append(episode.interventions)
        run.noise_shares.append(self._noise_share)
        if self._evaluate_every and episode.number % self._evaluate_every == 0:
            run.tests.append((episode.number, passes_now(self._learner, self._test_env, run.seed, self._helpers)))
        run.seconds = time.monotonic() - self._started
        if self._folder is not None:
            self._table.append(episode)
            _write_run(run, self._folder)
            save_policy(self._learner, self._folder / POLICY_NAME)
        if self._logger is not None:
            self._log(self._logger, episode, figures)
        self._watcher.episode_learned(episode, figures)

    def _log(self, logger: Logger, episode: Episode, figures: dict[str, float]) -> None:
        for name, value in {f'episode/{name}': value for name, value in episode.row().items()}.items():
            if not isinstance(value, str):
                logger.record(name, value)
        for name, figure in figures.items():
            logger.record(name, figure)
        for number, passed in self._run.tests[-1:]:
            if number == episode.number:
                logger.record('test/passed', float(passed))
        logger.dump(episode.number)
