"""Policies as people name them: a file, or the folder of a session or of a training run."""

import os
from collections.abc import Sequence
from pathlib import Path

from shared_control_learning.learner import Learner
from shared_control_learning.policy_file import POLICY_NAME, PolicyFileError, load_policy

from ..session.folder import SessionFolder


def load_policies(paths: Sequence[Path]) -> dict[str, Learner]:
    """The policies, by their paths from the folder that they have in common.

    Raises:
        PolicyFileError: one is missing or unusable, or a folder has none.
        ValueError: one is given twice.
    """
    absolute = [path.expanduser().resolve() for path in paths]
    if len(set(absolute)) < len(absolute):
        raise ValueError(f'a policy is given twice: {", ".join(map(str, paths))}')
    root = os.path.commonpath([path.parent for path in absolute])
    return {str(path.relative_to(root)): load_policy(_policy_file(path)) for path in absolute}


def _policy_file(path: Path) -> Path:
    if not path.is_dir():
        return path
    places = (path / POLICY_NAME, SessionFolder(path).policy)
    found = next((place for place in places if place.exists()), None)
    if found is None:
        raise PolicyFileError(f'no policy in {path}: expected {" or ".join(map(str, places))}')
    return found
