"""Builds sdist and wheel, installs each in an empty environment, and runs from there what people run.

    python tools/wheel.py --output dist                     # with this Python
    python tools/wheel.py --output dist --python python3.12
    python tools/wheel.py --output dist --quick             # a minute, no download

The wheel is built from the sdist, so that a file which the sdist lacks is missed here and not by somebody else. From
the wheel with all extras every console script explains itself and the Python of the tutorial teaches a policy; the
sdist alone is installed with what the core needs.

``--quick`` takes what the wheel needs from the environment that it is run in, and runs the README's Python in place of
the tutorial's.
"""

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from shared_control.command_line import script_parser

ROOT = Path(__file__).parents[1]
README, TUTORIAL = ROOT / 'README.md', ROOT / 'docs' / 'tutorial' / 'first_policy.md'
SOURCES = ('setup.py', 'pyproject.toml', 'requirements.txt', 'MANIFEST.in', 'README.md', 'LICENSE', 'ros2_ws/src')
BUILD = ('import setuptools.build_meta as build, sys; '
         'print(getattr(build, "build_" + sys.argv[1])(sys.argv[2]))')


def run(*command: object, cwd: Path, modules: Path | None = None) -> str:
    """Run a command in a folder; what it prints.

    Args:
        command: the words.
        cwd: the folder, away from the sources.
        modules: a folder whose modules go before all others.

    Raises:
        SystemExit: it failed; the message is its own.
    """
    env = {name: value for name, value in os.environ.items() if name != 'PYTHONPATH'}
    if modules:
        env['PYTHONPATH'] = str(modules)
    done = subprocess.run([str(part) for part in command], cwd=cwd, env=env, capture_output=True, text=True,
                          check=False)
    if done.returncode:
        raise SystemExit(f'{" ".join(map(str, command))}\n{done.stdout}{done.stderr}')
    return done.stdout


def environment(python: str, folder: Path) -> Path:
    """An empty environment; its interpreter."""
    run(python, '-m', 'venv', folder, cwd=folder.parent)
    return folder / 'bin' / 'python'


def install_setuptools(python: Path, work: Path) -> None:
    """The pinned ones, to build with."""
    pin = re.search(r'^setuptools==.*$', (ROOT / 'requirements.txt').read_text(), re.MULTILINE)
    assert pin
    run(python, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', pin[0], cwd=work)


def build(python: Path, work: Path, output: Path) -> tuple[Path, Path]:
    """The sdist of a copy of the sources, and the wheel of what is in the sdist."""
    copy = work / 'sources'
    for part in SOURCES:
        (copy / part).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / part).is_dir():
            shutil.copytree(ROOT / part, copy / part, ignore=shutil.ignore_patterns('__pycache__', '*.egg-info'))
        else:
            shutil.copy(ROOT / part, copy / part)
    output.mkdir(parents=True, exist_ok=True)
    sdist = output / run(python, '-c', BUILD, 'sdist', output, cwd=copy).splitlines()[-1]
    with tarfile.open(sdist) as archive:
        archive.extractall(work, filter='data')
    unpacked = work / sdist.name.removesuffix('.tar.gz')
    wheel = output / run(python, '-c', BUILD, 'wheel', output, cwd=unpacked).splitlines()[-1]
    return sdist, wheel


def check(python: Path, scripts: Path, page: Path, work: Path, modules: Path | None = None) -> None:
    """Every console script in the folder ``scripts`` explains itself, and the Python of ``page`` runs."""
    names = run(python, '-c', 'import importlib.metadata as m; print(*(s.name for s in '
                'm.distribution("shared-control").entry_points if s.group == "console_scripts"))',
                cwd=work, modules=modules).split()
    for name in names:
        run(scripts / name, '--help', cwd=work, modules=modules)
        print(f'{name} --help: ok', flush=True)
    [code] = re.findall(r'```python\n(.*?)```', page.read_text(), re.DOTALL)
    code += 'import shared_control; print(shared_control.__file__)'
    *printed, imported = run(python, '-c', code, cwd=work, modules=modules).splitlines()
    if Path(imported).is_relative_to(ROOT):
        raise SystemExit(f'not what was installed, but {imported}, was imported')
    print(*printed[-1:], f'the Python of {page.name}: ok', sep='\n', flush=True)


def check_quickly(work: Path, output: Path) -> None:
    """With what is installed beside this interpreter, the packages of the wheel before those of the sources."""
    python, modules = Path(sys.executable), work / 'modules'
    _, wheel = build(python, work, output)
    run(python, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', '--no-index', '--no-deps',
        '--target', modules, wheel, cwd=work)
    check(python, modules / 'bin', README, work, modules)


def main() -> None:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--output', type=Path, default=ROOT / 'dist', metavar='FOLDER',
                        help='where sdist and wheel go (default: dist)')
    parser.add_argument('--python', default=sys.executable, metavar='PYTHON',
                        help='the interpreter to build and install with (default: this one)')
    parser.add_argument('--quick', action='store_true', help='install the wheel alone, beside what is installed here')
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        output = args.output.resolve()
        if args.quick:
            check_quickly(work, output)
            return
        builder = environment(args.python, work / 'build')
        install_setuptools(builder, work)
        sdist, wheel = build(builder, work, output)
        print(sdist.name, wheel.name, sep='\n', flush=True)
        core = environment(args.python, work / 'core')
        run(core, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', sdist, cwd=work)
        print(run(core, '-c', 'from shared_control import BALANCE, panda; print("core from the sdist: task",'
                  ' BALANCE.name, "robot", panda().name)', cwd=work).strip(), flush=True)
        everything = environment(args.python, work / 'all')
        run(everything, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', f'{wheel}[all]', cwd=work)
        check(everything, everything.parent, TUTORIAL, work)


if __name__ == '__main__':
    main()
