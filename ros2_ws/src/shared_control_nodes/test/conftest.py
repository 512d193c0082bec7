"""Fixtures of this folder."""

from shared_control_testing.nodes import *  # noqa: F403
