"""Records every topic of the contract into an MCAP bag."""
