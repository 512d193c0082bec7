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

"""``shared-control tutors``: the population of simulated tutors, and how well each does the task alone."""

import argparse
import sys
from statistics import mean, median
from typing import Any

import numpy as np
from shared_control.command_line import prose, write_json
from shared_control.env import SharedControlEnv
from shared_control.plugins import TASKS, load
from shared_control.rates import POLICY_PERIOD
from shared_control.seeds import episode_seed
from shared_control.tasks.balance import BALANCE
from shared_control.tasks.task import Task, settled
from shared_control.teaching.families import FAMILIES
from shared_control.teaching.individual import Individual
from shared_control.teaching.profiles import PROFILES
from shared_control.teaching.tutors import TUTOR_NAMES, make_tutor, tutor_named
from shared_control_sim.local_plant import LocalPlant
from tqdm import tqdm

from .callbacks import Callbacks
from .episode import Episode
from .learn import run_episode


def run(args: argparse.Namespace) -> int:
    """Measure and print; the exit code."""
    if args.individuals < 1:
        raise ValueError(f'--individuals is {args.individuals}, expected at least 1')
    tutors = args.tutors or [name for name in TUTOR_NAMES
                             if args.device == 'keys' or isinstance(tutor_named(name), Individual)]
    for name in tutors:
        make_tutor(tutor_named(name), BALANCE, hand=args.device)
    task = load(TASKS, args.task)()
    rows = []
    with tqdm(total=len(tutors) * args.individuals, unit='episode', disable=None, file=sys.stderr) as bar:
        for name in tutors:
            rows.append(alone(name, task, args.individuals, args.device, bar))
    output = prose(args.json)
    print(f'{"":14} {"use":9} {"succeed":>8} {"kept":>5} {"off, mm":>8} {"rate":>5} {"presses":>8}  source',
          file=output)
    for row in rows:
        presses = '–' if row['presses_a_minute'] is None else f'{row["presses_a_minute"]:.0f}'
        print(f'{row["tutor"]:14} {row["use"]:9} {row["success"]:>8.0%} {row["kept"]:>5.0%} '
              f'{1e3 * row["position_error"]:>8.0f} {row["intervention_rate"]:>5.0%} {presses:>8}  {row["source"]}',
              file=output)
    print(f'{args.individuals} individuals each with {"keys" if args.device == "keys" else "a stick"}, alone with an '
          f'idle robot, one episode of {task.episode_seconds:g} s; off: median |position error| over the last 3 s; '
          'rate: intervention rate; presses: changes of the moment in a minute. Simulated.', file=output)
    write_json({'task': task.name, 'device': args.device, 'tutors': rows}, args.json)
    return 0


def alone(name: str, task: Task, individuals: int, device: str, bar: tqdm) -> dict[str, Any]:
    """The row of a profile or a family."""
    episodes = []
    for seed in range(individuals):
        person = make_tutor(tutor_named(name, seed), task, seed, hand=device)
        env = SharedControlEnv(LocalPlant(task, person), task)
        episode = Episode(task)
        try:
            run_episode(lambda _: np.zeros(len(task.axes)), env, episode_seed(seed, 1), episode, Callbacks())
        finally:
            env.close()
        episodes.append(episode)
        bar.update()
    family = FAMILIES.get(name)
    return {
        'tutor': name, 'simulated': True, 'device': device, 'use': family.use.value if family else 'profile',
        'source': family.source if family else f'profile, {PROFILES[name].reaction_time:g} s late',
        'individuals': individuals, 'success': mean(episode.success for episode in episodes),
        'kept': mean(not episode.failed for episode in episodes),
        'position_error': median(settled(np.array(episode.position_error)) for episode in episodes),
        'intervention_rate': mean(episode.intervention_rate for episode in episodes),
        'presses_a_minute': mean(map(_presses_a_minute, episodes)) if device == 'keys' else None}


def _presses_a_minute(episode: Episode) -> float:
    return episode.presses / (len(episode) * POLICY_PERIOD / 60.0)
