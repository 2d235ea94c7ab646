"""What an ensemble says: its table, the probability of failure, quantiles, sensitivities, pictures and a page."""

import base64
import csv
import html
import io
import math
import os
from pathlib import Path
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _html, _plots
from .._case import Case
from .._errors import invalid
from .._table import Table
from ._store import Row
from ._variables import Distribution, Variable

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Interval(NamedTuple):
    """A confidence interval."""

    low: float
    high: float


def wilson(failures: int, n: int, confidence: float = 0.95) -> Interval:
    """Score interval of a probability (E. B. Wilson, J. Am. Stat. Assoc. 22, 1927).

    It holds its confidence on average also for few failures, and is never empty.
    """
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    p, scale = failures / n, 1.0 + z * z / n
    middle = (p + 0.5 * z * z / n) / scale
    half = z / scale * math.sqrt(p * (1.0 - p) / n + 0.25 * z * z / n**2)
    return Interval(0.0 if failures == 0 else middle - half, 1.0 if failures == n else middle + half)


class Ensemble:
    """The samples of `run`, in their order, and what follows from them."""

    def __init__(
        self,
        case: Case,
        variables: dict[str, Variable],
        samples: list[dict[str, Any]],
        rows: list[Row],
        output: str | None,
        limit: float,
        method: str,
        seed: int,
    ) -> None:
        self.case, self.variables, self.limit, self.method, self.seed = case, variables, limit, method, seed
        self.failed = [(k, row.message) for k, row in enumerate(rows) if row.status == "failed"]
        """Samples without an answer, with the reason."""
        good = [k for k, row in enumerate(rows) if row.status == "done"]
        if not good:
            raise invalid(f"none of {len(rows)} samples has an answer; the first: {self.failed[0][1]}")
        names = list(rows[good[0]].outputs)
        self.output = output or names[0]
        """Name of the output that decides whether a sample fails: the first one, of a function."""
        columns: dict[str, Any] = {"sample": good}
        columns |= {key: [samples[k][key] for k in good] for key in variables}
        self.table = Table(columns | {name: [rows[k].outputs[name] for k in good] for name in names})
        """A row for each sample that has an answer: its number, the values of the keys, the outputs."""
        self.values: npt.NDArray[np.float64] = np.asarray(self.table[self.output], dtype=float)
        """The output that decides."""

    @property
    def doubtful(self) -> list[tuple[int, str]]:
        """Samples whose factor of safety is above the bound of limit analysis, with the warning of the program."""
        texts: list[str] = self.table["doubt"].tolist() if "doubt" in self.table else []
        return [(int(self.table["sample"][i]), text) for i, text in enumerate(texts) if text]

    @property
    def failures(self) -> int:
        """Number of samples below the limit."""
        return int(np.count_nonzero(self.values < self.limit))

    @property
    def probability_of_failure(self) -> float:
        """Share of the samples below the limit."""
        return self.failures / len(self.values)

    def interval(self, confidence: float = 0.95) -> Interval:
        """Confidence interval of the probability of failure by Wilson's formula; see `wilson`.

        It is that of independent samples. For a Latin hypercube, which scatters less, it is on the wide side.
        """
        if not 0 < confidence < 1:
            raise invalid(f"confidence: is {confidence}, must be within 0 and 1, such as 0.95")
        return wilson(self.failures, len(self.values), confidence)

    @property
    def beta(self) -> float:
        """Reliability index: minus the normal quantile of the probability of failure; infinite when nothing fails."""
        return _beta(self.probability_of_failure)

    def beta_interval(self, confidence: float = 0.95) -> Interval:
        """Confidence interval of the reliability index, from that of the probability."""
        low, high = self.interval(confidence)
        return Interval(_beta(high), _beta(low))

    def quantile(self, p: float) -> float:
        """The output below which the share `p` of the samples is."""
        return float(np.quantile(self.values, p))

    def sensitivity(self, method: str = "spearman") -> dict[str, float]:
        """How much the output follows each variable, by key.

        "spearman" is the rank correlation, within -1 and 1. "pawn" is the median of the index PAWN by the library
        SALib, from 0 to 1, which also sees influences that neither rise nor fall throughout. Seeds are left out: their
        numbers have no order.
        """
        keys = [key for key, variable in self.variables.items() if isinstance(variable, Distribution)]
        given = np.array([self.table[key] for key in keys], dtype=float).reshape(len(keys), -1)
        if method == "spearman":
            ranks = _ranks(self.values)
            return {key: float(np.corrcoef(_ranks(x), ranks)[0, 1]) for key, x in zip(keys, given, strict=True)}
        if method != "pawn":
            raise invalid(f"method: is {method!r}, must be one of spearman, pawn")
        import SALib.analyze.pawn

        pawn: Any = SALib.analyze.pawn
        bounds = [[float(x.min()), float(x.max())] for x in given]
        problem = {"num_vars": len(keys), "names": keys, "bounds": bounds}
        answer = pawn.analyze(problem, given.T, self.values, seed=self.seed)
        return dict(zip(keys, map(float, answer["median"]), strict=True))

    def to_pandas(self) -> Any:
        """The table as a data frame of pandas."""
        return self.table.to_pandas()

    def write_csv(self, path: str | os.PathLike[str]) -> None:
        """Writes the table as CSV; numbers read back to the same bits."""
        Path(path).write_text(self._csv(), encoding="utf-8")

    def _csv(self) -> str:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.table)
        writer.writerows(zip(*(column.tolist() for column in self.table.values()), strict=True))
        return text.getvalue()

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draws the histogram of the output and its limit by matplotlib; returns the axes."""
        ax = _plots.axes(ax)
        ax.hist(self.values, bins="auto", color="tab:blue", alpha=0.7)
        low, high = self.interval()
        p = self.probability_of_failure
        label = f"limit {self.limit:g}: P(f) = {p:.4g}, 95 % within {low:.4g} and {high:.4g}"
        ax.axvline(self.limit, color="crimson", label=label)
        ax.set(xlabel=self.output, ylabel="samples")
        ax.legend()
        return ax

    def scatter(self, figure: Any = None) -> Any:
        """Draws the output over every variable by matplotlib; returns the figure."""
        keys = [key for key, variable in self.variables.items() if isinstance(variable, Distribution)]
        if figure is None:
            figure = _plots.new_figure((4.5 * max(len(keys), 1), 4))
        bad = self.values < self.limit
        drawn: Any = np.atleast_1d(figure.subplots(1, max(len(keys), 1), sharey=True))
        for key, ax in zip(keys, drawn, strict=False):
            ax.plot(
                self.table[key][~bad], self.values[~bad], "o", ms=3, color="tab:blue", label="at or above the limit"
            )
            ax.plot(self.table[key][bad], self.values[bad], "x", ms=4, color="crimson", label="below the limit")
            ax.axhline(self.limit, color="0.5", lw=0.8)
            ax.set(xlabel=key, ylabel=self.output)
            ax.legend()
        return figure

    def report(self, path: str | os.PathLike[str]) -> Path:
        """Writes a page with results, pictures and the table, which opens offline in any browser; needs matplotlib."""
        from matplotlib.figure import Figure

        shapes = Figure(figsize=(8, 5), layout="constrained")
        self.plot(shapes.subplots())
        width = 4.5 * max(len(self.variables), 1)
        pictures = [shapes, self.scatter(Figure(figsize=(width, 4), layout="constrained"))]
        rows = [(name, html.escape(text)) for name, text in self._facts()]
        cells = "".join(f"<tr><th>{name}</th><td>{text}</td></tr>" for name, text in rows)
        shown = "".join(f'<p><img alt="" src="data:image/png;base64,{_png(picture)}"></p>' for picture in pictures)
        title = html.escape(self.case.title or "Ensemble")
        page = _PAGE.format(title=title, facts=cells, pictures=shown, table=html.escape(self._csv()))
        Path(path).write_text(page, encoding="utf-8")
        return Path(path)

    def _facts(self) -> list[tuple[str, str]]:
        low, high = self.interval()
        beta_low, beta_high = self.beta_interval()
        quantiles = ", ".join(f"{self.quantile(p):.4g}" for p in (0.05, 0.5, 0.95))
        facts = [
            ("samples", f"{len(self.values)} by {self.method.replace('_', ' ')}, seed {self.seed}"),
            ("without an answer", str(len(self.failed))),
            ("below the limit", f"{self.failures} below {self.limit:g}"),
            ("probability of failure", f"{self.probability_of_failure:.4g}, 95 % (Wilson): {low:.4g} to {high:.4g}"),
            ("reliability index", f"{self.beta:.3f}, 95 %: {beta_low:.3f} to {beta_high:.3f}"),
            (self.output, f"mean {self.values.mean():.4g}, 5, 50, 95 %: {quantiles}"),
        ]
        facts += [(f"variable {key}", str(variable)) for key, variable in self.variables.items()]
        found = self.sensitivity() if len(self.values) > 2 else {}
        return facts + [(f"rank correlation {key}", f"{value:.3f}") for key, value in found.items()]

    def __len__(self) -> int:
        return len(self.values)

    def _repr_html_(self) -> str:
        page = _html.facts(self._facts())
        try:
            from matplotlib.figure import Figure
        except ImportError:
            return page
        shapes = Figure(figsize=(8, 5), layout="constrained")
        self.plot(shapes.subplots())
        return page + _html.png(base64.b64decode(_png(shapes)), f"Histogram of {self.output}")

    def __repr__(self) -> str:
        low, high = self.interval()
        p = f"P(f) = {self.probability_of_failure:.4g} ({low:.4g} to {high:.4g})"
        return f"<enmm.ensemble.Ensemble: {len(self.values)} samples of {self.output}, {p}, beta = {self.beta:.3f}>"


def _beta(p: float) -> float:
    if p <= 0 or p >= 1:
        return math.inf if p <= 0 else -math.inf
    return -NormalDist().inv_cdf(p)


def _ranks(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Ranks, equal ones at their mean."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(count)
    return (ends - 0.5 * (count - 1))[place]


def _png(figure: Any) -> str:
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=110)
    return base64.b64encode(data.getvalue()).decode()


_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<style>body {{ font-family: sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; }}
th {{ text-align: left; padding-right: 2em; font-weight: normal; }} img {{ max-width: 100%; }}
pre {{ overflow-x: auto; background: #f4f4f4; padding: 1em; }}</style></head>
<body><h1>{title}</h1><table>{facts}</table>{pictures}
<details><summary>Table (CSV)</summary><pre>{table}</pre></details></body></html>
"""
