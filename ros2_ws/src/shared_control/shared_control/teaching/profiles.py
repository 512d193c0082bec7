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

"""Kinds of simulated tutors, by name."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class TutorProfile:
    """How a simulated tutor perceives, decides and presses.

    The defaults are the expert's.
    """

    reaction_time: float = 0.25
    """From the world to the picture that a decision rests on, s. Visual reaction times of practised people."""
    key_rate: float = 5.0
    """Most key presses a second, of the keys of one axis: each has a finger of its own, 1/s."""
    position_noise: float = 0.004
    """Standard deviation of the position as seen, m."""
    velocity_noise: float = 0.010
    """m/s"""
    pitch_noise: float = 0.003
    """rad"""
    stiffness: float = 0.6
    """Tilt wanted for each metre that the ball is off the centre, rad/m."""
    damping: float = 0.45
    """Tilt wanted against each m/s of the ball, rad s/m."""
    tolerance: float = 3.0
    """What the robot may lack before the tutor helps, N m. Who sees less exactly notices less."""
    patience: float = 0.6
    """How soon a ball that keeps off the centre brings more tilt, rad/(m s)."""
    generosity: float = 1.0
    """How many more tolerances the robot may lack once the tutor trusts it."""
    adapts_within: int = 0
    """Episodes that the tutor, at first a low performer, needs to become what the rest says (Fig. 20)."""
    watches: bool = True
    """False: presses keys that have nothing to do with the ball."""


EXPERT = TutorProfile()

_LOW = replace(
    EXPERT, reaction_time=0.35, key_rate=3.0, position_noise=0.012, velocity_noise=0.03, pitch_noise=0.009,
    tolerance=5.0, patience=0.15, generosity=2.0)

PROFILES: dict[str, TutorProfile] = {
    'expert': EXPERT,
    'high': replace(
        EXPERT, reaction_time=0.30, key_rate=4.0, position_noise=0.008, velocity_noise=0.02, pitch_noise=0.006,
        tolerance=4.0, patience=0.15, generosity=2.0),
    'low': _LOW,
    'adapting': replace(EXPERT, adapts_within=5),
    'sham': replace(EXPERT, watches=False),
}
"""``expert``, ``high`` and ``low`` performer (4.4, 4.5), ``adapting``, a low performer who becomes an expert within
five episodes (Figs. 20, 21), and ``sham``, whose keys are unrelated to the ball."""


def in_episode(profile: TutorProfile, episode: int) -> TutorProfile:
    """Who the tutor is in ``episode`` (from 1): senses and hands part of the way from a low performer's to its own."""
    if episode > profile.adapts_within:
        return profile
    part = (episode - 1) / profile.adapts_within
    return replace(profile, **{
        name: (1.0 - part) * getattr(_LOW, name) + part * getattr(profile, name) for name in (
            'reaction_time', 'key_rate', 'position_noise', 'velocity_noise', 'pitch_noise', 'tolerance', 'patience',
            'generosity')})


def profile(name: str) -> TutorProfile:
    """The profile called ``name``.

    Raises:
        ValueError: there is none; the message lists the names.
    """
    if name not in PROFILES:
        raise ValueError(f'no tutor profile {name!r}; there are {", ".join(PROFILES)}')
    return PROFILES[name]
