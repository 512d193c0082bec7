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

"""All of the validation, its table and its JSON."""

from dataclasses import asdict, dataclass
from typing import Any

from shared_control.control.references import FREQUENCIES, cosine_reference
from shared_control.rates import CONTROL_PERIOD
from shared_control.robot.model import RobotModel
from shared_control_sim.bullet import BulletWorld
from tqdm import tqdm

from .compliance import AGREEMENT, Compliance, check_compliance
from .model_checks import BOUND, Check, HomeFigures, check_model, home_figures
from .tracking import GAIN_SETS, SECONDS, SETTLING_SECONDS, Tracking, track


@dataclass(frozen=True)
class Validation:
    """What was found."""

    checks: list[Check]
    home: HomeFigures
    runs: list[Tracking]
    compliances: list[Compliance]

    @property
    def worse_with_terms(self) -> list[float]:
        """The frequencies, Hz, at which the low gains track worse with the non-linear terms than without them."""
        rms = {(run.frequency, run.nonlinear_terms): (run.rms, run.rms_settled)
               for run in self.runs if run.gains == 'low'}
        return [f for f in FREQUENCIES
                if any(ours >= theirs for ours, theirs in zip(rms[f, True], rms[f, False], strict=True))]

    @property
    def passed(self) -> bool:
        """The model agrees, moments tilt the tray as predicted, and the non-linear terms help, as Figs. 9-11 say."""
        return (all(check.passed for check in self.checks) and all(c.passed for c in self.compliances)
                and not self.worse_with_terms)

    def table(self) -> str:
        """For reading."""
        home = self.home
        lines = [
            f'Largest difference at random postures (agreement: {BOUND:g})',
            *(f'  {"ok  " if c.passed else "FAIL"} {c.difference:8.1e}  {c.name} [{c.unit}]' for c in self.checks),
            '', 'Reference posture',
            f'  end effector: Table 2 has it at {_point(home.table_2_flange)} m, it is at {_point(home.flange)} m, '
            f'{home.distance:.3f} m away',
            f'  manipulability: k_w = {home.manipulability:.4f}, '
            f'1 - k_w^2 = {home.one_minus_manipulability_squared:.4f}',
            '', f'Tilt of the tray about x and y at rest, deg per N m (agreement: {100 * AGREEMENT:g} %)',
            *(f'  {"ok  " if c.passed else "FAIL"} {c.axis}: {_pair(c.measured)}, predicted by J^T W: '
              f'{_pair(c.predicted)}' for c in self.compliances),
            '', "RMS error of the tray's velocity along x, mm/s (in brackets: without the first "
            f'{SETTLING_SECONDS:g} s)',
            '  gains     Hz   with the non-linear terms       without them']
        for gains in GAIN_SETS:
            for frequency in FREQUENCIES:
                with_terms, without = (
                    next(r for r in self.runs if (r.gains, r.frequency, r.nonlinear_terms) == (gains, frequency, terms))
                    for terms in (True, False))
                lines.append(f'  {gains:<5} {frequency:6.2f} {_rms(with_terms):>25} {_rms(without):>20}')
        lines.append('  With the low gains the non-linear terms help at every frequency.' if not self.worse_with_terms
                     else f'  FAIL: with the low gains the non-linear terms do not help at {self.worse_with_terms} Hz.')
        return '\n'.join(lines)

    def as_json(self) -> dict[str, Any]:
        """All figures of the table."""
        return {
            'passed': self.passed,
            'checks': [{**asdict(check), 'bound': BOUND, 'passed': check.passed} for check in self.checks],
            'home': asdict(self.home),
            'compliance': [{**asdict(c), 'unit': 'deg/(N m)', 'passed': c.passed} for c in self.compliances],
            'tracking': [{
                'gains': run.gains, 'nonlinear_terms': run.nonlinear_terms, 'frequency_hz': run.frequency,
                'rms_m_s': run.rms, 'rms_settled_m_s': run.rms_settled, 'max_distance_m': float(run.distance.max()),
                'manipulability_min': float(run.manipulability.min()),
                'manipulability_max': float(run.manipulability.max())} for run in self.runs]}


def validate() -> Validation:
    """Run all checks, with a progress bar."""
    model, world = RobotModel(), BulletWorld()
    runs = []
    with tqdm(total=1 + len(FREQUENCIES) * len(GAIN_SETS) * 2, unit='run', disable=None) as progress:
        progress.set_description('kinematics and dynamics')
        checks, home, compliances = check_model(model), home_figures(model), check_compliance(model, world)
        progress.update()
        for frequency in FREQUENCIES:
            reference = cosine_reference(model, frequency, SECONDS, CONTROL_PERIOD)
            for gains in GAIN_SETS:
                for nonlinear_terms in (True, False):
                    progress.set_description(f'{frequency:g} Hz, {gains} gains')
                    runs.append(track(model, world, gains, nonlinear_terms, frequency, reference))
                    progress.update()
    world.close()
    return Validation(checks, home, runs, compliances)


def _pair(values: tuple[float, float]) -> str:
    return ' '.join(f'{abs(value):.3f}' for value in values)


def _point(point: tuple[float, float, float]) -> str:
    return '(' + ', '.join(f'{value:.3f}' for value in point) + ')'


def _rms(run: Tracking) -> str:
    return f'{1e3 * run.rms:.2f} ({1e3 * run.rms_settled:.2f})'
