"""The driver: gives samples to workers, stores every answer at once, and returns the table of all."""

import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import ExitStack
from typing import Any

from .._case import Case
from .._errors import invalid
from .._library import load_library
from .._program import CaseLike
from ._outputs import NAMES, Answer, Output, evaluate
from ._sampling import Identity, draw_with_keys
from ._store import Row, Store
from ._summary import Ensemble
from ._variables import Distribution, Seeds, Variable

_WINDOW = 2000
"""Samples that are with the executor at a time."""
_TRIES = 3
"""How often a sample is given out whose worker was lost."""

AnyExecutor = Any
"""An executor of `concurrent.futures`, a client or the address of a Dask scheduler, "dask", or None."""


class EnsembleError(RuntimeError):
    """Workers were lost. What is done is stored; the same call continues from there."""


def run(
    case: CaseLike,
    variables: Mapping[str, Variable],
    n: int,
    output: Output = "factor_of_safety",
    *,
    executor: AnyExecutor = None,
    store: str | os.PathLike[str] | None = None,
    seed: int = 1,
    method: str = "monte_carlo",
    correlations: Mapping[tuple[str, str], float] | None = None,
    limit: float = 1.0,
    options: Mapping[str, Any] | None = None,
    retry_failed: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Ensemble:
    """Draws `n` samples of a case with uncertain values and works out one output of each.

    `variables` maps keys of the case to distributions, such as `{"joint_law.plane.friction_deg": Normal(35, 3),
    "joint_set[0].seed": Seeds()}`. `output` is "factor_of_safety", "level_tops" or "associated" (bounds of limit
    analysis, in milliseconds), or a function of a Case that returns a number or a dict of numbers. A sample fails when
    its output is below `limit`. `options` are those of `enmm.fos`.

    `executor` runs the samples: without one as many `enmm` programs as the machine has processors; any executor of
    `concurrent.futures`; a client of Dask, the address of its scheduler, or "dask" for a local cluster. Results do not
    depend on it. `store` is a SQLite file to which each sample is added as soon as it is done; the same call on the
    same store skips what is there. A stored sample belongs to a case, values, output, options and version, so other
    ensembles may share the file. A function is known to the store by its name, so take another file when you change it.

    `method` is "monte_carlo" or "latin_hypercube". `correlations` maps pairs of keys to the correlation of the normal
    variables behind them (Gaussian copula). `progress` is called with the number of samples done, and `n`.

    Samples whose case has no answer are stored as failed, counted in `Ensemble.failed` and warned of; `retry_failed`
    works them out again. Raises EnsembleError when workers were lost again and again.
    """
    base = Case.of(case)
    _check(base, variables, output)
    if store is not None and "<" in _name(output):
        raise invalid(
            "output: is a function without a name of its own, by which a store could find it; define one by def"
        )
    version = load_library().version
    identity = Identity(base.digest, _name(output), {name: float(value) for name, value in (options or {}).items()})
    samples, keys = draw_with_keys(variables, n, seed, method, correlations or {}, identity)
    with ExitStack() as stack:
        kept = stack.enter_context(Store(store))
        rows = kept.find(keys)
        wanted = [k for k, key in enumerate(keys) if key not in rows or (retry_failed and rows[key].status == "failed")]
        pool = stack.enter_context(_pool(executor)) if wanted else None
        done = n - len(wanted)
        for k, answer in _answers(pool, wanted, lambda k: (base, samples[k], output, dict(options or {}))):
            row = Row("failed" if answer.message else "done", answer.outputs, answer.message)
            kept.add(keys[k], k, samples[k], row, answer.seconds, version)
            rows[keys[k]] = row
            done += 1
            if progress is not None:
                progress(done, n)
    name = output if isinstance(output, str) else None
    found = Ensemble(base, dict(variables), samples, [rows[key] for key in keys], name, limit, method, seed)
    if found.failed:
        first = found.failed[0]
        warnings.warn(
            f"{len(found.failed)} of {n} samples have no answer and count neither as failed nor as stable slopes; "
            f"the first, sample {first[0]}: {first[1]}",
            stacklevel=2,
        )
    if found.doubtful:
        warnings.warn(
            f"{len(found.doubtful)} of {n} factors are above the bound of limit analysis (see `Ensemble.doubtful`): "
            "the slope may have slid before its strength was reduced, and shorter static stages help",
            stacklevel=2,
        )
    return found


def _check(case: Case, variables: Mapping[str, Variable], output: Output) -> None:
    if not variables:
        raise invalid("variables: is empty, must name at least one key of the case")
    for key, variable in variables.items():
        if not isinstance(variable, Distribution | Seeds):
            raise invalid(f"variables: {key} is {variable!r}, must be a distribution such as Normal(35, 3), or Seeds()")
        _ = case.with_values({key: variable.first if isinstance(variable, Seeds) else variable.value(0.5)})
    if isinstance(output, str) and output not in NAMES:
        raise invalid(f"output: is {output!r}, must be one of {', '.join(NAMES)}, or a function of a case")


def _name(output: Output) -> str:
    """Name of an output, of a function with its module; "<...>" without one."""
    if isinstance(output, str):
        return output
    return f"{getattr(output, '__module__', '')}.{getattr(output, '__qualname__', '<object>')}"


def _answers(
    pool: Executor | None, wanted: Iterable[int], job: Callable[[int], tuple[Any, ...]]
) -> Iterable[tuple[int, Answer]]:
    """The answers of samples, in the order in which they come."""
    if pool is None:
        return
    queue, running, tries = list(wanted)[::-1], dict[Future[Answer], int](), dict[int, int]()
    lost: BaseException | None = None
    while queue or running:
        while queue and len(running) < _WINDOW and lost is None:
            try:
                running[pool.submit(evaluate, *job(queue[-1]))] = queue[-1]
                queue.pop()
            except RuntimeError as error:  # A pool that lost a worker takes no more.
                lost = error
        if not running:
            break
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            k = running.pop(future)
            try:
                answer = future.result()
            except BaseException as error:
                if not _is_loss(error):
                    raise
                tries[k] = tries.get(k, 0) + 1
                lost = error if tries[k] >= _TRIES else lost
                queue.append(k)
                continue
            yield k, answer
    if lost is not None:
        message = (
            f"{len(queue)} samples were not done, because their workers were lost ({lost!r}); what is done is stored"
        )
        raise EnsembleError(f"{message}: call again to continue") from lost


def _is_loss(error: BaseException) -> bool:
    """Whether the worker was lost or starved, so that another one may succeed; all else is an error of the caller."""
    lost = (BrokenExecutor, CancelledError, OSError, MemoryError)
    return isinstance(error, lost) or type(error).__module__.partition(".")[0] == "distributed"


def _pool(executor: AnyExecutor) -> Any:
    """A context that gives an executor, and ends it when it began here."""
    stack = ExitStack()
    if executor is None:
        # The work is done by programs, so that threads are enough to wait for them.
        own = ThreadPoolExecutor(os.cpu_count())
        stack.callback(own.shutdown, cancel_futures=True)
        return _Pool(own, stack)
    if isinstance(executor, str):
        import distributed

        client: Any = distributed.Client
        local: Any = distributed.LocalCluster
        if executor == "dask":
            cluster = stack.enter_context(local(threads_per_worker=1, dashboard_address=":0"))
            executor = stack.enter_context(client(cluster))
        else:
            executor = stack.enter_context(client(executor))
    if hasattr(executor, "get_executor"):
        executor = executor.get_executor(pure=False)
    if not hasattr(executor, "submit"):
        raise invalid(f"executor: is {executor!r}, must have `submit`, as those of concurrent.futures have")
    return _Pool(executor, stack)


class _Pool:
    """An executor, and what was opened for it here and is closed at the end; that of a caller stays open."""

    def __init__(self, executor: Any, opened: ExitStack) -> None:
        self._executor, self._opened = executor, opened

    def __enter__(self) -> Any:
        return self._executor

    def __exit__(self, *_: object) -> None:
        self._opened.close()
