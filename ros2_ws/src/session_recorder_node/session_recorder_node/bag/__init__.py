"""Bags as rosbag2 writes them, in MCAP: writing, repairing and annotating them. Nothing here needs ROS."""

from .files import BagError
from .repair import Recovered, annotate, recover

__all__ = ['BagError', 'Recovered', 'annotate', 'recover']
