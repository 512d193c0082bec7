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

"""One run of a study: train, test, keep the result."""

import shlex
import time
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

from shared_control.control.sharing import Sharing
from shared_control.files import write_atomically
from shared_control.seeds import episode_seed
from shared_control.verdict import Verdict
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.episode_table import BROKEN_OFF, TABLE_NAME, TEXTS, read_rows
from shared_control_learning.evaluation.evaluate import SUCCESSES_NEEDED, TEST_EPISODES, TEST_SEED
from shared_control_learning.evaluation.result import ProtocolResult, checkpoint
from shared_control_learning.evaluation.run import run_protocol
from shared_control_learning.policy_file import POLICY_NAME, SUFFIX, load_policy
from shared_control_learning.presets import preset_for
from shared_control_learning.training import train

from ..session.final_test import load_test
from ..session.folder import SessionFolder
from .folder import StudyFolder
from .plan import Job, Plan, load_plan
from .progress import Progress
from .result import RunResult, describe, is_done, save_result


def run_job(folder: StudyFolder, name: str) -> None:
    """Do the run called ``name`` and keep its result; one that was killed goes on where it was.

    All that is random follows from the participant's seed, so it makes no difference where and when it runs.

    Raises:
        ValueError: there is no such run, or a file of it is damaged.
        OSError: its folder cannot be written.
    """
    plan = load_plan(folder.plan)
    job = next((job for job in plan.jobs if job.name == name), None)
    if job is None:
        raise ValueError(f'{folder.plan} has no run {name!r}')
    path = folder.run(job)
    if is_done(path):
        return
    path.mkdir(parents=True, exist_ok=True)
    result = taught_by_a_person if plan.people is not None and job.condition.taught else trained
    save_result(result(folder, plan, job), path)


def trained(folder: StudyFolder, plan: Plan, job: Job) -> RunResult:
    """Train with a simulated tutor or alone, then test."""
    path = folder.run(job)
    keeper = _Checkpoints(path, plan.checkpoints)
    training = train(
        preset_for(job.condition.task, job.condition.preset),
        job.participant.tutor if job.condition.taught else None, job.participant.seed, job.condition.episodes,
        until_skilled=True, physics=job.condition.physics, folder=path, evaluate_every=job.condition.evaluate_every,
        sharing=Sharing(job.condition.sharing), callbacks=keeper)
    tested = time.monotonic()
    tests = run_tests(plan, job, path / POLICY_NAME) | keeper.run_tests(plan, job)
    testing = time.monotonic() - tested
    episodes = learned_from(read_table(path / TABLE_NAME))
    if len(training.presses) == len(episodes):  # not of a run that an older version began
        for number, row in enumerate(episodes):
            row |= {'presses': training.presses[number], 'interventions': training.interventions[number],
                    'noise_share': training.noise_shares[number]}
    return RunResult(
        **describe(job, plan.people is None), first_pass=training.first_pass, skilled=training.skilled,
        episodes=episodes, tests=tests, seconds=training.seconds + testing)


class _Checkpoints(Callbacks):
    """Keeps the policies after some episodes, and tests them in the end.

    Args:
        folder: of the run, where the policy is, too.
        episodes: after how many.
    """

    def __init__(self, folder: Path, episodes: tuple[int, ...]):
        self._kept = {number: folder / f'after_{number}_episodes{SUFFIX}' for number in episodes}
        self._policy = folder / POLICY_NAME

    def episode_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`; the policy on disk is that of the episode before."""
        kept = self._kept.get(episode.number - 1)
        if kept is not None and not kept.exists():
            write_atomically(kept, self._policy.read_bytes())

    def run_tests(self, plan: Plan, job: Job) -> dict[str, ProtocolResult]:
        """The randomised test of the policies that were kept, by name."""
        found = {}
        for number, path in self._kept.items():
            if path.exists():
                learner = load_policy(path)
                [result] = run_protocol('randomized', learner.act, learner.task, seed=seed_of_tests(plan, job),
                                        physics=job.condition.tested_in or job.condition.physics)
                found[checkpoint(number)] = replace(result, test=checkpoint(number))
        return found


def seed_of_tests(plan: Plan, job: Job) -> int:
    """Seed of the tests of a run's policies.

    The same in all conditions, which are compared in pairs; another one in a study of another seed: what is chosen in
    one (studies/baselines_tuning.yaml) is not reported on the same ball starts in another.
    """
    return episode_seed(TEST_SEED + plan.seed, job.participant.number)


def taught_by_a_person(folder: StudyFolder, plan: Plan, job: Job) -> RunResult:
    """Test what a person has taught. The person said when; skilled is who then passed the session's test.

    Who taught to the end and left no policy, since every episode was discarded or they were done before the first, has
    a run like everybody else: of no episodes and without tests, which the report counts as lost.

    Raises:
        ValueError: table and policy of the session do not belong together, or one of its files is damaged.
        OSError: one is missing.
    """
    session = SessionFolder.open(folder.session(job))
    rows = read_table(session.episodes)
    episodes = learned_from(rows)
    if bool(episodes) != session.policy.exists():
        raise ValueError(f'{session.episodes} and {session.policy} do not belong together: the one has '
                         f'{len(episodes)} episodes that were learned from, the other is '
                         f'{"missing" if episodes else "there"}; take both from a back-up')
    test = load_test(session.test) if episodes else None
    if episodes and test is None:
        raise FileNotFoundError(
            f'{session.test} is missing: shared-control session --resume {shlex.quote(str(session.path))} tests again')
    passed = test is not None and test.successes >= len(test.episodes) * SUCCESSES_NEEDED / TEST_EPISODES
    return RunResult(
        **describe(job, simulated=False), first_pass=None, skilled=len(episodes) if passed else None,
        episodes=episodes, tests=run_tests(plan, job, session.policy) if episodes else {},
        seconds=sum(row['seconds'] + row['learn_seconds'] for row in rows),
        tlx=Progress.of(folder.person(job.participant)).tlx.get(job.condition.name))


def run_tests(plan: Plan, job: Job, policy: Path) -> dict[str, ProtocolResult]:
    """What the plan has every policy go through, by name."""
    learner = load_policy(policy)
    task, physics = learner.task, job.condition.tested_in or job.condition.physics
    results = [result for name in plan.tests
               for result in run_protocol(name, learner.act, task, seed=seed_of_tests(plan, job), physics=physics)]
    return {result.test: result for result in results}


def read_table(path: Path) -> list[dict[str, Any]]:
    """Episodes of teaching in an ``episodes.csv``, also those discarded or broken off; numbers as numbers.

    Raises:
        ValueError: it is no table of episodes; the message names it.
    """
    return [{key: value if key in TEXTS else float(value) for key, value in row.items()}
            for row in read_rows(path) if row['phase'] in ('teach', BROKEN_OFF)]


def learned_from(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows of a table whose episodes the robot has learned from: one for each number.

    What is discarded before the next episode begins is unlearned and done again, and does not count. What is discarded
    later is labelled alone (docs/contract.md, Verdicts): the robot keeps it, and it counts.
    """
    return [row for row, after in zip_longest(rows, rows[1:]) if row['phase'] == 'teach' and not (
        row.get('verdict') == Verdict.DISCARD and (after is None or after['episode'] == row['episode']))]
