"""``shared-control validate``: the thesis' validation of kinematics, dynamics and control (2.2-2.4), redone.

The tray follows cosine references, with the high and low gains of Table 3, with and without the non-linear terms; the
model is compared with kinematics and dynamics written down by hand. The exit code is 1 when something disagrees.
"""

import argparse
from pathlib import Path


def add_command(commands: argparse._SubParsersAction) -> None:
    """Add ``validate`` to the ``shared-control`` command."""
    parser = commands.add_parser(
        'validate', help='model and controller against the thesis (2.4)', description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', type=Path, metavar='DIR', default=Path('out/validation'),
                        help='folder for the figures, PNG and SVG (default: %(default)s)')
    parser.add_argument('--json', type=Path, metavar='FILE', help='write all figures of the tables there')
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Validate; the exit code."""
    # Imported late: pinocchio and matplotlib take a second, which `--help` need not wait for.
    from tqdm import tqdm

    from .figures import plots
    from .run import validate
    args.out.mkdir(parents=True, exist_ok=True)
    validation = validate()
    print(validation.table())
    for plot in tqdm(list(plots(validation.runs)), unit='figure', desc='figures', disable=None):
        plot.save(args.out)
    print(f'Figures in {args.out}')
    if args.json:
        validation.write_json(args.json)
        print(f'Written to {args.json}')
    return 0 if validation.passed else 1
