"""The size of the code, and what in it is tied to one task or one robot: at a commit and now.

    python tools/count.py
    python tools/count.py --since HEAD~20 --list

A module counts as tied to the task when it names the axis of ``balance`` or numbers of its tray, to the robot when it
names the Panda's joints, and lies outside the folder that is about just that. ``--list`` names the modules.
"""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path, PurePosixPath

from shared_control.command_line import script_parser

FIRST_VERSION = 'ec71391'
SOURCES = 'ros2_ws/src/'
TIED = {
    'axis': re.compile(r'\bm_y\b|\bm_y_|torque\.y\b(?!, torque\.z)|WRENCH_ROW'),
    'geometry': re.compile(r'\b0\.0069\b|TRAY_HALF_LENGTH|TRAY_SURFACE|TRAY_HOME_X|BALL_RADIUS *=|ON_TRAY *='),
    'robot': re.compile(r'\bDOF\b|JOINT_NAMES|Q_REFERENCE|panda_joint|\bGAINS\b'),
}
OWN_FOLDERS = {
    'axis': ('tasks/balance/', 'teaching/tutor.py', 'shared_control/wrench.py'),
    'geometry': ('tasks/balance/',),
    'robot': ('robot/', 'panda_tray_description/', 'shared_control_nodes/bridge/'),
}
"""Where what is tied belongs. The simulated tutor is a model of somebody who balances a ball by one moment."""


def count(files: list[str], read: Callable[[str], str]) -> dict:
    """Figures of a tree: ``files`` are its paths, ``read`` gives the text of one."""
    packages = {path.split('/')[2] for path in files if path.endswith('/package.xml')}
    code = [path for path in files if path.startswith(SOURCES) and path.endswith(('.py', '.js'))
            and '/test/' not in path and not path.endswith('setup.py')]
    texts = {path: read(path) for path in code if 'testing' not in path}
    tests = [path for path in files if path.endswith('.py') and ('/test/' in path or path.startswith('tests/')
                                                                 or 'testing' in path)]
    tied = {kind: sorted(path for path, text in texts.items()
                         if pattern.search(text) and not any(own in path for own in OWN_FOLDERS[kind]))
            for kind, pattern in TIED.items()}
    return {'packages': len(packages), 'files': len(texts),
            'lines': sum(text.count('\n') for text in texts.values()),
            'test_files': len(tests), 'test_lines': sum(read(path).count('\n') for path in tests), 'tied': tied}


def at(commit: str) -> dict:
    """Figures at a commit."""
    def git(*words: str) -> str:
        return subprocess.run(['git', *words], check=True, capture_output=True, text=True).stdout

    return count(git('ls-tree', '-r', '--name-only', commit).splitlines(), lambda path: git('show', f'{commit}:{path}'))


def now() -> dict:
    """Figures of the working tree."""
    root = Path(__file__).parents[1]
    listed = subprocess.run(['git', 'ls-files'], check=True, capture_output=True, text=True, cwd=root).stdout
    files = listed.splitlines()
    return count([path for path in files if (root / path).is_file()], lambda path: (root / path).read_text())


def main() -> int:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--since', default=FIRST_VERSION, metavar='REV',
                        help='commit to compare with (default: the first version)')
    parser.add_argument('--list', action='store_true', help='name the modules that are tied')
    parser.add_argument('--json', type=Path, metavar='FILE',
                        help='write all figures to this file (default: not written)')
    args = parser.parse_args()
    before, after = at(args.since), now()
    print(f'{"":24} {args.since:>8} {"now":>8}')
    for name in ('packages', 'files', 'lines', 'test_files', 'test_lines'):
        print(f'{name.replace("_", " "):24} {before[name]:8} {after[name]:8}')
    for kind in TIED:
        print(f'{"modules tied to " + kind:24} {len(before["tied"][kind]):8} {len(after["tied"][kind]):8}')
        if args.list:
            print(''.join(f'    {PurePosixPath(path)}\n' for path in after['tied'][kind]), end='')
    if args.json:
        args.json.parent.mkdir(parents=True, exist_ok=True)
        args.json.write_text(json.dumps({'before': before, 'now': after}, indent=2) + '\n')
    return 0


if __name__ == '__main__':
    sys.exit(main())
