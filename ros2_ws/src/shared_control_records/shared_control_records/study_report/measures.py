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

"""What the report says of one run, as numbers; and a study's runs by condition."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import pandas as pd
from shared_control.tasks.task import Task
from shared_control.wrench import AXIS_NAMES
from shared_control_learning.evaluation.result import CHECKPOINT, TRANSFER, ProtocolResult
from shared_control_learning.presets import preset_for
from shared_control_sim.changes import AS_TAUGHT

from ..study.folder import StudyFolder
from ..study.plan import Condition, Plan, load_plan
from ..study.result import ResultError, RunResult, check_result, load_result
from .participants import excluded_participants
from .statistics import Times

Row = dict[str, float | int | str | bool | None]
BEST = 5
"""Runs of a condition that the thesis compares (4.1)."""


@dataclass(frozen=True)
class Study:
    """What there is of a study."""

    plan: Plan
    runs: tuple[RunResult, ...]
    """Those that are done."""
    problems: tuple[str, ...]
    """Results that cannot be read."""
    excluded: dict[int, str]
    """Participants whose runs are left out, and why."""

    @property
    def conditions(self) -> tuple[str, ...]:
        """Names, in the plan's order; those with runs."""
        return tuple(c.name for c in self.plan.conditions if self.of(c.name))

    def of(self, condition: str) -> list[RunResult]:
        """The runs of a condition, by participant."""
        return sorted((run for run in self.runs if run.condition == condition), key=lambda run: run.participant)

    def best(self, condition: str, count: int | None = BEST) -> list[RunResult]:
        """The best runs of a condition, best first; all when ``count`` is None.

        By least mean |position error| in the perturbation test, which lasts 30 s as the test does by which the thesis
        ranks (4.1). Without that test, by the last return. Runs without a policy come last.
        """
        return sorted(self.of(condition), key=self._badness)[:count]

    @property
    def missing(self) -> int:
        """How many runs are not done, or cannot be read."""
        return sum(job.participant.number not in self.excluded for job in self.plan.jobs) - len(self.runs)

    def task(self, condition: str) -> Task:
        """What is learned in a condition."""
        return _task(next(c for c in self.plan.conditions if c.name == condition))

    def lost(self, run: RunResult) -> float:
        """What the position error of a run counts as once the ball has fallen, m; see :func:`lost_error`."""
        return lost_error(self.task(run.condition))

    def _badness(self, run: RunResult) -> float:
        if not run.episodes:
            return math.inf
        test = run.tests.get('perturbation')
        return -run.episodes[-1]['return'] if test is None else float(away(test, self.lost(run)).mean())


def load_study(folder: StudyFolder) -> Study:
    """All finished runs of a study; one that cannot be read is left out and said, as are those of who is excluded.

    Raises:
        PlanError: the plan is damaged.
        ValueError: the notes on a participant are.
    """
    plan = load_plan(folder.plan)
    excluded = excluded_participants(folder, plan)
    runs, problems = [], []
    for job in plan.jobs:
        if job.participant.number in excluded:
            continue
        try:
            run = load_result(folder.run(job))
            if run is not None:
                check_result(run, job, plan.people is None, folder.run(job))
        except ResultError as error:
            problems.append(str(error))
            continue
        if run is not None:
            runs.append(run)
    return Study(plan, tuple(runs), tuple(problems), excluded)


def run_table(study: Study) -> pd.DataFrame:
    """A row a run: who, what, and the measures of the tests; errors in cm and cm/s."""
    return pd.DataFrame([_row(run, study.lost(run)) if run.episodes else
                         {**_about(run), **_lost_measures(study.plan, study.lost(run))} for run in study.runs])


def times(runs: list[RunResult]) -> Times:
    """Episodes to skilled; who never was is censored at the last episode."""
    return Times(np.array([run.skilled or len(run.episodes) for run in runs], float),
                 np.array([run.skilled is not None for run in runs], bool))


def lost_error(task: Task) -> float:
    """What the position error counts as once the ball has fallen, m: where the tray ends, farthest from the goal."""
    scene = task.scene
    ends = np.array([scene.half_length, scene.half_width]) + np.abs(scene.goal)
    moved = (('m_y', 0), ('m_x', 1))  # a moment about y moves the ball along x
    along = [axis for name, axis in moved if AXIS_NAMES.index(name) in task.axes]
    return float(np.linalg.norm(ends[along]))


def away(test: ProtocolResult, lost: float) -> np.ndarray:
    """|position error| of every episode and step, a fallen ball ``lost`` m off; (episodes, steps), m."""
    return np.nan_to_num(np.abs(test.position_error), nan=lost)


def trajectories(run: RunResult) -> list[ProtocolResult]:
    """The tests on a moving tray, slowest first."""
    return [test for name, test in run.tests.items() if name.startswith('trajectory')]


def transfers(run: RunResult) -> list[ProtocolResult]:
    """The tests on arms that are not as taught."""
    return [test for name, test in run.tests.items()
            if name.startswith(TRANSFER) and name != TRANSFER + AS_TAUGHT.name]


def _about(run: RunResult) -> Row:
    return {
        'condition': run.condition, 'taught': run.taught, 'participant': run.participant, 'group': run.group,
        'simulated': run.simulated,
        'seed': run.seed, 'episodes': len(run.episodes), 'first_pass': run.first_pass, 'skilled': run.skilled,
        'seconds': run.seconds, 'workload': float(np.mean(list(run.tlx.values()))) if run.tlx else None}


def _lost_measures(plan: Plan, lost: float) -> Row:
    """The measures of a run that left no policy: it fails in every test, its ball where the tray ends."""
    of_tests: dict[str, Row] = {
        'randomized': {'kept': 0.0, 'success': 0.0, 'alone_error': 100 * lost},
        'perturbation': {'kept': 0.0, 'pushed_error': 100 * lost, 'pushed_kept': 0.0},
        'trajectory': {'kept': 0.0, 'moving_error': 100 * lost, 'moving_kept': 0.0}, 'transfer': {'elsewhere': 0.0}}
    return {name: value for test in plan.tests for name, value in of_tests[test].items()}


def _row(run: RunResult, lost: float) -> Row:
    fallen = [fell for name, test in run.tests.items() if not name.startswith((TRANSFER, CHECKPOINT))
              for fell in test.fallen]
    row: Row = {
        **_about(run), 'kept': 1.0 - float(np.mean(fallen)) if fallen else None,
        'human_share_first': run.episodes[0].get('human_share'),
        'human_share_last': run.episodes[-1].get('human_share'),
        'human_variance': _variance(run, 'std_human'), 'agent_variance': _variance(run, 'std_agent')}
    alone = run.tests.get('randomized')
    if alone is not None:
        row['success'] = float(alone.success.mean())
        row['alone_error'] = 100 * float(away(alone, lost)[:, -150:].mean())
        row['manipulability'] = float(np.nanmean(alone.manipulability))
    pushed = run.tests.get('perturbation')
    if pushed is not None:
        row['pushed_error'] = 100 * float(away(pushed, lost).mean())
        row['pushed_kept'] = float(not pushed.fallen.any())
    if moving := trajectories(run):
        row['moving_error'] = 100 * float(np.mean([away(test, lost).mean() for test in moving]))
        row['moving_kept'] = float(np.mean([not test.fallen.any() for test in moving]))
    if elsewhere := transfers(run):
        row['elsewhere'] = float(np.mean([test.success.mean() for test in elsewhere]))
    return row


@cache
def _task_of(task: str, preset: str) -> Task:
    return preset_for(task, preset).task


def _task(condition: Condition) -> Task:
    return _task_of(condition.task, condition.preset)


def _variance(run: RunResult, column: str) -> float | None:
    """Mean over the episodes of the variance of a moment within an episode, (N m)^2."""
    values = [episode[column] ** 2 for episode in run.episodes if column in episode]
    return float(np.mean(values)) if values else None
