"""What the program does with a case, as functions: `run`, `fos`, `bound` and `check`."""

import json
import os
from collections.abc import Callable, Sequence
from typing import Any, cast

from . import _places
from ._errors import Status, warn
from ._html import Record
from ._options import real, whole, words
from ._options import path as path_of
from ._program import FAILED, INTERRUPTED, SLOPE_FAILED, CaseLike, call, case_file, failure, message_of, record
from ._progress import Bar, in_notebook
from ._records import Bound, Check
from ._results import Fos, Result, RunError

THREADS_MAX = 1024
FACTORS = (0.05, 20.0)
"""Least and greatest factor of safety that a search tries."""


def run(
    case: CaseLike,
    output: str | os.PathLike[str] | None = None,
    *,
    threads: int | None = None,
    resume: str | os.PathLike[str] | None = None,
    pictures: bool = True,
    overwrite: bool = False,
    timeout: float | None = None,
    progress: bool | Callable[[str], object] | None = None,
) -> Result:
    """Runs all stages of a case and returns what `enmm run` writes.

    `output` is the directory of the results; without it they go to a temporary one, which `Result.close` removes. One
    with results of another case is refused without `overwrite`. `threads` is how many are used, all without it;
    results do not depend on it. `resume` is a checkpoint to continue from. Without `pictures` none are drawn, which
    takes most of the time of a small run. `progress` shows how far the run is: by default in notebooks alone; a
    function is called with a line for each instead. A run that has not ended after `timeout` (s) is ended with a
    TimeoutError; it leaves a checkpoint in `output`.

    Each warning of the results is an EnmmWarning. Raises CaseError with file, line and key; RunError, with the results
    so far, when a run fails numerically or does not come to a sound end. A slope that fails raises nothing: see
    `Result.failed` and `Result.verdict`.
    """
    options: dict[str, Any] = {"threads": whole("threads", threads, 1, THREADS_MAX)}
    options |= {"resume": None if resume is None else path_of("resume", resume)}
    options |= {"no-pictures": not pictures, "force": overwrite}
    result = Result(None) if output is None else None
    directory = result.directory if result else path_of("output", output or "")
    say = progress if callable(progress) else None
    shown = None if progress is None else bool(progress)
    show = bool(shown) and say is None and not in_notebook()
    with case_file(case) as path, Bar(False if say else None if shown is None else shown and in_notebook()) as bar:

        def hear(line: str) -> bool:
            is_used = "  simulated " in line or line.startswith("building the model")
            if say is None:
                bar.say(line, at_once=True)
            elif is_used:
                say(line.strip())
            return is_used

        listens = bar.shown or say is not None
        quiet = not show and not listens
        line = ["run", path, "-o", directory, *words(options | {"quiet": quiet})]
        status, _, error = call(line, show=show, hear=hear if listens else None, timeout=timeout)
    if status in (0, SLOPE_FAILED):
        found = result._read() if result else Result(directory)
        warn(found.warnings)
        return found
    message = message_of(status, error) if error or not show else "the run failed; see the message above"
    if status not in (FAILED, INTERRUPTED) or not (directory / "summary.json").is_file():
        raise failure(status, message)
    if status == INTERRUPTED:
        raise KeyboardInterrupt(message)
    if result:  # Its directory may be another one where the exception arrives.
        message = message.replace(str(result.checkpoint), "the `result.checkpoint` of this exception")
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
    overwrite: bool = False,
    timeout: float | None = None,
    progress: bool | Callable[[str], object] | None = None,
) -> Fos:
    """Finds the factor of safety of a case by strength reduction, as `enmm fos` does.

    `low` and `high` bound the factors that are tried, and the search begins with them. `tolerance` is the width of the
    final bracket relative to the factor (0.005 without it). Mechanisms of less rock than `least_area` (m2; 1.5 %
    of the free rock without it) do not count. `stage` is the static stage after which the slope is looked at.
    `mechanisms` is how many are sought, each without the blocks of those before. Without `pictures` neither pictures
    nor a page are drawn. `progress` shows the trials, by default in notebooks alone; a function is called with a line
    for each instead. A search that ends without a factor is no error: see `Fos.status`. `output`, `threads`,
    `overwrite` and `timeout` are as those of `run`.

    Each warning, and the doubt in a factor, is an EnmmWarning. Raises CaseError with file, line and key; StepError when
    the slope does not come to rest before the search.
    """
    options = search_options(low, high, tolerance, least_area, stage, mechanisms, threads)
    found = search(case, output, options | {"no-pictures": not pictures, "force": overwrite}, timeout, progress)
    warn([*found.warnings, *([found.doubt] if found.doubt else [])])
    return found


def search_options(
    low: float | None = None,
    high: float | None = None,
    tolerance: float | None = None,
    least_area: float | None = None,
    stage: str | None = None,
    mechanisms: int | None = None,
    threads: int | None = None,
) -> dict[str, Any]:
    """The options of a search that are given. Raises InvalidArgumentError for a value that no search takes."""
    options = {
        "low": real("low", low, *FACTORS),
        "high": real("high", high, *FACTORS),
        "tolerance": real("tolerance", tolerance, 1e-4, 0.5),
        "least_area": real("least_area", least_area, 0.0, 1e12),
        "stage": None if stage is None else str(stage),
        "mechanisms": whole("mechanisms", mechanisms, 1, 100),
        "threads": whole("threads", threads, 1, THREADS_MAX),
    }
    return {name: value for name, value in options.items() if value is not None}


def search(
    case: CaseLike,
    output: str | os.PathLike[str] | None,
    options: dict[str, Any],
    timeout: float | None = None,
    progress: bool | Callable[[str], object] | None = None,
) -> Fos:
    """Finds a factor of safety by options that have been checked, without a word of its warnings."""
    found = Fos(None) if output is None else None
    directory = found.directory if found else path_of("output", output or "")
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
        line = ["fos", path, "-o", directory, *words(options | {"trials": listens})]
        written = record(line, hear if listens else None, timeout)
    if found is None:
        return Fos(directory)
    found.record = written
    return found


def _trial(line: str) -> dict[str, Any] | None:
    """A trial that the program prints in one line before its result, which has several."""
    if not line.startswith('{"'):
        return None
    found: dict[str, Any] = json.loads(line)
    return found if "done" in found and "trial" in found else None


def bound(
    case: CaseLike,
    output: str | os.PathLike[str] | None = None,
    *,
    stage: str | None = None,
    overwrite: bool = False,
    timeout: float | None = None,
) -> Bound:
    """Bounds of the factor of safety by limit analysis, the object of `enmm bound --json`.

    `associated`, `level_tops` and `catching` of rigid blocks are upper bounds, and so is `bare`, the associated one
    without the cohesion of joints that open; `estimate` is none, and None where forces do not agree. Rock that yields
    has `lower` and `upper`. Each has `factor` and `end`, and all but `lower` a `mechanism`. `stage` is the static stage
    after which the slope is looked at. `output` is a directory for `report.html`, which shows the mechanism; without it
    no page is left. `overwrite` and `timeout` are as those of `run`. Each warning is an EnmmWarning. Raises CaseError
    for a case that limit analysis cannot treat.
    """
    found = bounds(case, output, words({"stage": stage, "force": overwrite}), timeout)
    warn(found["warnings"])
    return cast(Bound, found)


def bounds(
    case: CaseLike,
    output: str | os.PathLike[str] | None = None,
    options: Sequence[object] = (),
    timeout: float | None = None,
) -> Record:
    """Bounds by options that have been checked, without a word of their warnings."""
    page = _places.make() if output is None else None
    try:
        with case_file(case) as path:
            directory = page or path_of("output", output or "")
            return record(["bound", path, "-o", directory, *options], timeout=timeout)
    finally:
        if page is not None:
            _places.remove(page)


def check(case: CaseLike) -> Check:
    """Builds the model of a case only: the object of `enmm check --json`.

    It has counts, areas (m2), masses (kg/m), the critical step (s), memory (bytes) and warnings, each of which is an
    EnmmWarning too. Raises CaseError.
    """
    with case_file(case) as path:
        found = record(["check", path])
    warn(found["warnings"])
    return cast(Check, found)
