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

"""What other packages add by entry points."""

from importlib.metadata import EntryPoint

import pytest
from shared_control import plugins
from shared_control.tasks.balance import Balance


def test_what_has_another_name_than_its_entry_point_is_refused(monkeypatch):
    """It was taught to the end, and the policy could not be read: that keeps the name of the class."""
    own = EntryPoint('mine', f'{Balance.__module__}:Balance', plugins.TASKS)
    monkeypatch.setattr(plugins, 'entry_points', lambda group: [own])
    with pytest.raises(ValueError, match=r"the task 'mine' has the name 'balance' in shared_control\.tasks\.balance"):
        plugins.load(plugins.TASKS, 'mine')
