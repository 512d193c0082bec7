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

"""Exploring noise."""

import math

import torch
from shared_control.rates import POLICY_PERIOD


class CorrelatedNoise:
    """Standard normal at every step; steps that follow each other are correlated (an Ornstein-Uhlenbeck process).

    Args:
        size: numbers a step, k.
        seconds: correlation time, s; 0: white.
    """

    def __init__(self, size: int, seconds: float):
        self._kept = math.exp(-POLICY_PERIOD / seconds) if seconds else 0.0
        """Correlation from one step to the next."""
        self._random = torch.Generator()
        self._noise = torch.zeros(size)

    def begin(self, seed: int) -> None:
        """Begin the sequence that belongs to ``seed``."""
        self._random.manual_seed(seed)
        self._noise = self._draw()

    def next(self) -> torch.Tensor:
        """The noise of the next step, (k,)."""
        noise = self._noise
        self._noise = self._kept * noise + math.sqrt(1.0 - self._kept ** 2) * self._draw()
        return noise

    def _draw(self) -> torch.Tensor:
        return torch.randn(len(self._noise), generator=self._random)
