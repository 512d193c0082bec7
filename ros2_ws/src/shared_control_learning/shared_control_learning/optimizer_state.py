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

"""What Adam remembers, as tensors."""

from collections.abc import Iterable

import torch


def adam_tensors(optimizer: torch.optim.Optimizer, parameters: Iterable[tuple[str, torch.Tensor]],
                 ) -> dict[str, torch.Tensor]:
    """Moments and step counts by name; copying into these changes the optimizer.

    Args:
        parameters: with their names; all of them are the optimizer's.
    """
    tensors = {}
    for name, parameter in parameters:
        state = optimizer.state[parameter]
        if not state:  # as Adam itself starts
            state.update(step=torch.tensor(0.0), exp_avg=torch.zeros_like(parameter),
                         exp_avg_sq=torch.zeros_like(parameter))
        for key in ('step', 'exp_avg', 'exp_avg_sq'):
            tensors[f'adam.{key}.{name}'] = state[key]
    return tensors
