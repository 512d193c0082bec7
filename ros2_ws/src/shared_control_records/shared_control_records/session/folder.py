"""The folder of a session: where everything is, and who may write it."""

import fcntl
import json
import shutil
from pathlib import Path
from typing import IO, Any

import yaml


class SessionFolderError(OSError):
    """A session's folder cannot be used; the message names it and says why."""


class SessionFolder:
    """Paths of everything that a session keeps. Make one with :meth:`create` or :meth:`open`."""

    def __init__(self, path: Path):
        self.path = path
        self.bag = path / 'bag'
        """rosbag2 folder (MCAP)."""
        self.learner = path / 'learner'
        """The agent's own folder."""
        self.episodes = self.learner / 'episodes.csv'
        """One row an episode."""
        self.policy = self.learner / 'policy.safetensors'
        """The learner, to go on with or to test."""
        self.parameters = path / 'parameters.yaml'
        """ROS parameters as resolved."""
        self.settings = path / 'settings.json'
        """What the options said."""
        self.logs = path / 'log'
        """Output of the nodes."""
        self.test = path / 'test.json'
        """The final test of the policy alone."""
        self.summary = path / 'summary.json'
        """Figures of the session."""
        self.picture = path / 'picture.png'
        """What happened, at a glance."""
        self.report = path / 'report.html'
        """The report, self-contained."""
        self._lock_path = path / '.lock'
        self._lock: IO[bytes] | None = None

    @classmethod
    def create(cls, path: str | Path, overwrite: bool = False) -> 'SessionFolder':
        """A new folder, claimed for this process.

        Args:
            path: made when it is missing; otherwise empty, or an earlier session when ``overwrite``.
            overwrite: remove what an earlier session left there.

        Raises:
            SessionFolderError: it holds something else, cannot be written, or is in use.
        """
        folder = cls(Path(path).expanduser().absolute())
        try:
            folder.path.mkdir(parents=True, exist_ok=True)
            folder.claim()
            folder._make_room(overwrite)
            folder.learner.mkdir()
            folder.logs.mkdir()
        except SessionFolderError:
            folder.release()
            raise
        except OSError as error:
            folder.release()
            raise SessionFolderError(f'cannot write the session folder {folder.path}: {error.strerror}') from error
        return folder

    @classmethod
    def open(cls, path: str | Path) -> 'SessionFolder':
        """The folder of an earlier session. To write into it, :meth:`claim` it.

        Raises:
            SessionFolderError: there is none at ``path``.
        """
        folder = cls(Path(path).expanduser().absolute())
        if not folder.path.is_dir():
            raise SessionFolderError(f'there is no session folder {folder.path}')
        if not folder._is_session():
            raise SessionFolderError(f'{folder.path} is no session folder: it has neither settings.json nor bag/')
        return folder

    def claim(self) -> None:
        """Hold the folder until :meth:`release`, or until this process ends, however it ends.

        Raises:
            SessionFolderError: another session holds it, or it cannot be written.
        """
        try:
            file = self._lock_path.open('ab')
        except OSError as error:
            raise SessionFolderError(f'cannot write the session folder {self.path}: {error.strerror}') from error
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            file.close()
            raise SessionFolderError(f'the session folder {self.path} is in use by another session') from error
        self._lock = file

    def release(self) -> None:
        """Let others have the folder."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def read_json(self, path: Path) -> dict[str, Any] | None:
        """An object in one of the folder's JSON files; None when the file is missing.

        Raises:
            SessionFolderError: it is no such file.
        """
        try:
            content = json.loads(path.read_text())
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            raise SessionFolderError(f'cannot read {path}: {error}') from error
        if not isinstance(content, dict):
            raise SessionFolderError(f'cannot read {path}: expected a JSON object')
        return content

    def ros_parameters(self, node: str) -> dict[str, Any]:
        """A node's parameters in ``parameters.yaml``; empty when they are not there.

        Raises:
            SessionFolderError: the file is no parameter file.
        """
        try:
            content = yaml.safe_load(self.parameters.read_text())
            return dict(content.get(node, {}).get('ros__parameters', {}))
        except FileNotFoundError:
            return {}
        except (OSError, yaml.YAMLError, AttributeError, TypeError, ValueError) as error:
            raise SessionFolderError(f'cannot read {self.parameters}: {error}') from error

    def _is_session(self) -> bool:
        return self.settings.exists() or self.bag.exists()

    def _make_room(self, overwrite: bool) -> None:
        present = [child for child in self.path.iterdir() if child != self._lock_path]
        if not present:
            return
        if not self._is_session():
            raise SessionFolderError(f'{self.path} is not empty and no session: choose another folder')
        if not overwrite:
            raise SessionFolderError(f'{self.path} already holds a session: choose another folder, or overwrite it')
        for child in (self.bag, self.learner, self.logs, self.parameters, self.settings, self.test, self.summary,
                      self.picture, self.report):
            if child.is_dir() and not child.is_symlink():
                shutil.rmtree(child)
            else:
                child.unlink(missing_ok=True)
