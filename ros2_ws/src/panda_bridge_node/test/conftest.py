"""Fixtures of this folder."""

from shared_control_ros.testing import *  # noqa: F403
