"""Fixtures of this folder."""

from shared_control_testing.plants import *  # noqa: F403
