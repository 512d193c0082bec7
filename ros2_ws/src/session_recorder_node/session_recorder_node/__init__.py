"""Records every topic of the contract into an MCAP bag."""

from .bag import BagError, Recovered, annotate, recover

__all__ = ['BagError', 'Recovered', 'annotate', 'recover']
