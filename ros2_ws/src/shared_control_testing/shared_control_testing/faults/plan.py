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

"""Which faults befall a session, drawn by a seed so that a failure can be repeated."""

from dataclasses import dataclass

import numpy as np
from shared_control import contract

from .machine import WAYS

NODES = ('panda_sim_node', 'torque_ctrl_node', 'teleop_key_node', 'sim_tutor_node', 'session_recorder_node',
         'ppo_agent_node')
WRITERS = ('session_recorder_node', 'ppo_agent_node')
"""Nodes that write files."""
TOPICS = (contract.KEYS, contract.HUMAN_WRENCH, contract.AGENT_WRENCH, contract.BALL)
"""Topics on which a stranger's messages are mixed in. Not those of the 1 kHz loop: a second robot is another fault."""
TARGETS: dict[str, tuple[str, ...]] = {
    'kill': NODES,
    'stop': NODES,
    'delay': NODES,
    'duplicate': tuple(topic.name for topic in TOPICS),
    'reorder': tuple(topic.name for topic in TOPICS),
    'corrupt': tuple(topic.name for topic in TOPICS),
    'disk full': WRITERS,
    'network': WAYS,
    'clock': ('back', 'forward'),
    'emergency stop': ('torque_ctrl_node',),
    'interrupt': ('session',),
}
"""What each kind of fault can befall."""
SHARES = {'kill': 0.22, 'stop': 0.14, 'delay': 0.1, 'duplicate': 0.07, 'reorder': 0.07, 'corrupt': 0.12,
          'network': 0.1, 'clock': 0.06, 'disk full': 0.05, 'emergency stop': 0.04, 'interrupt': 0.03}
"""How often each kind is drawn."""
PHASES = ('teach', 'learn')
"""Phases of the learner at whose beginning the clock of a fault starts; a fault falls into the next one, too."""


@dataclass(frozen=True)
class Fault:
    """One fault."""

    number: int
    kind: str
    """A key of :data:`TARGETS`."""
    target: str
    """A node, a topic, the session, what becomes of packets, or where the clock is set to."""
    phase: str
    """It befalls the session ``wait`` s after this phase of the learner has begun."""
    wait: float
    """s"""
    seconds: float
    """How long it lasts; a kill has no duration. A clock is set by as many minutes."""
    seed: int
    """Seed of what is random in it."""

    def __str__(self) -> str:
        duration = '' if self.kind in ('kill', 'interrupt', 'clock') else f' for {self.seconds:.1f} s'
        return f'{self.number}: {self.kind} {self.target}{duration}, {self.wait:.2f} s into {self.phase}'


def draw(seed: int, number: int) -> list[Fault]:
    """``number`` faults. The first ones are the same whatever the number."""
    faults = []
    for index in range(number):
        rng = np.random.default_rng((seed, index))
        kind = str(rng.choice(list(SHARES), p=list(SHARES.values())))
        phase = str(rng.choice(PHASES, p=(0.8, 0.2)))
        faults.append(Fault(
            index, kind, str(rng.choice(TARGETS[kind])), phase,
            wait=float(rng.uniform(0.0, 1.5 if phase == 'teach' else 0.1)),
            seconds=float(rng.choice((0.1, 0.5, 2.0, 6.0)) * rng.uniform(0.5, 1.5)), seed=int(rng.integers(2**31))))
    return faults
