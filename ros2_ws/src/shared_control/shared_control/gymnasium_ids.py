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

"""Every task under an id of Gymnasium: ``gymnasium.make('shared_control/Balance-v0')``.

Gymnasium (since 1.0) asks no entry points for environments, so they are registered here: at once when Gymnasium is
there already, else as soon as it is imported. It is not imported for that, since the 1 kHz controller needs none.
"""

import re
import sys
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Any

_MAKER = 'shared_control_sim.environments:make_env'
"""As a string: it loads a simulator, once an environment is made."""


def gymnasium_id(task: str) -> str:
    """The id of the task called ``task``: ``two_axis`` is ``shared_control/TwoAxis-v0``."""
    return f'shared_control/{"".join(part[:1].upper() + part[1:] for part in re.split("[_-]", task))}-v0'


def register_with_gymnasium() -> None:
    """Register all tasks, now or when Gymnasium is imported."""
    if sys.modules.get('gymnasium') is not None:
        register_tasks()
    else:
        sys.meta_path.insert(0, _WhenImported())


def register_tasks() -> None:
    """Register the tasks that are not yet; imports neither them nor a simulator."""
    from gymnasium.envs.registration import register, registry

    from .plugins import TASKS, names  # here, because reading metadata is no work for the 1 kHz controller
    for task in names(TASKS):
        if gymnasium_id(task) not in registry:
            register(gymnasium_id(task), entry_point=_MAKER, kwargs={'task': task})


class _WhenImported(MetaPathFinder):
    """Finds Gymnasium where the others do, and registers the tasks after it has been loaded."""

    _is_asking = False

    def find_spec(self, name: str, path: Any, target: ModuleType | None = None) -> ModuleSpec | None:
        if name != 'gymnasium' or self._is_asking:
            return None
        self._is_asking = True
        try:
            spec = find_spec(name)
        finally:
            self._is_asking = False
        if spec is not None and spec.loader is not None:
            load = spec.loader.exec_module

            def load_and_register(module: ModuleType) -> None:
                load(module)
                register_tasks()

            spec.loader.exec_module = load_and_register  # type: ignore[method-assign]
        return spec
