"""All measurements, printed and written as JSON: ``make bench``.

The machines this runs on differ and are shared: compare the ratios, which are taken within one run.
"""

import argparse
import json
import platform
from collections.abc import Callable
from pathlib import Path
from typing import Any

import graph
import headless
import page
import training

MEASUREMENTS: dict[str, Callable[[], dict[str, Any]]] = {
    'headless': lambda: {'headless': headless.measure()}, 'graph': lambda: {'graph': graph.measure()},
    'page': lambda: {'page': page.measure()}, 'learning': training.measure}


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--output', type=Path, default=Path('out/bench.json'))
    parser.add_argument('--only', choices=tuple(MEASUREMENTS), help='one measurement instead of all')
    args = parser.parse_args()
    results: dict[str, Any] = {'machine': {'python': platform.python_version(), 'platform': platform.platform()}}
    for name, measure in MEASUREMENTS.items():
        if args.only in (None, name):
            print(f'{name} ...', flush=True)
            found = measure()
            results |= found
            print(json.dumps({key: {k: v for k, v in figures.items() if k != 'rounds'}
                              for key, figures in found.items()}, indent=2), flush=True)
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(results, indent=2) + '\n')
    print(f'written to {args.output}')


if __name__ == '__main__':
    main()
