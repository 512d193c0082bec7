"""What the report says of one run, as numbers; and a study's runs by condition."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from shared_control.tasks.balance import BALANCE
from shared_control_learning.evaluation.result import ProtocolResult

from ..study.folder import StudyFolder
from ..study.plan import Plan, load_plan
from ..study.result import ResultError, RunResult, load_result
from .statistics import Times

TRAY_END = BALANCE.scene.half_length
"""m: what the position error counts as once the ball has fallen; the tray ends there."""
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
        ranks (4.1). Without that test, by the last return.
        """
        return sorted(self.of(condition), key=_badness)[:count]


def load_study(folder: StudyFolder) -> Study:
    """All finished runs of a study; one that cannot be read is left out and said.

    Raises:
        PlanError: the plan is damaged.
    """
    plan = load_plan(folder.plan)
    runs, problems = [], []
    for job in plan.jobs:
        try:
            run = load_result(folder.run(job))
        except ResultError as error:
            problems.append(str(error))
            continue
        if run is not None:
            runs.append(run)
    return Study(plan, tuple(runs), tuple(problems))


def run_table(study: Study) -> pd.DataFrame:
    """A row a run: who, what, and the measures of the tests; errors in cm and cm/s."""
    return pd.DataFrame([_row(run) for run in study.runs])


def times(runs: list[RunResult]) -> Times:
    """Episodes to skilled; who never was is censored at the last episode."""
    return Times(np.array([run.skilled or len(run.episodes) for run in runs], float),
                 np.array([run.skilled is not None for run in runs], bool))


def away(test: ProtocolResult) -> np.ndarray:
    """|position error| of every episode and step, a fallen ball at the tray's end; (episodes, steps), m."""
    return np.nan_to_num(np.abs(test.position_error), nan=TRAY_END)


def trajectories(run: RunResult) -> list[ProtocolResult]:
    """The tests on a moving tray, slowest first."""
    return [test for name, test in run.tests.items() if name.startswith('trajectory')]


def _badness(run: RunResult) -> float:
    test = run.tests.get('perturbation')
    return -run.episodes[-1]['return'] if test is None else float(away(test).mean())


def _row(run: RunResult) -> dict[str, float | int | str | bool | None]:
    fallen = [fell for test in run.tests.values() for fell in test.fallen]
    row: dict[str, float | int | str | bool | None] = {
        'condition': run.condition, 'taught': run.taught, 'participant': run.participant, 'group': run.group,
        'simulated': run.simulated,
        'seed': run.seed, 'episodes': len(run.episodes), 'first_pass': run.first_pass, 'skilled': run.skilled,
        'seconds': run.seconds, 'kept': 1.0 - float(np.mean(fallen)) if fallen else None,
        'human_share_first': run.episodes[0].get('human_share'),
        'human_share_last': run.episodes[-1].get('human_share'),
        'human_variance': _variance(run, 'std_human'), 'agent_variance': _variance(run, 'std_agent'),
        'workload': float(np.mean(list(run.tlx.values()))) if run.tlx else None}
    alone = run.tests.get('randomized')
    if alone is not None:
        row['success'] = float(alone.success.mean())
        row['alone_error'] = 100 * float(away(alone)[:, -150:].mean())
        row['manipulability'] = float(np.nanmean(alone.manipulability))
    pushed = run.tests.get('perturbation')
    if pushed is not None:
        row['pushed_error'] = 100 * float(away(pushed).mean())
        row['pushed_kept'] = float(not pushed.fallen.any())
    if moving := trajectories(run):
        row['moving_error'] = 100 * float(np.mean([away(test).mean() for test in moving]))
        row['moving_kept'] = float(np.mean([not test.fallen.any() for test in moving]))
    return row


def _variance(run: RunResult, column: str) -> float | None:
    """Mean over the episodes of the variance of a moment within an episode, (N m)^2."""
    values = [episode[column] ** 2 for episode in run.episodes if column in episode]
    return float(np.mean(values)) if values else None
