"""Uncertain values: distributions, what they are of, and seeds."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from statistics import NormalDist
from typing import Any, ClassVar

from .._case import Case
from .._errors import invalid
from .._program import CaseLike

_STANDARD = NormalDist()
OF = ("value", "tangent", "log10")
"""What a distribution can be of: the value of the key, the tangent of its angle in degrees, its decimal logarithm."""


def transformed(x: float, of: str) -> float:
    """The value of a key from a number that is its value, its tangent or its decimal logarithm."""
    if of == "tangent":
        return math.degrees(math.atan(x))
    return 10.0**x if of == "log10" else x


@dataclass(frozen=True, kw_only=True)
class Distribution:
    """A continuous distribution, cut off at `low` and `high` where they are given.

    `of = "tangent"` says that the distribution is of the tangent of an angle that the case has in degrees, as strength
    is: `Normal(0.7, 0.1, of="tangent")` for `friction_deg`. `of = "log10"` says that it is of the decimal logarithm.
    `low` and `high` are bounds of what the distribution is of.
    """

    low: float | None = None
    high: float | None = None
    of: str = "value"
    name: ClassVar[str] = ""

    def __post_init__(self) -> None:
        if self.of not in OF:
            raise invalid(f"{self.name}: of is {self.of!r}, must be one of {', '.join(OF)}")
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, int | float) and not math.isfinite(value):
                raise invalid(f"{self.name}: {field.name} is {value}, must be finite; leave a bound out")
        self._check()
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise invalid(f"{self.name}: low is {self.low}, must be below high, {self.high}; swap them")
        start, end = self._range()
        if not end - start > 1e-12:
            raise invalid(f"{self.name}: hardly any value lies between low and high; widen the bounds")

    def _check(self) -> None:
        """Refuses parameters that make no distribution."""

    def _need(self, good: bool, what: str) -> None:
        if not good:
            raise invalid(f"{self.name}: {what}")

    def cdf(self, x: float) -> float:
        """Probability of a value below `x`, before it is cut off."""
        raise NotImplementedError

    def ppf(self, p: float) -> float:
        """The value below which the probability is `p`, before it is cut off."""
        raise NotImplementedError

    def _range(self) -> tuple[float, float]:
        start = 0.0 if self.low is None else self.cdf(self.low)
        return start, 1.0 if self.high is None else self.cdf(self.high)

    def value(self, p: float) -> float:
        """The value of the key below which the probability is `p`, within 0 and 1."""
        start, end = self._range()
        x = self.ppf(start + p * (end - start))
        x = x if self.low is None else max(x, self.low)  # Rounding alone may lead out of the bounds.
        x = x if self.high is None else min(x, self.high)
        return transformed(x, self.of)

    def to_dict(self) -> dict[str, Any]:
        """The row of a table `[[random]]` without its key."""
        there = {field.name: getattr(self, field.name) for field in fields(self)}
        default = {"of": "value"}
        kept = {name: value for name, value in there.items() if value is not None and value != default.get(name)}
        return {"distribution": self.name, **kept}


@dataclass(frozen=True)
class Normal(Distribution):
    """Normal distribution by mean and standard deviation."""

    mean: float
    sd: float
    name: ClassVar[str] = "normal"

    def _check(self) -> None:
        self._need(self.sd > 0, f"sd is {self.sd}, must be above 0; write a fixed value into the case")

    def cdf(self, x: float) -> float:
        return _STANDARD.cdf((x - self.mean) / self.sd)

    def ppf(self, p: float) -> float:
        return self.mean + self.sd * _STANDARD.inv_cdf(p)


@dataclass(frozen=True)
class LogNormal(Distribution):
    """Lognormal distribution by its own mean and standard deviation, not those of the logarithm."""

    mean: float
    sd: float
    name: ClassVar[str] = "lognormal"

    def _check(self) -> None:
        self._need(self.mean > 0, f"mean is {self.mean}, must be above 0")
        self._need(self.sd > 0, f"sd is {self.sd}, must be above 0; write a fixed value into the case")

    def _log(self) -> tuple[float, float]:
        ratio = self.sd / self.mean
        sd = math.sqrt(math.log1p(ratio * ratio))
        return math.log(self.mean) - 0.5 * (sd * sd), sd

    def cdf(self, x: float) -> float:
        mean, sd = self._log()
        return 0.0 if x <= 0 else _STANDARD.cdf((math.log(x) - mean) / sd)

    def ppf(self, p: float) -> float:
        mean, sd = self._log()
        return math.exp(mean + sd * _STANDARD.inv_cdf(p))


@dataclass(frozen=True)
class Uniform(Distribution):
    """Uniform distribution between `least` and `most`."""

    least: float
    most: float
    name: ClassVar[str] = "uniform"

    def _check(self) -> None:
        self._need(self.least < self.most, f"least is {self.least}, must be below most, {self.most}; swap them")

    def cdf(self, x: float) -> float:
        return min(max((x - self.least) / (self.most - self.least), 0.0), 1.0)

    def ppf(self, p: float) -> float:
        return self.least + p * (self.most - self.least)


@dataclass(frozen=True)
class Triangular(Distribution):
    """Triangular distribution from `least` over its peak at `mode` to `most`."""

    least: float
    mode: float
    most: float
    name: ClassVar[str] = "triangular"

    def _check(self) -> None:
        good = self.least <= self.mode <= self.most and self.least < self.most
        self._need(good, f"least, mode, most are {self.least}, {self.mode}, {self.most}, must ascend")

    def cdf(self, x: float) -> float:
        a, c, b = self.least, self.mode, self.most
        if x <= a or x >= b:
            return 0.0 if x <= a else 1.0
        if x < c:
            return (x - a) * (x - a) / ((b - a) * (c - a))
        return 1.0 - (b - x) * (b - x) / ((b - a) * (b - c))

    def ppf(self, p: float) -> float:
        a, c, b = self.least, self.mode, self.most
        if p * (b - a) < c - a:
            return a + math.sqrt(p * (b - a) * (c - a))
        return b - math.sqrt((1.0 - p) * (b - a) * (b - c))


@dataclass(frozen=True)
class Exponential(Distribution):
    """Exponential distribution by its mean, as spacings and trace lengths are often given."""

    mean: float
    name: ClassVar[str] = "exponential"

    def _check(self) -> None:
        self._need(self.mean > 0, f"mean is {self.mean}, must be above 0")

    def cdf(self, x: float) -> float:
        return -math.expm1(-max(x, 0.0) / self.mean)

    def ppf(self, p: float) -> float:
        return -self.mean * math.log1p(-p)


@dataclass(frozen=True)
class Seeds:
    """Another seed for every sample, such as that of a joint set: `first`, `first + 1`, ..."""

    first: int = 1
    name: ClassVar[str] = "seeds"

    def __post_init__(self) -> None:
        if not 0 <= self.first < 2**62:
            raise invalid(f"seeds: first is {self.first}, must be from 0 to 2^62 - 1")

    def to_dict(self) -> dict[str, Any]:
        """The row of a table `[[random]]` without its key."""
        return {"distribution": self.name, "first": self.first}


Variable = Distribution | Seeds
_KINDS: dict[str, type[Any]] = {
    kind.name: kind for kind in (Normal, LogNormal, Uniform, Triangular, Exponential, Seeds)
}


def from_tables(rows: Sequence[Mapping[str, Any]]) -> dict[str, Variable]:
    """The variables of tables `[[random]]`: `key`, `distribution`, and the parameters of the distribution by name.

    `[{"key": "joint_law.plane.friction_deg", "distribution": "normal", "mean": 0.7, "sd": 0.1, "of": "tangent"}]`
    """
    variables: dict[str, Variable] = {}
    for k, row in enumerate(rows):
        given = dict(row)
        key, name = given.pop("key", None), given.pop("distribution", None)
        if not isinstance(key, str) or key in variables:
            raise invalid(f"random[{k}].key: is {key!r}, must be a key of the case that no other row has")
        if name not in _KINDS:
            raise invalid(f"random[{k}].distribution: is {name!r}, must be one of {', '.join(_KINDS)}")
        known = [field.name for field in fields(_KINDS[name])]
        wrong = [name for name in given if name not in known]
        if wrong:
            raise invalid(f"random[{k}].{wrong[0]}: unknown key; a {name} distribution has {', '.join(known)}")
        try:
            variables[key] = _KINDS[name](**given)
        except TypeError as error:
            raise invalid(f"random[{k}]: {error}; a {name} distribution has {', '.join(known)}") from error
    return variables


def from_case(case: CaseLike) -> dict[str, Any]:
    """The arguments of `run` that the tables `[[random]]`, `[[random_correlation]]` and `[ensemble]` of a case give.

    `run(case, **from_case(case))` is the ensemble of `enmm sample`, to the bit.
    """
    table = Case.of(case).to_dict()
    ensemble = table.get("ensemble", {})
    return {
        "variables": from_tables(table.get("random", [])),
        "n": ensemble.get("samples", 100),
        "output": ensemble.get("output", "factor_of_safety"),
        "method": ensemble.get("sampling", "monte_carlo"),
        "seed": ensemble.get("seed", 1),
        "limit": ensemble.get("limit", 1.0),
        "interval": ensemble.get("interval"),
        "correlations": {tuple(row["keys"]): row["value"] for row in table.get("random_correlation", [])},
    }
