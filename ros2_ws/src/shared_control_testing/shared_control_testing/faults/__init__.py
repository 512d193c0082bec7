"""A fault campaign on the live graph: faults at random moments of sessions, and what must hold in spite of them."""

from .campaign import Campaign, Outcome
from .plan import Fault, draw

__all__ = ['Campaign', 'Fault', 'Outcome', 'draw']
