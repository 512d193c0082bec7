"""Pages of reference that are made of the code: commands, parameters of nodes, public modules.

They are written whenever the site is built, and not kept.
"""

import argparse
import importlib
import inspect
import os
import pkgutil
import tomllib
from importlib.metadata import distribution
from pathlib import Path

from shared_control.cli import known_commands
from shared_control_ros.declarations import declarations

ROOT = Path(__file__).parents[1]
PACKAGES = ('shared_control', 'shared_control_sim', 'shared_control_learning', 'shared_control_records',
            'shared_control_ros')
"""Packages whose modules people import, the last one to write a node."""


def version() -> str:
    """The version of the distribution."""
    return tomllib.loads((ROOT / 'pyproject.toml').read_text())['project']['version']


def write(folder: Path) -> None:
    """Write all of them into ``folder``; a page that has not changed is left alone, so that it is not built again."""
    folder.mkdir(exist_ok=True)
    pages = {'commands': commands(), 'parameters': parameters(), **{f'api_{name}': api(name) for name in PACKAGES}}
    for name, text in pages.items():
        path = folder / f'{name}.md'
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


def commands() -> str:
    """The help of ``shared-control`` and its subcommands, as argparse prints it; and which option is where."""
    os.environ['COLUMNS'] = '100'
    subparsers = argparse.ArgumentParser(prog='shared-control').add_subparsers()
    for entry_point in known_commands():
        entry_point.load()(subparsers)
    options: dict[str, list[str]] = {}
    text = ''
    for name, parser in subparsers.choices.items():
        text += f'\n## {name}\n\n```text\n{parser.format_help()}```\n'
        for option in (action.option_strings[-1] for action in parser._actions if action.option_strings):
            options.setdefault(option, []).append(name)
    rows = ''.join(f'| `{option}` | {", ".join(where)} |\n' for option, where in sorted(options.items())
                   if len(where) < len(subparsers.choices))
    return ('# Commands\n\n`shared-control COMMAND`; printed by argparse. An option means the same wherever it is:\n\n'
            f'| option | commands |\n|---|---|\n{rows}{text}')


def parameters() -> str:
    """The parameters that each node declares, from its sources."""
    text = ('# Parameters of nodes\n\nAs the sources declare them; no node is started for this. `ros2 param describe` '
            'says the same of a node that runs. Beside these, every node has the parameters of rclpy, such as '
            '`use_sim_time`.\n')
    scripts = distribution('shared-control').entry_points.select(group='console_scripts')
    nodes = sorted(script.name for script in scripts if script.name.endswith('_node'))
    for node in nodes:
        rows = ''.join(f'| `{found.name}` | `{found.shown}` | {found.description} |\n'
                       for found in declarations(node))
        text += f'\n## {node}\n\n' + (f'| parameter | default | what |\n|---|---|---|\n{rows}' if rows else 'None.\n')
    return text


def api(package: str) -> str:
    """The public modules of a package, by autodoc."""
    module = importlib.import_module(package)
    found = pkgutil.walk_packages(module.__path__, f'{package}.')
    public = [info for info in found if not any(part.startswith('_') for part in info.name.split('.'))]
    text = f'# {package}\n\n{(inspect.getdoc(module) or "").splitlines()[0]}\n'
    for info in public:
        options = '' if info.ispkg else '   :members:\n   :undoc-members:\n'
        # autodoc writes reStructuredText, which MyST would show as it is.
        text += f'\n## {info.name}\n\n```{{eval-rst}}\n.. automodule:: {info.name}\n{options}```\n'
    return text
