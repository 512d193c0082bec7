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

"""The report of a study: one page, its figures as PNG, SVG and PDF, its numbers as CSV."""

import base64
import math
from pathlib import Path
from typing import Any

import jinja2
import matplotlib
import pandas as pd
from markupsafe import Markup
from shared_control.files import write_atomically
from shared_control_learning.presets import preset_for

from ..plotting.plot import origin
from ..plotting.style import PAPER
from ..session.report import STYLE_SHEET
from ..study.folder import StudyFolder
from ..study.plan import Condition
from .cells import AGAINST, cell_rows
from .figures import draw_all
from .measures import Study, load_study, lost_error, run_table, times
from .participants import participants_table, turnout
from .statistics import median_time
from .tables import comparison_table, conditions_table, group_table, runs_in_words, transfer_table

_PAGE = Path(__file__).with_name('study.html')
_OWN = {'report.html', 'figures', 'data'}
THESIS_REDUCTION = 0.976
"""How many episodes fewer with a human (4.7): 17 against 788."""


def write_study_report(folder: StudyFolder, output: Path) -> Path:
    """Write ``report.html``, ``figures/`` and ``data/`` into ``output``; gives the page.

    Raises:
        ValueError: no run of the study is done yet, or its plan is damaged.
        OSError: ``output`` cannot be written, or holds something else.
    """
    study = load_study(folder)
    _refuse_foreign(output)
    figures, data = output / 'figures', output / 'data'
    for path in (figures, data):
        path.mkdir(parents=True, exist_ok=True)
    if study.plan.people is not None:
        _write_table(data / 'participants.csv', participants_table(folder, study.plan))
    if not study.runs:
        problems = ''.join(f'\n  {problem}' for problem in study.problems)
        raise ValueError(f'no run of the study in {folder.path} is done yet: shared-control study does those that need '
                         f'nobody, and the tests of what people have taught{problems}')
    runs = run_table(study)
    tables = {'runs': runs, 'conditions': conditions_table(study, runs), 'comparisons': comparison_table(study, runs),
              'groups': group_table(runs),
              **({'cells': pd.DataFrame(cell_rows(study))} if study.plan.people is None else {}),
              **({'transfer': transfer_table(study)} if 'elsewhere' in runs else {})}
    drawn = []
    footer = origin(study.plan.seed)
    with matplotlib.rc_context(PAPER):
        for plot, sheet, numbers in draw_all(study):
            tables[plot.name] = numbers
            sheet.save(figures / plot.name, footer, f'{plot.title}. {plot.caption}')
            drawn.append((plot, _embedded(figures / f'{plot.name}.svg')))
    for name, table in tables.items():
        _write_table(data / f'{name}.csv', table)
    page = output / 'report.html'
    write_atomically(page, _page(folder, study, tables, drawn, footer).encode())
    return page


def _refuse_foreign(output: Path) -> None:
    if output.is_dir() and (others := sorted({path.name for path in output.iterdir()} - _OWN)):
        raise FileExistsError(f'{output} holds {", ".join(others[:3])}{", ..." if len(others) > 3 else ""}, which is '
                              "of no study's report: name another folder")


def _write_table(path: Path, table: pd.DataFrame) -> None:
    write_atomically(path, table.to_csv(index=False, float_format='%.6g').encode())


def _embedded(svg: Path) -> str:
    return 'data:image/svg+xml;base64,' + base64.b64encode(svg.read_bytes()).decode()


def _page(folder: StudyFolder, study: Study, tables: dict[str, pd.DataFrame], drawn: list, footer: str) -> str:
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True,
                                     lstrip_blocks=True)
    environment.filters['number'] = _number
    environment.filters['interval'] = _interval
    simulated = study.plan.people is None
    conditions, comparisons, groups = (
        tables[name].to_dict('records') for name in ('conditions', 'comparisons', 'groups'))
    for row in comparisons:
        row['pair'] = f'{row["first"]} beats {row["second"]}'
    for row in groups:
        row['row'] = (study.conditions.index(row['condition']), row['measure'])
    return environment.from_string(_PAGE.read_text(encoding='utf-8')).render(
        css=Markup(STYLE_SHEET.read_text(encoding='utf-8')), study=study, simulated=simulated, figures=drawn,
        turnout=None if simulated else turnout(folder, study.plan),
        problems=list(map(folder.without_path, study.problems)),
        headlines=_headlines(study), conditions=conditions,
        measures=list(dict.fromkeys(row['measure'] for row in conditions)), comparisons=comparisons, groups=groups,
        reduction=_reduction(study), thesis_reduction=THESIS_REDUCTION,
        tasks={task.name: (task, 100 * lost_error(task)) for task in map(study.task, study.conditions)},
        origin=footer)


def _headlines(study: Study) -> list[tuple[str, str]]:
    """Value and what it is: episodes to skilled of each condition."""
    found = []
    for name in study.conditions:
        reached = times(study.of(name))
        median = median_time(reached)
        what = f'{name}: episodes to skilled, median ({reached.reached.sum()} of {runs_in_words(len(reached.reached))} '
        found.append((_number(median, 'g') if math.isfinite(median) else f'over {int(reached.episodes.max())}',
                      what + 'got there)'))
    return found


def _reduction(study: Study) -> list[tuple[str, float]]:
    """Conditions with a teacher, and the share of episodes that they save against learning alone, by medians.

    Alone the same learner, or PPO, has learned the same task.
    """
    medians = {c.name: median_time(times(study.of(c.name))) for c in study.plan.conditions
               if study.of(c.name)}
    found = []
    for taught in (c for c in study.plan.conditions if c.taught and c.name in medians):
        alone = [c.name for preset in (_preset(taught), AGAINST) for c in study.plan.conditions
                 if not c.taught and c.name in medians and _preset(c) == preset
                 and study.task(c.name).name == study.task(taught.name).name]
        if alone and math.isfinite(medians[taught.name]) and math.isfinite(medians[alone[0]]):
            found.append((taught.name, 1 - medians[taught.name] / medians[alone[0]]))
    return found


def _preset(condition: Condition) -> str:
    return preset_for(condition.task, condition.preset).name


def _interval(row: dict[str, Any], form: str) -> str:
    if math.isnan(row['low']):
        return 'no interval'
    return f'{_number(row["low"], form)} to {_number(row["high"], form)}'


def _number(value: Any, form: str) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return '–'
    if isinstance(value, float) and math.isinf(value):
        return '∞'
    if abs(value) >= 1000:
        form = '.0f'  # not 4.88e+03
    return format(value, form).replace('-', '−')
