"""A small set of data to start from: sessions of simulated tutors of several families on each task.

    python tools/data_set.py out/data_set           # 12 sessions; add --quick for one short session of each task

A session is a bag (MCAP, as `ros2 bag` reads it) and a part of its task's LeRobot data set. Everything is computed in
process, without a graph, at the policy's rate: bags have a sample every 20 ms, with the robot's time for the
recorder's, and the same command gives the same bytes (SHA256SUMS). The data card (README.md) says what is in it.
"""

import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore
from shared_control import contract
from shared_control.command_line import script_parser
from shared_control.contract import Topic
from shared_control.env import SharedControlEnv
from shared_control.plant import PlantState
from shared_control.rates import POLICY_PERIOD
from shared_control.teaching.tutors import make_tutor, tutor_named
from shared_control_learning.callbacks import Callbacks
from shared_control_learning.episode import Episode
from shared_control_learning.learn import learn
from shared_control_learning.presets import preset_for
from shared_control_records.bag import annotate
from shared_control_records.bag.reader import read_bag
from shared_control_records.bag.task import RECORD, SETTINGS
from shared_control_records.bag.writer import BagWriter
from shared_control_records.export.frames import episode_frames
from shared_control_records.export.lerobot import write_lerobot
from shared_control_sim.local_plant import LocalPlant

TASKS = ('balance', 'plate', 'detour')
FAMILIES = ('predictive', 'bang_bang', 'reactive', 'crossover')
EPISODES = 6
SEED = 2026
START_NS = 1_735_689_600_000_000_000
"""The robot's time at the start of every session: 2025-01-01, ns."""
PERIOD_NS = round(POLICY_PERIOD * 1e9)
STORE = get_typestore(Stores.ROS2_JAZZY)
TOPICS = (contract.JOINT_STATES, contract.BALL, contract.AGENT_APPLIED, contract.HUMAN_APPLIED, contract.APPLIED_WRENCH,
          contract.EPISODE, contract.PHASE, contract.EPISODE_RETURN)


class RecordedPlant(LocalPlant):
    """A plant that writes down what it does."""

    def __init__(self, task: Any, person: Any, bag: BagWriter):
        super().__init__(task, person)
        self._axes, self._bag, self._sequence = task.axes, bag, 0
        self.now_ns = START_NS
        self._channels = {topic: bag.add_topic(
            topic.full_name, topic.type, STORE.generate_msgdef(topic.type, ros_version=2)[0],
            STORE.hash_rihs01(topic.type), '[]') for topic in TOPICS}

    def reset(self, seed: int | None = None) -> PlantState:
        """See :class:`LocalPlant`."""
        state = super().reset(seed)
        self._write_state(state)
        return state

    def advance(self, agent: np.ndarray) -> PlantState:
        """See :class:`LocalPlant`."""
        state = super().advance(agent)
        for topic, moment in ((contract.AGENT_APPLIED, state.agent), (contract.HUMAN_APPLIED, state.human),
                              (contract.APPLIED_WRENCH, state.applied)):
            wrench = np.zeros(6)
            wrench[list(self._axes)] = moment
            self.write(topic, header=self._header(), wrench=_make(
                'geometry_msgs/msg/Wrench', force=_vector(wrench[:3]), torque=_vector(wrench[3:])))
        self.now_ns += PERIOD_NS
        self._write_state(state)
        return state

    def write(self, topic: Topic, **fields: Any) -> None:
        """One message, at the robot's time."""
        self._sequence += 1
        data = STORE.serialize_cdr(_make(topic.type, **fields), topic.type)
        self._bag.write(self._channels[topic], bytes(data), self.now_ns, self.now_ns, self._sequence)

    def _write_state(self, state: PlantState) -> None:
        q, qd = self.world.joint_state()
        self.write(contract.JOINT_STATES, header=self._header(), name=list(self.spec.joints), position=np.array(q),
                   velocity=np.array(qd), effort=np.array(self.world.effort))
        pose = _make('geometry_msgs/msg/Pose', position=_make('geometry_msgs/msg/Point', **_xyz(state.ball_position)),
                     orientation=_make('geometry_msgs/msg/Quaternion', x=0.0, y=0.0, z=0.0, w=1.0))
        twist = _make('geometry_msgs/msg/Twist', linear=_vector(state.ball_velocity), angular=_vector(np.zeros(3)))
        self.write(
            contract.BALL, header=self._header(), child_frame_id=contract.BALL_FRAME,
            pose=_make('geometry_msgs/msg/PoseWithCovariance', pose=pose, covariance=np.zeros(36)),
            twist=_make('geometry_msgs/msg/TwistWithCovariance', twist=twist, covariance=np.zeros(36)))

    def _header(self) -> Any:
        seconds, nanoseconds = divmod(self.now_ns, 1_000_000_000)
        return _make('std_msgs/msg/Header', frame_id=contract.BASE_FRAME, stamp=_make(
            'builtin_interfaces/msg/Time', sec=seconds, nanosec=nanoseconds))


class Lesson(Callbacks):
    """Announces the episodes of a recorded plant."""

    def __init__(self, plant: RecordedPlant, bag: BagWriter):
        self._plant, self._bag = plant, bag

    def episode_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._plant.now_ns += PERIOD_NS
        self._plant.write(contract.PHASE, data=episode.phase)
        self._plant.write(contract.EPISODE, data=episode.number)

    def learning_started(self, episode: Episode) -> None:
        """See :class:`Callbacks`."""
        self._plant.now_ns += 1
        self._plant.write(contract.EPISODE_RETURN, data=episode.episode_return)
        self._plant.now_ns += PERIOD_NS - 1
        self._bag.flush()


def _make(kind: str, **fields: Any) -> Any:
    return STORE.types[kind](**fields)


def _xyz(values: Any) -> dict[str, float]:
    return dict(zip('xyz', map(float, values), strict=True))


def _vector(values: Any) -> Any:
    return _make('geometry_msgs/msg/Vector3', **_xyz(values))


def make_session(folder: Path, task_name: str, family: str, seed: int, episodes: int, seconds: float | None) -> Path:
    """One session as a bag; gives its folder."""
    chosen = preset_for(task_name)
    learner = chosen.make(seed)
    task = learner.task
    if seconds is not None:
        task = replace(task, episode_seconds=seconds)
    bag = BagWriter(folder)
    plant = RecordedPlant(task, make_tutor(tutor_named(family, seed), task, seed), bag)
    env = SharedControlEnv(plant, task)
    try:
        learn(learner, env, episodes, Lesson(plant, bag))
    finally:
        env.close()
    bag.finish()
    annotate(folder, RECORD, {SETTINGS: json.dumps({
        'task': task_name, 'preset': chosen.name, 'tutor': f'simulated: {family}', 'seed': seed,
        'episodes': episodes})})
    return folder


def card(rows: list[dict[str, Any]], command: str) -> str:
    """The data card."""
    table = '\n'.join(f'| {row["session"]} | {row["task"]} | {row["tutor"]} | {row["seed"]} | {row["episodes"]} | '
                      f'{row["frames"]} | {row["intervention"]:.0%} | {row["successes"]} |' for row in rows)
    return f"""---
license: apache-2.0
task_categories: [robotics]
tags: [LeRobot, shared-control, simulated]
---
# Shared control of a ball on a tray: simulated sessions

{len(rows)} sessions, {sum(row['frames'] for row in rows)} frames at 50 Hz. **Every tutor is simulated**: a model of a
person at the keys, of the family named; no person took part. The robot (Franka Panda with a tray, PyBullet) learns
while the tutor presses keys; both moments are summed. Made by `{command}`, which gives these bytes again (SHA256SUMS).

| session | task | tutor (simulated) | seed | episodes | frames | with the tutor's moment | succeeded |
|---|---|---|---|---|---|---|---|
{table}

- `bags/SESSION/`: MCAP, topics of the project's contract, a sample every 20 ms of the robot's time (a recorded session
  of the live graph has 1 kHz); `shared-control view`, `report`, `export` and `ros2 bag` read it.
- `lerobot/TASK/`: LeRobot v3.0. `observation.state` (the same as `observation.environment_state`): what the task
  shows a learner; `action`: the applied moment (M_x, M_y), N m; `complementary_info.action_agent`, `.action_human`: its
  parts; `intervention`; `next.reward`, `next.done`, `next.truncated`, `next.success` (by the task's own criterion).
  `meta/episodes` has the session of each episode.

Limits: early episodes of learning, with exploring and falls, are in it on purpose. One simulator, one robot, one ball.
The tutors are models of the literature and were not fitted to people.
"""


def main() -> None:
    """Make the set."""
    parser = script_parser(__doc__)
    parser.add_argument('output', type=Path, metavar='FOLDER', help='new folder')
    parser.add_argument('--quick', action='store_true', help='one session of each task, two episodes of 2 s')
    args = parser.parse_args()
    if args.output.exists():
        parser.error(f'{args.output} exists already: choose another folder')
    families, episodes, seconds = (FAMILIES[:1], 2, 2.0) if args.quick else (FAMILIES, EPISODES, None)
    rows = []
    for task in TASKS:
        found = []
        for number, family in enumerate(families):
            name = f'{task}_{family}'
            seed = SEED + number
            bag = make_session(args.output / 'bags' / name, task, family, seed, episodes, seconds)
            frames = episode_frames(read_bag(bag))
            found += frames
            rows.append({
                'session': name, 'task': task, 'tutor': family, 'seed': seed, 'episodes': len(frames),
                'frames': sum(map(len, frames)), 'successes': sum(frame.succeeded for frame in frames),
                'intervention': float(np.mean(np.concatenate([(frame.human != 0).any(axis=1) for frame in frames])))})
            print(f'{name}: {rows[-1]["frames"]} frames of {len(frames)} episodes', flush=True)
        write_lerobot(found, args.output / 'lerobot' / task)
    quick = ' --quick' if args.quick else ''
    (args.output / 'README.md').write_text(card(rows, f'python tools/data_set.py FOLDER{quick}'))
    files = sorted(path for path in args.output.rglob('*') if path.is_file())
    (args.output / 'SHA256SUMS').write_text(''.join(
        f'{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(args.output).as_posix()}\n'
        for path in files))
    print(f'{len(files)} files, {sum(path.stat().st_size for path in files) / 1e6:.1f} MB in {args.output}')


if __name__ == '__main__':
    main()
