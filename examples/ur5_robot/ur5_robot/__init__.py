"""A UR5 for shared-control."""

from pathlib import Path

UR5 = Path(__file__).parent / 'ur5.yaml'
