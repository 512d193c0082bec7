"""The thesis' tests of a policy: randomised (4.2), perturbation (4.3), trajectory (4.6)."""
