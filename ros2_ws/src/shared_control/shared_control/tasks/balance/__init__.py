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

"""The task of the thesis: bring the ball to the centre of the tray and keep it there, by one moment."""

from dataclasses import replace

from .task import Balance, BalanceState

__all__ = ['BALANCE', 'THESIS', 'Balance', 'BalanceState']

BALANCE = Balance()
"""As it is taught by default."""
THESIS = replace(
    BALANCE, action_scale=100.0, moment_limit=105.0, observation_scales=None, rewards_high_manipulability=False,
    reward_scale=1.0)
"""As the appendix runs it."""
