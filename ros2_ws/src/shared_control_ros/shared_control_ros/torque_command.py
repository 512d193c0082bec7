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

"""Joint torques as they travel: Float64MultiArray with the tick that they answer.

The label of the array's dimension is the stamp of the joint states that were answered, ns, in digits. A simulator in
lockstep needs it: after a stall an answer may come twice, and one taken for that of the next tick would leave every
torque from then on a tick late. Effort controllers of robots look at the data alone.
"""

import math

from rclpy.serialization import serialize_message
from shared_control.contract import answer_label
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout

from .wire import WireLayout


def torque_command(torque: list[float], stamp_ns: int) -> Float64MultiArray:
    """The answer to joint states of a stamp: torques, (n,), N m."""
    dimension = MultiArrayDimension(label=answer_label(stamp_ns), size=len(torque), stride=len(torque))
    return Float64MultiArray(layout=MultiArrayLayout(dim=[dimension]), data=torque)


def command_layout(dof: int) -> WireLayout:
    """Where torques and label lie in an answer with ``dof`` torques."""
    return WireLayout(torque_command([0.0] * dof, 0), ('data',), text=answer_label(0).encode())


class TorqueBytes:
    """An answer laid out once, of which torques and label are filled in."""

    def __init__(self, dof: int):
        layout = command_layout(dof)
        self._bytes = bytearray(serialize_message(torque_command([0.0] * dof, 0)))
        self._label = layout.text
        self.torque, = layout.views(self._bytes)
        """(n,), N m; write the torques here."""

    def answer(self, stamp_ns: int) -> bytes:
        """The message that answers joint states of this stamp.

        Raises:
            ValueError: a torque is not finite; no robot is to be sent such a one, whatever it came from.
        """
        if not math.isfinite(self.torque.sum()):
            raise ValueError(f'torques that are not finite: {self.torque}')
        self._bytes[self._label] = answer_label(stamp_ns).encode()
        return bytes(self._bytes)
