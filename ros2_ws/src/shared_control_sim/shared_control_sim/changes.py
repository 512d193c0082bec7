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

"""What may be otherwise on another arm than on the one that a policy was taught on."""

from dataclasses import dataclass, replace
from math import radians

from shared_control.rates import POLICY_PERIOD
from shared_control.scene import Ball


@dataclass(frozen=True)
class Change:
    """One thing, or several, that are not as they were when a policy was taught."""

    name: str
    ball: Ball | None = None
    """Another ball."""
    askew: float = 0.0
    """By how much the tray is mounted askew, about its y axis, rad. Nobody knows: neither controller nor learner."""
    joint_friction: float = 0.0
    """Coulomb friction in each joint, N m."""
    model_masses: float = 1.0
    """Masses and inertias of the arm's links in the controller's model, as a multiple of the real ones."""
    model_is_fer: bool = False
    """Whether the controller's model has the inertias of franka_description instead."""
    late: int = 0
    """How late a learner sees, in policy periods."""
    noise: bool = False
    """Whether it sees with the errors of :class:`shared_control_sim.poor_senses.PoorSenses`."""


AS_TAUGHT = Change('as taught')
_BALL = Ball()
CHANGES: tuple[Change, ...] = (
    AS_TAUGHT,
    *(Change(f'ball of {mass:g} kg', ball=replace(_BALL, mass=mass)) for mass in (0.05, 0.3, 0.6)),
    *(Change(f'ball of {100 * radius:g} cm radius', ball=replace(_BALL, radius=radius)) for radius in (0.01, 0.03)),
    *(Change(f'friction of {friction:g}', ball=replace(_BALL, friction=friction)) for friction in (0.2, 1.5)),
    *(Change(f'tray askew by {degrees:+g} deg', askew=radians(degrees)) for degrees in (-2, -1, -0.5, 0.5, 1, 2)),
    *(Change(f'masses times {factor:g} in the controller', model_masses=factor) for factor in (0.9, 1.1)),
    Change("FER's inertias in the controller", model_is_fer=True),
    *(Change(f'friction of {friction:g} N m in the joints', joint_friction=friction) for friction in (0.2, 0.5)),
    Change(f'seen {2e3 * POLICY_PERIOD:g} ms late', late=2),
    Change('seen with noise', noise=True),
    Change(f'seen {2e3 * POLICY_PERIOD:g} ms late with noise', late=2, noise=True))
"""What ``shared-control evaluate --protocol transfer`` goes through."""


def change_named(name: str) -> Change:
    """One of :data:`CHANGES`.

    Raises:
        ValueError: there is none of that name; the message lists the names.
    """
    for change in CHANGES:
        if change.name == name:
            return change
    raise ValueError(f'there is no change {name!r}; there are: {", ".join(change.name for change in CHANGES)}')
