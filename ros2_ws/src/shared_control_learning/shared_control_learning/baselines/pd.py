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

"""A spring and a damper, by hand."""

from shared_control.tasks.task import Task

from .linear import LinearLearner
from .needs import scales_of
from .presets import PdSettings


class PdController(LinearLearner):
    """``M = stiffness e - damping v + level``: what an engineer tries first. It learns nothing.

    Raises:
        ValueError: the task is not ``balance``, whose observation it knows.
    """

    settings: PdSettings

    def __init__(self, name: str, task: Task, settings: PdSettings, seed: int = 0):
        super().__init__(name, task, settings, seed)
        error, velocity, _ = scales_of(name, task)
        self.weights[0, :2] = settings.stiffness * error, -settings.damping * velocity
        self.weights /= task.scale
        self.bias[0] = settings.level / float(task.scale[0])
