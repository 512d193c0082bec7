"""Plots as files."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .style import STYLE


@dataclass(frozen=True)
class Plot:
    """A plot that is yet to be drawn."""

    name: str
    """Name of its files, without suffix."""
    draw: Callable[[Figure], None]
    """Draws it into an empty figure."""
    size: tuple[float, float] = (8.0, 4.5)
    """inches"""

    def save(self, folder: Path) -> None:
        """Draw it, and write ``NAME.png`` and ``NAME.svg`` to ``folder``."""
        with matplotlib.rc_context(STYLE):
            figure = Figure(figsize=self.size, layout='constrained')
            FigureCanvasAgg(figure)
            self.draw(figure)
            figure.savefig(folder / f'{self.name}.png', dpi=110)
            figure.set_layout_engine('none')  # laid out by now; doing it again would take as long as the rest
            figure.savefig(folder / f'{self.name}.svg')
