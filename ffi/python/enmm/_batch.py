"""Many models, or many states of one model, in one call."""

import ctypes
from collections.abc import Mapping, Sequence
from ctypes import c_double, c_int32, c_uint32, c_void_p
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _abi
from ._core import pointer
from ._errors import invalid
from ._model import Model, State
from ._options import number
from ._values import PortState


class Rollout(NamedTuple):
    """Outputs of samples."""

    values: npt.NDArray[np.float64]
    """Outputs by sample, step and output; not a number behind the failure of a sample."""
    statuses: npt.NDArray[np.int32]
    """Status of each sample: `Status.OK`, or why it failed."""


def rollout(
    model: Model,
    states: State | Sequence[State],
    parameters: Mapping[str, npt.ArrayLike] | None = None,
    *,
    steps: int,
    h: float | None = None,
    outputs: Sequence[tuple[str, str]],
    threads: int = 1,
) -> Rollout:
    """Takes samples of a model on from saved states, each with parameters of its own; the model stays as it is.

    `states` is one state for all samples or one for each; `parameters` gives each sample a value of each name (one
    number is for all of them); `h` is the communication step (s), that of the case without it; `outputs` are names of
    ports with fields of `PortState`, such as ("toe", "displacement_x"). The bits are those of the same calls one by
    one, on any number of threads. A sample that fails is not a number from there on.
    """
    given = {name: np.asarray(values, dtype=np.float64) for name, values in (parameters or {}).items()}
    alone = [states] if isinstance(states, State) else list(states)
    samples = max([len(alone), *(values.size for values in given.values() if values.ndim)])
    if len(alone) not in (1, samples):
        raise invalid(f"states: are {len(alone)}, must be 1 or as many as samples, {samples}")
    for name, values in given.items():
        if values.shape not in ((), (samples,)):
            raise invalid(f"{name}: has the shape {values.shape}, must be a number or have the shape ({samples},)")
    columns = [np.broadcast_to(values, (samples,)) for values in given.values()]
    table = np.ascontiguousarray(np.stack(columns, axis=1) if columns else np.empty((samples, 0)))
    for _, name in outputs:
        if name not in PortState._fields:
            raise invalid(f"outputs: has the field {name!r}, must be one of {', '.join(PortState._fields)}")
    indices = np.array([model.parameters.index(name) for name in given], dtype=np.uint32)
    ports = np.array([model.ports[port].index for port, _ in outputs], dtype=np.uint32)
    quantities = np.array([PortState._fields.index(name) for _, name in outputs], dtype=np.uint32)
    handles = (c_void_p * len(alone))(*(state.handle for state in alone))
    plan = _abi.RolloutPlan(
        struct_size=ctypes.sizeof(_abi.RolloutPlan),
        samples=samples,
        states=ctypes.cast(handles, c_void_p),
        state_count=len(alone),
        parameters=ctypes.cast(pointer(indices, c_uint32), c_void_p),
        parameter_count=len(given),
        values=ctypes.cast(pointer(table, c_double), c_void_p),
        step=model.communication_step if h is None else number("h", h),
        steps=steps,
        ports=ctypes.cast(pointer(ports, c_uint32), c_void_p),
        quantities=ctypes.cast(pointer(quantities, c_uint32), c_void_p),
        output_count=len(outputs),
        threads=threads,
    )
    values = np.empty((samples, steps, len(outputs)))
    statuses = np.zeros(samples, dtype=np.int32)
    room = pointer(values, c_double), values.size, pointer(statuses, c_int32)
    model._core.call("enmm_rollout", ctypes.byref(plan), *room)
    return Rollout(values, statuses)


def batch_step(models: Sequence[Model], h: float, *, threads: int = 1) -> npt.NDArray[np.int32]:
    """Advances models by `h` (s) each from where it stands, on some threads; returns the status of each.

    The bits are those of `Model.do_step`. A model that fails is as before; the others have gone on.
    """
    statuses = np.zeros(len(models), dtype=np.int32)
    if not models:
        return statuses
    library = models[0]._core.library
    handles = (c_void_p * len(models))(*(model._core.handle for model in models))
    result = library.attempt("enmm_batch_step", handles, len(models), number("h", h), threads, pointer(statuses, c_int32))
    if not statuses.any():
        library.judge(*result)
    return statuses
