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

"""Sessions of many minutes, made of one that is repeated, for what is measured by the length of a session."""

import struct
from pathlib import Path
from typing import Any

from shared_control import contract
from shared_control.contract import Topic
from shared_control_records.bag.writer import BagWriter
from shared_control_records.session.folder import SessionFolder

from .sessions import (
    MS,
    START_NS,
    STORE,
    command,
    lesson,
    message,
    record,
    simulator_status,
    write_episodes,
    write_settings,
)

LESSON_STEPS = 750
"""15 s at the rate of the policy."""
LESSONS = 4
"""In the minute that is repeated."""
MINUTE_NS = 60_000 * MS
FLUSHED_NS = 250 * MS
"""A recorder writes what it has this often."""
_STAMPED = (contract.JOINT_STATES, contract.BALL, contract.AGENT_WRENCH, contract.HUMAN_WRENCH, contract.APPLIED_WRENCH,
            contract.HUMAN_APPLIED, contract.AGENT_APPLIED, contract.KEYS, contract.CLOCK)
"""Topics whose messages begin with their stamp."""


def write_long_session(path: Path, minutes: int) -> SessionFolder:
    """Write a session of some minutes into a new folder: bag, table of episodes, settings.

    Each minute is the first one again, with its own stamps and numbers of episodes; the wall clock is the robot's time.
    """
    folder = SessionFolder.create(path)
    lessons = [lesson(LESSON_STEPS, seed) for seed in range(LESSONS)]
    minute = [(topic, received_ns, content, bytes(STORE.serialize_cdr(content, topic.type)))
              for topic, received_ns, content in sorted(record(lessons).messages, key=lambda entry: entry[1])]
    writer = BagWriter(folder.bag)
    channels = {topic: writer.add_topic(
        topic.full_name, topic.type, STORE.generate_msgdef(topic.type, ros_version=2)[0],
        STORE.hash_rihs01(topic.type), '') for topic in contract.BAG_TOPICS}
    flushed_ns = START_NS
    for number in range(minutes):
        for topic, received_ns, content, raw in minute:
            at_ns = received_ns + number * MINUTE_NS
            writer.write(channels[topic], _of_minute(number, topic, at_ns, content, raw), at_ns, at_ns)
            if at_ns - flushed_ns >= FLUSHED_NS:
                writer.flush()
                flushed_ns = at_ns
    writer.finish()
    write_episodes(folder.episodes, lessons * minutes)
    write_settings(folder.settings)
    folder.release()
    return folder


def _of_minute(number: int, topic: Topic, at_ns: int, content: Any, raw: bytes) -> bytes:
    """A message of the first minute as it is in a later one."""
    if topic in _STAMPED:
        seconds, = struct.unpack_from('<i', raw, 4)
        return raw[:4] + struct.pack('<i', seconds + 60 * number) + raw[8:]
    if topic == contract.EFFORT_COMMANDS:
        answered_ns = int(content.layout.dim[0].label) + number * MINUTE_NS
        return bytes(STORE.serialize_cdr(command(answered_ns, content.data), topic.type))
    if topic == contract.EPISODE:
        return bytes(STORE.serialize_cdr(message(topic.type, data=content.data + number * LESSONS), topic.type))
    if topic == contract.DIAGNOSTICS:
        return bytes(STORE.serialize_cdr(simulator_status(at_ns, (at_ns - START_NS) // MS + 1), topic.type))
    return raw
