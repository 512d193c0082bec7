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

"""The arm, the tray and the ball as a three.js scene that NiceGUI sets up; the browser moves what has a name."""

import numpy as np
import pinocchio as pin
from nicegui import ui
from shared_control.robot.model import RobotModel
from shared_control.scene import Scene
from shared_control.tasks.task import Task

_TRAY_COLOUR, _OBSTACLE_COLOUR, _BALL_COLOUR, _GOAL_COLOUR, _FLOOR_COLOUR = (
    '#3d5068', '#a83a32', '#f2b705', '#35b37e', '#cfd8e0')
_FLAT = 0.0004
"""Height of what is painted on the tray, m."""
_EVERY_FRAME = 1000
"""NiceGUI's scene waits 1 / fps between two frames of the browser: too long a wait leaves out every other one."""
_CAMERA = {'x': -0.43, 'y': 0.82, 'z': 1.14, 'look_at_x': -0.43, 'look_at_y': 0.0, 'look_at_z': 0.76}
"""From base +y: base +x, where the left key rolls the ball, is on the left."""


def build_scene(task: Task) -> ui.scene:
    """A scene with named groups ``joint1``, ``joint2`` ..., ``ball`` (base frame) and ``shadow`` (tray frame)."""
    robot = RobotModel()
    model = robot.pin_model
    with ui.scene(grid=False, background_color='#eaf0f5', fps=_EVERY_FRAME, click_events=[],
                  camera=ui.scene.perspective_camera(fov=40)) as scene:
        scene.box(3.0, 3.0, 0.02).move(-0.2, 0.0, -0.01).material(_FLOOR_COLOUR)
        scene.sphere(task.scene.ball.radius, 24, 16).material(_BALL_COLOUR).with_name('ball')
        _link(scene, 0)
        with _Nested() as nested:
            for joint in range(1, robot.spec.dof + 1):
                nested.enter(_placed(scene, model.jointPlacements[joint]))
                nested.enter(scene.group().with_name(f'joint{joint}'))
                _link(scene, joint)
            nested.enter(_placed(scene, model.frames[model.getFrameId(robot.spec.tool_frame)].placement))
            _tray(scene, task.scene, len(task.axes) == 1)
    scene.move_camera(**_CAMERA, duration=0.0)
    return scene


class _Nested:
    """Groups within groups: a chain of links has no fixed depth."""

    def __enter__(self) -> '_Nested':
        self._groups: list[ui.scene.group] = []
        return self

    def enter(self, group: ui.scene.group) -> None:
        """What follows is part of ``group``."""
        group.__enter__()
        self._groups.append(group)

    def __exit__(self, *error: object) -> None:
        for group in reversed(self._groups):
            group.__exit__(*error)


def _placed(scene: ui.scene, placement: pin.SE3) -> ui.scene.group:
    return scene.group().move(*placement.translation.tolist()).rotate_R(placement.rotation.tolist())


def _link(scene: ui.scene, number: int) -> None:
    scene.gltf(f'/static/meshes/link{number}.glb')


def _tray(scene: ui.scene, tray: Scene, one_axis: bool) -> None:
    """The boxes of the task, the goal (a stripe across the one axis, or a disc), and the ball's shadow."""
    for box in tray.boxes:
        scene.box(*box.size).move(*box.centre).material(_OBSTACLE_COLOUR if box.is_obstacle else _TRAY_COLOUR)
    goal: ui.scene.box | ui.scene.cylinder
    if one_axis:
        goal = scene.box(2 * tray.goal_radius, 1.96 * tray.half_width, _FLAT)
    else:
        goal = scene.cylinder(tray.goal_radius, tray.goal_radius, _FLAT, 32).rotate(np.pi / 2, 0.0, 0.0)
    goal.move(*tray.goal, tray.surface + _FLAT).material(_GOAL_COLOUR)
    flat = scene.cylinder(tray.ball.radius, tray.ball.radius, _FLAT, 24).rotate(np.pi / 2, 0.0, 0.0)
    flat.material('#000000', 0.45).with_name('shadow')
