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

"""What of a bag is logged to Rerun, and where.

    world/arm/LINK, world/tray, world/ball       what there is to see, base frame, m
    world/moments/human, agent, applied          the moment at the tray as an arrow along its axis
    moments/AXIS/human, agent, applied           N m, a chart for each axis of the task
    ball/position_error, training/...            charts
    log/phase, log/keys, log/verdict             lines of text
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pinocchio as pin
import rerun as rr
import rerun.blueprint as rrb
from shared_control import contract
from shared_control.robot.model import RobotModel, quaternion_of
from shared_control.robot.tray import carrying
from shared_control.wrench import AXIS_NAMES

from ..bag.ball_tracks import episode_tracks
from ..bag.reader import Bag
from ..bag.recorded import Wrenches

TIMELINE = 'time'
"""Seconds since the first message of the bag, by the recorder's clock: the one clock that all topics have."""
PICTURE_NS = 20_000_000
"""The arm is logged as often, which is every frame of a screen."""
METRES_PER_NM = 0.02
COLOURS = {'human': (213, 94, 0), 'agent': (0, 114, 178), 'applied': (150, 157, 164)}
"""Human orange and agent blue, as on the page and in figures."""
EYE, LOOKED_AT = (1.6, 1.2, 1.3), (0.3, 0.0, 0.7)
"""Where the scene is seen from at first, and what is looked at, base frame, m."""


def log_bag(bag: Bag, recording: rr.RecordingStream) -> None:
    """Log everything that can be seen of a bag."""
    _log_scene(bag, recording)
    for who, wrenches in _moments(bag).items():
        _log_moments(bag, recording, who, wrenches)
    for topic, series in bag.training.items():
        if topic != contract.PHASE and len(series.values):
            _send(recording, _entity(topic.name), bag, series.received_ns,
                  rr.Scalars.columns(scalars=series.values.astype(float)))
    phases = bag.training[contract.PHASE]
    lines = [(at, 'log/phase', str(phase)) for at, phase in zip(phases.received_ns, phases.values, strict=True)]
    lines += [(press.received_ns, 'log/keys', f'{press.source}: {press.key.name.lower()}') for press in bag.presses]
    lines += [(judgement.received_ns, 'log/verdict', f'{judgement.episode}: {judgement.verdict or "taken back"}')
              for judgement in bag.judgements]
    for entity in ('log/phase', 'log/keys', 'log/verdict'):
        found = [(at, text) for at, where, text in lines if where == entity]
        if found:
            _send(recording, entity, bag, np.array([at for at, _ in found]),
                  rr.TextLog.columns(text=[text for _, text in found]))
    for track in episode_tracks(bag):
        first, last = np.searchsorted(bag.ball.received_ns, track.received_ns)
        stamps = track.start_ns + np.round(track.seconds * 1e9).astype(np.int64)
        samples = np.searchsorted(bag.ball.stamp_ns[first:last + 1], stamps) + first
        received = bag.ball.received_ns[samples.clip(max=last)]
        _send(recording, 'ball/position_error', bag, received, rr.Scalars.columns(scalars=track.position_error))


def blueprint(bag: Bag) -> rrb.Blueprint:
    """How the viewer lays it out: the scene beside the charts, lines of text below."""
    charts = [rrb.TimeSeriesView(origin=f'moments/{AXIS_NAMES[row]}', name=f'{AXIS_NAMES[row]} (N m)')
              for row in bag.task.axes]
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Horizontal(
                rrb.Spatial3DView(origin='world', name=bag.task.name, eye_controls=rrb.EyeControls3D(
                    position=EYE, look_target=LOOKED_AT, eye_up=(0.0, 0.0, 1.0))),
                rrb.Vertical(*charts, rrb.TimeSeriesView(origin='ball', name='position error (m)'),
                             rrb.TimeSeriesView(origin='training', name='training'))),
            rrb.TextLogView(origin='log', name='phases, keys, verdicts'), row_shares=[4, 1]),
        rrb.TimePanel(timeline=TIMELINE, state='collapsed'), rrb.BlueprintPanel(state='collapsed'),
        rrb.SelectionPanel(state='collapsed'))


def _moments(bag: Bag) -> dict[str, Wrenches]:
    """What counted; what was asked for where the controller did not publish the parts."""
    return {'human': bag.human_applied if len(bag.human_applied.stamp_ns) else bag.human,
            'agent': bag.agent_applied if len(bag.agent_applied.stamp_ns) else bag.agent, 'applied': bag.applied}


def _log_scene(bag: Bag, recording: rr.RecordingStream) -> None:
    recording.log('world', rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    if not len(bag.joint_states.q):
        return
    received = bag.joint_states.received_ns
    shown = np.unique(received // PICTURE_NS, return_index=True)[1]
    model = RobotModel(carrying(RobotModel().spec, bag.task.scene))
    for name, mesh, translations, rotations in _meshes(model, bag.joint_states.q[shown]):
        recording.log(f'world/arm/{name}', rr.Asset3D(path=mesh), static=True)
        _send_poses(recording, f'world/arm/{name}', bag, received[shown], translations, rotations)
    poses = [(where.copy(), quaternion_of(rotation)) for where, rotation in map(
        model.tray_pose, bag.joint_states.q[shown])]
    boxes = bag.task.scene.boxes
    recording.log('world/tray', rr.Boxes3D(
        centers=[box.centre for box in boxes], sizes=[box.size for box in boxes],
        colors=[(180, 60, 60) if box.is_obstacle else (61, 80, 104) for box in boxes], fill_mode='solid'), static=True)
    _send_poses(recording, 'world/tray', bag, received[shown], np.array([where for where, _ in poses]),
                np.array([rotation for _, rotation in poses]))
    recording.log('world/ball', rr.Ellipsoids3D(
        radii=[bag.task.scene.ball.radius], colors=[(242, 183, 5)], fill_mode='solid'), static=True)
    _send(recording, 'world/ball', bag, bag.ball.received_ns,
          rr.Transform3D.columns(translation=bag.ball.position))


def _meshes(model: RobotModel, q: np.ndarray) -> Iterator[tuple[str, str, np.ndarray, np.ndarray]]:
    """Every mesh of the robot: name, file, and where it is at each row of ``q``: (n, 3), m, and (n, 4), x y z w."""
    found = pin.buildGeomFromUrdfString(
        model.pin_model, model.spec.description, pin.GeometryType.VISUAL,
        package_dirs=[str(model.spec.urdf.parents[2])])
    data = model.pin_model.createData()
    geometry = pin.GeometryData(found)
    shown = [(index, item) for index, item in enumerate(found.geometryObjects) if item.meshPath.endswith('.obj')]
    translations, rotations = np.empty((len(shown), len(q), 3)), np.empty((len(shown), len(q), 4))
    for row, joints in enumerate(q):
        pin.updateGeometryPlacements(model.pin_model, data, found, geometry, joints)
        for number, (index, _) in enumerate(shown):
            translations[number, row] = geometry.oMg[index].translation
            rotations[number, row] = quaternion_of(geometry.oMg[index].rotation)
    for number, (_, item) in enumerate(shown):
        yield item.name, item.meshPath, translations[number], rotations[number]


def _log_moments(bag: Bag, recording: rr.RecordingStream, who: str, wrenches: Wrenches) -> None:
    if not len(wrenches.stamp_ns):
        return
    for axis, row in enumerate(bag.task.axes):
        entity = f'moments/{AXIS_NAMES[row]}/{who}'
        recording.log(entity, rr.SeriesLines(colors=[COLOURS[who]], names=[who]), static=True)
        _send(recording, entity, bag, wrenches.received_ns, rr.Scalars.columns(scalars=wrenches.moment[:, axis]))
    if not len(bag.joint_states.q):
        return
    about = np.zeros((len(wrenches.moment), 6))
    about[:, list(bag.task.axes)] = wrenches.moment * METRES_PER_NM
    model = RobotModel()
    home = model.tray_pose(bag.joint_states.q[0])[0].copy()
    _send(recording, f'world/moments/{who}', bag, wrenches.received_ns, rr.Arrows3D.columns(
        vectors=about[:, 3:], origins=np.tile(home, (len(about), 1)),
        colors=[COLOURS[who]] * len(about)))


def _send_poses(recording: rr.RecordingStream, entity: str, bag: Bag, received_ns: np.ndarray,
                translations: np.ndarray, rotations: np.ndarray) -> None:
    _send(recording, entity, bag, received_ns, rr.Transform3D.columns(
        translation=translations, quaternion=rotations))


def _send(recording: rr.RecordingStream, entity: str, bag: Bag, received_ns: np.ndarray, columns: Any) -> None:
    seconds = (np.asarray(received_ns) - bag.start_ns) * 1e-9
    recording.send_columns(entity, indexes=[rr.TimeColumn(TIMELINE, duration=seconds)], columns=columns)


def _entity(topic: str) -> str:
    return topic.removeprefix('/')
