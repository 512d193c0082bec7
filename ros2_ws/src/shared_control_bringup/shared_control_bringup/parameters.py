"""The parameters of a session: the file that comes with the package, and what the options change in it."""

from pathlib import Path
from typing import Any

import yaml

DEFAULTS = Path(__file__).parent / 'config' / 'session.yaml'


def load(path: Path = DEFAULTS) -> dict[str, dict[str, Any]]:
    """Parameters by node; a node named for any namespace (``/**/NODE``) appears under its name.

    Raises:
        ValueError: the file is not a ROS parameter file; the message names it.
        OSError: it cannot be read.
    """
    try:
        content = yaml.safe_load(path.read_text())
    except yaml.YAMLError as error:
        raise ValueError(f'{path} is not valid YAML: {error}') from error
    if not isinstance(content, dict):
        raise ValueError(f'{path} is not a ROS parameter file: expected NODE: ros__parameters: NAME: VALUE')
    for node, section in content.items():
        if not isinstance(section, dict) or not isinstance(section.get('ros__parameters'), dict):
            raise ValueError(f'{path}: node {node!r} has no ros__parameters')
    return {node.removeprefix('/**/'): dict(section['ros__parameters']) for node, section in content.items()}


def save(parameters: dict[str, dict[str, Any]], path: Path) -> None:
    """Write a ROS parameter file."""
    content = {node: {'ros__parameters': values} for node, values in parameters.items()}
    path.write_text(yaml.safe_dump(content, sort_keys=False))
