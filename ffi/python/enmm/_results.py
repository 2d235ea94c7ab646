"""Results of the program, as objects: `Result` of a run, `Fos` of a factor of safety."""

import html
import json
import os
import weakref
import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from . import _html, _places, _plots
from ._closing import Closing
from ._errors import EnmmError, invalid
from ._frames import Frames
from ._options import number
from ._options import path as path_of
from ._program import in_python
from ._progress import in_notebook
from ._table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _keep(folder: Path) -> None:
    """What the end of results does to a directory that is not temporary."""


_GONE = (
    "the results are closed, and their temporary directory is gone; read before `close`, "
    "or give an `output` to keep them"
)


class RunError(EnmmError):
    """A run that ended early, or whose end is in doubt. `result` has all that it wrote, with a checkpoint."""

    result: "Result"

    def __init__(self, message: str, status: int, result: "Result") -> None:
        super().__init__(message, status)
        self.result = result

    def __reduce__(self) -> tuple[type["RunError"], tuple[str, int, "Result"]]:  # type: ignore[override]
        return type(self), (str(self), self.status, self.result)


class Directory(Closing):
    """A directory with results; a temporary one is removed by `close`, at the end of a `with`, or with the object.

    Pickle takes the files of a temporary one along, so that results which a worker sends back are whole; of any other
    it takes what has been read, and the directory is sought at the same place.
    """

    directory: Path
    """Where the files are."""
    _record = ""
    """Name of the file that says what the results are."""

    def __init__(self, directory: str | os.PathLike[str] | None) -> None:
        self._settle(None if directory is None else path_of("directory", directory))
        if directory is not None:
            if not (self.directory / self._record).is_file():
                what = f"has no {self._record}, so it holds no results of this kind"
                raise FileNotFoundError(f"{self.directory}: {what}; give the `output` of what wrote them")
            self._read()

    def _settle(self, directory: Path | None) -> None:
        """Takes a directory, or makes a temporary one."""
        self._is_temporary = directory is None
        self.directory = _places.make() if directory is None else directory
        remove: Callable[[Path], object] = _places.remove if directory is None else _keep
        self._close = weakref.finalize(self, remove, self.directory)

    def _read(self) -> Self:
        """Reads what is there."""
        raise NotImplementedError

    def __getstate__(self) -> dict[str, Any]:
        state = {name: value for name, value in self.__dict__.items() if name != "_close"}
        if self._is_temporary:
            self._need()
            files = (path for path in self.directory.rglob("*") if path.is_file())
            state["files"] = {path.relative_to(self.directory).as_posix(): path.read_bytes() for path in files}
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        files: dict[str, bytes] | None = state.pop("files", None)
        self.__dict__.update(state)
        self._settle(None if files is not None else self.directory)
        for name, data in (files or {}).items():
            path = self.directory / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        if files is not None and self._record in files:
            self._read()

    def _need(self) -> None:
        """Refuses a directory that is gone."""
        if not self.directory.is_dir():
            raise invalid(f"{self.directory}: {_GONE}")

    @property
    def pictures(self) -> list[Path]:
        """The pictures that the program drew."""
        self._need()
        return sorted(self.directory.glob("*.png"))

    @property
    def report(self) -> Path | None:
        """`report.html`, which opens in a browser; None when this version of the program writes none."""
        path = self.directory / "report.html"
        return path if path.is_file() else None

    def show(self, height: int = 640) -> None:
        """Shows the page of results: in a frame of a notebook, else in a browser. `height` is that of the frame (px)."""
        self._need()
        if self.report is None:
            raise invalid(f"{self.directory}: holds no report.html to show; leave out pictures=False")
        if in_notebook():
            from IPython import display

            shown: Any = display
            shown.display(shown.HTML(_html.frame(self.report, height)))
        else:
            webbrowser.open(self.report.absolute().as_uri())

    def close(self) -> None:
        """Removes the directory if it is a temporary one. What has been read stays."""
        self._close()


class Result(Directory):
    """Results of `run`, or of any directory that `enmm run` wrote: `Result("fractured_slope")`."""

    summary: dict[str, Any]
    """`summary.json`: counts, stages, steps, energies, penetration, wall times, version, hash of the case."""
    history: Table
    """`history.csv`: time, monitored quantities and energies."""
    blocks: Table
    """`blocks.csv`: the blocks at the end."""
    lines: Table | None
    """`lines.csv`: the points of all lines at the end of each stage; None when the case has no `[[line]]`."""
    frames: Frames
    """Elements at every time that the case asks for; empty with `output.frames = false`."""

    _record = "summary.json"

    def _read(self) -> Self:
        self.summary = json.loads((self.directory / "summary.json").read_text(encoding="utf-8"))
        self.history = Table.read_csv(self.directory / "history.csv")
        self.blocks = Table.read_csv(self.directory / "blocks.csv")
        lines = self.directory / "lines.csv"
        self.lines = Table.read_csv(lines) if lines.is_file() else None
        self.frames = Frames(self.directory / "run.pvd", _Seal(self.directory, self.summary["case_hash"]))
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
    def at_rest(self) -> bool:
        """Whether all static stages came to rest; a slope that moves in a dynamic one is not looked at."""
        return all(stage["converged"] is not False for stage in self.summary["stages"])

    @property
    def warnings(self) -> list[str]:
        """What the user should know of the case and its results."""
        return list(self.summary["warnings"])

    @property
    def checkpoint(self) -> Path:
        """The state at the end, from which `run(case, resume=...)` continues."""
        self._need()
        return self.directory / "checkpoint.enmm"

    def plot(
        self,
        field: str = "displacement",
        frame: int = -1,
        ax: "Axes | None" = None,
        *,
        scale: float = 1.0,
        joints: bool = True,
    ) -> "Axes":
        """Draws the elements of a frame, coloured by a field, with the joints, by matplotlib; returns the axes.

        `field` is one of `Frame.cell_data` or `Frame.point_data`; of a vector its length. `scale` multiplies the
        displacements that are drawn.
        """
        return _plots.frame(self.frames[frame], field, ax, number("scale", scale), joints)

    def plot_history(self, *names: str, ax: "Axes | None" = None) -> "Axes":
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
        rows += [("warning", text) for text in self.warnings]
        return _html.facts(rows) + _html.picture(self.directory / "deformed.png", "The slope at the end of the run")

    def __repr__(self) -> str:
        if not hasattr(self, "summary"):
            return f"<enmm.Result {str(self.directory)!r}, not written yet>"
        what = f"{self.summary['status']}, t = {self.summary['time']:g} s, {self.blocks.rows} blocks"
        fate = ", the slope has failed" if self.failed else "" if self.at_rest else ", not at rest"
        return f"<enmm.Result {str(self.directory)!r}: {what}, {len(self.frames)} frames{fate}{_number_of(self.warnings)}>"


class _Seal:
    """Whether a directory still holds the results of one case."""

    def __init__(self, directory: Path, case_hash: str) -> None:
        self.directory, self.case_hash = directory, case_hash
        self._stamp = self._now()

    def _now(self) -> tuple[int, int] | None:
        summary = self.directory / "summary.json"
        if not summary.is_file():
            return None
        found = summary.stat()
        return found.st_mtime_ns, found.st_size

    def check(self) -> None:
        """Refuses what is gone, or was replaced by results of another case."""
        now = self._now()
        if now is None:
            raise invalid(f"{self.directory}: {_GONE}")
        if now == self._stamp:
            return
        found = json.loads((self.directory / "summary.json").read_text(encoding="utf-8"))["case_hash"]
        if found != self.case_hash:
            other = f"holds results of another case now ({found}, was {self.case_hash})"
            raise invalid(f"{self.directory}: {other}; read them by `Result(directory)`")


def _number_of(warnings: list[str]) -> str:
    """The number of warnings at the end of a line."""
    return f", {len(warnings)} warning{'s' * (len(warnings) > 1)}" if warnings else ""


def _float(value: Any) -> float | None:
    return None if value is None else float(value)


class Fos(Directory):
    """A factor of safety: what `fos` found, or any directory that `enmm fos` wrote: `Fos("plane_slide/fos")`."""

    record: dict[str, Any]
    """`fos.json`."""

    _record = "fos.json"

    def _read(self) -> Self:
        self.record = json.loads((self.directory / self._record).read_text(encoding="utf-8"))
        return self

    @property
    def factor_corners_hold(self) -> float | None:
        """The factor where the corners of `corner_contacts` hold; None where none carry the slope."""
        return _float(self.record.get("factor_corners_hold"))

    @property
    def factor_lost(self) -> float | None:
        """The greatest factor at which the slope rests in its real geometry; None where it was not found."""
        return _float(self.record.get("factor_lost"))

    @property
    def corner_contacts(self) -> list[dict[str, Any]]:
        """Corners that carry the slope: `block`, `ahead`, `x` and `y` (m), `length` (m), `force` (N/m)."""
        return list(self.record.get("corner_contacts", []))

    @property
    def factor(self) -> float | None:
        """The factor of safety; None when the search ended without one, see `status`, or `at_most` holds."""
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
    def at_most(self) -> float | None:
        """The upper bound of limit analysis, when a trial above it was stable: the factor is at most that."""
        most = self.record.get("at_most")
        return None if most is None else float(most)

    @property
    def bracket(self) -> tuple[float | None, float | None]:
        """Greatest factor that is stable and least that is not."""
        return self.record["bracket"]["stable"], self.record["bracket"]["unstable"]

    @property
    def trials(self) -> Table:
        """The trials, in the order of the factor."""
        return Table.of_rows(self.record["trials"], first=("factor", "verdict", "displacement"))

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

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draws displacement over the factor of every trial by matplotlib; returns the axes."""
        return _plots.trials(self, ax)

    def _repr_html_(self) -> str:
        low, high = self.bracket
        named = [("stable at", low), ("not stable at", high), ("at least", self.at_least), ("at most", self.at_most)]
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
            if self.at_most is not None:
                raise ValueError(f"the factor is at most {self.at_most:.4f}, an upper bound: {self.doubt}")
            raise ValueError(f"the search ended {self.status}: there is no factor; {in_python(self.record['remedy'])}")
        return self.factor

    def __repr__(self) -> str:
        told = _number_of(self.warnings)
        if self.at_most is not None:
            return f"<enmm.Fos: at most {self.at_most:.4f}{told}>"
        if self.factor is None:
            least = "" if self.at_least is None else f", at least {self.at_least:.4f}"
            return f"<enmm.Fos: {self.status}{least}{told}>"
        low, high = self.bracket
        return f"<enmm.Fos {self.factor:.4f}: stable at {low:.4f}, not at {high:.4f}{told}>"


def _of_bound(bound: dict[str, Any]) -> str:
    """The factor of limit analysis, or the reason why there is none."""
    if "refused" in bound:
        return f"none: {bound['refused']}"
    named = {"level_tops": "upper bound", "lower": "lower bound", "upper": "upper bound", "estimate": "estimate"}
    return ", ".join(f"{word} {_html.words(bound[name])}" for name, word in named.items() if bound.get(name))
