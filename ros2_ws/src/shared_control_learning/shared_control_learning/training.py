"""Teaching in process, without a graph: what ``shared-control train`` and studies run."""

import json
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from shared_control.env import BalanceEnv
from shared_control.files import write_atomically
from shared_control.seeds import episode_seed
from shared_control.teaching.profiles import TutorProfile
from shared_control.teaching.tutor import SimulatedTutor
from shared_control_sim.local_plant import LocalPlant
from stable_baselines3.common.logger import configure

from .callbacks import Hooks
from .episode_ppo import EpisodePPO
from .episode_table import TABLE_NAME, EpisodeTable
from .evaluation.evaluate import passes, test_settings
from .learn import learn, make_learner
from .policy_file import POLICY_NAME, load_policy, save_policy
from .presets import Preset
from .record import EpisodeRecord

RUN_NAME = 'run.json'
TENSORBOARD_NAME = 'tensorboard'

TEST_SEED = 1_000_000
"""Added to the run's seed: tests draw other ball starts than the teaching."""


class TrainingError(ValueError):
    """A folder holds no run, or another one than was asked for; the message says which."""


@dataclass
class TrainingRun:
    """What was taught, by whom, and how well it went."""

    preset: str
    tutor: dict[str, Any] | None
    """The tutor's profile; None when there was nobody."""
    seed: int
    human_only: bool = False
    """The agent's moment was not applied (4.7)."""
    tests: list[tuple[int, bool]] = field(default_factory=list)
    """After how many episodes the policy was tested alone, and whether it passed."""
    returns: list[float] = field(default_factory=list)
    """Of each episode, unscaled."""
    intervention_rates: list[float] = field(default_factory=list)
    """Part of each episode in which the human held a moment, 0..1."""
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


def train(preset: Preset, tutor: TutorProfile | None, seed: int, episodes: int, *, until_skilled: bool = True,
          human_only: bool = False, folder: Path | None = None, tensorboard: bool = False,
          evaluate_every: int = 1, hooks: Hooks | None = None) -> TrainingRun:
    """Teach a policy in this process, by a simulated tutor or by nobody.

    A run that was stopped goes on from its folder, and ends as if it had never stopped.

    Args:
        preset: what is learned, and how.
        tutor: who helps; nobody when None.
        seed: of weights, exploration, ball starts and tutor.
        episodes: at most so many, those of an earlier part of the run included.
        until_skilled: stop when the policy has passed two tests in a row.
        human_only: the agent's moment is not applied (4.7).
        folder: for policy, table and run; nothing is kept when None.
        tensorboard: write logs for TensorBoard there, too.
        evaluate_every: test after so many episodes each, 0: never.
        hooks: are told of the episodes, each after its test.

    Raises:
        TrainingError: ``folder`` holds another run.
        PolicyFileError: ``folder`` holds an unusable policy.
    """
    run = TrainingRun(preset.name, None if tutor is None else asdict(tutor), seed, human_only)
    learner = make_learner(preset, seed)
    if folder is not None:
        learner, run = _resumed(learner, run, folder)
        if tensorboard:
            learner.set_logger(configure(str(folder / TENSORBOARD_NAME), ['tensorboard']))
    person = None if tutor is None else SimulatedTutor(tutor, seed, learner.episode)
    env = BalanceEnv(LocalPlant(person, preset.task.moment_limit), preset.task, human_only)
    test_env = BalanceEnv(LocalPlant(None, preset.task.moment_limit), test_settings(preset.task))
    try:
        learn(learner, env, episodes, _Keeper(
            learner, run, folder, test_env, evaluate_every, until_skilled, hooks or Hooks()))
    finally:
        env.close()
        test_env.close()
    return run


def passes_now(learner: EpisodePPO, test_env: BalanceEnv, seed: int) -> bool:
    """Whether the learner of the run ``seed`` passes the test that belongs to the episodes it has learned from."""
    return passes(learner.act, test_env, episode_seed(TEST_SEED + seed, learner.episode))


def read_run(folder: Path) -> TrainingRun:
    """The run in ``folder``, as far as it got.

    Raises:
        TrainingError: there is none, or it cannot be read.
    """
    path = folder / RUN_NAME
    try:
        stored = json.loads(path.read_text())
        stored['tests'] = [(int(episode), bool(passed)) for episode, passed in stored['tests']]
        return TrainingRun(**stored)
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise TrainingError(f'{path} is no run: {error}') from error


def _resumed(learner: EpisodePPO, run: TrainingRun, folder: Path) -> tuple[EpisodePPO, TrainingRun]:
    """The learner and the run in ``folder``, or those given when there are none yet."""
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / POLICY_NAME).exists():
        _write_run(run, folder)  # from now on the folder is known as a run's, however early this one is killed
        return learner, run
    stored = read_run(folder)
    for name in ('preset', 'tutor', 'seed', 'human_only'):
        if getattr(stored, name) != getattr(run, name):
            raise TrainingError(f'{folder} holds a run with {name} {getattr(stored, name)!r}, asked for '
                                f'{getattr(run, name)!r}: name another folder')
    learner = load_policy(folder / POLICY_NAME)
    # The policy is written last: an episode that it has not learned from is taught anew.
    stored.tests = [test for test in stored.tests if test[0] <= learner.episode]
    stored.returns = stored.returns[:learner.episode]
    stored.intervention_rates = stored.intervention_rates[:learner.episode]
    return learner, stored


def _write_run(run: TrainingRun, folder: Path) -> None:
    write_atomically(folder / RUN_NAME, (json.dumps(asdict(run), indent=2) + '\n').encode())


class _Keeper(Hooks):
    """Tests, keeps and tells after each episode."""

    def __init__(self, learner: EpisodePPO, run: TrainingRun, folder: Path | None, test_env: BalanceEnv,
                 evaluate_every: int, until_skilled: bool, watcher: Hooks):
        self._learner, self._run, self._folder, self._test_env = learner, run, folder, test_env
        self._evaluate_every, self._until_skilled, self._watcher = evaluate_every, until_skilled, watcher
        self._started = time.monotonic() - run.seconds
        if folder is not None:
            self._table = EpisodeTable(folder / TABLE_NAME, learner.episode)

    def stop(self) -> bool:
        """See :class:`Hooks`."""
        return (self._until_skilled and self._run.skilled is not None) or self._watcher.stop()

    def episode_started(self, record: EpisodeRecord) -> None:
        """See :class:`Hooks`."""
        self._watcher.episode_started(record)

    def stepped(self, record: EpisodeRecord) -> None:
        """See :class:`Hooks`."""
        self._watcher.stepped(record)

    def episode_learned(self, record: EpisodeRecord) -> None:
        """See :class:`Hooks`."""
        run = self._run
        run.returns.append(record.episode_return)
        run.intervention_rates.append(record.intervention_rate)
        if self._evaluate_every and record.episode % self._evaluate_every == 0:
            run.tests.append((record.episode, passes_now(self._learner, self._test_env, run.seed)))
        run.seconds = time.monotonic() - self._started
        if self._folder is not None:
            self._keep(record, self._folder)
        self._watcher.episode_learned(record)

    def _keep(self, record: EpisodeRecord, folder: Path) -> None:
        self._table.append(record)
        _write_run(self._run, folder)
        save_policy(self._learner, folder / POLICY_NAME)
        logger = self._learner.logger
        for name, value in record.row().items():
            if not isinstance(value, str):
                logger.record(f'episode/{name}', value)
        for episode, passed in self._run.tests[-1:]:
            if episode == record.episode:
                logger.record('test/passed', float(passed))
        logger.dump(record.episode)
