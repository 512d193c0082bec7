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

"""Shared-control training: a person and a learning agent move a robot together.

What a user needs stands here: ``from shared_control import BALANCE, LocalPlant, SharedControlEnv``. A name is loaded
when it is asked for, because the 1 kHz controller imports this package and must not load a simulator or torch with it.
``gymnasium.make('shared_control/Balance-v0')`` works once this package is imported (:mod:`.gymnasium_ids`).
"""

from importlib import import_module
from typing import TYPE_CHECKING

from .extras import missing
from .gymnasium_ids import register_with_gymnasium

if TYPE_CHECKING:
    from shared_control_learning.callbacks import Callbacks
    from shared_control_learning.episode import Episode
    from shared_control_learning.evaluation.evaluate import Evaluation, as_tested, evaluate
    from shared_control_learning.learn import learn
    from shared_control_learning.learner import Learner
    from shared_control_learning.policy_file import load_policy, save_policy
    from shared_control_learning.presets import Preset, preset
    from shared_control_learning.training import TrainingRun, train
    from shared_control_sim.bullet import BulletWorld
    from shared_control_sim.local_plant import LocalPlant, Person

    from .control.computed_torque import ComputedTorqueController
    from .env import SharedControlEnv
    from .keys import Key, KeyMap
    from .plant import Plant, PlantInterrupted, PlantState
    from .plugins import DEVICES, LEARNERS, ROBOTS, TASKS, WORLDS, load, names
    from .robot.model import RobotModel
    from .robot.spec import Gains, RobotSpec
    from .robot.spec_file import load_robot, panda
    from .scene import Ball, Box, Scene
    from .tasks.balance import BALANCE, Balance, BalanceState
    from .tasks.task import Task, TaskState, settled
    from .teaching.device import Device
    from .teaching.profiles import TutorProfile, profile
    from .teaching.tutor import SimulatedTutor
    from .world import World

__all__ = [
    'BALANCE', 'DEVICES', 'LEARNERS', 'ROBOTS', 'TASKS', 'WORLDS', 'Balance', 'BalanceState', 'Ball', 'Box',
    'BulletWorld', 'Callbacks', 'ComputedTorqueController', 'Device', 'Episode', 'Evaluation', 'Gains', 'Key',
    'KeyMap', 'Learner', 'LocalPlant', 'Person', 'Plant', 'PlantInterrupted', 'PlantState', 'Preset', 'RobotModel',
    'RobotSpec', 'Scene', 'SharedControlEnv', 'SimulatedTutor', 'Task', 'TaskState', 'TrainingRun', 'TutorProfile',
    'World', 'as_tested', 'evaluate', 'learn', 'load', 'load_policy', 'load_robot', 'names', 'panda', 'preset',
    'profile', 'save_policy', 'settled', 'train',
]

_NAMES_IN = {
    'shared_control.control.computed_torque': ('ComputedTorqueController',),
    'shared_control.env': ('SharedControlEnv',),
    'shared_control.keys': ('Key', 'KeyMap'),
    'shared_control.plant': ('Plant', 'PlantInterrupted', 'PlantState'),
    'shared_control.plugins': ('DEVICES', 'LEARNERS', 'ROBOTS', 'TASKS', 'WORLDS', 'load', 'names'),
    'shared_control.robot.model': ('RobotModel',),
    'shared_control.robot.spec': ('Gains', 'RobotSpec'),
    'shared_control.robot.spec_file': ('load_robot', 'panda'),
    'shared_control.scene': ('Ball', 'Box', 'Scene'),
    'shared_control.tasks.balance': ('BALANCE', 'Balance', 'BalanceState'),
    'shared_control.tasks.task': ('Task', 'TaskState', 'settled'),
    'shared_control.teaching.device': ('Device',),
    'shared_control.teaching.profiles': ('TutorProfile', 'profile'),
    'shared_control.teaching.tutor': ('SimulatedTutor',),
    'shared_control.world': ('World',),
    'shared_control_learning.callbacks': ('Callbacks',),
    'shared_control_learning.episode': ('Episode',),
    'shared_control_learning.evaluation.evaluate': ('Evaluation', 'as_tested', 'evaluate'),
    'shared_control_learning.learn': ('learn',),
    'shared_control_learning.learner': ('Learner',),
    'shared_control_learning.policy_file': ('load_policy', 'save_policy'),
    'shared_control_learning.presets': ('Preset', 'preset'),
    'shared_control_learning.training': ('TrainingRun', 'train'),
    'shared_control_sim.bullet': ('BulletWorld',),
    'shared_control_sim.local_plant': ('LocalPlant', 'Person'),
}
"""Where a name is defined. As strings: this package stands below the others and imports none of them itself."""
_MODULE_OF = {name: module for module, names_ in _NAMES_IN.items() for name in names_}

if not TYPE_CHECKING:  # so that mypy knows the names above, and no others
    def __getattr__(name):
        """Load an exported name.

        Raises:
            ImportError: what it needs is not installed; the message says what to install.
        """
        if name not in _MODULE_OF:
            raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
        try:
            value = getattr(import_module(_MODULE_OF[name]), name)
        except ModuleNotFoundError as error:
            raise missing(f'shared_control.{name}', error) from error
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


register_with_gymnasium()
