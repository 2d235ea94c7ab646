"""What is worked out of a sample: runs on the workers."""

import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from .. import _tasks
from .._case import Case
from .._errors import CaseError, InvalidArgumentError, Status, StepError
from .._results import Fos, RunError

Output = str | Callable[[Case], float | Mapping[str, Any]]
"""`factor_of_safety`, `level_tops` or `associated` (limit analysis), `failure` (whether the factor is below the limit),
or a function of a case that pickle can take."""

DECIDING = {
    "factor_of_safety": "factor_of_safety",
    "level_tops": "level_tops",
    "associated": "associated",
    "failure": "factor_estimate",
}
"""The column of each output that decides whether a sample fails."""
NAMES = tuple(DECIDING)
_ALONE: dict[str, Any] = {"threads": 1}
"""Options of a search that others go beside."""


class Answer(NamedTuple):
    """What a worker sends back: outputs, or the message of a case that has no answer."""

    outputs: dict[str, Any]
    message: str
    seconds: float


def evaluate(
    case: Case,
    values: dict[str, Any],
    output: Output,
    options: dict[str, Any],
    hear: Callable[[str], None] | None = None,
) -> Answer:
    """Works out one sample; `hear` is called with a line for each of its trials. A case without an answer is an answer too; all else is raised, and may be tried again."""
    start = time.perf_counter()
    try:
        outputs = _outputs(case.with_values(values), output, options, hear)
        return Answer(outputs, "", time.perf_counter() - start)
    except (CaseError, StepError, InvalidArgumentError, RunError) as error:
        return Answer({}, str(error), time.perf_counter() - start)


def _outputs(case: Case, output: Output, options: dict[str, Any], hear: Callable[[str], None] | None) -> dict[str, Any]:
    if output == "factor_of_safety":
        given = _tasks.search_options(**(_ALONE | options)) | {"no-pictures": True}
        with _tasks.search(case, None, given, progress=hear or False) as found:
            return _of_fos(found)
    if isinstance(output, str):
        collapse = _tasks.bounds(case)[output]
        return {output: float(collapse["limit"]), "status": str(collapse["end"])}
    answer = output(case)
    if isinstance(answer, Mapping):
        return {name: value.item() if hasattr(value, "item") else value for name, value in answer.items()}
    return {"output": float(answer)}


def _of_fos(found: Fos) -> dict[str, Any]:
    """Factor and what fails. A factor beyond the search is its limit, with the status that says so; one above an upper
    bound is the bound."""
    low, high = found.bracket
    known = (found.at_most, found.factor, found.at_least, high)
    factor = next((value for value in known if value is not None), None)
    if factor is None or found.status == "failed":
        message = f"the search for the factor of safety ended {found.status}: {found.record['remedy']}"
        raise StepError(message, Status.NUMERICAL_FAILURE)
    failing = found.failing or {"blocks": 0, "area": 0.0}
    return {
        "factor_of_safety": float(factor),
        "stable": low,
        "unstable": high,
        "status": found.status,
        "failing_blocks": int(failing["blocks"]),
        "failing_area": float(failing["area"]),
        "doubt": found.doubt or "",
    }
