"""The task of the thesis: bring the ball to the centre of the tray and keep it there, by one moment."""

from dataclasses import replace

from .task import Balance, BalanceState

__all__ = ['BALANCE', 'THESIS', 'Balance', 'BalanceState']

BALANCE = Balance()
"""As it is taught by default."""
THESIS = replace(
    BALANCE, action_scale=100.0, moment_limit=105.0, observation_scales=None, rewards_high_manipulability=False,
    reward_scale=1.0)
"""As the appendix runs it."""
