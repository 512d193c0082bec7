"""``shared-control evaluate``: the thesis' tests of policies that act alone.

randomized (4.2): 20 episodes of 10 s, the ball dropped anywhere. perturbation (4.3): 30 s, the ball in the centre,
the tray pushed with 50 N along both axes from 5 to 6 s and from 10 to 11 s. trajectory (4.6): 20 s each on a tray that
follows cosine references of 0.25, 0.5 and 1 Hz.
"""

import argparse
from pathlib import Path
from typing import Any

from shared_control.plugins import TASKS, WORLDS, load, names


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``evaluate`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'evaluate', help="the thesis' tests of policies", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('policies', nargs='+', type=Path, metavar='POLICY',
                        help='policy.safetensors, or folder of a session or training run; several are one condition')
    parser.add_argument('--protocol', choices=('randomized', 'perturbation', 'trajectory'), default='randomized',
                        help='which test (default: %(default)s)')
    parser.add_argument('--physics', choices=names(WORLDS), default='bullet',
                        help='what they are tested in, whatever they were trained in (default: %(default)s)')
    parser.add_argument('--episodes', type=int, default=20, help='of the randomized test (default: %(default)s)')
    parser.add_argument('--seed', type=int, default=None, help='of its ball starts; always the same when not given')
    parser.add_argument('--until-known', action='store_true',
                        help='only whether 19 of 20 randomized episodes succeed; stops as soon as that is known')
    parser.add_argument('--lerobot-python', type=Path, metavar='FILE', default=None,
                        help='the Python that lerobot is installed for: POLICY may be a folder pretrained_model/ that '
                             'it has trained on an exported data set')
    parser.add_argument('--task', choices=names(TASKS), default='balance',
                        help='what a policy of LeRobot was trained for (default: %(default)s)')
    parser.add_argument('--json', type=Path, metavar='FILE', help='write all figures there')
    parser.add_argument('--out', type=Path, metavar='DIR', help='write tracks (CSV) and figures (PNG, SVG) there')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Test the policies; the exit code."""
    if args.episodes < 1:
        raise ValueError(f'--episodes is {args.episodes}; at least 1 is needed')
    if args.until_known and (args.protocol != 'randomized' or args.episodes != 20 or args.out):
        raise ValueError('--until-known answers one question of the randomized test with 20 episodes: '
                         'leave out --protocol, --episodes and --out')
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

    from .figures import plots
    from .tables import by_test, text_table, write_csv, write_json

    class Progress(Callbacks):
        """Moves the bar."""

        def episode_tested(self, episode: Any) -> None:
            """See :class:`Callbacks`."""
            bar.update()

    results = {}
    total = len(policies) * count_episodes(args.protocol, args.episodes)
    with tqdm(total=total, unit='episode', disable=None) as bar:
        for name, policy in policies.items():
            bar.set_description(name)
            results[name] = run_protocol(
                args.protocol, policy.act, policy.task, args.episodes, seed, Progress(), args.physics)
    print(text_table(results))
    if args.json:
        write_json(results, args.json, protocol=args.protocol, physics=args.physics, seed=seed)
        print(f'Written to {args.json}')
    if args.out:
        args.out.mkdir(parents=True, exist_ok=True)
        write_csv(results, args.out)
        for tests in by_test(results).values():
            for plot in plots(tests):
                plot.save(args.out)
        print(f'Tracks and figures in {args.out}')
    return 0


def _decide(policies: dict[str, Any], physics: str, seed: int, path: Path | None) -> int:
    import json

    from shared_control.env import SharedControlEnv
    from shared_control.files import write_atomically
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
        print(f'{name}: {"passes" if answers[name] else "does not pass"}')
    if path:
        path.parent.mkdir(parents=True, exist_ok=True)
        content = {'seed': seed, 'physics': physics, 'passes': answers}
        write_atomically(path, (json.dumps(content, indent=2) + '\n').encode())
    return 0
