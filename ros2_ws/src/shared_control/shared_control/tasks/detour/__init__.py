"""The plate with a bar across it, round which the ball has to be brought."""

from .task import Detour

__all__ = ['Detour']
