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

"""Wrenches for Rosetta (github.com/iblnkn/rosetta), which has no codec for them; ``rosetta_contract.yaml`` names these.

``spec.names`` are the selected fields, as in ``wrench.torque.y``.
"""

from functools import reduce
from typing import Any

import numpy as np
from geometry_msgs.msg import WrenchStamped

from .contract import BASE_FRAME
from .stamps import set_ns


def decode_wrench(message: WrenchStamped, spec: Any) -> np.ndarray:
    """The selected fields, (k,), N and N m."""
    return np.array([reduce(getattr, name.split('.'), message) for name in spec.names], np.float64)


def encode_wrench(values: np.ndarray, spec: Any, stamp_ns: int | None = None) -> WrenchStamped:
    """A wrench of the base frame with ``values``, (k,), in the selected fields, and zeros in the others."""
    message = WrenchStamped()
    message.header.frame_id = BASE_FRAME
    if stamp_ns is not None:
        set_ns(message.header.stamp, stamp_ns)
    for name, value in zip(spec.names, values, strict=True):
        *path, field = name.split('.')
        setattr(reduce(getattr, path, message), field, float(value))
    return message
