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

"""Figures as files: PNG to look at, SVG and PDF for papers, with where they come from in a small line below."""

import io
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import date
from importlib.metadata import version
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from shared_control.files import write_atomically

from .style import FAINT, PAPER

FOOTER = 0.2
"""Height of the line below a figure, inches."""
DPI = 200


def origin(seed: object = None, when: date | None = None) -> str:
    """Where a figure or a report comes from, as a line: version, seed, day.

    Args:
        seed: of the data; left out when None.
        when: the day of the data; today when not given.
    """
    parts = [f'shared-control {version("shared-control")}', *([] if seed is None else [f'seed {seed}']),
             f'{when or date.today():%Y-%m-%d}']
    return ' · '.join(parts)


class Sheet:
    """A figure to draw in, with a line below for where it comes from.

    Args:
        width, height: of what is drawn, inches.
        spaces: of :class:`matplotlib.layout_engine.ConstrainedLayoutEngine`.
    """

    def __init__(self, width: float, height: float, **spaces: Any):
        self.figure = Figure(figsize=(width, height + FOOTER), layout=ConstrainedLayoutEngine(**spaces))
        FigureCanvasAgg(self.figure)
        parts: Any = self.figure.subfigures(2, 1, height_ratios=(height, FOOTER))
        self.content: SubFigure = parts[0]
        """What is drawn in."""
        self._line: SubFigure = parts[1]

    def save(self, stem: Path, footer: str, caption: str, dpi: int = DPI) -> np.ndarray:
        """Write ``STEM.png``, ``STEM.svg`` and ``STEM.pdf``, each as a whole.

        Returns:
            The pixels, (height, width, 4), uint8.

        Args:
            footer: :func:`origin`.
            caption: goes into the files as their description.
        """
        self._line.text(0.99, 0.5, footer, ha='right', va='center', fontsize=6.5, color=FAINT)
        about: dict[str, dict[str, str | None]] = {
            'png': {'Title': stem.name, 'Description': caption},
            'svg': {'Title': stem.name, 'Description': caption, 'Date': None},
            'pdf': {'Title': stem.name, 'Subject': caption, 'CreationDate': None}}
        with matplotlib.rc_context({'svg.hashsalt': 'shared-control'}):  # the same figure is the same file
            self.figure.dpi = dpi
            agg = FigureCanvasAgg(self.figure)
            svg, pdf = FigureCanvasSVG(self.figure), FigureCanvasPdf(self.figure)
            for canvas, kind in ((agg, 'png'), (svg, 'svg'), (pdf, 'pdf')):
                image = io.BytesIO()
                self.figure.set_canvas(canvas)
                # Not by savefig, which draws everything twice.
                getattr(canvas, f'print_{kind}')(image, metadata=about[kind])
                self.figure.set_layout_engine('none')  # laid out by now; again would take as long as the rest
                write_atomically(stem.with_name(f'{stem.name}.{kind}'), image.getvalue())
        return np.asarray(agg.buffer_rgba())


@dataclass(frozen=True)
class Plot:
    """A plot that is yet to be drawn."""

    name: str
    """Name of its files, without suffix."""
    draw: Callable[[SubFigure], None]
    """Draws it into an empty figure."""
    caption: str
    """What is seen, with units and numbers of runs."""
    size: tuple[float, float] = (7.1, 4.0)
    """inches; 7.1 is 180 mm, two columns of a journal"""

    def save(self, folder: Path, footer: str) -> None:
        """Draw it, and write ``NAME.png``, ``NAME.svg`` and ``NAME.pdf`` to ``folder``.

        Args:
            footer: :func:`origin`.
        """
        with matplotlib.rc_context(PAPER):
            sheet = Sheet(*self.size)
            self.draw(sheet.content)
            sheet.save(folder / self.name, footer, self.caption)


def write_captions(plots: Iterable[Plot], path: Path) -> None:
    """The captions of figures in a text beside them."""
    write_atomically(path, ''.join(f'**{plot.name}**: {plot.caption}\n\n' for plot in plots).encode())
