"""The numbers of the task, for the default and as the thesis' appendix has them."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class TaskSettings:
    """What is observed, what is rewarded, and when an episode ends.

    The reward's weights are those of the appendix.
    """

    episode_seconds: float = 15.0
    """s (3.1)"""
    fallen_below: float = 0.836
    """Height under which the ball has fallen, m (appendix)."""
    fall_reward: float = -5000.0
    action_scale: float = 8.0
    """M_yai of a full action, N m."""
    moment_limit: float = 20.0
    """Bound of |M_yai + M_yh|, N m."""
    observation_scales: tuple[float, float, float] | None = (0.1, 0.15, 0.05)
    """What position error (m), velocity (m/s) and pitch (rad) are divided by. None squeezes the three by their own
    minimum and maximum at every step, as the appendix does, which destroys their sign and scale."""
    rewards_high_manipulability: bool = True
    """True: w_kw k_w^2 as in (35). False: w_kw (1 - k_w^2) as in the appendix."""
    reward_scale: float = 1.0
    """What the reward is multiplied by before the learner sees it."""

    position_error_max_squared: float = 0.0642
    """m^2: ||e_x|| in (33), (36), (37) is the squared position error over this."""
    weight_pitch: float = 1.0
    """(31)"""
    weight_velocity: float = 0.333
    """(32)"""
    weight_margin: float = 5.0
    """(33), on the whole part of ||e_x||"""
    weight_position: float = 10.0
    """(36)"""
    rate_centre: float = -20.0
    """(37)"""
    weight_manipulability: float = 0.5
    """(35)"""


DEFAULT_TASK = TaskSettings(reward_scale=0.02)

THESIS_TASK = replace(
    DEFAULT_TASK, action_scale=100.0, moment_limit=105.0, observation_scales=None,
    rewards_high_manipulability=False, reward_scale=1.0)
"""As the appendix runs it."""
