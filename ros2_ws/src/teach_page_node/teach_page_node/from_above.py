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

"""The tray from above as a drawing, for tasks with two axes; ``static/close_view.js`` moves what moves."""

from shared_control.scene import Scene


def view_from_above(tray: Scene) -> str:
    """SVG, 1 mm a unit: base +x is on the left and -y, away from who looks, at the top."""
    half_x, half_y = 1000 * tray.half_length, 1000 * tray.half_width
    wall, radius = 5, 1000 * tray.ball.radius
    boxes = ''.join(
        f'<rect x="{-1000 * (box.centre[0] + box.size[0] / 2):.1f}" y="{1000 * (box.centre[1] - box.size[1] / 2):.1f}" '
        f'width="{1000 * box.size[0]:.1f}" height="{1000 * box.size[1]:.1f}" class="obstacle"/>'
        for box in tray.boxes if box.is_obstacle)
    goal = -1000 * tray.goal[0], 1000 * tray.goal[1]
    return f"""
<svg viewBox="{-half_x - 30} {-half_y - 36} {2 * half_x + 60} {2 * half_y + 62}" data-part="close-view" role="img"
    aria-label="The tray from above">
  <rect x="{-half_x - wall / 2}" y="{-half_y - wall / 2}" width="{2 * half_x + wall}" height="{2 * half_y + wall}"
      rx="3" class="plate"/>
  <circle cx="{goal[0]}" cy="{goal[1]}" r="{1000 * tray.goal_radius}" class="goal"/>
  {boxes}
  <circle data-part="close-ball" r="{radius}" class="ball"/>
  <text x="{-half_x - 4}" y="{-half_y - 14}" data-part="tilt-text" class="tilt-text"></text>
  <g class="arrows">
    <path data-part="arrow-applied" class="applied"/>
    <path data-part="arrow-human" class="human"/>
    <path data-part="arrow-agent" class="agent"/>
  </g>
</svg>"""
