"""Explicit numerical manifold method for jointed rock: models that a host drives through time.

    import enmm

    with enmm.Model.from_file("coupled_slope.toml") as model:
        model.start()
        while model.time < model.stop_time:
            model.set_block_force(model.ports["toe"].block, 0.45e6, 0.28e6)
            info = model.do_step(model.time, model.communication_step)

Whole runs need one line each; the wheel brings the program `enmm`, which they call:

    enmm.fos("plane_slide.toml").factor
    enmm.run("fractured_slope.toml").plot()

`enmm.ensemble` draws samples of uncertain values and finds the probability of failure; `enmm.aio` has the same
functions for `await`.

Units are SI: m, s, kg, N, Pa, rad, per metre of thickness; x to the right, y upwards, angles and moments
counter-clockwise, stresses positive in tension.

Models share nothing: any number can be used at the same time, each by one thread at a time; any other gets BusyError.
Calls release the interpreter lock. A State may be used by many threads.
"""

import importlib
from typing import Any

from ._abi import (
    ABI_VERSION,
    BlockFlag,
    ContactState,
    EventKind,
    Input,
    Interpolation,
    LogLevel,
    NameKind,
    PortKind,
    SectionFailure,
)
from ._batch import Rollout, batch_step, rollout
from ._case import Case
from ._data import examples, schema
from ._document import document
from ._doors import (
    Imported,
    Report,
    Samples,
    Stereonet,
    Sweep,
    fmu,
    import_drawing,
    new,
    report,
    sample,
    stereonet,
    sweep,
)
from ._errors import (
    BufferTooSmallError,
    BusyError,
    CallInterruptedError,
    CaseError,
    CaseFileError,
    DeadHandleError,
    EnmmError,
    EnmmWarning,
    EquilibriumWarning,
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
from ._frames import Frame, Frames
from ._library import Library, load_library
from ._model import BLOCK_DTYPE, CONTACT_DTYPE, Model, State
from ._parameters import Parameter, Parameters
from ._ports import Port, Ports
from ._program import program
from ._records import Bound, Check, Collapse, EnsembleRecord, MechanismBlock, MemoryPart, SweepRecord
from ._results import Fos, Result, RunError
from ._table import Table
from ._tasks import bound, check, fos, run
from ._types import Cut, Event, FlowInputs, Inputs, PortInputs
from ._values import (
    BLOCK_FIELDS,
    Energies,
    InletState,
    JointMonitorState,
    MonitorState,
    MonitorStress,
    PortState,
    Progress,
    StartInfo,
    StepInfo,
    Totals,
)

__version__ = "0.1.0"

document("_batch", "_doors", "_parameters", "_types", "_values")


def __getattr__(name: str) -> Any:
    if name in ("aio", "ensemble"):  # Only when it is asked for, so that the import of the package stays short.
        return importlib.import_module(f"enmm.{name}")
    raise AttributeError(f"module 'enmm' has no attribute {name!r}")


__all__ = [
    "ABI_VERSION",
    "BLOCK_DTYPE",
    "BLOCK_FIELDS",
    "CONTACT_DTYPE",
    "BlockFlag",
    "Bound",
    "BufferTooSmallError",
    "BusyError",
    "CallInterruptedError",
    "Case",
    "CaseError",
    "CaseFileError",
    "Check",
    "Collapse",
    "ContactState",
    "Cut",
    "DeadHandleError",
    "Energies",
    "EnmmError",
    "EnmmWarning",
    "EnsembleRecord",
    "EquilibriumWarning",
    "Event",
    "EventKind",
    "FlowInputs",
    "Fos",
    "Frame",
    "Frames",
    "Imported",
    "InletState",
    "Input",
    "Inputs",
    "Interpolation",
    "InvalidArgumentError",
    "JointMonitorState",
    "Library",
    "LibraryError",
    "LogLevel",
    "MechanismBlock",
    "MemoryPart",
    "Model",
    "MonitorState",
    "MonitorStress",
    "NameKind",
    "NotFoundError",
    "NullArgumentError",
    "PanicError",
    "Parameter",
    "Parameters",
    "Port",
    "PortInputs",
    "PortKind",
    "PortState",
    "Ports",
    "Progress",
    "Report",
    "Result",
    "Rollout",
    "RunError",
    "Samples",
    "SectionFailure",
    "StartInfo",
    "State",
    "StateError",
    "Status",
    "StepError",
    "StepInfo",
    "Stereonet",
    "Sweep",
    "SweepRecord",
    "Table",
    "TimeError",
    "Totals",
    "__version__",
    "batch_step",
    "bound",
    "check",
    "examples",
    "fmu",
    "fos",
    "import_drawing",
    "load_library",
    "new",
    "program",
    "report",
    "rollout",
    "run",
    "sample",
    "schema",
    "stereonet",
    "sweep",
]
