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

"""Runs the graph of a session until the teaching is over."""

import sys
import time
from enum import Enum

from shared_control_records.session.folder import SessionFolder
from shared_control_ros.clock_steps import ClockSteps, in_words

from . import parameters as ros_parameters
from .graph import Role, named, nodes_of
from .interrupts import Interrupts
from .node_process import NodeProcess
from .page import Page
from .progress import EpisodePrinter
from .supervisor import SessionError, StoppedByNode, Supervisor
from .suspension import Suspension
from .waits import Waits

POLL_SECONDS = 0.1


class End(Enum):
    """How the teaching ended; the value is the exit code."""

    DONE = 0
    FAILED = 1
    STOPPED = 130


def teach(folder: SessionFolder, tutor: str, shows_screen: bool, page: Page | None,
          interrupts: Interrupts, blind: bool) -> tuple[End, int, NodeProcess | None]:
    """Run the graph until the agent is done or somebody stops it.

    Args:
        folder: of the session, with the parameters of its nodes.
        tutor: who teaches; decides which nodes take part.
        shows_screen: whether the lesson is shown in the terminal.
        page: whose address is printed when it can be opened.
        interrupts: how somebody stops it from the terminal, or by a signal.
        blind: whether the terminal keeps to itself how each episode went.

    Returns:
        How it ended, how often nodes were started again, and the node of the page when that stays for the result.
    """
    paced = ros_parameters.load(folder.parameters)['panda_sim_node'].get('paced', True)
    environment = page.environment if page else {}
    nodes = [NodeProcess(
        node.name, folder.parameters, folder.logs / f'{node.name}.log',
        in_foreground=shows_screen and node.role is Role.FOREGROUND, in_control_loop=node.role is Role.CONTROL_LOOP,
        in_real_time=paced, environment=environment.get(node.name), after=node.after) for node in nodes_of(tutor)]
    log = (folder.logs / 'session.log').open('a', encoding='utf-8')

    def note(text: str) -> None:
        print(time.strftime('%H:%M:%S'), text, file=log, flush=True)

    def tell(text: str) -> None:
        note(text)
        print(text, flush=True)

    say = note if shows_screen else tell

    (leader,), (stopper,) = named(Role.LEADER), named(Role.STOPPER)
    episodes = EpisodePrinter(folder.episodes, note if blind else say)
    waits = Waits(nodes, say)

    clock_steps = ClockSteps()
    suspension = Suspension(next((node for node in nodes if node.in_foreground), None))

    def attend() -> None:
        if step := clock_steps.new():
            say(in_words(step))
        suspension.poll()
        waits.poll()
        interrupts.check()

    supervisor = Supervisor(nodes, leader=leader, stopper=stopper, say=say, attend=attend)
    error: SessionError | None = None
    end = End.FAILED
    began = time.monotonic()
    try:
        print('Starting simulator, controller and learner: about 10 s ...', flush=True)
        with suspension:
            supervisor.start()
            say(f'all nodes are ready ({time.monotonic() - began:.0f} s)')
            if page:
                print(f'\n    Teach here: {page.address}\n', flush=True)  # with the token, hence not into the log
            waits.open()
            while supervisor.poll():
                attend()
                episodes.poll()
                time.sleep(POLL_SECONDS)
        end = End.DONE
    except (KeyboardInterrupt, StoppedByNode):
        end = End.STOPPED
    except SessionError as problem:
        end, error = End.FAILED, problem
    finally:
        stays = stopper if page and end is End.DONE else ''
        supervisor.stop(but=stays, say=tell, learns=waits.learns, asked=lambda: interrupts.count)
        waits.close()
        episodes.poll()
        log.close()
    if error is not None:
        print(f'shared-control: {error}', file=sys.stderr)
    return end, supervisor.restarts, next((node for node in nodes if node.name == stays), None)
