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

"""What a recorder that is started again gets told once more."""

from collections.abc import Mapping
from itertools import islice
from pathlib import Path

from mcap.reader import make_reader


def last_sent(files: list[Path], depths: Mapping[str, int]) -> dict[str, set[int]]:
    """When the newest messages of some topics in a bag's files were sent, ns.

    Publishers of a latched topic repeat the last of what they said to every new subscriber, with the times of then.
    They are known by these and not by being older: the clock may have been set back.

    Args:
        files: of the bag, in their order.
        depths: how many messages of each topic may be repeated.
    """
    found: dict[str, set[int]] = {topic: set() for topic in depths}
    for path in reversed(files):
        with path.open('rb') as file:
            reader = make_reader(file)
            for topic, depth in depths.items():
                if missing := max(depth - len(found[topic]), 0):
                    messages = reader.iter_messages(topic, reverse=True)
                    found[topic] |= {message.publish_time for _, _, message in islice(messages, missing)}
    return found
