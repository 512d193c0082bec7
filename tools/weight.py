"""What the 1 kHz controller costs the robot's computer: installs it alone, counts, and lets it answer a mock robot.

    python tools/weight.py --output out/weight.json        # what `make weight` runs

Makes an empty environment, installs just what torque_ctrl_node needs (``pip install .[ros]``), prints the packages with
their sizes, and starts the controller from there beside a mock robot of this environment. Exit code 1 when something
heavy came along or when the controller does not answer.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

from shared_control.command_line import script_parser

ROOT = Path(__file__).parents[1]
HEAVY = ('torch', 'stable-baselines3', 'pybullet', 'mujoco', 'pandas', 'matplotlib', 'nicegui')
"""Distributions that have no place on a robot's computer."""
ANSWERS = 500
"""Torques that the mock robot must get."""
LIST = """
import importlib.metadata, json, os
print(json.dumps({
    d.metadata['Name']: sum(os.path.getsize(p) for f in d.files or () if os.path.isfile(p := d.locate_file(f)))
    for d in importlib.metadata.distributions()}))
"""


def install(folder: Path) -> Path:
    """An environment in ``folder`` with the controller and nothing else; its interpreter."""
    venv.create(folder / 'venv', with_pip=True)
    python = folder / 'venv' / 'bin' / 'python'
    sources = folder / 'sources'  # a copy, since a build leaves files beside what it builds
    for part in ('setup.py', 'pyproject.toml', 'requirements.txt', 'README.md', 'LICENSE', 'ros2_ws/src'):
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        (sources / part).parent.mkdir(parents=True, exist_ok=True)
        copy(ROOT / part, sources / part)
    subprocess.run([python, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', f'{sources}[ros]'],
                   check=True)
    subprocess.run([python, '-m', 'pip', 'uninstall', '--quiet', '--yes', 'setuptools', 'pip'], check=True)
    return python


def sizes(python: Path) -> dict[str, int]:
    """Bytes of every distribution of an environment."""
    return json.loads(subprocess.run([python, '-c', LIST], check=True, capture_output=True, text=True).stdout)


def answers(python: Path) -> int:
    """How many torques the controller of that environment sends to a mock robot of this one, up to ``ANSWERS``."""
    from shared_control_ros import contract
    from shared_control_testing.nodes import Observer, free_domain, running_nodes
    from std_srvs.srv import SetBool
    with free_domain() as domain, tempfile.TemporaryDirectory() as logs, running_nodes(Path(logs)) as start:
        start('mock_panda_node')
        start('torque_ctrl_node', python=str(python), prediction_horizon=0.004)
        observer = Observer(domain)
        try:
            torques = observer.listen(contract.EFFORT_COMMANDS)
            # Enabled by hand, as on a robot; it refuses until it has seen where the joints are.
            while not observer.call(SetBool, contract.ENABLE_SERVICE, SetBool.Request(data=True)).success:
                observer.spin_for(0.2)
            observer.spin(lambda: len(torques) >= ANSWERS, 60.0, 'torques')
            return len(torques)
        finally:
            observer.close()


def main() -> int:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--output', type=Path, default=Path('out/weight.json'), metavar='FILE',
                        help='file for the figures')
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        python = install(Path(folder))
        found = sizes(python)
        answered = answers(python)
    for name, size in sorted(found.items(), key=lambda item: -item[1]):
        print(f'{size / 1e6:9.1f} MB  {name}')
    total = sum(found.values()) / 1e6
    heavy = sorted(name for name in found if name.lower() in HEAVY)
    print(f'{total:9.1f} MB  in {len(found)} packages; torques that a mock robot got from it: {answered}'
          + (f'; too heavy: {", ".join(heavy)}' if heavy else ''))
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps({
        'controller_mb': round(total, 1), 'controller_packages': len(found), 'heavy': heavy, 'answers': answered,
        'packages_mb': {name: round(size / 1e6, 2) for name, size in sorted(found.items())}}, indent=2) + '\n')
    return int(bool(heavy) or answered < ANSWERS)


if __name__ == '__main__':
    sys.exit(main())
