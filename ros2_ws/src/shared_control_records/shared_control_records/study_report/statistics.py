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

"""Statistics of a study: few runs, skewed, some censored.

After Agarwal et al., 2021, "Deep RL at the edge of the statistical precipice". Their package rliable gives the same
numbers (docs/how_to/study.md), but drags in packages that do not go with today's pandas; what is needed of it
stands here.

Participants are resampled within their group (stratum): a study of two experts and eleven novices stays one.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import stats

CONFIDENCE = 0.95
RESAMPLES = 5000
TINY = 1e-9
"""By which a share that was computed may be beside one half."""
ENOUGH = 5
"""Participants below which no interval is given: one that is drawn from one or two looks certain."""


@dataclass(frozen=True)
class Estimate:
    """A number and its 95 % interval; inf where it was never reached.

    nan where there is nothing to tell it from: an interval of fewer than :data:`ENOUGH`, or one without width, would
    look certain.
    """

    value: float
    low: float
    high: float


def iqm(values: np.ndarray) -> np.ndarray:
    """Interquartile mean along the last axis: of the middle half, so that no single run decides."""
    return stats.trim_mean(values, 0.25, axis=-1)


def bootstrap(values: np.ndarray, strata: np.ndarray, statistic: Callable[[np.ndarray], np.ndarray] = iqm,
              seed: int = 0) -> Estimate:
    """A statistic with its percentile interval, by resampling participants within their strata.

    However small a stratum is: two experts among 24 participants vary too little when they are resampled, but are as
    small a part of the whole.

    Args:
        values: one a participant, (n,).
        strata: of each participant, (n,).
        statistic: along the last axis.
    """
    if not len(values):
        return Estimate(np.nan, np.nan, np.nan)
    random = np.random.default_rng(seed)
    members = [np.flatnonzero(strata == stratum) for stratum in np.unique(strata)]
    if len(values) < ENOUGH:
        return Estimate(float(statistic(values)), np.nan, np.nan)
    drawn = np.hstack([random.choice(rows, (RESAMPLES, len(rows))) for rows in members])
    tail = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(statistic(values[drawn]), [tail, 100 - tail])
    return Estimate(float(statistic(values)), *_with_width(float(low), float(high)))


def improvement(better: np.ndarray, strata: np.ndarray) -> Estimate:
    """Probability of improvement, paired: how often a participant's run in one condition beats theirs in the other.

    Args:
        better: 1 where it does, 0 where it does not, 0.5 for a tie, (n,).
    """
    return bootstrap(better, strata, lambda rows: rows.mean(axis=-1))


def beats(first: np.ndarray, second: np.ndarray, lower_is_better: bool) -> np.ndarray:
    """For :func:`improvement`: whether ``first`` beats ``second``, pair by pair."""
    gain = second - first if lower_is_better else first - second
    return np.heaviside(gain, 0.5)


def sooner(first: 'Times', second: 'Times') -> np.ndarray:
    """For :func:`improvement`: whether ``first`` was reached before ``second``, pair by pair.

    Where one was given up before the other was reached, nobody knows: a tie.
    """
    known_first = first.reached & (first.episodes <= second.episodes)
    known_second = second.reached & (second.episodes <= first.episodes)
    return 0.5 + 0.5 * (known_first.astype(float) - known_second.astype(float))


@dataclass(frozen=True, eq=False)
class Times:
    """Episodes until something was reached, or until it was given up (censored)."""

    episodes: np.ndarray
    """(n,)"""
    reached: np.ndarray
    """(n,), bool"""


@dataclass(frozen=True, eq=False)
class Survival:
    """The Kaplan-Meier estimate of how many have not reached it yet, with Greenwood's interval (log-log)."""

    episodes: np.ndarray
    """(k,), from 0"""
    waiting: np.ndarray
    """(k,), share, 1 at first"""
    low: np.ndarray
    """(k,)"""
    high: np.ndarray
    """(k,)"""
    median: Estimate
    """inf when half of them never reached it."""


def survival(times: Times) -> Survival:
    """Time to event with censoring."""
    curve = stats.ecdf(stats.CensoredData.right_censored(times.episodes, ~times.reached)).sf
    with warnings.catch_warnings(), np.errstate(divide='ignore', invalid='ignore'):
        warnings.simplefilter('ignore', RuntimeWarning)  # where the estimate is 0 or 1 there is no interval
        interval = curve.confidence_interval(CONFIDENCE, method='log-log')
    waiting = curve.probabilities
    low = np.minimum(_held(interval.low.probabilities), waiting)
    high = _held(interval.high.probabilities)
    low[waiting == 0.0] = high[waiting == 0.0] = np.nan  # the estimate of its variance is nothing there
    if len(times.episodes) < ENOUGH:
        low, high = np.full((2, len(waiting)), np.nan)
    return Survival(
        np.concatenate([[0.0], curve.quantiles]), np.concatenate([[1.0], waiting]), np.concatenate([[1.0], low]),
        np.concatenate([[1.0], high]), _median(times))


def median_time(times: Times) -> float:
    """When half of them had reached it, by the Kaplan-Meier estimate; inf when half of them never did."""
    return float(_medians(_pairs(times)[None])[0])


def _pairs(times: Times) -> np.ndarray:
    return np.stack([times.episodes, times.reached], axis=-1)


def _median(times: Times) -> Estimate:
    """When half of them had reached it, with its percentile interval by resampling.

    Not from where the band crosses one half: the band ends where all have reached it, so that of runs that took three
    episodes each the interval would have no end.
    """
    values, value = _pairs(times), median_time(times)
    if len(values) < ENOUGH:
        return Estimate(value, np.nan, np.nan)
    drawn = np.random.default_rng(0).integers(len(values), size=(RESAMPLES, len(values)))
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(_medians(values[drawn]), [tail, 1 - tail], method='inverted_cdf')  # some may be infinite
    return Estimate(value, *_with_width(float(low), float(high)))


def _medians(samples: np.ndarray) -> np.ndarray:
    """When, in each sample of times, (m, n, 2), the Kaplan-Meier estimate falls to one half, (m,); inf where never."""
    episodes, reached = samples[..., 0], samples[..., 1] == 1.0
    medians, waiting = np.full(len(samples), np.inf), np.ones(len(samples))
    for when in np.unique(episodes[reached]):
        ends, at_risk = (reached & (episodes == when)).sum(axis=-1), (episodes >= when).sum(axis=-1)
        waiting *= 1.0 - ends / np.maximum(at_risk, 1)
        medians = np.where((waiting <= 0.5 + TINY) & np.isinf(medians), when, medians)
    return medians


def _with_width(low: float, high: float) -> tuple[float, float]:
    """An interval; nan when it has no width, with which it would look certain."""
    return (low, high) if low < high else (np.nan, np.nan)


def _held(band: np.ndarray) -> np.ndarray:
    """A band without its gaps: what is not a number repeats the value before it, 1 at first."""
    known = np.concatenate([[1.0], band])
    last = np.maximum.accumulate(np.where(np.isfinite(known), np.arange(len(known)), 0))
    return known[last][1:]
