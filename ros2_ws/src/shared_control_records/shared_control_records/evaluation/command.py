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

"""``shared-control evaluate``: the thesis' tests of policies that act alone."""

import argparse
from pathlib import Path
from typing import Any

from shared_control.command_line import add_json_option, add_parser, prose, write_json
from shared_control.files import refuse_unwritable
from shared_control.plugins import TASKS, WORLDS, load, names

TEST_EPISODES = 20
SEED_MAX = 2**31 - 1

DESCRIPTION = """Test policies that act alone, without exploring, in this process, each on its own task. The first
three tests are those of the thesis:

  randomized    20 episodes of 10 s, the ball dropped anywhere
  perturbation  30 s, the tray pushed with 50 N from 5 to 6 s and from 10 to 11 s
  trajectory    20 s each on a tray that follows 0.25, 0.5 and 1 Hz
  transfer      randomized, on arms that are not as taught: another ball, a tray that sits askew, other inertias in the
                controller, friction in the joints, late and noisy senses; one thing otherwise at a time, 7 minutes"""


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``evaluate`` to the ``shared-control`` command."""
    parser = add_parser(
        commands, 'evaluate', run, summary='test policies that act alone', description=DESCRIPTION,
        examples=['shared-control evaluate out/train',
                  'shared-control evaluate out/demo --protocol perturbation --output out/tests --json -'])
    parser.add_argument('policies', nargs='+', type=Path, metavar='POLICY',
                        help='policy.safetensors, or folder of a session or training run; several are one condition')
    parser.add_argument('--protocol', choices=('randomized', 'perturbation', 'trajectory', 'transfer'),
                        default='randomized', help='which test')
    parser.add_argument('--physics', choices=names(WORLDS), default='bullet',
                        help='what they are tested in, whatever they were trained in')
    parser.add_argument('--test-episodes', type=int, default=None, metavar='N',
                        help=f'episodes of a randomized test, or of each part of transfer (default: {TEST_EPISODES})')
    parser.add_argument('--seed', type=int, default=None, metavar='N',
                        help='seed of the ball starts (default: 424242, the same for all)')
    parser.add_argument('--until-known', action='store_true',
                        help='find out only whether 19 of 20 randomized episodes succeed; stop once that is known')
    parser.add_argument('--lerobot-python', type=Path, metavar='FILE', default=None,
                        help='the Python that lerobot is installed for: POLICY may be a folder pretrained_model/ that '
                             'it has trained on an exported data set (default: policies of ours alone)')
    parser.add_argument('--task', choices=names(TASKS), default='balance',
                        help='what a policy of LeRobot was trained for; ours say it themselves')
    parser.add_argument('--output', type=Path, metavar='FOLDER',
                        help='write tracks (CSV) and figures (PNG, SVG, PDF) there (default: not written)')
    add_json_option(parser, 'all figures')


def run(args: argparse.Namespace) -> int:
    """Test the policies; the exit code."""
    if args.protocol in ('perturbation', 'trajectory') and (args.seed is not None or args.test_episodes is not None):
        raise ValueError(f'the episodes of --protocol {args.protocol} are always the same: leave out --seed and '
                         '--test-episodes')
    if args.test_episodes is None:
        args.test_episodes = TEST_EPISODES
    if args.test_episodes < 1:
        raise ValueError(f'--test-episodes is {args.test_episodes}; at least 1 is needed')
    if args.seed is not None and not 0 <= args.seed <= SEED_MAX:
        raise ValueError(f'--seed is {args.seed}, expected 0 to {SEED_MAX}')
    if args.until_known and (args.protocol != 'randomized' or args.test_episodes != TEST_EPISODES or args.output):
        raise ValueError('--until-known answers one question of the randomized test with 20 episodes: '
                         'leave out --protocol, --test-episodes and --output')
    if args.output:
        refuse_unwritable(args.output)
    # Imported late: torch and pinocchio take seconds, which `--help` need not wait for.
    from shared_control_learning.evaluation.evaluate import TEST_SEED

    from .policies import load_policies
    policies = load_policies(args.policies, args.lerobot_python, load(TASKS, args.task)())
    seed = TEST_SEED if args.seed is None else args.seed
    return _decide(policies, args.physics, seed, args.json) if args.until_known else _test(policies, args, seed)


def _test(policies: dict[str, Any], args: argparse.Namespace, seed: int) -> int:
    from shared_control_learning.callbacks import Callbacks
    from shared_control_learning.evaluation.run import count_episodes, run_protocol
    from tqdm import tqdm

    from ..plotting.plot import origin, write_captions
    from .figures import plots
    from .tables import as_json, by_test, text_table, write_csv
    from .transfer import transfer_plot, transfer_table

    class Progress(Callbacks):
        """Moves the bar."""

        def episode_tested(self, episode: Any) -> None:
            """See :class:`Callbacks`."""
            bar.update()

    results = {}
    total = len(policies) * count_episodes(args.protocol, args.test_episodes)
    with tqdm(total=total, unit='episode', disable=None) as bar:
        for name, policy in policies.items():
            bar.set_description(name)
            results[name] = run_protocol(
                args.protocol, policy.act, policy.task, args.test_episodes, seed, Progress(), args.physics)
    is_transfer = args.protocol == 'transfer'
    print(transfer_table(results) if is_transfer else text_table(results), file=prose(args.json))
    write_json({'protocol': args.protocol, 'physics': args.physics, 'seed': seed, **as_json(results)}, args.json)
    if args.output:
        args.output.mkdir(parents=True, exist_ok=True)
        write_csv(results, args.protocol, args.output)
        found = [transfer_plot(results)] if is_transfer else [
            plot for tests in by_test(results).values() for plot in plots(tests)]
        write_captions(found, args.output / f'{args.protocol}_captions.md')
        for plot in found:
            plot.save(args.output, origin(seed))
        print(f'Tracks and figures are in {args.output}', file=prose(args.json))
    return 0


def _decide(policies: dict[str, Any], physics: str, seed: int, path: Path | None) -> int:
    from shared_control.env import SharedControlEnv
    from shared_control_learning.evaluation.evaluate import as_tested, passes
    from shared_control_sim.local_plant import LocalPlant
    answers = {}
    for name, policy in policies.items():
        task = policy.task
        env = SharedControlEnv(LocalPlant(task, physics=physics), as_tested(task))
        try:
            answers[name] = passes(policy.act, env, seed)
        finally:
            env.close()
        print(f'{name}: {"passes" if answers[name] else "does not pass"}', file=prose(path))
    write_json({'seed': seed, 'physics': physics, 'passes': answers}, path)
    return 0
