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

"""Receiving at 1 kHz with rclpy.

``rclpy.spin`` builds a wait set, a task and a callback for every message, which costs a round trip of 0.75-1 ms
between two processes. Waiting on one persistent wait set and taking the message directly costs 0.33-0.40 ms
(``benchmarks/pingpong.py`` measures it), and only that leaves room for a controller in a millisecond.

A node that receives fast subscribes with :class:`Polled` subscriptions, which its executor leaves alone, waits on
the urgent one with :meth:`Polled.wait`, and lets :class:`Background` serve the rest (services, parameters) now and
then.
"""

from collections.abc import Callable
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import EventHandler, SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from . import contract
from .contract import Topic, qos
from .stamps import robot_time, to_ns


class _NotForTheExecutor(CallbackGroup):
    """Entities of this group are taken by hand; an executor passes them over."""

    def can_execute(self, entity) -> bool:
        return False

    def beginning_execution(self, entity) -> bool:
        return False

    def ending_execution(self, entity) -> None:
        pass


class Polled:
    """A subscription whose messages are taken by hand.

    ``depth`` is how many messages may wait; with 1 a take gives the newest. ``raw`` gives serialized bytes. ``warns``:
    of publishers that it cannot hear (:func:`warn_of_unheard`).
    """

    def __init__(self, node: Node, topic: Topic, depth: int = 1, raw: bool = False,
                 qos_profile: QoSProfile | None = None, warns: bool = True):
        self._node = node
        self._type = topic.msg_type
        self._raw = raw
        self._subscription = node.create_subscription(
            topic.msg_type, topic.name, lambda _: None, qos_profile or qos(depth),
            callback_group=_NotForTheExecutor(), raw=raw,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=warns))
        self._handle = self._subscription.handle
        self._wait_set = rclpy_implementation.WaitSet(1, 0, 0, 0, 0, 0, node.context.handle)

    @property
    def topic_name(self) -> str:
        """The name after namespace and remapping."""
        return self._subscription.topic_name

    def publisher_count(self) -> int:
        """How many publishers the topic has."""
        return self._node.count_publishers(self.topic_name)

    def take(self) -> Any:
        """The next waiting message, or None."""
        taken = self._handle.take_message(self._type, self._raw)
        return None if taken is None else taken[0]

    def take_with_info(self) -> tuple[Any, dict] | None:
        """The next waiting message and its ``source_timestamp`` and ``received_timestamp`` in ns, or None."""
        return self._handle.take_message(self._type, self._raw)

    def clear(self) -> None:
        """Drop what waits."""
        while self.take() is not None:
            pass

    def wait_ready(self, timeout: float) -> None:
        """Return when a message waits, or after ``timeout`` seconds."""
        self._wait_set.clear_entities()
        self._wait_set.add_subscription(self._handle)
        self._wait_set.wait(int(timeout * 1e9))

    def wait(self, timeout: float) -> Any:
        """The next message, waiting ``timeout`` seconds for it at the most; None when none came."""
        self.wait_ready(timeout)
        return self.take()


def _clocks(node: Node) -> list[Subscription]:
    """The subscriptions by which rclpy sets the clock of a node with ``use_sim_time``."""
    return [subscription for subscription in node.subscriptions
            if subscription.topic_name == contract.CLOCK.full_name
            and not isinstance(subscription.callback_group, _NotForTheExecutor)]


def _refuse_impossible_times(node: Node) -> None:
    """Drop what /clock cannot have shown: rclpy raises an error at a negative time, which would end the node."""
    for subscription in _clocks(node):
        set_clock = subscription.callback

        def heed(message: Clock, set_clock: Callable[[Clock], None] = set_clock) -> None:
            try:
                robot_time(to_ns(message.clock))
            except ValueError as error:
                node.get_logger().error(
                    f'dropped a message on {contract.CLOCK.full_name}: {error}', throttle_duration_sec=1.0)
            else:
                set_clock(message)

        subscription.callback = heed


def follow_clock(node: Node) -> None:
    """Set the clock of a node with ``use_sim_time`` to the newest ``/clock``, before it stamps a message.

    rclpy takes /clock in the executor, which such a node serves seldom: its clock would lag by seconds, or stay at 0.
    """
    for subscription in _clocks(node):
        taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
        if taken is not None:
            subscription.callback(taken[0])


def warn_of_unheard(node: Node) -> None:
    """Log which publishers polled subscriptions cannot hear, for their quality of service or their type.

    rclpy says so by an event, which its executor would take; it leaves what is polled alone.
    """
    events = [waitable for waitable in node.waitables
              if isinstance(waitable, EventHandler) and isinstance(waitable.callback_group, _NotForTheExecutor)]
    if not events:
        return
    wait_set = rclpy_implementation.WaitSet(0, 0, 0, 0, 0, len(events), node.context.handle)
    wait_set.clear_entities()
    for event in events:
        event.add_to_wait_set(wait_set)
    wait_set.wait(0)
    for event in events:
        if event.is_ready(wait_set) and (news := event.take_data()) is not None:
            event.callback(news)


class Background:
    """Serves a node's services, parameters, timers and ordinary subscriptions between its ticks."""

    def __init__(self, node: Node):
        self._node = node
        _refuse_impossible_times(node)
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._wait_set: Any = None
        self._services: list[Any] = []

    def _prepare(self) -> None:
        """Collect the services once: nodes create them at their start."""
        self._services = [service.handle for service in self._node.services]
        self._wait_set = rclpy_implementation.WaitSet(
            0, 0, 0, 0, len(self._services), 0, self._node.context.handle)

    def poll(self) -> None:
        """Serve what waits, if anything does; 15 us when nothing does, against 250 us of ``spin_once``."""
        if self._wait_set is None:
            self._prepare()
        self._wait_set.clear_entities()
        for handle in self._services:
            self._wait_set.add_service(handle)
        self._wait_set.wait(0)
        if self._wait_set.get_ready_entities('service'):
            self._executor.spin_once(timeout_sec=0)

    def spin_once(self, timeout: float) -> None:
        """Wait up to ``timeout`` seconds for something to serve, and serve it."""
        self._executor.spin_once(timeout_sec=timeout)

    def close(self) -> None:
        """Give the node back."""
        self._executor.remove_node(self._node)
        self._executor.shutdown()
