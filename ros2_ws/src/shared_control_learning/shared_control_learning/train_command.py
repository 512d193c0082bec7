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

"""``shared-control train``: teach a policy in this process, without a graph."""

import argparse
import os
import shlex
import sys
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path

from shared_control.command_line import prose, write_json
from shared_control.control.sharing import Sharing
from shared_control.run_folder import RunFolder
from shared_control.teaching.picture import can_teach
from shared_control.teaching.tutors import tutor_named
from tqdm import tqdm

from .callbacks import Callbacks
from .episode import Episode
from .episode_table import TABLE_NAME
from .policy_file import POLICY_NAME
from .presets import Preset, preset_for
from .train_options import OPTIONS_NAME, TrainOptions, keep_options, options_of
from .training import RUN_NAME, TENSORBOARD_NAME, TrainingError, TrainingRun, new_learner, read_run, train


def run(args: argparse.Namespace) -> int:
    """Run the command; 0, or 1 when the policy was tested and is not skilled yet."""
    options = options_of(args)
    chosen = preset_for(options.task, options.preset)
    args.output = args.resume or args.output
    _check_options(options, chosen)
    folder = _claim_folder(args)
    try:
        return _train(args, options, chosen)
    finally:
        folder.release()


def _train(args: argparse.Namespace, options: TrainOptions, chosen: Preset) -> int:
    """Train, and print what came of it; the exit code."""
    tutor = _tutor(options, chosen)
    done = read_run(args.output).episodes if args.resume else 0
    try:
        with tqdm(total=options.episodes, initial=done, unit='episode', disable=None, file=sys.stderr) as bar:
            result = train(
                chosen, None if tutor == 'none' else tutor_named(tutor, options.seed), options.seed, options.episodes,
                until_skilled=options.until_skilled, human_only=options.human_only, physics=options.physics,
                folder=args.output, tensorboard=find_spec('tensorboard') is not None,
                evaluate_every=options.evaluate_every, sharing=Sharing(options.sharing),
                callbacks=_Watch(bar, args.output, options), processes=len(os.sched_getaffinity(0)))
    except KeyboardInterrupt:
        print(f'stopped; go on with: shared-control train --resume {shlex.quote(str(args.output))}', file=sys.stderr)
        return 130
    _tell(result, tutor, args)
    return 0 if result.skilled is not None or not result.tests else 1


def _tutor(options: TrainOptions, chosen: Preset) -> str:
    """The name of who teaches, ``none`` for nobody."""
    return options.profile or ('expert' if chosen.taught and can_teach(chosen.task) else 'none')


def _check_options(options: TrainOptions, chosen: Preset) -> None:
    """Refuse numbers and combinations that cannot be, before anything is overwritten."""
    if options.episodes < 1 or options.evaluate_every < 0 or not 0 <= options.seed < 2**31:
        raise ValueError('--episodes must be at least 1, --evaluate-every and --seed at least 0')
    if not chosen.taught and options.profile not in ('', 'none'):
        raise ValueError(f'the preset {chosen.name} has no tutor: leave --profile out, or choose another preset')
    tutor = _tutor(options, chosen)
    if options.until_skilled and not 0 < 2 * options.evaluate_every <= options.episodes:
        raise ValueError(f'--until-skilled needs two tests: --evaluate-every is {options.evaluate_every}, --episodes '
                         f'{options.episodes}')
    if options.human_only and tutor == 'none':
        raise ValueError('--human-only, but nobody teaches: choose a --profile')
    new_learner(chosen, None if tutor == 'none' else tutor_named(tutor, options.seed), options.seed, options.physics,
                Sharing(options.sharing))


def _claim_folder(args: argparse.Namespace) -> RunFolder:
    """The folder as the options say, for this process alone."""
    own = (POLICY_NAME, TABLE_NAME, OPTIONS_NAME, f'{TENSORBOARD_NAME}/events.out.tfevents.*')
    folder = RunFolder(args.output, 'run', own=own, mark=RUN_NAME, keys=('preset', 'tutor', 'seed'))
    if args.resume:
        if not (args.output / RUN_NAME).exists():
            raise TrainingError(f'--resume: there is no run in {args.output}: leave --resume out to begin one')
        read_run(args.output)
        folder.claim()
    else:
        if folder.holds_run and not args.overwrite:
            raise TrainingError(f'{args.output} holds a run: --resume {shlex.quote(str(args.output))}, --overwrite, or '
                                'another --output')
        folder.begin(args.overwrite)
    return folder


class _Watch(Callbacks):
    """Moves the progress bar on, and keeps the options: from the first episode on, when they have been found to fit."""

    def __init__(self, bar: tqdm, folder: Path, options: TrainOptions):
        self._bar, self._folder = bar, folder
        self._options: TrainOptions | None = options

    def episode_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        if self._options is not None:
            keep_options(self._options, self._folder)
            self._options = None

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        tests = [passed for _, passed in read_run(self._folder).tests]
        self._bar.set_postfix_str(
            f'return {episode.episode_return:.0f}, intervention rate {episode.intervention_rate:.0%}, '
            f'tests passed {sum(tests)} of {len(tests)}{", the last one" if tests[-1:] == [True] else ""}')
        self._bar.update()


def _tell(result: TrainingRun, tutor: str, args: argparse.Namespace) -> None:
    summary = {**asdict(result), 'tutor': tutor, 'tutor_is_simulated': tutor != 'none', 'episodes': result.episodes,
               'first_pass': result.first_pass, 'skilled': result.skilled, 'folder': str(args.output)}
    write_json(summary, args.json)
    found = 'was not tested' if not result.tests else (
        f'skilled after {result.skilled} episodes' if result.skilled is not None else
        f'not skilled after {result.episodes} episodes')
    print(f'{result.preset}, {"nobody" if tutor == "none" else f"simulated {tutor}"} at the keys, seed {result.seed}: '
          f'{found}; {result.seconds:.0f} s. {args.output}', file=prose(args.json))
