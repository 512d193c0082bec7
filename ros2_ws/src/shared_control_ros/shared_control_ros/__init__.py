"""What the nodes of the shared-control graph have in common: contract, 1 kHz receive loop, parameters, diagnostics."""
