"""Says what this machine lacks before anything is installed. Standard library only; works with any Python 3."""

import importlib.util
import platform
import shutil
import sys


def missing():
    """One sentence for each thing that is missing."""
    found = []
    if sys.version_info[:2] not in ((3, 11), (3, 12)):
        found.append(
            'Python 3.11 or 3.12 is needed; this is %s. Say which to use: make PYTHON=python3.12 ...'
            % platform.python_version())
    if platform.system() != 'Linux' or platform.machine() != 'x86_64':
        found.append('Linux on x86_64 is needed (ROS 2 wheels exist for nothing else); this is %s on %s.'
                     % (platform.system(), platform.machine()))
    if importlib.util.find_spec('ensurepip') is None:
        found.append("Python's venv module is incomplete: apt-get install python3-venv")
    if sys.version_info[:2] == (3, 12) and shutil.which('g++') is None:
        found.append('A C++ compiler is needed, as PyBullet has no wheel for Python 3.12: '
                     'apt-get install g++ python3-dev')
    return found


if __name__ == '__main__':
    problems = missing()
    for problem in problems:
        print('error: ' + problem, file=sys.stderr)
    sys.exit(1 if problems else 0)
