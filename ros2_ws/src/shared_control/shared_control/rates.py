"""How often the controller and the policy run."""

POLICY_PERIOD = 0.02
"""s: the policy runs at 50 Hz."""
CONTROL_PERIOD = 0.001
"""s: the controller runs at 1 kHz."""
TICKS_PER_ACTION = round(POLICY_PERIOD / CONTROL_PERIOD)
