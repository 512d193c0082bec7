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

"""``summary.json``: the figures of a session by name."""

from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypeVar

import pydantic
from shared_control.run_folder import RunFolderError
from shared_control.tasks.task import Task
from shared_control_learning.episode_table import BROKEN_OFF
from shared_control_learning.wrong_content import what_is_wrong

from ..bag.checks import check_bag
from ..bag.presses import presses_that_count
from ..bag.reader import Bag
from ..bag.timing import timing_of
from .episodes import EpisodeRow
from .final_test import FinalTest
from .folder import SessionFolder

CONTROLLER = 'torque_ctrl_node'
Content = TypeVar('Content', bound=pydantic.BaseModel)


@dataclass(frozen=True)
class Summary:
    """What is not known is None."""

    task: str
    preset: str | None
    seed: int | None
    recorded: str | None
    """When the recording began, UTC, ISO 8601."""
    tutor: str | None
    simulated_tutor: bool | None
    """Whether the person at the keys was a model of one, in any part of the session."""
    duration_s: float | None
    """From the first to the last message of the bag, by the clock on the wall."""
    episodes_taught: int | None
    """Without those that a person has discarded."""
    episodes_discarded: int | None
    episodes_broken_off: int | None
    """Episodes of teaching that the robot has not learned from: repeated, stopped, or cut short by a fault."""
    taught_s: float | None
    """How long the robot was taught by its own time, with episodes broken off and discarded."""
    key_presses: int | None
    """Those that counted: in practice and teaching, and not while it was paused."""
    devices: list[str] | None
    """What the person, or the simulated tutor, had in the hand: ``keys (terminal)``, ``stick (joy)``."""
    autonomous_success: int | None
    """Episodes of the final test that succeeded."""
    autonomous_episodes: int | None
    """Episodes of the final test."""
    control_rate_hz: float | None
    real_time_factor: float | None
    """Simulated over running seconds, pauses excluded."""
    tick_ms: dict[str, float] | None
    """p50 and p99 of the duration of a tick."""
    late_tick_ratio: float | None
    """Part of the ticks that took more than a millisecond."""
    restarts: int | None
    """How often nodes that died were started again."""
    bag_checks: list[str] | None
    """What is wrong with the bag; empty when nothing is."""
    bag: str | None
    """Names, without the folder: reports are passed on, and whose machine it was is nobody's business."""
    picture: str | None
    report: str

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def summarize(folder: SessionFolder, task: Task, bag: Bag | None, bag_error: str | None, rows: list[EpisodeRow],
              test: FinalTest | None, restarts: int | None) -> Summary:
    """The figures of a session.

    Args:
        task: what was learned.
        bag: None when there is none that can be read.
        bag_error: why it cannot be read.
        rows: of the table of episodes.
        test: the final test, if there was one.
        restarts: of nodes that died; None when not known.

    Raises:
        RunFolderError: a file of the session cannot be used; the message names it.
    """
    settings = _usable(_Settings, folder.read_json(folder.settings), folder.settings)
    tutor = _tutors(settings)
    timing = timing_of(bag) if bag else None
    taught = [row for row in rows if row.phase == 'teach' and row.counts]
    broken_off = [row for row in rows if row.phase == BROKEN_OFF]
    return Summary(
        task=task.name, preset=settings.preset, seed=settings.seed,
        recorded=f'{datetime.fromtimestamp(bag.start_ns // 1_000_000_000, UTC):%Y-%m-%dT%H:%M:%SZ}' if bag else None,
        tutor=tutor,
        simulated_tutor=None if tutor is None else 'simulated' in tutor,
        duration_s=round((bag.end_ns - bag.start_ns) * 1e-9, 3) if bag else None,
        episodes_taught=len(taught) if folder.episodes.exists() else None,
        episodes_discarded=sum(not row.counts for row in rows) if folder.episodes.exists() else None,
        episodes_broken_off=len(broken_off) if folder.episodes.exists() else None,
        taught_s=round(sum(row.seconds or 0.0 for row in rows if row.phase in ('teach', BROKEN_OFF)), 3)
        if rows else None,
        key_presses=len(presses_that_count(bag)) if bag else None,
        devices=bag.devices if bag else None,
        autonomous_success=test.successes if test else None,
        autonomous_episodes=len(test.episodes) if test else None,
        control_rate_hz=round(timing.control_rate_hz, 2) if timing else None,
        real_time_factor=round(timing.real_time_factor, 5) if timing else None,
        tick_ms={'p50': timing.tick_p50_ms, 'p99': timing.tick_p99_ms} if timing else None,
        late_tick_ratio=round(timing.late_tick_ratio, 6) if timing else None,
        restarts=restarts,
        bag_checks=_bag_checks(folder, bag) if bag else
        [bag_error.replace(f'{folder.bag.parent}/', '')] if bag_error else None,
        bag=folder.bag.name if folder.bag.exists() else None, picture=folder.picture.name, report=folder.report.name)


class _Settings(pydantic.BaseModel):
    """What a report says of ``settings.json``, which has more."""

    model_config = pydantic.ConfigDict(strict=True)

    preset: str | None = None
    seed: int | None = None
    tutor: str | None = None
    earlier_tutors: list[str] = []


class _Earlier(pydantic.BaseModel):
    """What outlives a report in ``summary.json``."""

    model_config = pydantic.ConfigDict(strict=True)

    restarts: int | None = None


class _Controller(pydantic.BaseModel):
    """What a bag is checked against of the controller's parameters."""

    moment_limit: float = 20.0


def earlier_restarts(folder: SessionFolder) -> int | None:
    """How often a node was started again, as an earlier report says; None when none does.

    Raises:
        RunFolderError: ``summary.json`` cannot be used.
    """
    return _usable(_Earlier, folder.read_json(folder.summary), folder.summary).restarts


def _usable(kind: type[Content], content: dict[str, Any] | None, path: Path) -> Content:
    """The part of a file that a report needs; that of an empty one when it is missing."""
    try:
        return kind.model_validate(content or {})
    except pydantic.ValidationError as error:
        raise RunFolderError(f'cannot use {path}: {what_is_wrong(error)}') from error


def _tutors(settings: _Settings) -> str | None:
    """Who taught; those of earlier parts of a session that went on with another tutor come last."""
    if settings.tutor is None:
        return None
    return ', before that '.join([settings.tutor, *reversed(settings.earlier_tutors)])


def _bag_checks(folder: SessionFolder, bag: Bag) -> list[str]:
    controller = _usable(_Controller, folder.ros_parameters(CONTROLLER), folder.parameters)
    return check_bag(bag, moment_limit=controller.moment_limit)
