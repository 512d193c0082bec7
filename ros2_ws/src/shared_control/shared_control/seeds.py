"""Seeds of episodes."""

import numpy as np


def episode_seed(seed: int, episode: int) -> int:
    """A seed of 31 bits that belongs to ``episode`` (from 1) of the run ``seed``."""
    return int(np.random.SeedSequence((seed, episode)).generate_state(1)[0] >> 1)
