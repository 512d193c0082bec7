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

"""The parameter that says which task a node has to do with."""

from rclpy.node import Node
from shared_control.plugins import TASKS, load, names
from shared_control.tasks.task import Task

from .declarations import TASK
from .parameters import ParameterError, declare


def declare_task(node: Node, description: str) -> Task:
    """Declare the parameter ``task`` and make the task it names, with its default settings.

    Args:
        node: whose parameter it is.
        description: of the parameter: what in the task matters to this node.

    Raises:
        ParameterError: there is no such task, or it cannot be used.
    """
    name = declare(node, 'task', TASK, description, choices=names(TASKS))
    try:
        task: Task = load(TASKS, name)()
    except ValueError as error:
        raise ParameterError(f"parameter 'task': {error}") from error
    return task
