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

"""A stranger on a topic of the graph, who repeats, delays or garbles what others send."""

import time
from collections import deque
from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.serialization import serialize_message
from shared_control_ros.contract import Topic
from shared_control_ros.fast_loop import Polled

NASTY = (float('nan'), float('inf'), -float('inf'), 1e300, -1e300, 1e9, -0.0, 5e-324)


def disturb(node: Node, topic: Topic, heard: Polled, kind: str, seconds: float, seed: int,
            serve: Callable[[], Any]) -> int:
    """Send on ``topic`` for a while; how many messages were sent.

    Args:
        heard: a subscription of the topic.
        kind: ``duplicate`` each message at once, ``reorder``: again after others have come, ``corrupt``: garbled.
        serve: called again and again in the meantime.
    """
    rng = np.random.default_rng(seed)
    _newest(heard)
    publisher = node.create_publisher(topic.msg_type, topic.name, topic.qos)
    late: deque[tuple[float, Any]] = deque()
    sent = 0
    end = time.monotonic() + seconds
    try:
        while (now := time.monotonic()) < end:
            # One message each time and no more: what is sent here is heard here, too, and must not multiply.
            message = _newest(heard)
            if message is not None:
                if kind == 'reorder':
                    late.append((now + rng.uniform(0.02, 0.5), message))
                else:
                    publisher.publish(message if kind == 'duplicate' else garbled(message, rng))
                    sent += 1
            while late and late[0][0] <= now:
                publisher.publish(late.popleft()[1])
                sent += 1
            serve()
            time.sleep(0.01)
    finally:
        node.destroy_publisher(publisher)
    return sent


def _newest(heard: Polled) -> Any:
    """The newest message that can be read, or None."""
    newest = None
    while True:
        try:
            message = heard.take()
        except Exception:  # garbled bytes come back, and rclpy cannot read them either
            continue
        if message is None:
            return newest
        newest = message


def garbled(message: Any, rng: np.random.Generator) -> Any:
    """A copy with something wrong: numbers, stamp, names, lengths, or the bytes themselves."""
    message = deepcopy(message)
    how = rng.integers(5)
    if how == 0:
        _set_numbers(message, rng)
    elif how == 1 and hasattr(message, 'header'):
        message.header.stamp.sec = int(rng.choice((0, 2**31 - 1, -2**31, message.header.stamp.sec + 5)))
    elif how == 2 and hasattr(message, 'header'):
        message.header.frame_id = str(rng.choice(('', 'map', '\x1b[2J', 'panda_link0/' + 'x' * 1000)))
    elif how == 3 and hasattr(message, 'buttons'):
        message.buttons = [int(value) for value in rng.integers(-2**31, 2**31, rng.integers(0, 40))]
        message.axes = [float(value) for value in rng.choice((0.5, float('nan'), 1e30), rng.integers(0, 40))]
    else:
        raw = bytearray(serialize_message(message))
        for _ in range(rng.integers(1, 6)):
            raw[rng.integers(4, len(raw))] = rng.integers(256)
        return bytes(raw[:len(raw) - int(rng.integers(0, 9))] if rng.random() < 0.3 else raw)
    return message


def _set_numbers(message: Any, rng: np.random.Generator) -> None:
    """Make some of the floating-point fields nasty."""
    for name, kind in message.get_fields_and_field_types().items():
        value = getattr(message, name)
        if kind in ('double', 'float'):
            if rng.random() < 0.5:
                setattr(message, name, float(rng.choice(NASTY)))
        elif hasattr(value, 'get_fields_and_field_types') and name != 'header':
            _set_numbers(value, rng)
