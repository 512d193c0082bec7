"""The robots that come with the core, a file each."""

from pathlib import Path

PANDA = Path(__file__).parent / 'panda.yaml'
"""A Franka Emika Panda with the tray."""
