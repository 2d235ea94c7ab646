"""Models and saved states."""

import ctypes
import os
import weakref
from contextlib import suppress
from ctypes import byref, c_double, c_int32, c_size_t, c_uint32, c_void_p
from pathlib import Path
from typing import NamedTuple, Self, SupportsIndex

import numpy as np
import numpy.typing as npt

from . import _abi
from ._abi import EventKind, Interpolation
from ._closing import Closing
from ._core import Core, LogFunction, Rows, dtype_of, ids_of, index, number, pointer, text, values_of
from ._errors import BusyError, DeadHandleError, Status, invalid
from ._library import Library, load_library
from ._ports import Port, Ports
from ._types import Event
from ._values import Energies, StepInfo, Totals

BLOCK_DTYPE = dtype_of(_abi.BlockState)
"""Fields of `Model.blocks`, those of `enmm_block_state`."""
CONTACT_DTYPE = dtype_of(_abi.Contact)
"""Fields of `Model.contacts`, those of `enmm_contact`."""


class State(Closing):
    """A saved state of a model, made by `Model.save` or `Model.deserialize`; it may outlive the model.

    It is given free by `close`, at the end of a `with`, or with the object. It goes through pickle as the case and
    the bytes of `Model.serialize`, and is whole again in the process that unpickles it.
    """

    def __init__(self, library: Library, handle: c_void_p, source: "Source", core: Core) -> None:
        self.handle = handle
        self._source, self._core = source, weakref.ref(core)
        self._close = weakref.finalize(self, library.functions["enmm_state_free"], handle)

    def close(self) -> None:
        """Gives the state free. Later uses raise DeadHandleError; closing again does nothing."""
        self._close()

    def __reduce__(self) -> tuple[object, ...]:
        return _unpickled_state, (self._source, self._bytes())

    def _bytes(self) -> bytes:
        """The bytes of the state, by its model or, when that is closed or in use, by another one of the case."""
        if not self._close.alive:
            raise DeadHandleError("the state was closed: save another one to pickle", Status.DEAD_HANDLE)
        core = self._core()
        if core is not None:
            with suppress(DeadHandleError, BusyError):
                return _serialized(core, self)
        with self._source.model() as model:
            return model.serialize(self)

    def __repr__(self) -> str:
        return f"<enmm.State{'' if self._close.alive else ', closed'}>"


def _unpickled_state(source: "Source", data: bytes) -> State:
    with source.model() as model:
        return model.deserialize(data)


def _unpickled_model(source: "Source", data: bytes, threads: int) -> "Model":
    model = source.model()
    with model.deserialize(data) as state:
        model.restore(state)
    model.threads = threads
    return model


def _serialized(core: Core, state: State) -> bytes:
    count = c_size_t()
    core.call("enmm_state_serialize", state.handle, None, 0, byref(count))
    buffer = ctypes.create_string_buffer(count.value)
    core.call("enmm_state_serialize", state.handle, buffer, count.value, byref(count))
    return buffer.raw[: count.value]


class Source(NamedTuple):
    """What a model was made of: the text of its case, the directory of the files that it names, and its name."""

    toml: str
    base_dir: str
    name: str

    def model(self) -> "Model":
        """Builds the model once more, by the library that this process finds."""
        return Model.from_string(self.toml, self.base_dir)


class Recording:
    """Results of a model that go to the folder `directory`; the end of its `with` writes the summary."""

    def __init__(self, model: "Model", directory: Path) -> None:
        self._model, self.directory = model, directory

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def write_frame(self) -> None:
        """As `Model.write_frame`."""
        self._model.write_frame()

    def close(self) -> None:
        """As `Model.end_record`; does nothing when the model was closed, which has ended the recording too."""
        if self._model.is_alive:
            self._model.end_record()


class Model(Closing):
    """A jointed rock mass that a host drives through communication steps.

    Made by `from_file` or `from_string`. It ends with `close`, at the end of a `with`, or with the object and its
    ports; later calls raise DeadHandleError. One thread at a time may use it; any other gets BusyError.

    Inputs act from the start of the next step on, or are reached at its end (see `interpolation`), and hold until
    they are set anew. A value that is refused raises InvalidArgumentError, and the old one holds.

    A model goes through pickle as its case and its state, without its log; the copy continues with the same bits. The
    files that the case names must be found at the same place by the process that unpickles it.
    """

    def __init__(self, core: Core, source: Source) -> None:
        self._core, self._source = core, source
        self._blocks, self._contacts, self._events = Rows(_abi.BlockState), Rows(_abi.Contact), Rows(_abi.Event)
        self._threads = 1
        self._ports = Ports(core)

    @classmethod
    def from_file(
        cls, path: str | os.PathLike[str], *, library: Library | str | os.PathLike[str] | None = None
    ) -> Self:
        """Builds the model of a case file; files that the case names are sought beside it. Nothing moves yet.

        `library` is the C library or the path of it; see `load_library`. Raises CaseFileError, or CaseError with
        file, line and key.
        """
        core = Core(_library(library), "enmm_create_from_file", text("path", path))
        toml = Path(path).read_text(encoding="utf-8")
        return cls(core, Source(toml, str(Path(path).absolute().parent), os.fspath(path)))

    @classmethod
    def from_string(
        cls,
        toml: str,
        base_dir: str | os.PathLike[str] | None = None,
        *,
        library: Library | str | os.PathLike[str] | None = None,
    ) -> Self:
        """Builds the model of a case that is given as text in TOML, called "case" in messages.

        `base_dir` is the directory where files that the case names are sought, the current one without. Else as
        `from_file`.
        """
        base = None if base_dir is None else text("base_dir", base_dir)
        core = Core(_library(library), "enmm_create_from_string", text("toml", toml), base)
        return cls(core, Source(toml, str(Path(base_dir or ".").absolute()), "case"))

    def close(self) -> None:
        """Ends the model and gives its memory free. Closing again does nothing."""
        self._core.close()

    @property
    def is_alive(self) -> bool:
        """Whether the model has not been closed."""
        return bool(self._core.close.alive)

    def __reduce__(self) -> tuple[object, ...]:
        return _unpickled_model, (self._source, self.serialize(), self._threads)

    def __repr__(self) -> str:
        if not self.is_alive:
            return f"<enmm.Model {self._source.name!r}, closed>"
        return f"<enmm.Model {self._source.name!r}: {self.block_count} blocks, t = {self.time:g} s>"

    # Time.

    def start(self) -> None:
        """Seeks the initial equilibrium now, under the inputs that have been set.

        This runs the static stages before the first dynamic one; otherwise the first `do_step` does. Does nothing when
        it has been done. Time 0 is its end. Raises StepError, or CaseError when a stage does not fit the model.
        """
        self._core.call("enmm_start")

    def do_step(self, t: float, h: float) -> StepInfo:
        """Advances the model from `t` to exactly `t + h` (s), or not at all.

        `t` must be the time of the model. How a time is split into communication steps does not change results, not
        even in the last bit, when they are multiples of the internal step. After the last stage of the case the model
        goes on in it.

        Raises TimeError; InvalidArgumentError when `h` is not greater than 0 and finite; StepError with block, place
        and cause. The model then still is at `t`, with its inputs.
        """
        raw = self._core.read("enmm_do_step", _abi.StepInfo, number(t), number(h))
        return StepInfo(*(getattr(raw, name) for name in StepInfo._fields))

    @property
    def time(self) -> float:
        """Time of the model (s): 0 at the start of the first dynamic stage."""
        return float(self._core.get("enmm_get_time", c_double))

    @property
    def internal_step(self) -> float:
        """Internal step (s), an integer fraction of a tenth of the communication step."""
        return float(self._core.get("enmm_get_internal_step", c_double))

    @property
    def communication_step(self) -> float:
        """Communication step (s) that the case suggests; hosts may take any other."""
        return float(self._core.get("enmm_get_communication_step", c_double))

    @property
    def stop_time(self) -> float:
        """Time (s) at which the stages of the case end; hosts may go on."""
        return float(self._core.get("enmm_get_stop_time", c_double))

    # Settings.

    @property
    def threads(self) -> int:
        """Number of threads that steps use, 1 to 1024; 1, the thread of the call, at the creation.

        Results do not depend on it, not even in the last bit. A forked process starts as many anew.
        """
        return self._threads

    @threads.setter
    def threads(self, count: int) -> None:
        count = index("threads", count)
        self._core.call("enmm_set_threads", count)
        self._threads = count

    @property
    def interpolation(self) -> Interpolation:
        """How inputs go through a communication step; HOLD at the creation.

        Holds from the next step on, and is part of saved states.
        """
        return Interpolation(self._core.get("enmm_get_interpolation", c_int32))

    @interpolation.setter
    def interpolation(self, mode: Interpolation) -> None:
        self._core.call("enmm_set_interpolation", index("interpolation", mode))

    def set_log(self, callback: LogFunction | None) -> None:
        """Sets the function that gets level and text of every message of this model, or None for none.

        The first one gets the warnings of the case at once. Messages come on the thread of a call to the model, when
        that is otherwise done, so that the function may use the model. An exception that it raises goes on from that
        call, which has been done nevertheless; when the call failed too, it is the cause of that error.
        """
        self._core.set_log(callback)

    @property
    def case_hash(self) -> str:
        """Fingerprint of the case: 16 hexadecimal digits, equal for equal models, part of every serialised state."""
        return self._core.text("enmm_case_hash")

    # Inputs.

    def set_gravity(self, gx: float, gy: float) -> None:
        """Sets gravity (m/s2, x to the right, y upwards; on Earth 0 and -9.81).

        In the initial equilibrium it grows from 0.
        """
        self._core.call("enmm_set_gravity", number(gx), number(gy))

    def set_block_force(self, block: SupportsIndex, fx: float, fy: float, moment: float = 0.0) -> None:
        """Sets force (N/m) through the mass centroid of a block and moment about it (N*m/m, counter-clockwise).

        They take the place of those that were set before, first of those of the port of the case at this block, and add
        to its loads.
        """
        self._core.call("enmm_set_block_force", index("block", block), number(fx), number(fy), number(moment))

    def set_block_forces(
        self, ids: npt.ArrayLike, fx: npt.ArrayLike, fy: npt.ArrayLike, moment: npt.ArrayLike = 0.0
    ) -> None:
        """Sets force (N/m) and moment (N*m/m) of many blocks at once: all, or none when one value is refused.

        `fx`, `fy` and `moment` hold a value for each block of `ids`, or are one for all of them. Where a block is named
        twice the last one counts. Blocks that are not named keep their force.
        """
        blocks = ids_of(ids)
        loads = [values_of(name, values, blocks.size) for name, values in (("fx", fx), ("fy", fy), ("moment", moment))]
        pointers = [pointer(load, c_double) for load in loads]
        self._core.call("enmm_set_block_forces", pointer(blocks, c_uint32), blocks.size, *pointers)

    def set_base_acceleration(self, ax: float, ay: float) -> None:
        """Sets the acceleration of the base (m/s2).

        Displacements and velocities are relative to the base; all rock feels the opposite acceleration.
        It is no part of the initial equilibrium and begins at time 0.
        """
        self._core.call("enmm_set_base_acceleration", number(ax), number(ay))

    def set_water_level(self, y: float) -> None:
        """Sets the height of the water surface (m, in the coordinates of the case). The case must have `[water]`."""
        self._core.call("enmm_set_water_level", number(y))

    def set_boundary_traction(self, port: Port | str | SupportsIndex, tx: float, ty: float) -> None:
        """Sets traction (Pa, global axes, per length before deformation) on a boundary port.

        Positive pushes to the right and upwards.
        """
        self._core.call("enmm_set_boundary_traction", self._port(port), number(tx), number(ty))

    def set_boundary_pressure(self, port: Port | str | SupportsIndex, p: float) -> None:
        """Sets fluid pressure (Pa) on a boundary port; positive pushes into the rock, normal to its surface now."""
        self._core.call("enmm_set_boundary_pressure", self._port(port), number(p))

    def set_joint_pressure(self, port: Port | str | SupportsIndex, p: float) -> None:
        """Sets fluid pressure (Pa) in the joints of a joint port; positive pushes both faces into their rock, apart."""
        self._core.call("enmm_set_joint_pressure", self._port(port), number(p))

    def set_strength_factor(self, f: float) -> None:
        """Sets the factor by which cohesion, tan(friction angle) and tensile strength of all joints are multiplied.

        1 is the strength of the case.
        """
        self._core.call("enmm_set_strength_factor", number(f))

    # Observation.

    @property
    def ports(self) -> Ports:
        """Ports of the case by name."""
        return self._ports

    @property
    def block_count(self) -> int:
        """Number of blocks, excavated ones included. It never changes."""
        return int(self._core.get("enmm_block_count", c_size_t))

    def blocks(self, *, copy: bool = False) -> npt.NDArray[np.void]:
        """State of every block, by id: an array with the fields of `enmm_block_state` (`BLOCK_DTYPE`).

        `BLOCK_FIELDS` has the meaning and the unit of each; for `flags` see BlockFlag.

        The array is a read-only view of a buffer of this model that the next call fills anew: nothing is copied, and
        arrays of earlier calls change with it. With `copy` the array is a new one that stays as it is.
        """
        return self._rows(self._blocks, "enmm_get_block_states", copy)

    def contacts(self, *, copy: bool = False) -> npt.NDArray[np.void]:
        """Contacts of boundary nodes with edges, with the forces of the last internal step (`CONTACT_DTYPE`).

        `state` (see ContactState); `law`, the place of the joint law among the names of the laws in alphabetical order;
        `node_block`, `edge_block`; `position_x`, `position_y` of the node now (m); `normal_x`, `normal_y`, outward from
        the edge; `length` of boundary that the node stands for (m); `normal_stress` (Pa, tension positive);
        `shear_stress` (Pa) on the node, positive along the normal turned by 90 degrees counter-clockwise.

        The array is a view as that of `blocks`; when contacts become more than ever before it is one of a new buffer.
        """
        return self._rows(self._contacts, "enmm_get_contacts", copy)

    def events(self, first: SupportsIndex = 0) -> list[Event]:
        """Events from index `first` on (0: all since the start), in the order of time.

        Going back to a saved state goes back to its events.
        """
        rows = self._rows(self._events, "enmm_get_events", False, index("first", first))
        columns = (rows[name].tolist() for name in ("kind", "subject", "time", "other", "depth"))
        none = {_abi.NO_JOINT: None, _abi.NO_BLOCK: None}
        return [
            Event(EventKind(kind), none.get(of, of), time, none.get(other, other), depth)
            for kind, of, time, other, depth in zip(*columns, strict=True)
        ]

    def energies(self) -> Energies:
        """Energies now and works since the start."""
        raw = self._core.read("enmm_get_energies", _abi.Energies)
        return Energies(*(getattr(raw, name) for name in Energies._fields))

    def totals(self) -> Totals:
        """Sums and extremes over the model."""
        raw = self._core.read("enmm_get_totals", _abi.Totals)
        return Totals(*(getattr(raw, name) for name in Totals._fields))

    def polygon(self, block: SupportsIndex) -> npt.NDArray[np.float64]:
        """Outer outline of a block now, counter-clockwise: a point (m) in each row.

        Cracks that end in the block are part of its outline; for holes see `holes`. Raises NotFoundError for a block
        that has been excavated.
        """
        return self._core.points("enmm_get_block_polygon", index("block", block))

    def holes(self, block: SupportsIndex) -> list[npt.NDArray[np.float64]]:
        """Outlines of the holes of a block now, clockwise: a point (m) in each row. Raises as `polygon`."""
        of = index("block", block)
        count = self._core.get("enmm_block_hole_count", c_size_t, of)
        return [self._core.points("enmm_get_block_hole", of, hole) for hole in range(count)]

    def find_block_at(self, x: float, y: float) -> int:
        """Block at a place (m) now, the lowest id where blocks meet. Raises NotFoundError where no rock is."""
        return int(self._core.get("enmm_find_block_at", c_uint32, number(x), number(y)))

    # Results.

    def record(self, folder: str | os.PathLike[str]) -> Recording:
        """Records results into a folder from now on, as `enmm run` writes them: history, film, frames, at the end
        pictures, checkpoint, page and summary.

        Call it before `start` to have the initial equilibrium. It ends with the `with` of what it returns, with
        `end_record`, or with the model. Rows and frames are due at the times of the case; what a step brings is written
        when the next one begins, and a return to an earlier state removes what is later. No result changes by it.

        Raises CaseFileError when the folder cannot be written, another process writes there, or a result would replace
        an input of the case; InvalidArgumentError when the model is recorded already. When a file cannot be written
        later, steps go on, the log gets the error and `end_record` raises it.
        """
        self._core.call("enmm_record", text("folder", folder))
        return Recording(self, Path(folder))

    def write_frame(self) -> None:
        """Writes a row of the history, a frame of the film and frames for ParaView of this instant at once.

        A host that repeats steps calls it when a step stands. Raises InvalidArgumentError when nothing is recorded, and
        CaseFileError.
        """
        self._core.call("enmm_write_frame")

    def end_record(self) -> None:
        """Ends the recording with pictures, checkpoint, page and summary.

        Raises InvalidArgumentError when nothing is recorded, and CaseFileError when a file could not be written, now or
        before; the recording has ended in any case.
        """
        self._core.call("enmm_end_record")

    # Saved states.

    def save(self) -> State:
        """Saves all that the model needs to go on from here with the same bits.

        That is motion, contacts, stage, time, events and inputs.
        """
        return self._state("enmm_state_save")

    def restore(self, state: State) -> None:
        """Goes back to a saved state of this model, or of another model of the same case.

        The state can be used again. Raises StateError for a state of another case; the model then stays as it is.
        """
        self._core.call("enmm_state_restore", state.handle)

    def serialize(self, state: State | None = None) -> bytes:
        """A state, without one that of now, as bytes for a file or another process.

        They contain version, hash of the case and checksum. Raises StateError for a state of another case.
        """
        if state is None:
            with self.save() as now:
                return self.serialize(now)
        return _serialized(self._core, state)

    def deserialize(self, data: bytes | bytearray | memoryview) -> State:
        """Makes a state of bytes that `serialize` gave, in this process or another, or of a `checkpoint.enmm` of a run.

        Raises StateError for bytes that are damaged, or of another case or version.
        """
        # A view refuses what is no buffer, of which `bytes` would make zeros or a copy.
        whole = bytes(memoryview(data))
        return self._state("enmm_state_deserialize", whole, len(whole))

    def _state(self, name: str, *arguments: object) -> State:
        handle = c_void_p()
        self._core.call(name, *arguments, byref(handle))
        return State(self._core.library, handle, self._source, self._core)

    def _rows(self, rows: Rows, name: str, copy: bool, *arguments: object) -> npt.NDArray[np.void]:
        view = rows.fill(lambda *buffer: self._core.call(name, *arguments, *buffer))
        return view.copy() if copy else view

    def _port(self, port: Port | str | SupportsIndex) -> int:
        if isinstance(port, str):
            return self._ports[port].index
        if not isinstance(port, Port):
            return index("port", port)
        if not port.belongs_to(self._core):
            raise invalid(f"port: {port.name!r} is one of another model; use that of this one")
        return port.index


def _library(given: Library | str | os.PathLike[str] | None) -> Library:
    return given if isinstance(given, Library) else load_library(given)
