"""The driver: gives samples to workers, stores every answer at once, and returns the table of all."""

import os
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
from functools import partial
from typing import Any, NamedTuple

from .. import _tasks
from .._case import Case
from .._errors import invalid, warn
from .._library import load_library
from .._options import whole
from .._program import CaseLike
from .._progress import Bar
from ._outputs import DECIDING, NAMES, Answer, Output, evaluate
from ._sampling import Identity, draw_with_keys
from ._screen import screened
from ._shown import DaskTrials, Shown, TrialHeard
from ._store import Row, Store
from ._summary import Ensemble, wilson
from ._variables import Distribution, Seeds, Variable

_WINDOW = 2000
"""Samples that are with the executor at a time."""
_BATCH = 50
"""Samples after each of which the width of the interval is looked at."""
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
    interval: float | None = None,
    options: Mapping[str, Any] | None = None,
    retry_failed: bool = False,
    progress: bool | Callable[[int, int], object] | None = None,
) -> Ensemble:
    """Draws `n` samples of a case with uncertain values and works out one output of each.

    `variables` maps keys of the case to distributions, such as `{"joint_law.plane.friction_deg": Normal(35, 3),
    "joint_set[0].seed": Seeds()}`. `output` is "factor_of_safety", "level_tops" or "associated" (bounds of limit
    analysis, in milliseconds), or a function of a Case that returns a number or a dict of numbers. A sample fails when
    its output is below `limit`. "failure" finds which samples have a factor below the limit with a fraction of the
    searches: by bounds, and by a trial at the limit where these leave it open. With `interval` no more samples are
    worked out once the 95 % interval of the probability of failure is as narrow as that; it is looked at after every
    50 samples, and `method` must be "monte_carlo". `options` are those of `enmm.fos`.

    `executor` runs the samples: without one as many `enmm` programs as the machine has processors; any executor of
    `concurrent.futures`; a client of Dask, the address of its scheduler, or "dask" for a local cluster. Results do not
    depend on it. `store` is a SQLite file to which each sample is added as soon as it is done; the same call on the
    same store skips what is there. A stored sample belongs to a case, values, output, options and version, so other
    ensembles may share the file. A function is known to the store by its name, so take another file when you change it.

    `method` is "monte_carlo" or "latin_hypercube". `correlations` maps pairs of keys to the correlation of the normal
    variables behind them (Gaussian copula). `progress` shows, by default in notebooks alone, how many samples are done
    and below the limit, the slowest, the time left, and the last trial of those that threads of this process or Dask
    work out. A function is called with the number of samples done, and how many are wanted, instead. With `output`
    "failure" both begin again for each of the bounds, the searches and the trials.

    Samples whose case has no answer are stored as failed, counted in `Ensemble.failed` and warned of; `retry_failed`
    works them out again. Raises EnsembleError when workers were lost again and again.
    """
    base = Case.of(case)
    n = whole("n", n, 1, 10**7)
    _tasks.search_options(**(options or {}))
    _check(base, variables, output)
    if store is not None and "<" in _name(output):
        raise invalid(
            "output: is a function without a name of its own, by which a store could find it; define one by def"
        )
    if output == "failure" and not 0.05 <= limit <= 20:
        raise invalid(f'limit: is {limit}, must be from 0.05 to 20 with output "failure", which makes trials at it')
    if interval is not None and (not 0 < interval < 1 or method != "monte_carlo"):
        raise invalid(
            f'interval: is {interval} with method {method!r}, must be within 0 and 1 with "monte_carlo": the first '
            "samples of a Latin hypercube are no sample of the whole"
        )
    with ExitStack() as stack:
        bar = stack.enter_context(Bar(False if callable(progress) else progress))
        shown = Shown(bar, limit, progress if callable(progress) else None)
        answers = _Answers(stack, base, _Draw(variables, n, seed, method, correlations or {}), executor, store)
        answers.retry_failed, answers.shown, answers.hears = retry_failed, shown, bar.shown
        rows: list[Row] = []
        margin = None
        while len(rows) < n:
            batch = range(len(rows), n if interval is None else min(n, len(rows) + _BATCH))
            if output == "failure":
                found, margin = screened(batch, limit, dict(options or {}), answers.find, margin)
                rows += found
            else:
                rows += answers.find(batch, output, dict(options or {}))
            if interval is not None and _is_narrow(rows, DECIDING.get(_name(output)), limit, interval):
                break
        samples = answers.samples[: len(rows)]
    name = DECIDING[output] if isinstance(output, str) else None
    ensemble = Ensemble(base, dict(variables), samples, rows, name, limit, method, seed)
    if ensemble.failed:
        first = ensemble.failed[0]
        lost = f"{len(ensemble.failed)} of {len(rows)} samples have no answer"
        counted = "count neither as failed nor as stable slopes"
        warn([f"{lost} and {counted}; the first, sample {first[0]}: {first[1]}"])
    if ensemble.doubtful:
        many = f"{len(ensemble.doubtful)} of {len(rows)} factors are above the bound of limit analysis"
        remedy = "the slope may have slid before its strength was reduced, and shorter static stages help"
        warn([f"{many} (see `Ensemble.doubtful`): {remedy}"])
    return ensemble


class _Draw(NamedTuple):
    """How samples are drawn."""

    variables: Mapping[str, Variable]
    n: int
    seed: int
    method: str
    correlations: Mapping[tuple[str, str], float]


class _Answers:
    """Outputs of samples: from the store where they are there, else from workers, and then into the store at once."""

    def __init__(
        self, stack: ExitStack, case: Case, draw: _Draw, executor: AnyExecutor, store: str | os.PathLike[str] | None
    ) -> None:
        self._stack, self._case, self._draw, self._executor = stack, case, draw, executor
        self._store = stack.enter_context(Store(store))
        self._version = load_library().version
        self._pool: Executor | None = None
        self._keys: dict[str, list[str]] = {}
        self.samples: list[dict[str, Any]] = []
        """The values of the samples, once one has been asked for."""
        self.retry_failed = False
        self.shown: Shown | None = None
        """What shows how far the work is."""
        self.hears = False
        """Whether it shows trials."""
        self._trials: TrialHeard | None = None

    def find(self, places: Iterable[int], output: Output, options: dict[str, Any]) -> list[Row]:
        """One output of some samples, in their order."""
        places, keys = list(places), self._keys_of(output, options)
        rows = self._store.find(keys[k] for k in places)
        again = [k for k in places if keys[k] in rows and self.retry_failed and rows[keys[k]].status == "failed"]
        wanted = [k for k in places if keys[k] not in rows] + again
        shown = self.shown
        if shown is not None:
            there = [rows[keys[k]] for k in set(places).difference(wanted)]
            shown.begin(_name(output), DECIDING.get(_name(output)), there, len(places))
        if wanted and self._pool is None:
            self._pool = self._stack.enter_context(_pool(self._executor))
            self._trials = self._listen(self._pool)

        def job(k: int) -> tuple[Any, ...]:
            hear = None if self._trials is None else partial(self._trials, k)
            return self._case, self.samples[k], output, options, hear

        for k, answer in _answers(self._pool, sorted(wanted), job):
            row = Row("failed" if answer.message else "done", answer.outputs, answer.message)
            self._store.add(keys[k], k, self.samples[k], row, answer.seconds, self._version)
            rows[keys[k]] = row
            if shown is not None:
                shown.note(k, row, answer.seconds)
        return [rows[keys[k]] for k in places]

    def _listen(self, pool: Any) -> TrialHeard | None:
        """What workers call with their trials; none where they cannot be heard."""
        if self.shown is None or not self.hears:
            return None
        if isinstance(pool, ThreadPoolExecutor):
            return self.shown.trial
        # That of a client of Dask.
        client = getattr(pool, "_client", None)
        if client is None or not hasattr(client, "subscribe_topic"):
            return None
        trials = DaskTrials()
        self._stack.callback(trials.subscribe(client, self.shown.trial))
        return trials

    def _keys_of(self, output: Output, options: dict[str, Any]) -> list[str]:
        """Keys of all samples in the store."""
        given = {name: value if isinstance(value, str) else float(value) for name, value in options.items()}
        identity = Identity(self._case.digest, _name(output), given)
        name = repr(identity)
        if name not in self._keys:
            self.samples, self._keys[name] = draw_with_keys(*self._draw, identity)
        return self._keys[name]


def _is_narrow(rows: list[Row], name: str | None, limit: float, width: float) -> bool:
    """Whether the interval of the probability of failure is no wider than `width`."""
    outputs = [float(row.outputs[name or next(iter(row.outputs))]) for row in rows if row.status == "done"]
    if not outputs:
        return False
    low, high = wilson(sum(output < limit for output in outputs), len(outputs))
    return high - low <= width


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
