"""Explicit numerical manifold method for jointed rock: models that a host drives through time.

    import enmm

    with enmm.Model.from_file("coupled_slope.toml") as model:
        model.start()
        while model.time < model.stop_time:
            model.set_block_force(model.ports["toe"].block, 0.45e6, 0.28e6)
            info = model.do_step(model.time, model.communication_step)

Units are SI: m, s, kg, N, Pa, rad, per metre of thickness; x to the right, y upwards, angles and moments
counter-clockwise, stresses positive in tension.

Models share nothing: any number can be used at the same time, each by one thread at a time; any other gets BusyError.
Calls release the interpreter lock. A State may be used by many threads.
"""

from ._abi import ABI_VERSION
from ._errors import (
    BufferTooSmallError,
    BusyError,
    CaseError,
    CaseFileError,
    DeadHandleError,
    EnmmError,
    InvalidArgumentError,
    LibraryError,
    NotFoundError,
    NullArgumentError,
    PanicError,
    StateError,
    Status,
    StepError,
    TimeError,
)
from ._library import Library, load_library
from ._model import BLOCK_DTYPE, CONTACT_DTYPE, Model, State
from ._ports import Port, Ports
from ._types import (
    BlockFlag,
    ContactState,
    Energies,
    Event,
    EventKind,
    Interpolation,
    LogLevel,
    PortKind,
    PortState,
    StepInfo,
    Totals,
)

__all__ = [
    "ABI_VERSION",
    "BLOCK_DTYPE",
    "CONTACT_DTYPE",
    "BlockFlag",
    "BufferTooSmallError",
    "BusyError",
    "CaseError",
    "CaseFileError",
    "ContactState",
    "DeadHandleError",
    "Energies",
    "EnmmError",
    "Event",
    "EventKind",
    "Interpolation",
    "InvalidArgumentError",
    "Library",
    "LibraryError",
    "LogLevel",
    "Model",
    "NotFoundError",
    "NullArgumentError",
    "PanicError",
    "Port",
    "PortKind",
    "PortState",
    "Ports",
    "State",
    "StateError",
    "Status",
    "StepError",
    "StepInfo",
    "TimeError",
    "Totals",
    "load_library",
]
