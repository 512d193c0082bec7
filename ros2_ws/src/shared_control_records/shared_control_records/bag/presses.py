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

"""Which key presses of a bag count."""

from typing import Any

import numpy as np
from shared_control import contract
from shared_control.keys import COUNT_IN

from .reader import Bag
from .recorded import Press, Series


def presses_that_count(bag: Bag) -> list[Press]:
    """Those in practice and teaching, or where nobody gives a lesson, and in no pause that the simulator reports."""
    phases, pauses = bag.training[contract.PHASE], _pauses(bag)
    return [press for press in bag.presses
            if _at(phases, press) in (None, *COUNT_IN) and _at(pauses, press) != 'True']


def _pauses(bag: Bag) -> Series:
    reports = sorted((status.received_ns, status.values['paused']) for statuses in bag.statuses.values()
                     for status in statuses if 'paused' in status.values)
    return Series(np.array([at for at, _ in reports], np.int64), np.array([paused for _, paused in reports]))


def _at(series: Series, press: Press) -> Any:
    """What was said last; None: nothing."""
    index = int(np.searchsorted(series.received_ns, press.received_ns, 'right')) - 1
    return series.values[index] if index >= 0 else None
