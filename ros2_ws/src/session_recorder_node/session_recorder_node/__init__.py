"""Records every topic of the contract into an MCAP bag."""

from .bag_folder import BagError
from .recovery import Recovered, annotate, recover

__all__ = ['BagError', 'Recovered', 'annotate', 'recover']
