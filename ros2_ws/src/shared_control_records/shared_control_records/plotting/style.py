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

"""How our plots look. Colours: Okabe and Ito's, and cividis, which people with any colour vision tell apart."""

from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

HUMAN = '#D55E00'
AGENT = '#0072B2'
GOOD = '#009E73'
BAD = '#CC3311'
INK = '#1f2933'
FAINT = '#7b8794'
SEQUENCE = matplotlib.colormaps['cividis']
"""From early to late."""

STYLE: dict[Any, Any] = {
    'figure.facecolor': 'white', 'axes.facecolor': 'white', 'savefig.facecolor': 'white',
    'font.size': 10.5, 'axes.titlesize': 12, 'axes.titleweight': 'bold', 'axes.titlelocation': 'left',
    'axes.titlepad': 10, 'axes.labelcolor': INK, 'text.color': INK, 'axes.edgecolor': FAINT,
    'xtick.color': FAINT, 'ytick.color': FAINT, 'xtick.labelcolor': INK, 'ytick.labelcolor': INK,
    'axes.spines.top': False, 'axes.spines.right': False, 'axes.grid': True, 'grid.color': '#e4e7eb',
    'grid.linewidth': 0.8, 'axes.axisbelow': True, 'lines.linewidth': 1.8, 'lines.solid_capstyle': 'round',
    'legend.frameon': False, 'legend.fontsize': 9.5, 'pdf.fonttype': 42}
"""For ``matplotlib.rc_context``: figures to look at on a screen."""

PAPER: dict[Any, Any] = {
    **STYLE, 'font.size': 8, 'axes.titlesize': 8.5, 'axes.titlepad': 6, 'legend.fontsize': 7.5, 'lines.linewidth': 1.3,
    'lines.markersize': 4.5}
"""Likewise: figures as wide as a page or a column, as they are."""


def say_empty(axes: Axes, text: str) -> None:
    """Say in a plot why there is nothing in it."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha='center', va='center', color=FAINT)
    axes.tick_params(bottom=False, left=False, labelbottom=False, labelleft=False)
    axes.grid(visible=False)


def cross(colour: str, label: str) -> Line2D:
    """The sign of a fallen ball, for a legend."""
    return Line2D([], [], marker='x', linestyle='', color=colour, markeredgewidth=2, label=label)
