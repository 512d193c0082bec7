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

"""Finished studies, made up for tests: what runs would have left, with curves that look like theirs."""

from pathlib import Path

import numpy as np
from shared_control.control.references import FREQUENCIES
from shared_control.rates import POLICY_PERIOD
from shared_control_learning.evaluation.result import TRACKS, TRANSFER, ProtocolResult
from shared_control_records.study.folder import StudyFolder
from shared_control_records.study.plan import Job
from shared_control_records.study.result import RunResult, describe, save_result

GOOD = {'coached': 0.95, 'thesis': 0.2, 'autonomous': 0.75, 'lqr': 0.95}
"""How well the policies of a condition do, 0..1."""


def made_study(path: Path, plan: Path, seed: int = 0, missing: int = 0) -> StudyFolder:
    """A study whose runs are done, but for the last ``missing`` of them."""
    folder = StudyFolder(path)
    content = folder.begin(plan)
    for job in content.jobs[:len(content.jobs) - missing]:
        own = folder.run(job)
        own.mkdir(parents=True)
        save_result(made_result(job, np.random.default_rng((seed, job.participant.seed)), content.tests), own)
    return folder


def made_result(job: Job, random: np.random.Generator, tested: tuple[str, ...] = ()) -> RunResult:
    """A run that is done."""
    good = GOOD[job.condition.preset] > random.random()
    quick = good and job.condition.taught
    episodes = int(random.integers(3, 9)) if quick else max(1, job.condition.episodes - 2 * good)
    tests = [_test('randomized', random, good, 20, 10.0), _test('perturbation', random, good, 1, 30.0),
             *(_test(f'trajectory {frequency:g} Hz', random, good, 1, 20.0) for frequency in FREQUENCIES)]
    if 'transfer' in tested:
        tests += [_test(f'{TRANSFER}{name}', random, good, 20, 10.0) for name in ('as taught', 'ball of 0.6 kg')]
    return RunResult(
        **describe(job, simulated=job.participant.tutor is not None),
        first_pass=episodes - 1 if good else None, skilled=episodes if good else None,
        seconds=10.0 * episodes, tests={test.test: test for test in tests},
        episodes=[_episode(number, job, random) for number in range(1, episodes + 1)])


def _episode(number: int, job: Job, random: np.random.Generator) -> dict:
    human = max(0.0, 4 - number / 3 + random.normal(0, 0.5)) if job.condition.taught else 0.0
    return {'episode': float(number), 'phase': 'teach', 'steps': 750.0, 'seconds': 15.0, 'learn_seconds': 0.5,
            'return': 500 - 2000 / number + random.normal(0, 80), 'fallen': 0.0, 'mean_abs_human': human,
            'mean_abs_agent': 2.0 + random.normal(0, 0.3), 'std_human': human,
            'std_agent': 3.0, 'human_share': human / 6, 'intervention_rate': human / 5}


def _test(name: str, random: np.random.Generator, good: bool, episodes: int, length: float) -> ProtocolResult:
    seconds = np.arange(1, round(length / POLICY_PERIOD) + 1) * POLICY_PERIOD
    start = random.uniform(-0.15, 0.15, (episodes, 1))
    error = start * np.exp(-seconds) + (0.003 if good else 0.06) * np.sin(3 * seconds + start * 20)
    velocity = np.gradient(error, POLICY_PERIOD, axis=1)
    fallen = np.full(episodes, False)
    if not good:
        fallen[0] = True
        error[0, len(seconds) // 2:] = velocity[0, len(seconds) // 2:] = np.nan
    tracks = {'position_error': error, 'velocity': -velocity, 'velocity_error': velocity, 'agent_moment': 10 * error,
              'manipulability': np.full_like(error, 0.074)}
    return ProtocolResult(name, seconds, **{track: tracks[track] for track in TRACKS}, fallen=fallen,
                          success=~fallen & good)
