"""URDF and meshes of a Franka Emika Panda with a walled tray on its flange."""

from pathlib import Path

URDF_PATH = Path(__file__).parent / 'urdf' / 'panda_tray.urdf'
"""The robot's description: joints ``panda_joint1..7``, root ``panda_link0``, tray frame ``panda_tray``."""
