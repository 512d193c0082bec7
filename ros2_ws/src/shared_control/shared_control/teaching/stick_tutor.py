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

"""The same simulated people with a stick in the hand."""

import math

import numpy as np

from ..bounds import bounded
from ..keys import HUMAN_MOMENT_LIMIT
from ..plant import PlantState
from ..rates import POLICY_PERIOD
from .individual_tutor import IndividualTutor

HAND_SECONDS = 0.1
"""How late the hand follows what is wanted: the neuromuscular lag (McRuer and Jex, 1967), s."""


class StickTutor(IndividualTutor):
    """An :class:`Individual` at a stick: eyes, delays, lapses and law are as at the keys; the hand holds any moment.

    What is a matter of keys (rate of presses, habits, wrong keys) has no meaning here. There is no such person for the
    graph: nodes press keys.
    """

    def _begin(self) -> None:
        super()._begin()
        self._held = np.zeros(len(self._task.axes))

    def moment(self, state: PlantState) -> np.ndarray:
        """M_h for the coming policy period, (k,), N m (see ``Person``)."""
        aim = self.wanted(self._steps * POLICY_PERIOD, self.look(state), self._held)
        self._steps += 1
        if aim is not None:
            aim = bounded(aim, HUMAN_MOMENT_LIMIT)
            self._held = aim + (self._held - aim) * math.exp(-POLICY_PERIOD / HAND_SECONDS)
        return self._held
