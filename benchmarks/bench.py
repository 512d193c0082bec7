"""All measurements, printed and written as JSON: ``make bench``.

    python benchmarks/bench.py                   # what `make bench` runs
    python benchmarks/bench.py --only page       # a key in the browser until it counts

The machines this runs on differ and are shared: compare the ratios, which are taken within one run.
"""

import json
import platform
import traceback
from importlib import import_module
from pathlib import Path
from typing import Any

from shared_control.command_line import script_parser
from shared_control.files import write_atomically

MEASUREMENTS = {'headless': 'headless', 'graph': 'graph', 'tick': 'tick', 'start': 'start', 'end': 'end',
                'page': 'page', 'learning': 'training', 'install': 'install'}
"""By name, the module whose ``measure()`` gives the figures by subject."""
MISSING = 'missing'
"""Key of a subject's figures: what of this machine's could not be measured, and what would be needed."""


def main() -> int:
    """Entry point; the exit code: 0, or 1 when a measurement failed."""
    parser = script_parser(__doc__)
    parser.add_argument('--output', type=Path, default=Path('out/bench.json'), metavar='FILE',
                        help='file for the figures')
    parser.add_argument('--only', choices=tuple(MEASUREMENTS), help='one measurement (default: all)')
    args = parser.parse_args()
    results: dict[str, Any] = {'machine': {'python': platform.python_version(), 'platform': platform.platform()}}
    args.output.parent.mkdir(parents=True, exist_ok=True)
    failed = []
    for name in [args.only] if args.only else MEASUREMENTS:
        print(f'{name} ...', flush=True)
        try:
            found = measure(name)
        except Exception:  # each stands on its own
            traceback.print_exc()
            failed.append(name)
            continue
        results |= found
        write_atomically(args.output, (json.dumps(results, indent=2) + '\n').encode())
        print(json.dumps({key: {k: v for k, v in figures.items() if k != 'rounds'}
                          for key, figures in found.items()}, indent=2), flush=True)
    print(f'written to {args.output}')
    for name, figures in results.items():
        if MISSING in figures:
            print(f'{name}: not all was measured: {figures[MISSING]}')
    if failed:
        print(f'failed: {", ".join(failed)}')
    return int(bool(failed))


def measure(name: str) -> dict[str, dict[str, Any]]:
    """The figures of one measurement, by subject; a package that is missing is among them."""
    try:
        module = import_module(MEASUREMENTS[name])
    except ModuleNotFoundError as error:
        return {name: {MISSING: f'there is no Python package {error.name}'}}
    figures: dict[str, dict[str, Any]] = module.measure()
    return figures if name == 'learning' else {name: figures}


if __name__ == '__main__':
    raise SystemExit(main())
