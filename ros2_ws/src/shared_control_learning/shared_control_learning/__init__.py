"""Learning with and without a person: presets, PPO, policy files, training, tests of a policy."""
