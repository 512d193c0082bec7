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

"""Start and stop of a node, the same for all of them."""

import faulthandler
import signal
import sys
from collections.abc import Callable
from typing import Protocol

import rclpy
from rclpy.exceptions import ROSInterruptException
from rclpy.logging import get_logging_directory
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from shared_control.extras import NotInstalled
from shared_control.streams import open_closed_streams

from .parameters import ParameterError, passed_over_files, refuse_unknown_types, unknown_parameters
from .processes import adopt_node_environment
from .readiness import DONE, READY, ReadyPipe
from .real_time import put_loop_above_other_threads
from .watchdog import leave_within

LEAVE_SECONDS = 10.0
"""The middleware has once taken more than a minute to take leave; everything has been said by then, s."""

_SOURCE_LINE = ', at /'
"""What follows this in an error of rcl says where its sources raise it."""


class Stop:
    """Set by SIGINT, SIGTERM and SIGHUP. A node looks at it in its loop, so that it can publish when it leaves."""

    def __init__(self) -> None:
        self.requested = False

    def __call__(self, *_: object) -> None:
        """As a signal handler."""
        self.requested = True


class Runnable(Protocol):
    """What :func:`run` runs."""

    node: Node

    def run(self, stop: Stop) -> None:
        """Work until ``stop.requested``."""

    def close(self) -> None:
        """Leave a safe state behind: publish zero, flush files."""


def run(make: Callable[[], Runnable], args: list[str] | None = None) -> int:
    """Initialise rclpy, build the node, run it until it ends or a signal comes, close it.

    Returns:
        The exit code: 0, or 2 when an argument, a parameter or a file is unusable, or something is not installed
        (said in one line on stderr).
    """
    open_closed_streams()
    pipe = ReadyPipe()
    if args is None:
        args = sys.argv
    adopt_node_environment()  # a node that was started by hand keeps to this machine, too
    try:
        rclpy.init(args=[*args, *_log_arguments()], signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:  # of all of rclpy's errors here: unknown arguments, a file that is none of parameters
        print(f'error: ROS cannot begin with these arguments: {str(error).partition(_SOURCE_LINE)[0]}', file=sys.stderr)
        return 2
    stop = Stop()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:  # nohup
            signal.signal(number, stop)
    faulthandler.register(signal.SIGUSR1, 2)  # who started it asks so where it stands still
    runnable: Runnable | None = None
    code = 1
    try:
        runnable = make()
        put_loop_above_other_threads()
        refuse_unknown_types(runnable.node)
        for line in (*unknown_parameters(runnable.node), *passed_over_files(runnable.node, args)):
            runnable.node.get_logger().warning(line)
        runnable.node.get_logger().info('ready')
        pipe.tell(READY)
        runnable.run(stop)
        code = 0
    except (ParameterError, OSError, NotInstalled) as error:
        print(f'error: {error}', file=sys.stderr)
        code = 2
    except ROSInterruptException:
        code = 0
    finally:
        if runnable is not None:
            runnable.close()
            if code == 0 and not stop.requested:
                pipe.tell(DONE)
            leave_within(LEAVE_SECONDS)
            runnable.node.destroy_node()
        rclpy.try_shutdown()
    return code


def _log_arguments() -> list[str]:
    """Arguments that keep ROS from writing log files where it cannot, which would end the node."""
    try:
        get_logging_directory().mkdir(parents=True, exist_ok=True)
    except (RuntimeError, OSError) as error:  # without HOME the first
        print(f'no log file is written ({error}); ROS_LOG_DIR names a folder for it', file=sys.stderr)
        return ['--ros-args', '--disable-external-lib-logs']
    return []
