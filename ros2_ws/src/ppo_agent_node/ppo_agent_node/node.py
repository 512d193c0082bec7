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

"""PPO agent: learns on the running graph, an update an episode, and publishes its moment M_yai at 50 Hz.

Takes /ball, /joint_states_throttle, /human/applied_wrench, /agent/applied_wrench, /target_wrench and /human/verdict,
publishes /agent/target_wrench and /training/*, rests and resets the simulator between episodes. Services (Trigger):
learner/start: end the practice; learner/repeat: start the episode over; learner/finish: end the teaching after this
episode, begun anew if it is void; learner/keep_teaching: take that back.

A verdict is about the last episode that has ended. An episode of teaching that is discarded before the next one begins
is unlearned and taught again, unless the teaching is to end; later it is only labelled.
"""

import json
import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from rclpy.node import Node
from shared_control.env import SharedControlEnv
from shared_control.files import write_atomically
from shared_control.plant import PlantInterrupted
from shared_control.plugins import LEARNERS, TASKS, names
from shared_control.rates import POLICY_PERIOD
from shared_control.run_folder import RunFolder
from shared_control.verdict import Verdict
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.episode_table import TABLE_NAME, EpisodeTable
from shared_control_learning.evaluation.evaluate import as_tested, evaluate
from shared_control_learning.learn import learn
from shared_control_learning.learner import Learner
from shared_control_learning.policy_file import POLICY_NAME, PolicyFileError, load_policy, save_policy
from shared_control_learning.practice import PRACTICE_NAME, Practice
from shared_control_learning.presets import Preset, preset, preset_for
from shared_control_learning.warm_up import warm_up
from shared_control_ros import contract
from shared_control_ros.diagnostics import Diagnostics
from shared_control_ros.fast_loop import Background
from shared_control_ros.one_graph import claim
from shared_control_ros.parameters import ParameterError, declare
from shared_control_ros.robot_parameter import declare_robot
from shared_control_ros.runner import Stop, run
from std_srvs.srv import Trigger

from .graph_plant import GraphPlant
from .kept_policy import KeptPolicy
from .last_episode import LAST_EPISODE_NAME, LastEpisode
from .training_topics import TrainingTopics
from .verdicts import Verdicts

STEPS_PER_PROGRESS = 5
"""Progress is told at 10 Hz."""
STEPS_PER_NOTE = 50
"""How far an episode has come is kept once a second: what a killed agent was taught is known but for that."""
TRY_AGAIN_SECONDS = 0.5
"""Between a void episode and the next try, s."""
VOID_IN_A_ROW = 3
"""After so many void episodes nobody should hope that it passes by itself."""


class _Stopped(Exception):
    """The node was told to stop in mid-episode."""


class PpoAgentNode(Callbacks):
    """See the module."""

    def __init__(self) -> None:
        self.node = node = Node('ppo_agent_node')
        self._role = claim(node, 'learner')
        robot = declare_robot(node)
        mode = declare(
            node, 'mode', 'teach', 'teach: learn, then test. test: only test a policy.', choices=('teach', 'test'))
        chosen = preset_for(
            declare(node, 'task', '', 'What is learned (mode teach); empty: what the preset was made for.',
                    choices=('', *names(TASKS))),
            declare(node, 'preset', '', 'How it is learned (mode teach); empty: as the task is.',
                    choices=('', *names(LEARNERS))))
        seed = declare(node, 'seed', 0, 'Of weights, exploration and ball starts.', minimum=0, maximum=2**31 - 1)
        self._episodes = declare(
            node, 'episodes', 0, 'Teach until this many, those of an earlier run included; 0: until '
            'learner/finish is called or the time is up.', minimum=0, maximum=100_000)
        self._episode_seconds = declare(
            node, 'episode_seconds', chosen.task.episode_seconds, 'The longest an episode of teaching lasts.',
            unit='s', minimum=1.0, maximum=600.0)
        minutes = declare(
            node, 'max_minutes', 45.0, "Teach for this long at the most, by the robot's time and that of learning; "
            'what an earlier run in output has used is counted, pauses are not.',
            unit='min', minimum=0.1, maximum=1440.0)
        self._test_episodes = declare(
            node, 'test_episodes', 0, 'Test the policy alone with so many episodes on the graph, in the end.',
            minimum=0, maximum=1000)
        self._practises = declare(
            node, 'practice', False, 'Before a new learner is taught, the person alone moves the tray until '
            'learner/start is called (3.4).')
        rests = declare(
            node, 'practice_rests', 0, 'Refuse learner/start until the person has brought the ball to rest at the '
            'goal, for 3 s, so often.', minimum=0, maximum=100)
        practice_minutes = declare(
            node, 'practice_minutes', 5.0, 'After this much practice learner/start is not refused any more.',
            unit='min', minimum=0.1, maximum=60.0)
        self._break_seconds = declare(
            node, 'break_seconds', 0.0, 'Before the first and between all episodes at least, with the time that '
            'learning takes: for a person to read how it went, and to get ready.', unit='s', minimum=0.0, maximum=60.0)
        output = declare(
            node, 'output', '', f'Folder for {POLICY_NAME} and {TABLE_NAME}; a learner that is there goes on. Empty: '
            'nothing is kept.')
        resume = declare(node, 'resume', False, 'Insist that output holds a learner to go on with.')
        policy = declare(node, 'policy', '', 'The policy file to test (mode test).')

        self._teaches = mode == 'teach'
        self._policy_path: Path | None = None
        self._kept: KeptPolicy | None = None
        self._folder: RunFolder | None = None
        """Held as long as this process lives, as `train` does: two learners would write over each other."""
        self._table: EpisodeTable | None = None
        if self._teaches:
            self._learner = self._make_learner(chosen, seed, output, resume)
        else:
            if not self._test_episodes:
                raise ParameterError("parameter 'test_episodes' must be at least 1 in mode 'test'")
            if output:
                node.get_logger().warning("parameter 'output' counts nothing in mode 'test': nothing is kept")
            self._learner = _load(Path(policy), 'policy')
        warm_up(replace(preset(self._learner.name), task=self._learner.task))
        self._minutes = minutes
        self._seconds_left = minutes * 60.0 - (self._table.taught_seconds if self._table else 0.0)
        self._practice = Practice(self._learner.task, rests, practice_minutes * 60.0)
        self._episode: Episode | None = None
        self._last = self._last_episode(output, minutes)
        self._repeat = False
        self._void = 0
        """Episodes in a row that were void, and not because the person wanted it."""
        self._ended = 0.0
        """When the last episode of teaching did, s of the monotonic clock."""
        self._training = TrainingTopics(node)
        self._diagnostics = Diagnostics(node, POLICY_PERIOD)
        self._background = Background(node)
        self._verdicts = Verdicts(node, self._training, self._judged)
        self._plant = GraphPlant(node, self._learner.task.axes, self._background, self._attend, robot)
        self._stop: Stop | None = None
        node.create_service(Trigger, contract.START_SERVICE, self._on_start)
        node.create_service(Trigger, contract.REPEAT_SERVICE, self._on_repeat)
        node.create_service(Trigger, contract.FINISH_SERVICE, self._on_finish)
        node.create_service(Trigger, contract.KEEP_TEACHING_SERVICE, self._on_keep_teaching)

    def _make_learner(self, chosen: Preset, seed: int, output: str, resume: bool) -> Learner:
        """A new learner, or the one in the output folder."""
        try:
            learner = chosen.make(seed)
        except ValueError as error:
            raise ParameterError(f"parameter 'preset' is {chosen.name!r}, which cannot learn the task "
                                 f'{chosen.task.name!r}: {error}') from error
        if output:
            folder = Path(output)
            folder.mkdir(parents=True, exist_ok=True)
            self._folder = RunFolder(folder, 'learner', own=(), mark=POLICY_NAME, keys=())
            self._folder.claim()
            self._policy_path = folder / POLICY_NAME
            self._kept = KeptPolicy(self._policy_path)
            if self._policy_path.exists():
                learner = _load(self._policy_path, 'output')
                for parameter, given, stored in (
                        ('preset', chosen.name, learner.name), ('task', chosen.task.name, learner.task.name)):
                    if given != stored:
                        raise ParameterError(
                            f'parameter {parameter!r} is {given!r}, but {self._policy_path} was learned with '
                            f'{stored!r}: name that one, or another output folder')
                self.node.get_logger().info(
                    f'going on after episode {learner.episode} of {self._policy_path} (seed {learner.seed})')
            try:
                self._table = EpisodeTable(folder / TABLE_NAME, learner.episode, live=True)
            except ValueError as error:
                raise ParameterError(f"parameter 'output': {error}") from error
        if resume and not learner.episode:
            raise ParameterError(f"parameter 'resume' is true, but there is no {POLICY_NAME} in output ({output!r})")
        return learner

    def _last_episode(self, output: str, minutes: float) -> LastEpisode:
        """What an agent that was killed has been told."""
        path = Path(output) / LAST_EPISODE_NAME if output and self._teaches else None
        try:
            last = LastEpisode(path, {'episodes': self._episodes, 'max_minutes': minutes})
        except ValueError as error:
            raise ParameterError(f"parameter 'output': {error}") from error
        if last.number is not None:
            end = 'is over' if last.is_learned(self._learner.episode) else f'ends with episode {last.number}'
            self.node.get_logger().info(f'the teaching {end}, as somebody has asked; to go on with it, remove {path}')
        return last

    # -- running -----------------------------------------------------------------------------------------------------

    def run(self, stop: Stop) -> None:
        """Teach, test, and leave when that is done."""
        self._stop = stop
        try:
            self._wait()
            if self._teaches:
                self._practise()
                self._take_a_break(time.monotonic())
                task = replace(self._learner.task, episode_seconds=self._episode_seconds)
                learn(self._learner, SharedControlEnv(self._plant, task), self._episodes or None, self)
                if self._seconds_left <= 0.0:
                    self.node.get_logger().info(
                        f"the teaching is over: its {self._minutes:g} minutes are used up (parameter 'max_minutes'; an "
                        'earlier run in output counts)')
            if self._test_episodes:
                self._test()
            self._training.enter('done')
            self._last.forget()
        except _Stopped:
            self._break_off('the session was stopped')
            self.node.get_logger().info(f'stopped; {self._learner.episode} episodes are learned and kept')

    def _wait(self) -> None:
        self._training.enter('wait')
        self._plant.wait_until_up()

    def _practise(self) -> None:
        """The person alone moves the tray; a ball that falls, or that was brought to rest, is dropped anew."""
        if not self._practises or self._learner.episode:
            return
        env = SharedControlEnv(self._plant, self._learner.task, human_only=True)
        hands_off = np.zeros(len(env.task.axes), np.float32)
        while self._practises and self._last.number is None:
            self._training.enter('practice')
            try:
                env.reset()
                self._practice.begin()
                is_over = False
                while self._practises and self._last.number is None and not is_over:
                    info = env.step(hands_off)[-1]
                    at_rest = self._practice.step(info['state'].position_error)
                    is_over = info['failed'] or (at_rest and self._practice.wanted > 0)
                    self._training.rests_left(self._practice.left)
            except PlantInterrupted as error:
                self.interrupted(error)
        done = self._practice.as_dict()
        self.node.get_logger().info(f'practice: {done}')
        if self._policy_path is not None:
            write_atomically(self._policy_path.with_name(PRACTICE_NAME), json.dumps(done).encode())

    def _take_a_break(self, since: float) -> None:
        """Let the break that began at ``since`` (monotonic clock, s) come to its end, and count it down."""
        if not self._break_seconds:
            return
        if self._training.phase != 'learn':
            self._training.enter('wait')
            self._plant.rest()
        while (left := since + self._break_seconds - time.monotonic()) > 0.0:
            time.sleep(min(left, 0.1))  # first: screens are to know the episode's own last time
            self._attend()
            self._training.time_left(max(since + self._break_seconds - time.monotonic(), 0.0))

    def _test(self) -> None:
        env = SharedControlEnv(self._plant, as_tested(self._learner.task))
        evaluation = evaluate(self._learner.act, env, self._test_episodes, callbacks=self)
        self._training.success(evaluation.success_rate)
        self.node.get_logger().info(
            f'alone: {evaluation.successes} of {self._test_episodes} episodes succeeded; over their last 3 s mean '
            f'|position error| {1e3 * evaluation.mean_position_error:.1f} mm, '
            f'mean |velocity| {1e3 * evaluation.mean_velocity:.1f} mm/s')

    def _attend(self) -> None:
        """Everything besides learning; called once a step and while waiting."""
        self._background.poll()
        self._verdicts.poll()
        if self._diagnostics.due():
            self._diagnostics.publish(
                {}, phase=self._training.phase, episode=self._learner.episode, late_steps=self._plant.late_steps)
        if self._stop is not None and self._stop.requested:
            raise _Stopped

    def _judged(self, episode: Episode) -> None:
        if self._table is None or self._kept is None:
            return
        # In this order: an episode that is not discarded and not in the policy counts as broken off on resuming.
        if episode.verdict is Verdict.DISCARD:
            self._kept.drop_last()
            self._table.amend(episode)
        else:
            self._table.amend(episode)
            self._kept.keep_last()

    def _on_start(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        left = self._practice.left
        response.success = self._practises and not left
        response.message = ('this is no practice' if not self._practises else 'the teaching begins' if not left else
                            f'first bring the ball to rest {left} more time{"s" if left > 1 else ""}')
        self._practises = self._practises and not response.success
        return response

    def _on_repeat(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._repeat = self._training.phase in ('teach', 'test')
        response.message = 'the episode starts over' if self._repeat else 'there is no episode to start over'
        return response

    def _on_keep_teaching(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._last.number is not None and self._training.phase in ('teach', 'learn', 'wait')
        if response.success:
            self._last.forget()
        response.message = 'the teaching goes on' if response.success else 'the teaching was not to end, or has ended'
        return response

    def _on_finish(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._teaches
        if not self._teaches:
            response.message = 'nothing is taught: the mode is test'
        elif self._training.phase in ('test', 'done'):
            response.message = 'the teaching has ended'
        elif self._episode is not None or self._training.phase == 'teach':  # void, it is about to begin anew
            self._last.set(self._learner.episode + 1)
            response.message = 'the teaching ends with this episode'
        else:
            self._last.set(0)
            response.message = 'the teaching ends'
        return response

    # -- callbacks of learning and testing ---------------------------------------------------------------------------

    def should_stop(self) -> bool:
        """See :class:`Callbacks`."""
        self._attend()
        return self._is_taught

    @property
    def _is_taught(self) -> bool:
        """Whether the teaching is over. A last episode that was void has not been learned from, and begins anew."""
        return self._last.is_learned(self._learner.episode) or self._seconds_left <= 0.0

    def episode_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._episode = episode
        self._repeat = False
        self._diagnostics.skip()
        self._training.enter(episode.phase)
        self._training.episode(episode.number)
        self._training.time_left(self._longest(episode))  # screens take it for the episode's length

    def stepped(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        if self._repeat:
            raise PlantInterrupted('the person starts it over')
        self._diagnostics.tick()
        if len(episode) % STEPS_PER_PROGRESS == 0:
            self._training.progress(self._longest(episode) - len(episode) * POLICY_PERIOD, episode.human_share)
        if self._table is not None and episode.phase == 'teach' and len(episode) % STEPS_PER_NOTE == 0:
            self._table.under_way(episode)

    def _longest(self, episode: Episode) -> float:
        """How long an episode lasts at the most, s."""
        return self._episode_seconds if episode.phase == 'teach' else self._learner.task.test_seconds

    def learning_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._void = 0
        self._ended = time.monotonic()
        self._training.episode_return(episode.episode_return)
        self._verdicts.episode_ended(episode)
        self._training.enter('learn')
        self._plant.rest()

    def episode_learned(self, episode: Episode, figures: dict[str, float]) -> None:
        """See :class:`Callbacks`."""
        if self._table is not None and self._kept is not None:
            self._table.append(episode)  # before the learner: a row too many is dropped on resuming
            self._kept.learned(self._learner)
        self._episode = None
        if self._last.number is not None:
            self._last.set(0)  # it was this one, also when it is discarded now
        self._seconds_left -= len(episode) * POLICY_PERIOD + episode.learn_seconds
        self.node.get_logger().info(
            f'episode {episode.number}: return {episode.episode_return:.1f}, human share {episode.human_share:.0%}, '
            f'learned in {episode.learn_seconds:.2f} s')
        self._take_a_break(self._ended)
        self._attend()
        if self._kept is not None:
            self._kept.settle()

    def episode_unlearned(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._verdicts.close()
        if self._policy_path is not None:
            if self._learner.episode:
                save_policy(self._learner, self._policy_path)
            else:
                self._policy_path.unlink(missing_ok=True)  # a learner that has learned nothing is none
        again = '' if self._is_taught else ', and taught again'
        self.node.get_logger().info(f'episode {episode.number} is discarded: it is unlearned{again}')

    def episode_tested(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._void = 0
        self._training.episode_return(episode.episode_return)
        self._verdicts.episode_ended(episode)
        if self._table is not None:
            self._table.append(episode)
        self._take_a_break(time.monotonic())

    def interrupted(self, error: PlantInterrupted) -> None:
        """See :class:`Callbacks`."""
        self.node.get_logger().warning(f'the episode is void: {error}')
        if not self._repeat:
            self._void_again()
        self._break_off(str(error))
        again = time.monotonic() + TRY_AGAIN_SECONDS  # whatever is the matter may last
        while time.monotonic() < again:
            time.sleep(0.1)
            self._attend()
        self._wait()

    def _void_again(self) -> None:
        self._void += 1
        if self._void % VOID_IN_A_ROW == 0:
            cores, load = len(os.sched_getaffinity(0)), os.getloadavg()[0]
            self.node.get_logger().error(
                f'{self._void} episodes in a row were void, and none will count like this: end other programs (load '
                f'{load:.1f} on {cores} cores) and look with `shared-control doctor`, or end the session and go on '
                'with it later')

    def _break_off(self, reason: str) -> None:
        """What is under way is not learned from, but a person has taught for as long."""
        episode, self._episode = self._episode, None
        if episode is not None and episode.phase == 'teach':
            self._seconds_left -= len(episode) * POLICY_PERIOD
            if self._table is not None:
                self._table.break_off(episode, reason)

    def close(self) -> None:
        """Leave no moment behind, and see to it that the last words arrive."""
        self._plant.close()
        self._training.flush()
        self._background.close()


def _load(path: Path, parameter: str) -> Learner:
    try:
        return load_policy(path)
    except PolicyFileError as error:
        raise ParameterError(f'parameter {parameter!r}: {error}') from error


def main() -> int:
    """Entry point."""
    return run(PpoAgentNode)


if __name__ == '__main__':
    raise SystemExit(main())
