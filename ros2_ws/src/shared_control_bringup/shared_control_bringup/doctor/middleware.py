"""Checks of the middleware, by trying it as a session does before it starts its nodes."""

import os
from collections.abc import Iterator

from shared_control_bringup.neighbours import Neighbours

from .finding import Finding, Level


def middleware() -> Iterator[Finding]:
    """Whether ROS starts, two nodes find each other, and nobody is in the domain."""
    domain = os.environ.get('ROS_DOMAIN_ID', '').strip() or '0'
    try:
        with Neighbours() as neighbours:
            neighbours.refuse()
    except ValueError as problem:
        # The message names the remedy itself: a session refuses to start by the same words.
        yield Finding(Level.FAULT, f'ROS, domain {domain}', str(problem))
    else:
        yield Finding(Level.OK, f'ROS, domain {domain}', 'nodes find each other, and nobody else is there')
