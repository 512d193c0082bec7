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

"""From where an arm may be taken under control: near the reference, to which it would leap from further off."""

import numpy as np

from .spec import RobotSpec

START_WITHIN = 0.2
"""rad"""


def far_from_home(spec: RobotSpec, q: np.ndarray) -> str:
    """Which joint is further from the reference than ``START_WITHIN``; empty when none is. ``q``: (n,), rad."""
    off = np.abs(q - spec.home)
    if off.max() <= START_WITHIN:
        return ''
    joint = int(off.argmax())
    return (f'{spec.joints[joint]} is {off[joint]:.2f} rad off the reference, at most {START_WITHIN} are '
            'allowed: bring the arm there first')
