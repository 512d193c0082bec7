"""Bags as rosbag2 writes them, in MCAP: written, repaired, annotated, read back as arrays, and checked."""

from .files import BagError
from .repair import Recovered, annotate, recover

__all__ = ['BagError', 'Recovered', 'annotate', 'recover']
