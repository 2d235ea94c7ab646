"""Other commands of the program as functions: new cases, drawings, FMUs, reports, stereonets, samples, sweeps."""

import html
import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self, cast

from . import _html
from ._case import Case
from ._errors import CaseFileError, Status, invalid, warn
from ._options import number, real, whole, word, words
from ._options import path as path_of
from ._program import CaseLike, case_file, printed, record
from ._records import EnsembleRecord, SweepRecord
from ._results import Directory
from ._table import Table
from ._tasks import search_options

KINDS = ("slope", "topple", "pit", "coupled")


def new(kind: str, path: str | os.PathLike[str] | None = None) -> Case:
    """A commented case to begin with: `slope`, `topple`, `pit` or `coupled`.

    With `path` it is written there too, with the schema beside it; the file must not be there yet. Raises
    CaseFileError.
    """
    kind = word("kind", kind, KINDS)
    if path is not None:
        target = path_of("path", path)
        _absent(target)
        printed(["new", kind, "-o", target])
        return Case.from_file(target)
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / f"{kind}.toml"
        printed(["new", kind, "-o", target])
        return Case.from_string(target.read_text(encoding="utf-8"))


class Imported(NamedTuple):
    """A case that was written for a drawing."""

    path: Path
    """The case file."""
    report: str
    """What was found, and what is left open."""

    def case(self) -> Case:
        """The case; a CaseError says what is still open."""
        return Case.from_file(self.path)


def import_drawing(
    drawing: str | os.PathLike[str], path: str | os.PathLike[str], *, examples: bool = False
) -> Imported:
    """Writes a case for a drawing (ASCII DXF) or a file of GeoJSON, JSON, WKT or CSV, and says what is left open.

    `path` is the case file, which must not be there yet. With `examples` it has example values for rock, joints and
    bolts, each marked as such. Raises CaseFileError.
    """
    source, target = path_of("drawing", drawing), path_of("path", path)
    if not source.is_file():
        raise CaseFileError(f"{source}: there is no such drawing; check the path", Status.FILE_ERROR)
    _absent(target)
    return Imported(target, printed(["import", source, "-o", target, *words({"examples": examples})]).strip())


def fmu(
    case: CaseLike,
    path: str | os.PathLike[str],
    *,
    fmi: int = 3,
    libraries: Mapping[str, str | os.PathLike[str]] | None = None,
) -> Path:
    """Packs a case as a co-simulation FMU that needs no other file; returns its path.

    `fmi` is the version of the standard, 2 or 3. `libraries` are those of other platforms to pack as well, such as
    `{"win64": "enmm.dll"}`. Raises CaseError.
    """
    target = path_of("path", path)
    version = whole("fmi", fmi, 2, 3)
    given = [f"{name}={path_of('libraries', library)}" for name, library in (libraries or {}).items()]
    more = [option for pair in given for option in ("--library", pair)]
    with case_file(case) as source:
        printed(["fmu", source, "-o", target, "--fmi", version, *more])
    return target


class Report(NamedTuple):
    """A report on paper."""

    html: Path
    """The page, which prints on A4."""
    pdf: Path | None
    """The same as PDF; None without a program that makes one."""


def report(
    directory: str | os.PathLike[str], *, pdf: bool = True, converter: str | os.PathLike[str] | None = None
) -> Report:
    """Writes a report of results for paper into their directory, as `enmm report` does.

    `directory` is that of `run`, `fos`, `bound`, `sample` or `sweep`; those in its directories of these names count
    too. `converter` makes the PDF: a browser of the family of Chromium, weasyprint or wkhtmltopdf, by default the first
    that is installed.
    """
    place = path_of("directory", directory)
    program = None if converter is None else path_of("converter", converter)
    printed(["report", place, *words({"no-pdf": not pdf, "converter": program})])
    made = place / "report_a4.pdf"
    return Report(place / "report_a4.html", made if pdf and made.is_file() else None)


class Stereonet(NamedTuple):
    """Joint sets in space, and which failures they allow."""

    picture: Path
    """The picture (SVG)."""
    text: str
    """Face, sets and findings, a line each."""

    def _repr_html_(self) -> str:
        return f"{self.picture.read_text(encoding='utf-8')}<pre>{html.escape(self.text)}</pre>"


def stereonet(
    case: CaseLike,
    path: str | os.PathLike[str],
    *,
    face: tuple[float, float] | None = None,
    sliding_limit: float | None = None,
    toppling_limit: float | None = None,
    equal_angle: bool = False,
) -> Stereonet:
    """Draws the joint sets of a case in space into a picture (SVG), and checks which failures they allow.

    `face` is dip and dip direction of the face (degrees), by default those of the outline. `sliding_limit` is the
    greatest angle (degrees) between the dip directions of a plane that slides and of the face, `toppling_limit` that
    between the strikes of layers that topple and of the face. `equal_angle` draws by equal angles instead of areas.
    """
    target = path_of("path", path)
    dip = None if face is None else "/".join(f"{number('face', angle):g}" for angle in face)
    options: dict[str, Any] = {"face": dip, "sliding-limit": real("sliding_limit", sliding_limit, 0.0, 90.0)}
    options |= {"toppling-limit": real("toppling_limit", toppling_limit, 0.0, 90.0), "equal-angle": equal_angle}
    with case_file(case) as source:
        text = printed(["stereonet", source, "-o", target, *words(options)])
    return Stereonet(target, text.strip())


class Samples(Directory):
    """Samples of a case with random values: what `sample` found, or any directory that `enmm sample` wrote."""

    record: EnsembleRecord
    """`ensemble.json`."""
    table: Table
    """`ensemble.csv`: the samples that have an answer, with their values and outputs."""
    _record = "ensemble.json"

    def _read(self) -> Self:
        self.record = json.loads((self.directory / self._record).read_text(encoding="utf-8"))
        self.table = Table.read_csv(self.directory / "ensemble.csv")
        return self

    @property
    def probability_of_failure(self) -> float:
        """Share of the samples below the limit."""
        return self.record["probability_of_failure"]

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of that probability (Wilson)."""
        low, high = self.record["interval"]
        return low, high

    def _repr_html_(self) -> str:
        low, high = self.interval
        rows = [("samples", str(self.record["samples"])), ("reliability index", f"{self.record['beta']:.3f}")]
        rows += [("probability of failure", f"{self.probability_of_failure:.4g} ({low:.4g} to {high:.4g})")]
        return _html.facts(rows) + _html.picture(self.directory / "ensemble.png", "Histogram of the output")

    def __repr__(self) -> str:
        low, high = self.interval
        p = f"P(f) = {self.probability_of_failure:.4g} ({low:.4g} to {high:.4g})"
        return f"<enmm.Samples: {self.record['samples']} samples, {p}>"


def sample(
    case: CaseLike,
    output: str | os.PathLike[str] | None = None,
    *,
    samples: int | None = None,
    jobs: int | None = None,
    store: str | os.PathLike[str] | None = None,
    low: float | None = None,
    high: float | None = None,
    tolerance: float | None = None,
    least_area: float | None = None,
    retry_failed: bool = False,
    overwrite: bool = False,
    timeout: float | None = None,
) -> Samples:
    """Finds the probability of failure of a case with tables `[[random]]`, as `enmm sample` does.

    `samples` is their number, that of the case without it; `jobs` is how many are worked out at a time. `store` is the
    file that keeps every sample, by default one in `output`. `enmm.ensemble.run` has executors, functions as outputs
    and distributions beside the case. Other arguments are as those of `fos`. Samples without an answer, and factors
    above a bound, are an EnmmWarning.
    """
    options: dict[str, Any] = {"samples": whole("samples", samples, 1, 10**7), "jobs": whole("jobs", jobs, 1, 1024)}
    options |= {"store": None if store is None else path_of("store", store)}
    options |= search_options(low, high, tolerance, least_area)
    options |= {"retry-failed": retry_failed, "force": overwrite}
    found = Samples(None) if output is None else None
    directory = found.directory if found else path_of("output", output or "")
    with case_file(case) as path:
        record(["sample", path, "-o", directory, *words(options)], timeout=timeout)
    found = found._read() if found else Samples(directory)
    _warn(cast(dict[str, Any], found.record), found.record["samples"])
    return found


def _warn(record: dict[str, Any], count: int) -> None:
    """Warns of samples without an answer and of factors above their bound."""
    kinds = {"samples have no answer": "without_answer", "factors are above the bound of limit analysis": "doubtful"}
    lists = [(text, record[name]) for text, name in kinds.items()]
    warn(f"{len(those)} of {count} {text}" for text, those in lists if those)


class Sweep(Directory):
    """Factors, or displacements, over values of keys: what `sweep` found, or any directory that `enmm sweep` wrote."""

    record: SweepRecord
    """`sweep.json`."""
    table: Table
    """`sweep.csv`: the samples that have an answer, with their values and outputs."""
    _record = "sweep.json"

    def _read(self) -> Self:
        self.record = json.loads((self.directory / self._record).read_text(encoding="utf-8"))
        self.table = Table.read_csv(self.directory / "sweep.csv")
        return self

    @property
    def keys(self) -> list[str]:
        """The keys of the case whose values were swept."""
        return [key["key"] for key in self.record["keys"]]

    @property
    def outputs(self) -> list[float | None]:
        """Output of each sample, in the order of `record["samples"]`; None without an answer."""
        name = self.record["output"]
        return [sample.get(name) for sample in self.record["samples"]]

    @property
    def crossings(self) -> list[dict[str, Any]]:
        """Where the output passes the limit; empty where it does not, and of changes one by one."""
        return list(self.record.get("crossings", []))

    @property
    def effects(self) -> list[dict[str, Any]]:
        """Effects of changes one by one, the greatest first; empty of a curve or a contour."""
        return list(self.record.get("effects", []))

    @property
    def crossing(self) -> float | None:
        """The value at which a curve passes the limit; None where it does not, or more than once."""
        found = self.crossings
        value = found[0]["value"] if len(found) == 1 and self.record["kind"] == "curve" else None
        return None if value is None else float(value)

    def _repr_html_(self) -> str:
        rows = [("values of", ", ".join(self.keys)), ("samples", str(len(self.record["samples"])))]
        rows += [("passes the limit at", f"{found['value']:g}") for found in self.crossings if found["value"] is not None]
        return _html.facts(rows) + _html.picture(self.directory / "sweep.png", "Output over the values")

    def __repr__(self) -> str:
        found = [output for output in self.outputs if output is not None]
        return f"<enmm.Sweep of {', '.join(self.keys)}: {min(found):.4g} to {max(found):.4g} in {len(found)} samples>"


def sweep(
    case: CaseLike,
    values: Mapping[str, Iterable[float]],
    output: str | os.PathLike[str] | None = None,
    *,
    of: str = "bound",
    one_by_one: bool = False,
    jobs: int | None = None,
    store: str | os.PathLike[str] | None = None,
    low: float | None = None,
    high: float | None = None,
    tolerance: float | None = None,
    least_area: float | None = None,
    retry_failed: bool = False,
    overwrite: bool = False,
    timeout: float | None = None,
) -> Sweep:
    """Finds the factor of safety of a case over values of its keys, as `enmm sweep` does.

    `values` maps keys to numbers, such as `{"joint_law.fault.friction_deg": range(20, 41)}`: one key makes a curve, two
    make a contour, and `one_by_one` changes each alone. `of` is the command whose result each sample gets: "bound"
    (limit analysis), "fos" (strength reduction) or "run" (largest displacement of the last stage, and whether the slope
    fails). `low`, `high`, `tolerance` and `least_area` are for "fos". Other arguments are as those of `sample`. Samples
    without an answer, and factors above a bound, are an EnmmWarning. Raises CaseError for a value that the case cannot
    have.
    """
    options: dict[str, Any] = {"of": word("of", of, ("bound", "fos", "run")), "one-by-one": one_by_one}
    options |= {"jobs": whole("jobs", jobs, 1, 1024), "store": None if store is None else path_of("store", store)}
    options |= search_options(low, high, tolerance, least_area)
    options |= {"retry-failed": retry_failed, "force": overwrite}
    changes = [f"{key}={','.join(_numbers(key, those))}" for key, those in values.items()]
    if not changes:
        raise invalid("values: is empty, must have at least 1 key; give one with its numbers")
    found = Sweep(None) if output is None else None
    directory = found.directory if found else path_of("output", output or "")
    with case_file(case) as path:
        record(["sweep", path, *changes, "-o", directory, *words(options)], timeout=timeout)
    found = found._read() if found else Sweep(directory)
    _warn(cast(dict[str, Any], found.record), len(found.record["samples"]))
    return found


def _numbers(key: str, values: Iterable[Any]) -> list[str]:
    """Numbers with all of their digits, each once; whole ones as such, since seeds and counts take no others."""
    name = f"values[{key!r}]"
    found = [str(int(value)) if number(name, value).is_integer() else repr(number(name, value)) for value in values]
    twice = next((text for k, text in enumerate(found) if text in found[:k]), None)
    if not found or twice is not None:
        what = "is empty, must have at least 1 number" if not found else f"has {twice} twice; give each number once"
        raise invalid(f"{name}: {what}")
    return found


def _absent(path: Path) -> None:
    if path.exists():
        message = f"{path}: is there already, and no case is replaced; choose another name, or move it away"
        raise CaseFileError(message, Status.FILE_ERROR)
