"""``shared-control doctor``: what of this machine a session depends on, and what to mend."""
