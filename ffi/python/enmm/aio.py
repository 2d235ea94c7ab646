"""Asynchronous forms of what the program does: `await enmm.aio.fos("plane_slide.toml")`.

Each takes the arguments of the function of its name and runs beside others in a thread of the event loop. Cancelling
it, as `asyncio.timeout` does, ends the program:

    async with asyncio.TaskGroup() as group:
        tasks = [group.create_task(enmm.aio.run(case, threads=1)) for case in cases]
"""

import asyncio
import contextvars
from collections.abc import Callable, Coroutine
from functools import partial, wraps
from typing import Any, ParamSpec, TypeVar

from . import _doors, _tasks
from ._program import LEASH, Leash

__all__ = ["bound", "check", "fos", "run", "sample", "sweep"]

P = ParamSpec("P")
T = TypeVar("T")


def _asynchronous(function: Callable[P, T]) -> Callable[P, Coroutine[Any, Any, T]]:
    """The function as a coroutine; its end ends the program that it calls."""

    @wraps(function)
    async def call(*arguments: P.args, **named: P.kwargs) -> T:
        context, leash = contextvars.copy_context(), Leash()
        context.run(LEASH.set, leash)
        job = partial(context.run, partial(function, *arguments, **named))
        work = asyncio.get_running_loop().run_in_executor(None, job)
        try:
            return await asyncio.shield(work)
        except asyncio.CancelledError:
            leash.end()
            # The program has ended when the cancelled task has; what came of it is of no use.
            await asyncio.wait([work])
            work.exception()
            raise

    return call


run = _asynchronous(_tasks.run)
fos = _asynchronous(_tasks.fos)
bound = _asynchronous(_tasks.bound)
check = _asynchronous(_tasks.check)
sample = _asynchronous(_doors.sample)
sweep = _asynchronous(_doors.sweep)
