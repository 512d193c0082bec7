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

"""When the robot's time ran on, and when it was set back: by a simulator that was started anew, or by a clock."""

import numpy as np

from .reader import Bag


def run_window(bag: Bag, received_ns: int) -> tuple[int, int]:
    """The recorder's time from which, and until which, the robot's time ran on around ``received_ns``, ns.

    Stamps are in order there and name one moment each. Beyond, the same stamps may come again, of another run.
    """
    stamps, received = bag.joint_states.stamp_ns, bag.joint_states.received_ns
    set_back = received[1:][np.diff(stamps) < 0]
    index = int(np.searchsorted(set_back, received_ns, 'right'))
    limits = np.iinfo(np.int64)
    return (int(set_back[index - 1]) if index else limits.min,
            int(set_back[index]) if index < len(set_back) else limits.max)
