# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The folder of a session: where everything is, and who may write it."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from shared_control.files import write_atomically
from shared_control.run_folder import RunFolder, RunFolderError

_OF_THE_NODES = (
    'bag/bag_*.mcap', 'bag/bag_*.mcap.tmp', 'bag/metadata.yaml', 'bag/metadata.yaml.tmp',
    'learner/episodes.csv', 'learner/unfinished.csv', 'learner/last_episode.json', 'learner/practice.json',
    'learner/policy.safetensors', 'learner/policy.json', 'learner/.lock', 'log/*.log')
"""What recorder, learner and nodes write. Their modules take seconds to load, so the names stand here once more."""


def report_beside(session: Path) -> Path:
    """Where the report of a session or of a bag is written unless another place is named."""
    return session.absolute().with_name(f'{session.stem}_report')


class SessionFolder(RunFolder):
    """Paths of everything that a session keeps. Make one with :meth:`create` or :meth:`open`."""

    def __init__(self, path: Path):
        self.bag = path / 'bag'
        """rosbag2 folder (MCAP)."""
        self.learner = path / 'learner'
        """The agent's own folder."""
        self.episodes = self.learner / 'episodes.csv'
        """One row an episode."""
        self.last_episode = self.learner / 'last_episode.json'
        """The end of the teaching that somebody has asked for; there until the agent has done all."""
        self.policy = self.learner / 'policy.safetensors'
        """The learner, to go on with or to test."""
        self.parameters = path / 'parameters.yaml'
        """ROS parameters as resolved."""
        self.given_parameters = path / 'given_parameters.yaml'
        """The ROS parameter file that the session was begun with, as it was then."""
        self.settings = path / 'settings.json'
        """What the options said."""
        self.logs = path / 'log'
        """Output of the nodes."""
        self.test = path / 'test.json'
        """The final test of the policy alone."""
        self.summary = path / 'summary.json'
        """Figures of the session."""
        self.picture = path / 'picture.png'
        """What happened, at a glance; as SVG and PDF beside it."""
        self.report = path / 'report.html'
        """The report, self-contained."""
        self.ending = path / 'ending.json'
        """What is being done after the teaching; there until the session is over, for its page."""
        files = (self.given_parameters, self.parameters, self.test, self.summary, self.picture,
                 self.picture.with_suffix('.svg'), self.picture.with_suffix('.pdf'), self.report, self.ending)
        super().__init__(
            path, 'session', [*(file.name for file in files), *_OF_THE_NODES], self.settings.name, keys=['tutor'])

    @classmethod
    def create(cls, path: str | Path, overwrite: bool = False,
               settings: Mapping[str, Any] | None = None) -> 'SessionFolder':
        """A new folder, claimed for this process.

        Args:
            path: made when it is missing; otherwise empty, or an earlier session when ``overwrite``.
            overwrite: remove what an earlier session wrote there, and nothing else.
            settings: what the options said. Written first: a folder that is left half-made is known as a session's.

        Raises:
            RunFolderError: it holds something else, cannot be written, or is in use; it is then left as it was.
        """
        folder = cls(Path(path).expanduser().absolute())
        folder.begin(overwrite)
        try:
            if settings is not None:
                folder.write_settings(settings)
            folder.learner.mkdir(exist_ok=True)
            folder.logs.mkdir(exist_ok=True)
        except OSError as error:
            folder.release()
            raise RunFolderError(f'cannot write the session folder {folder.path}: {error.strerror}') from error
        return folder

    @classmethod
    def open(cls, path: str | Path) -> 'SessionFolder':
        """The folder of an earlier session. To write into it, claim it.

        Raises:
            RunFolderError: there is none at ``path``.
        """
        folder = cls(Path(path).expanduser().absolute())
        if not folder.path.is_dir():
            raise RunFolderError(f'there is no session folder {folder.path}: sessions are in out/sessions, '
                                 'unless --output said another place')
        if not folder.holds_run and not folder.bag.exists():
            folder.read_json(folder.settings)  # names it when it is damaged
            raise RunFolderError(
                f"{folder.path} is no session folder: it has neither a session's settings.json nor bag/")
        return folder

    def write_settings(self, settings: Mapping[str, Any]) -> None:
        """Write ``settings.json``.

        Raises:
            OSError: it cannot be written.
        """
        write_atomically(self.settings, (json.dumps(settings, indent=2) + '\n').encode())

    def read_json(self, path: Path) -> dict[str, Any] | None:
        """An object in one of the folder's JSON files; None when the file is missing.

        Raises:
            RunFolderError: it is no such file.
        """
        try:
            content = json.loads(path.read_text(encoding='utf-8'))
        except FileNotFoundError:
            return None
        except (OSError, ValueError, RecursionError) as error:
            raise RunFolderError(f'cannot read {path}: {error}') from error
        if not isinstance(content, dict):
            raise RunFolderError(f'cannot read {path}: expected a JSON object')
        return content

    def ros_parameters(self, node: str) -> dict[str, Any]:
        """A node's parameters in ``parameters.yaml``; empty when they are not there.

        Raises:
            RunFolderError: the file is no parameter file.
        """
        try:
            content = yaml.safe_load(self.parameters.read_text(encoding='utf-8'))
            return dict(content.get(node, {}).get('ros__parameters', {}))
        except FileNotFoundError:
            return {}
        except (OSError, yaml.YAMLError, AttributeError, TypeError, ValueError, RecursionError) as error:
            raise RunFolderError(f'cannot read {self.parameters}: {error}') from error
