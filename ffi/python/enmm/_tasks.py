"""What the program does with a case, as functions: `run`, `fos`, `bound` and `check`."""

import html
import json
import os
import tempfile
import weakref
import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

from . import _html, _plots
from ._closing import Closing
from ._errors import EnmmError, Status, invalid
from ._frames import Frames
from ._program import FAILED, INTERRUPTED, SLOPE_FAILED, CaseLike, call, case_file, failure, message_of, record
from ._progress import Bar, in_notebook
from ._table import Table


class RunError(EnmmError):
    """A run that ended early, or whose end is in doubt. `result` has all that it wrote, with a checkpoint."""

    result: "Result"

    def __init__(self, message: str, status: int, result: "Result") -> None:
        super().__init__(message, status)
        self.result = result


class _Directory(Closing):
    """A directory with results; a temporary one is removed by `close`, at the end of a `with`, or with the object."""

    directory: Path
    """Where the files are."""

    def __init__(self, directory: str | os.PathLike[str] | None) -> None:
        if directory is None:
            temporary = tempfile.TemporaryDirectory(prefix="enmm-", ignore_cleanup_errors=True)
            self.directory, self._close = Path(temporary.name), weakref.finalize(self, temporary.cleanup)
        else:
            self.directory, self._close = Path(directory), weakref.finalize(self, lambda: None)

    @property
    def pictures(self) -> list[Path]:
        """The pictures that the program drew."""
        return sorted(self.directory.glob("*.png"))

    @property
    def report(self) -> Path | None:
        """`report.html`, which opens in a browser; None when this version of the program writes none."""
        path = self.directory / "report.html"
        return path if path.is_file() else None

    def show(self, height: int = 640) -> None:
        """Shows the page of results: in a frame of a notebook, else in a browser. `height` is that of the frame (px)."""
        if self.report is None:
            raise invalid(f"{self.directory}: holds no report.html to show; let `fos` draw its pictures")
        if in_notebook():
            from IPython.display import HTML, display

            display(HTML(_html.frame(self.report, height)))
        else:
            webbrowser.open(self.report.absolute().as_uri())

    def close(self) -> None:
        """Removes the directory if it is a temporary one. What has been read stays."""
        self._close()


class Result(_Directory):
    """Results of `run`, or of any directory that `enmm run` wrote: `Result("fractured_slope")`."""

    summary: dict[str, Any]
    """`summary.json`: counts, stages, steps, energies, penetration, wall times, version, hash of the case."""
    history: Table
    """`history.csv`: time, monitored quantities and energies."""
    blocks: Table
    """`blocks.csv`: the blocks at the end."""
    frames: Frames
    """Elements at every time that the case asks for; empty with `output.frames = false`."""

    def __init__(self, directory: str | os.PathLike[str] | None) -> None:
        super().__init__(directory)
        if directory is not None:
            self._read()

    def _read(self) -> Self:
        self.summary = json.loads((self.directory / "summary.json").read_text(encoding="utf-8"))
        self.history = Table.read_csv(self.directory / "history.csv")
        self.blocks = Table.read_csv(self.directory / "blocks.csv")
        self.frames = Frames(self.directory / "run.pvd")
        return self

    @property
    def failed(self) -> bool:
        """Whether the slope has failed in any stage."""
        return bool(self.summary["failed"])

    @property
    def verdict(self) -> str:
        """Whether the slope has failed, and how, in one line: stage, mechanism, blocks, largest displacement, place."""
        return str(self.summary["verdict"])

    @property
    def checkpoint(self) -> Path:
        """The state at the end, from which `run(case, resume=...)` continues."""
        return self.directory / "checkpoint.enmm"

    def plot(self, field: str = "displacement", frame: int = -1, ax: Any = None) -> Any:
        """Draws the elements of a frame, coloured by a field, by matplotlib; returns the axes.

        `field` is one of `Frame.cell_data` or `Frame.point_data`; of a vector its length.
        """
        return _plots.frame(self.frames[frame], field, ax)

    def plot_history(self, *names: str, ax: Any = None) -> Any:
        """Draws columns of the history over time, without names all displacements; returns the axes of matplotlib."""
        return _plots.history(self.history, names, ax)

    def animate(self, path: str | os.PathLike[str] | None = None, field: str = "displacement", fps: int = 10) -> Any:
        """Animates the frames, coloured by a field; writes `path` (.gif, or .mp4 where ffmpeg is there) when given.

        Returns the animation of matplotlib; in a notebook show its `to_jshtml()`.
        """
        return _plots.animation(self.frames, field, fps, path)

    def _repr_html_(self) -> str:
        if not hasattr(self, "summary"):
            return f"<p>{html.escape(repr(self))}</p>"
        ends = {True: "at rest", False: "not at rest", None: ""}
        stages = [
            (
                f"stage {stage['name']}",
                f"{stage['time']:.4g} s, {stage['steps']} steps {ends[stage['converged']]}".strip(),
            )
            for stage in self.summary["stages"]
        ]
        verdict = [("verdict", self.verdict)] if "verdict" in self.summary else []
        rows = [*verdict, ("status", self.summary["status"]), ("blocks", str(self.blocks.rows)), *stages]
        rows += [("warning", text) for text in self.summary.get("warnings", [])]
        return _html.facts(rows) + _html.picture(self.directory / "deformed.png", "The slope at the end of the run")

    def __repr__(self) -> str:
        if not hasattr(self, "summary"):
            return f"<enmm.Result {str(self.directory)!r}, not written yet>"
        what = f"{self.summary['status']}, t = {self.summary['time']:g} s, {self.blocks.rows} blocks"
        return f"<enmm.Result {str(self.directory)!r}: {what}, {len(self.frames)} frames>"


class Fos(_Directory):
    """A factor of safety: what `fos` found, or any directory that `enmm fos` wrote: `Fos("plane_slide/fos")`."""

    record: dict[str, Any]
    """`fos.json`."""

    def __init__(self, directory: str | os.PathLike[str] | None) -> None:
        super().__init__(directory)
        if directory is not None:
            self.record = json.loads((self.directory / "fos.json").read_text(encoding="utf-8"))

    @property
    def factor(self) -> float | None:
        """The factor of safety; None when the search ended without one, see `status`."""
        factor = self.record["factor_of_safety"]
        return None if factor is None else float(factor)

    @property
    def status(self) -> str:
        """`found`, `stable_throughout` (then `at_least` holds), `unstable_throughout` or `failed`."""
        return str(self.record["status"])

    @property
    def at_least(self) -> float | None:
        """The greatest factor at which the slope is stable, when it is at all that were tried."""
        least = self.record["at_least"]
        return None if least is None else float(least)

    @property
    def bracket(self) -> tuple[float | None, float | None]:
        """Greatest factor that is stable and least that is not."""
        return self.record["bracket"]["stable"], self.record["bracket"]["unstable"]

    @property
    def trials(self) -> Table:
        """The trials, in the order of the factor."""
        return Table.of_rows(self.record["trials"])

    @property
    def failing(self) -> dict[str, Any] | None:
        """Blocks, area (m2), mass (kg/m) and share of the free rock that fail; None when nothing does."""
        found: dict[str, Any] | None = self.record["failing"]
        return found

    @property
    def failing_blocks(self) -> Table:
        """The blocks that fail: id, x, y (m), area (m2), mass (kg/m), displacement (m), rotation, speed (m/s)."""
        rows = [{**row, "x": row["place"][0], "y": row["place"][1]} for row in self.record["failing_blocks"]]
        return Table.of_rows([{name: value for name, value in row.items() if name != "place"} for row in rows])

    @property
    def mechanisms(self) -> list[dict[str, Any]]:
        """One record for each mechanism that was sought; those that are too small do not count."""
        return list(self.record["mechanisms"])

    @property
    def bound(self) -> dict[str, Any]:
        """Limit analysis of the same slope, as `bound` returns it, or `{"refused": why}`."""
        return dict(self.record["bound"])

    @property
    def warnings(self) -> list[str]:
        """What the user should know of the case and the search."""
        return list(self.record["warnings"])

    @property
    def doubt(self) -> str | None:
        """Why the factor is in doubt: it is above the bound of limit analysis. None when it is not."""
        doubt: str | None = self.record.get("doubt")
        return doubt

    def plot(self, ax: Any = None) -> Any:
        """Draws displacement over the factor of every trial by matplotlib; returns the axes."""
        return _plots.trials(self, ax)

    def _repr_html_(self) -> str:
        low, high = self.bracket
        named = [("stable at", low), ("not stable at", high), ("at least", self.at_least)]
        rows = [("factor of safety", "none" if self.factor is None else f"{self.factor:.4f}"), ("status", self.status)]
        rows += [(name, f"{value:.4f}") for name, value in named if value is not None]
        rows += [("limit analysis", _of_bound(self.bound))]
        if self.failing:
            rows += [
                ("failing area", f"{self.failing['area']:.3g} m², {100 * self.failing['share']:.3g} % of the free rock")
            ]
        rows += [("warning", text) for text in self.warnings]
        return _html.facts(rows) + _html.picture(self.directory / "failure.png", "The rock that fails")

    def __float__(self) -> float:
        if self.factor is None:
            raise ValueError(f"the search ended {self.status}: there is no factor; {self.record['remedy']}")
        return self.factor

    def __repr__(self) -> str:
        if self.factor is None:
            return f"<enmm.Fos: {self.status}{'' if self.at_least is None else f', at least {self.at_least:.4f}'}>"
        low, high = self.bracket
        return f"<enmm.Fos {self.factor:.4f}: stable at {low:.4f}, not at {high:.4f}>"


def _of_bound(bound: dict[str, Any]) -> str:
    """The factor of limit analysis, or the reason why there is none."""
    if "refused" in bound:
        return f"none: {bound['refused']}"
    return " to ".join(_html.words(bound[name]) for name in ("level_tops", "lower", "upper") if name in bound)


def run(
    case: CaseLike,
    output: str | os.PathLike[str] | None = None,
    *,
    threads: int | None = None,
    resume: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
) -> Result:
    """Runs all stages of a case and returns what `enmm run` writes.

    `output` is the directory of the results; without it they go to a temporary one, which `Result.close` removes.
    `threads` is how many are used, all without it; results do not depend on it. `resume` is a checkpoint to continue
    from. `progress` shows how far the run is: by default in notebooks alone.

    Raises CaseError with file, line and key; RunError, with the results so far, when a run fails numerically or does
    not come to a sound end. A slope that fails raises nothing: see `Result.failed` and `Result.verdict`.
    """
    result = Result(None) if output is None else None
    directory = result.directory if result else Path(output or "")
    words: list[object] = ["-o", directory]
    words += [] if threads is None else ["--threads", threads]
    words += [] if resume is None else ["--resume", resume]
    show = bool(progress) and not in_notebook()
    with case_file(case) as path, Bar(None if progress is None else progress and in_notebook()) as bar:

        def hear(line: str) -> bool:
            bar.say(line, at_once=True)
            return "  simulated " in line or line.startswith("building the model")

        words += [] if show or bar.shown else ["--quiet"]
        status, _, error = call(["run", path, "--force", *words], show=show, hear=hear if bar.shown else None)
    if status in (0, SLOPE_FAILED):
        return result._read() if result else Result(directory)
    message = message_of(status, error) if error or not show else "the run failed; see the message above"
    if status not in (FAILED, INTERRUPTED) or not (directory / "summary.json").is_file():
        raise failure(status, message)
    if status == INTERRUPTED:
        raise KeyboardInterrupt(message)
    raise RunError(message, Status.NUMERICAL_FAILURE, result._read() if result else Result(directory))


def fos(
    case: CaseLike,
    output: str | os.PathLike[str] | None = None,
    *,
    low: float | None = None,
    high: float | None = None,
    tolerance: float | None = None,
    least_area: float | None = None,
    stage: str | None = None,
    mechanisms: int | None = None,
    threads: int | None = None,
    pictures: bool = True,
    progress: bool | Callable[[str], object] | None = None,
) -> Fos:
    """Finds the factor of safety of a case by strength reduction, as `enmm fos` does.

    `low` and `high` bound the factors that are tried, and the search begins with them. `tolerance` is the width of the
    final bracket relative to the factor (0.005 without it). Mechanisms of less rock than `least_area` (m2; 1.5 %
    of the free rock without it) do not count. `stage` is the static stage after which the slope is looked at.
    `mechanisms` is how many are sought, each without the blocks of those before. Without `pictures` neither pictures
    nor a page are drawn. `progress` shows the trials, by default in notebooks alone; a function is called with a line
    for each instead. A search that ends without a factor is no error: see `Fos.status`. `output` and `threads` are
    as those of `run`.

    Raises CaseError with file, line and key; StepError when the slope does not come to rest before the search.
    """
    found = Fos(None) if output is None else None
    directory = found.directory if found else Path(output or "")
    options = {"low": low, "high": high, "tolerance": tolerance, "least-area": least_area, "stage": stage}
    options |= {"mechanisms": mechanisms, "threads": threads}
    words = [word for name, value in options.items() if value is not None for word in (f"--{name}", value)]
    words += [] if pictures else ["--no-pictures"]
    with case_file(case) as path, Bar(False if callable(progress) else progress) as bar:
        bar.say("the slope comes to rest before the first trial")

        def hear(line: str) -> bool:
            trial = _trial(line)
            if trial is not None and callable(progress):
                progress(trial["trial"])
            elif trial is not None:
                bar.say(trial["trial"], trial["done"] / max(trial["expected"], 1), at_once=True)
            return trial is not None

        listens = bar.shown or callable(progress)
        words += ["--trials"] if listens else []
        written = record(["fos", path, "--force", "-o", directory, *words], hear if listens else None)
    if found is None:
        return Fos(directory)
    found.record = written
    return found


def _trial(line: str) -> dict[str, Any] | None:
    """A trial that the program prints in one line before its result, which has several."""
    if not line.startswith('{"'):
        return None
    found = json.loads(line)
    return found if "done" in found and "trial" in found else None


def bound(case: CaseLike, output: str | os.PathLike[str] | None = None, *, stage: str | None = None) -> dict[str, Any]:
    """Bounds of the factor of safety by limit analysis, the object of `enmm bound --json`.

    `associated`, `level_tops` and `catching` of rigid blocks, and `lower` and `upper` of rock that yields, have
    `factor` and `end` each, and all but `lower` a `mechanism`. `stage` is the static stage after which the slope is
    looked at. `output` is a directory for `report.html`, which shows the mechanism; without it no page is left. Raises
    CaseError for a case that limit analysis cannot treat.
    """
    words = [] if stage is None else ["--stage", stage]
    with case_file(case) as path, tempfile.TemporaryDirectory() as page:
        return record(["bound", path, "--force", "-o", page if output is None else output, *words])


def check(case: CaseLike) -> dict[str, Any]:
    """Builds the model of a case only: the object of `enmm check --json`.

    It has counts, areas (m2), masses (kg/m), the critical step (s), memory (bytes) and warnings. Raises CaseError.
    """
    with case_file(case) as path:
        return record(["check", path])
