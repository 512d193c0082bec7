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

"""What a person said of the episodes of a bag."""

from collections.abc import Sequence

from shared_control.verdict import Verdict

from .reader import Bag


def last_verdicts(bag: Bag, episodes: Sequence[tuple[int, str]]) -> list[Verdict]:
    """What was said last of each episode.

    Args:
        episodes: in their order; the recorder's time of each start or end, ns, and its name (``episode_key``). One that
            was taught again goes by the same name as before.
    """
    next_ns: dict[str, int] = {}
    found = []
    for since_ns, key in reversed(episodes):
        until_ns = next_ns.get(key, bag.end_ns + 1)
        said = [judgement.verdict for judgement in bag.judgements
                if judgement.episode == key and since_ns <= judgement.received_ns < until_ns]
        found.append(said[-1] if said else Verdict.NONE)
        next_ns[key] = since_ns
    return found[::-1]
