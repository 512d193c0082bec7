"""Learning with and without a person: presets, PPO, policy files, evaluation."""
