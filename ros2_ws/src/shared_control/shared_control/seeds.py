# Copyright 2026 shared-control maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Seeds of episodes."""

import numpy as np


def episode_seed(seed: int, episode: int) -> int:
    """A seed of 31 bits that belongs to ``episode`` (from 1) of the run ``seed``."""
    return int(np.random.SeedSequence((seed, episode)).generate_state(1)[0] >> 1)
