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

"""Doing what is left of a study's runs."""

import sys
from collections.abc import Generator, Sequence
from contextlib import closing
from typing import TextIO

from tqdm import tqdm

from .estimate import TimeLeft, in_words
from .folder import StudyError, StudyFolder
from .plan import Job, Plan
from .pool import Outcome, on_ray, on_this_machine
from .progress import Progress
from .result import is_done, load_brief

DISK = ('No space left', 'Disk quota', 'Read-only file system')
"""Errors after which no other run can succeed either."""


def do_runs(folder: StudyFolder, plan: Plan, workers: int, ray: str | None = None,
            output: TextIO | None = None) -> None:
    """Do the runs that can be done and are not; a bar shows how many are, and the time left.

    Args:
        workers: processes on this machine.
        ray: address of a Ray cluster to use instead.
        output: where it is printed what became of each run; standard output when not given.

    Raises:
        ResultError: an earlier run's result is damaged; the message names it.
        StudyError: runs failed; the message says which and why. The others are done.
    """
    jobs = {job.name: job for job in plan.jobs if _possible(folder, plan, job)}
    left = {name: job for name, job in jobs.items() if not is_done(folder.run(job))}
    time_left = TimeLeft()
    for job in jobs.values():
        if job.name not in left:
            time_left.learn(job, load_brief(folder.run(job)).seconds)
    failed: list[Outcome] = []
    with closing(_outcomes(folder, list(left), workers, ray)) as ended, \
         tqdm(total=len(jobs), initial=len(jobs) - len(left), unit='run', disable=not sys.stderr.isatty(),
              bar_format='{bar} {n_fmt} of {total_fmt} runs, {elapsed}{postfix}') as bar:
        for outcomes in ended:
            for outcome in outcomes:
                job = left.pop(outcome.name)
                if outcome.error:
                    failed.append(outcome)
                else:
                    time_left.learn(job, load_brief(folder.run(job)).seconds)
                bar.update()
                _tell(bar, f'{outcome.name}: {outcome.error or _summary(folder, job)}', output)
            bar.set_postfix_str(f'about {in_words(time_left.estimate(left.values(), workers))} left')
            if failed and any(text in (failed[-1].error or '') for text in DISK):
                break
    if failed:
        reasons = '\n'.join(f'  {outcome.name}: {outcome.error}' for outcome in failed)
        raise StudyError(f'{len(failed)} of {len(jobs)} runs failed:\n{reasons}\nWhat is finished is kept in '
                         f'{folder.path}; start the same command again to do the rest.')


def _outcomes(folder: StudyFolder, names: Sequence[str], workers: int,
              ray: str | None) -> Generator[list[Outcome], None, None]:
    path = folder.path.absolute()
    return on_this_machine(path, names, workers) if ray is None else on_ray(path, names, ray)


def _possible(folder: StudyFolder, plan: Plan, job: Job) -> bool:
    """Whether a run waits for nobody."""
    if plan.people is None:
        return True
    progress = Progress.of(folder.person(job.participant))
    if progress.withdrawn == 'delete':
        return False  # nor is a run of theirs that needs nobody: it has no partner
    return not job.condition.taught or job.condition.name in progress.taught


def _summary(folder: StudyFolder, job: Job) -> str:
    skilled = load_brief(folder.run(job)).skilled
    return f'skilled after {skilled} episodes' if skilled else 'not skilled'


def _tell(bar: tqdm, text: str, output: TextIO | None) -> None:
    if bar.disable:
        print(text, file=output, flush=True)
    else:
        bar.write(text, file=sys.stderr)
