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

"""What comes after the teaching: the test of the policy alone, and a word to the person."""

import json
import shlex
import sys
from collections.abc import Callable
from dataclasses import replace

from shared_control.control.computed_torque import ComputedTorqueController
from shared_control.env import SharedControlEnv
from shared_control.files import write_atomically
from shared_control.plugins import WORLDS, load
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.model import RobotModel
from shared_control.robot.spec_file import load_robot
from shared_control.robot.tray import carrying
from shared_control.scene import Ball
from shared_control.tasks.task import Task
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.evaluation.evaluate import as_tested, evaluate
from shared_control_learning.policy_file import load_policy, read_description
from shared_control_records.session.final_test import save_test, sha256
from shared_control_records.session.folder import SessionFolder
from shared_control_records.session.summary import Summary
from shared_control_sim.local_plant import LocalPlant


class _Progress(Callbacks):
    """A bar on a terminal; asks at every step whether to go on."""

    def __init__(self, folder: SessionFolder, episodes: int, attend: Callable[[], None]):
        self._folder = folder
        self._episodes = episodes
        self._attend = attend

    def stepped(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._attend()

    def episode_tested(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        tell_page(self._folder, 'testing', tested=episode.number, of=self._episodes)
        if sys.stdout.isatty():
            bar = '#' * episode.number + '.' * (self._episodes - episode.number)
            print(f'\rtesting the robot alone [{bar}]', end='' if episode.number < self._episodes else '\n', flush=True)


def tell_page(folder: SessionFolder, stage: str, **figures: int | None) -> None:
    """Tell the page of the session what is being done after the teaching (``teach_page_node.ending``)."""
    write_atomically(folder.ending, json.dumps({'stage': stage, **figures}).encode())


def test_policy(folder: SessionFolder, episodes: int, physics: str, attend: Callable[[], None]) -> None:
    """Test the session's policy alone, in this process, which equals the graph (tests/test_parity.py).

    ``physics`` is what it was taught in. ``attend`` is called at every step; it may raise to break the test off, which
    then leaves nothing behind.
    """
    attend()
    tell_page(folder, 'testing', tested=0, of=episodes)
    tested = sha256(folder.policy)
    learner = load_policy(folder.policy)
    env = SharedControlEnv(plant_of(folder, learner.task, physics), as_tested(learner.task))
    try:
        save_test(evaluate(learner.act, env, episodes, callbacks=_Progress(folder, episodes, attend)), folder.test,
                  tested)
    finally:
        env.close()


def plant_of(folder: SessionFolder, task: Task, physics: str) -> LocalPlant:
    """The world and the controller that the session's parameters make of a task, in this process, with nobody."""
    simulator, controller = folder.ros_parameters('panda_sim_node'), folder.ros_parameters('torque_ctrl_node')
    ball = Ball(mass=simulator.get('ball_mass', Ball.mass), radius=simulator.get('ball_radius', Ball.radius))
    robot = load_robot(simulator.get('robot', 'panda'))
    world = load(WORLDS, physics)(replace(task.scene, ball=ball), CONTROL_PERIOD, carrying(robot, task.scene))
    plant = LocalPlant(task, robot=robot, world=world)
    plant.controller = ComputedTorqueController(
        RobotModel(plant.spec), task.axes, gains=controller.get('gains', 'task'), dt=CONTROL_PERIOD,
        horizon=controller.get('prediction_horizon'))
    return plant


def describe_policy(folder: SessionFolder) -> None:
    """Put the description that the policy carries in its header beside it, to be read."""
    if folder.policy.exists():
        text = json.dumps(read_description(folder.policy), indent=2) + '\n'
        write_atomically(folder.policy.with_suffix('.json'), text.encode())


def tell_summary(folder: SessionFolder, summary: Summary) -> None:
    """Print what came of the session."""
    print()
    if summary.simulated_tutor:
        print('The tutor of this session was simulated.')
    print(f'episodes taught    {summary.episodes_taught}')
    print(f'key presses        {summary.key_presses}')
    if summary.devices:
        print(f'device             {", ".join(summary.devices)}')
    if summary.autonomous_success is not None:
        print(f'robot alone        {summary.autonomous_success} of {summary.autonomous_episodes} randomised episodes')
    if summary.real_time_factor is not None and summary.tick_ms is not None:
        print(f'control loop       {summary.control_rate_hz} Hz, real-time factor {summary.real_time_factor}, '
              f'tick p50 {summary.tick_ms["p50"]} ms, p99 {summary.tick_ms["p99"]} ms')
    for finding in summary.bag_checks or []:
        print(f'bag                {finding}')
    print(f'picture            {folder.picture}')
    print(f'report             {folder.report}')
    print(f'everything         {folder.path}')
    print(f'watch it again     shared-control replay {shlex.quote(str(folder.path))}')
