"""PPO agent that learns on the running graph and publishes its moment M_yai."""
