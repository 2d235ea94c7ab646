"""Other commands of the program as functions: new cases, drawings, FMUs, reports, stereonets, samples."""

import html
import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self, cast

from . import _html
from ._case import Case
from ._errors import CaseFileError, Status, warn
from ._options import number, real, whole, word, words
from ._options import path as path_of
from ._program import CaseLike, case_file, printed, record
from ._records import EnsembleRecord
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

    `directory` is that of `run`, `fos`, `bound` or `sample`; those in its directories `fos`, `bound` and `sample` count
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
    of = found.record["samples"]
    kinds = {"samples have no answer": "without_answer", "factors are above the bound of limit analysis": "doubtful"}
    lists = [(text, cast(dict[str, Any], found.record)[name]) for text, name in kinds.items()]
    warn(f"{len(those)} of {of} {text}" for text, those in lists if those)
    return found


def _absent(path: Path) -> None:
    if path.exists():
        message = f"{path}: is there already, and no case is replaced; choose another name, or move it away"
        raise CaseFileError(message, Status.FILE_ERROR)
