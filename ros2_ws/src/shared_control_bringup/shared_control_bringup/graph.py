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

"""The nodes of a session: who takes part, who starts after whom, and what its settings give them.

``shared-control session``, the launch files and the tests of ``docker/compose.yaml`` all go by this table.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path
from typing import Any

from shared_control_records.session.folder import SessionFolder

from .settings import Settings


class Role(Enum):
    """What a node is to its session."""

    MEMBER = auto()
    """Nothing special."""
    CONTROL_LOOP = auto()
    """A part of the 1 kHz loop, which has a core of its own."""
    FOREGROUND = auto()
    """Uses the terminal when the lesson is shown there."""
    LEADER = auto()
    """Its clean end is the end of the session."""
    STOPPER = auto()
    """Its clean end stops the session before its end."""


@dataclass(frozen=True)
class Session:
    """What the parameters of nodes depend on."""

    settings: Settings
    folder: SessionFolder
    shows_screen: bool
    """Whether the lesson is shown in the terminal."""


@dataclass(frozen=True)
class SessionNode:
    """One node of a session."""

    name: str
    """Name of the node and of its executable."""
    parameters: Callable[[Session], dict[str, Any]]
    """What it is given on top of the parameter file."""
    role: Role = Role.MEMBER
    tutor: str = ''
    """Takes part with this tutor only; empty: with any."""
    after: str = ''
    """Starts when this node is ready; empty: at once."""


BREAK_SECONDS = 3.0
"""Before and between episodes, when a person teaches, s."""
BESIDE_A_SIMULATOR = {'enabled': True}
"""Parameters of the controller where whoever starts it also starts a simulator. Nowhere else is it enabled without a
person."""
ALONE: dict[str, dict[str, Any]] = {'torque_ctrl_node': {'enabled': False}}
"""What a node is given when it is started without the others, whatever the parameter file says: the robot might be a
real one, and a controller that died must not move it again by itself."""


def _of_the_task(settings: Settings) -> dict[str, Any]:
    """What the controller takes from the task."""
    from shared_control_learning.presets import preset_for  # late: `--help` need not wait for pinocchio
    task = preset_for(settings.task, settings.preset).task
    return {'task': task.name, 'moment_limit': float(task.limit.max())}


NODES = (
    SessionNode('session_recorder_node', lambda s: {'output': str(s.folder.bag)}),
    SessionNode('torque_ctrl_node', lambda s: {
        **_of_the_task(s.settings), 'sharing': s.settings.sharing, **BESIDE_A_SIMULATOR}, Role.CONTROL_LOOP),
    SessionNode('panda_sim_node', lambda s: {
        'task': _of_the_task(s.settings)['task'], 'physics': s.settings.physics, 'seed': s.settings.seed},
        Role.CONTROL_LOOP, after='session_recorder_node'),
    SessionNode('teleop_key_node', lambda s: {
        'task': _of_the_task(s.settings)['task'],
        'screen': 'auto' if s.shows_screen else 'off', 'in_session': True,
        'feedback': s.settings.feedback, 'verdicts': s.settings.verdicts}, Role.FOREGROUND),
    SessionNode('sim_tutor_node', lambda s: {
        'task': _of_the_task(s.settings)['task'], 'profile': s.settings.profile,
        'seed': s.settings.seed}, tutor='sim'),
    SessionNode('teach_page_node', lambda s: {
        'task': _of_the_task(s.settings)['task'], 'host': s.settings.page[0], 'port': s.settings.page[1],
        'session': str(s.folder.path), 'feedback': s.settings.feedback, 'verdicts': s.settings.verdicts,
        'shows_result': not s.settings.blind}, Role.STOPPER, tutor='page'),
    SessionNode('ppo_agent_node', lambda s: {
        'task': s.settings.task, 'preset': s.settings.preset, 'seed': s.settings.seed, 'episodes': s.settings.episodes,
        'max_minutes': s.settings.minutes, 'practice': s.shows_screen or s.settings.tutor == 'page',
        'practice_rests': s.settings.practice_rests, 'practice_minutes': s.settings.practice_minutes,
        'break_seconds': BREAK_SECONDS if s.settings.tutor in ('keyboard', 'page') else 0.0,
        'output': str(s.folder.learner)}, Role.LEADER),
)
"""In the order in which they start, side by side: all wait for the simulator, which begins the time, and this for the
recorder, which is to miss none of it."""
OTHERS = ('mock_panda_node', 'panda_bridge_node', 'robot_view_node')
"""Nodes that no session starts."""
ALL_NODES = (*(node.name for node in NODES), *OTHERS)


def nodes_of(tutor: str) -> list[SessionNode]:
    """Those that take part in a session with this tutor."""
    return [node for node in NODES if node.tutor in ('', tutor)]


def named(*roles: Role) -> list[str]:
    """Names of the nodes in these roles."""
    return [node.name for node in NODES if node.role in roles]


def overrides(settings: Settings, folder: Path, shows_screen: bool) -> dict[str, dict[str, Any]]:
    """What the nodes of a session are given on top of the parameter file, by name.

    Args:
        settings: of the session; the port of its page must be known.
        folder: of the session.
        shows_screen: whether the lesson is shown in the terminal.
    """
    session = Session(settings, SessionFolder(folder), shows_screen)
    robot = {'robot': settings.robot} if settings.robot else {}
    return {node.name: {**robot, **node.parameters(session)} for node in nodes_of(settings.tutor)}
