"""Which samples fail, with few searches.

The bound of each sample is known in milliseconds, and its factor of safety lies beside it by a ratio that hardly changes
within a case. Samples whose bound lies far from the limit are decided by it; how far is far enough follows from the
ratios of those nearest the limit. The others are decided by one trial at the limit. The program does the same.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from ._store import Row

_PILOT = 12
"""Samples whose factor is searched for, to learn how it lies beside the bound."""
_FEWEST = 5
"""Fewest of these that have both."""
_STUDENT = (8.610, 6.869, 5.959, 5.408, 5.041, 4.781, 4.587, 4.437)
"""Student's t for a two-sided probability of 99.9 %, at 4 to 11 degrees of freedom."""
_TOLERANCE = 5e-3
"""Width of the bracket of a search that is given none."""

Find = Callable[[Iterable[int], str, dict[str, Any]], list[Row]]


class Margin(NamedTuple):
    """How the factor of safety lies beside the bound in a case: the logarithm of their ratio."""

    middle: float
    """Its mean."""
    half: float
    """Half the width of the interval that holds another one with 99.9 %, no less than the tolerance of the search."""

    def estimate(self, bound: float) -> float:
        """The factor that a bound suggests."""
        return bound * math.exp(self.middle)

    def decides(self, bound: float, limit: float) -> bool:
        """Whether a bound decides on which side of the limit the factor is."""
        return abs(math.log(self.estimate(bound) / limit)) > self.half


def screened(
    samples: Sequence[int], limit: float, options: dict[str, Any], find: Find, margin: Margin | None
) -> tuple[list[Row], Margin | None]:
    """The rows of some samples, and the margin, which the first ones find, number 0 among them."""
    bounds = find(samples, "level_tops", {})
    rows: dict[int, Row] = {}
    if samples[0] == 0:
        pilot = _nearest(bounds, limit)
        factors = find([samples[i] for i in pilot], "factor_of_safety", options)
        pairs = [pair for i, row in zip(pilot, factors, strict=True) if (pair := _pair(bounds[i], row))]
        margin = _margin(pairs, float(options.get("tolerance") or _TOLERANCE))
        rows |= {i: _by_factor(bounds[i], row) for i, row in zip(pilot, factors, strict=True)}
    for i, row in enumerate(bounds):
        bound = _number(row, "level_tops") or 0.0
        if i not in rows and margin is not None and bound > 0.0 and margin.decides(bound, limit):
            rows[i] = _row(margin.estimate(bound), "bound", bound, "")
    left = [i for i in range(len(bounds)) if i not in rows]
    at_limit = {**options, "low": limit, "high": limit}
    for i, trial in zip(left, find([samples[i] for i in left], "factor_of_safety", at_limit), strict=True):
        rows[i] = _by_trial(bounds[i], trial, margin, limit)
    return [rows[i] for i in range(len(bounds))], margin


def _margin(pairs: list[tuple[float, float]], tolerance: float) -> Margin | None:
    """From pairs of a bound and a factor; none when there are too few."""
    n = len(pairs)
    if n < _FEWEST:
        return None
    ratios = [math.log(factor / bound) for bound, factor in pairs]
    middle = sum(ratios) / n
    deviation = math.sqrt(sum((ratio - middle) * (ratio - middle) for ratio in ratios) / (n - 1))
    return Margin(middle, max(_STUDENT[n - _FEWEST] * deviation * math.sqrt(1.0 + 1.0 / n), tolerance))


def _nearest(bounds: list[Row], limit: float) -> list[int]:
    """Places of the samples whose bounds are nearest the limit, in their order."""
    found = [(abs(math.log(bound / limit)), i) for i, row in enumerate(bounds) if (bound := _found_bound(row))]
    return sorted(i for _, i in sorted(found)[:_PILOT])


def _found_bound(row: Row) -> float | None:
    """A bound that was found, not one that lies beyond the greatest or the least that is looked for."""
    bound = _number(row, "level_tops")
    return bound if bound and bound > 0.0 and row.outputs["status"] == "found" else None


def _pair(bound: Row, factor: Row) -> tuple[float, float] | None:
    """Bound and factor of a sample that has both."""
    pair = _found_bound(bound), _number(factor, "factor_of_safety")
    if pair[0] is None or pair[1] is None or factor.outputs["status"] != "found":
        return None
    return pair[0], pair[1]


def _number(row: Row, name: str) -> float | None:
    return float(row.outputs[name]) if row.status == "done" else None


def _row(estimate: float, decided_by: str, bound: float | None, doubt: str) -> Row:
    outputs = {"factor_estimate": estimate, "decided_by": decided_by, "level_tops": bound, "doubt": doubt}
    return Row("done", outputs, "")


def _by_factor(bound: Row, factor: Row) -> Row:
    """A sample whose factor was searched for."""
    found = _number(factor, "factor_of_safety")
    if found is None:
        return factor
    return _row(found, "factor", _number(bound, "level_tops"), str(factor.outputs["doubt"]))


def _by_trial(bound: Row, trial: Row, margin: Margin | None, limit: float) -> Row:
    """A sample that a trial at the limit decides: its estimate is put at the side of the limit that the trial found."""
    if trial.status != "done":
        return trial
    value = _number(bound, "level_tops")
    estimate = margin.estimate(value) if margin is not None and value is not None else limit
    if trial.outputs["status"] == "stable_throughout":
        estimate = max(estimate, limit)
    else:
        estimate = min(estimate, math.nextafter(limit, -math.inf))
    return _row(estimate, "trial", value, str(trial.outputs["doubt"]))
