"""Models and saved states."""

import ctypes
import os
import weakref
from collections.abc import Generator, Mapping
from contextlib import contextmanager, suppress
from ctypes import byref, c_double, c_int32, c_size_t, c_uint32, c_void_p
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Self, SupportsIndex

import numpy as np
import numpy.typing as npt

from . import _abi, _html, _plots
from ._abi import EventKind, Input, Interpolation, LogLevel, NameKind, SectionFailure
from ._case import checked_text
from ._closing import Closing
from ._core import Core, LogFunction, ProgressFunction, Rows, dtype_of, ids_of, index, pointer, text
from ._core import unheard, values_of
from ._errors import BusyError, DeadHandleError, EquilibriumWarning, Status, invalid, warn
from ._library import Library, load_library
from ._mapping import number_of
from ._options import number, numbers, path
from ._parameters import Parameters
from ._ports import Port, Ports
from ._types import CUT_FIELDS, Cut, Event, FlowInputs, Inputs, PortInputs
from ._values import (
    Energies,
    InletState,
    JointMonitorState,
    MonitorState,
    MonitorStress,
    StartInfo,
    StepInfo,
    Totals,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
    """What a model was made of: text of its case, directory of the files that it names, name, parameters."""

    toml: str
    base_dir: str
    name: str
    parameters: tuple[tuple[str, float], ...] = ()

    def model(self) -> "Model":
        """Builds the model once more, by the library that this process finds; its warnings have been given."""
        model = Model.from_string(self.toml, self.base_dir, log=unheard)
        model.set_log(None)
        if self.parameters:
            model.parameters.update(dict(self.parameters))
        return model


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

    __slots__ = (
        "__weakref__",
        "_blocks",
        "_case",
        "_contacts",
        "_core",
        "_cuts",
        "_events",
        "_is_started",
        "_names",
        "_parameters",
        "_ports",
        "_threads",
        "_untold",
    )

    def __init__(self, core: Core | None = None, source: Source | None = None) -> None:
        if not isinstance(core, Core) or source is None:
            raise TypeError("a Model is made by `Model.from_file(path)`, `Model.from_string(toml)` or `case.model()`")
        self._core, self._case = core, source
        self._blocks, self._contacts, self._events = Rows(_abi.BlockState), Rows(_abi.Contact), Rows(_abi.Event)
        self._cuts = Rows(_abi.Cut)
        self._threads = 1
        self._ports = Ports(core)
        self._parameters = Parameters(core)
        self._is_started = False
        self._names: dict[NameKind, tuple[str, ...]] = {}
        self._untold: list[tuple[LogLevel, str]] = []

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        library: Library | str | os.PathLike[str] | None = None,
        log: LogFunction | None = None,
    ) -> Self:
        """Builds the model of a case file; files that the case names are sought beside it. Nothing moves yet.

        `library` is the C library or the path of it; see `load_library`. `log` gets messages, as by `set_log`; without
        it each warning of the case is an EnmmWarning. Raises CaseFileError, or CaseError with file, line and key.
        """
        place = _path(path)
        core = Core(_library(library), "enmm_create_from_file", text("path", place))
        toml = place.read_text(encoding="utf-8-sig")
        return cls(core, Source(toml, str(place.absolute().parent), str(place)))._hearing(log)

    @classmethod
    def from_string(
        cls,
        toml: str,
        base_dir: str | os.PathLike[str] | None = None,
        *,
        library: Library | str | os.PathLike[str] | None = None,
        log: LogFunction | None = None,
    ) -> Self:
        """Builds the model of a case that is given as text in TOML, called "case" in messages.

        `base_dir` is the directory where files that the case names are sought, the current one without. Else as
        `from_file`.
        """
        place = path("base_dir", base_dir or ".")
        base = None if base_dir is None else text("base_dir", place)
        core = Core(_library(library), "enmm_create_from_string", text("toml", checked_text(toml)), base)
        return cls(core, Source(toml, str(place.absolute()), "case"))._hearing(log)

    def _hearing(self, log: LogFunction | None) -> Self:
        """Lets a function get messages from the beginning; without one the warnings of the case are warned of."""
        if log is not None:
            self.set_log(log)
            return self
        self._core.set_log(lambda level, message: self._untold.append((level, message)))
        self._core.set_log(None)
        warn((message for level, message in self._untold if level <= LogLevel.WARNING))
        return self

    def close(self) -> None:
        """Ends the model and gives its memory free. Closing again does nothing."""
        self._core.close()

    @property
    def is_alive(self) -> bool:
        """Whether the model has not been closed."""
        return bool(self._core.close.alive)

    def __reduce__(self) -> tuple[object, ...]:
        return _unpickled_model, (self._source, self.serialize(), self._threads)

    @property
    def _source(self) -> Source:
        """What it was made of, with the parameters that were set before the start."""
        return self._case._replace(parameters=tuple(self._parameters.built.items()))

    def __repr__(self) -> str:
        if not self.is_alive:
            return f"<enmm.Model {self._source.name!r}, closed>"
        return f"<enmm.Model {self._source.name!r}: {self.block_count} blocks, t = {self.time:g} s>"

    # Time.

    def start(self, *, progress: ProgressFunction | None = None) -> StartInfo:
        """Seeks the initial equilibrium now, under the inputs that have been set.

        This runs the static stages before the first dynamic one; otherwise the first `do_step` does. Does nothing when
        it has been done. Time 0 is its end. Raises StepError, CaseError when a stage does not fit the model, or what
        ends the call early; see `do_step`.

        Warns by EquilibriumWarning when the model did not come to rest or the slope failed on the way, which is no
        error; so does the first `do_step` where it seeks the equilibrium.
        """
        with self._core.watched(progress), self._seeking():
            self._core.call("enmm_start")
        return self.start_info()

    def start_info(self) -> StartInfo:
        """How the search for the initial equilibrium ended."""
        raw = self._core.read("enmm_get_start_info", _abi.StartInfo)
        return StartInfo(*(getattr(raw, name) for name in StartInfo._fields))

    @contextmanager
    def _seeking(self) -> Generator[None]:
        """Warns of an equilibrium that a call within it seeks and does not reach."""
        if self._is_started or self.start_info().started:
            self._is_started = True
            yield
            return
        yield
        info = self.start_info()
        self._is_started = bool(info.started)
        if not info.settled:
            text = f"the model is not at rest at time 0 (unbalanced ratio {info.unbalanced:.2e})"
            remedy = "the slope moves, or its static stage needs a longer duration"
            warn([f"{text}: {remedy}"], EquilibriumWarning)
        elif info.failed:
            warn(["the slope has failed in the initial equilibrium"], EquilibriumWarning)

    def do_step(self, t: float, h: float, *, progress: ProgressFunction | None = None) -> StepInfo:
        """Advances the model from `t` to exactly `t + h` (s), or not at all.

        `t` must be the time of the model. How a time is split into communication steps does not change results, not
        even in the last bit, when they are multiples of the internal step. After the last stage of the case the model
        goes on in it.

        Raises TimeError; InvalidArgumentError when `h` is not greater than 0 and finite; StepError with block, place
        and cause. The model then still is at `t`, with its inputs.

        `progress` gets a Progress at most every 50 ms, on the thread of the call; other calls to the model raise
        BusyError there. An exception that it raises, and the KeyboardInterrupt of Ctrl+C in the main thread, end the
        call within 50 ms, or an internal step if that takes longer, and so does `interrupt` with CallInterruptedError;
        the model then is as it was before the call.
        """
        with self._core.watched(progress), self._seeking():
            raw = self._core.read("enmm_do_step", _abi.StepInfo, *numbers(t=t, h=h))
        return StepInfo(*(getattr(raw, name) for name in StepInfo._fields))

    def interrupt(self) -> None:
        """Ends the `start` or `do_step` that is in progress in another thread, which raises CallInterruptedError.

        Without such a call it does nothing: a call forgets what came before it.
        """
        self._core.call("enmm_interrupt")

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

    def set_interpolation_of(self, input: Input, mode: Interpolation, of: SupportsIndex = 0) -> None:
        """Sets how one input goes through a communication step; `of` is the block, port, head, rain or drain.

        Holds from the next step on, and is part of saved states. `interpolation` sets that of all inputs.
        """
        whole = index("input", input), index("of", of), index("mode", mode)
        self._core.call("enmm_set_input_interpolation", *whole)

    def set_log(self, callback: LogFunction | None) -> None:
        """Sets the function that gets level and text of every message of this model, or None for none.

        The first one gets the warnings of the case at once. Messages come on the thread of a call to the model, when
        that is otherwise done, so that the function may use the model. An exception that it raises goes on from that
        call, which has been done nevertheless; when the call failed too, it is the cause of that error.
        """
        self._core.set_log(callback)
        if callback is not None:
            told, self._untold = self._untold, []
            for level, message in told:
                callback(level, message)

    @property
    def case_hash(self) -> str:
        """Fingerprint of the case: 16 hexadecimal digits, equal for equal models, part of every serialised state."""
        return self._core.text("enmm_case_hash")

    # Inputs.

    def set_gravity(self, gx: float, gy: float) -> None:
        """Sets gravity (m/s2, x to the right, y upwards; on Earth 0 and -9.81).

        In the initial equilibrium it grows from 0.
        """
        self._core.call("enmm_set_gravity", *numbers(gx=gx, gy=gy))

    def set_block_force(self, block: SupportsIndex, fx: float, fy: float, moment: float = 0.0) -> None:
        """Sets force (N/m) through the mass centroid of a block and moment about it (N*m/m, counter-clockwise).

        They take the place of those that were set before, first of those of the port of the case at this block, and add
        to its loads.
        """
        self._core.call("enmm_set_block_force", index("block", block), *numbers(fx=fx, fy=fy, moment=moment))

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
        self._core.call("enmm_set_base_acceleration", *numbers(ax=ax, ay=ay))

    def set_water_level(self, y: float) -> None:
        """Sets the height of the water surface (m, in the coordinates of the case). The case must have `[water]`."""
        self._core.call("enmm_set_water_level", number("y", y))

    def set_boundary_traction(self, port: Port | str | SupportsIndex, tx: float, ty: float) -> None:
        """Sets traction (Pa, global axes, per length before deformation) on a boundary port.

        Positive pushes to the right and upwards.
        """
        self._core.call("enmm_set_boundary_traction", self._port(port), *numbers(tx=tx, ty=ty))

    def set_boundary_pressure(self, port: Port | str | SupportsIndex, p: float) -> None:
        """Sets fluid pressure (Pa) on a boundary port; positive pushes into the rock, normal to its surface now."""
        self._core.call("enmm_set_boundary_pressure", self._port(port), number("p", p))

    def set_joint_pressure(self, port: Port | str | SupportsIndex, p: float) -> None:
        """Sets fluid pressure (Pa) in the joints of a joint port; positive pushes both faces into their rock, apart."""
        self._core.call("enmm_set_joint_pressure", self._port(port), number("p", p))

    def set_port_velocity(self, port: Port | str | SupportsIndex, vx: float, vy: float) -> None:
        """Sets the velocity (m/s) of the supports of a held place, or of the wave that comes in at a quiet boundary.

        It acts in dynamic stages, beside what the case says.
        """
        self._core.call("enmm_set_port_velocity", self._port(port), *numbers(vx=vx, vy=vy))

    def set_port_displacement(self, port: Port | str | SupportsIndex, ux: float, uy: float) -> None:
        """Sets the displacement (m) that the supports of a held place have reached at the end of the next step.

        It counts from their place before a host has moved them. They go there at a steady velocity, and stay.
        """
        self._core.call("enmm_set_port_displacement", self._port(port), *numbers(ux=ux, uy=uy))

    def set_head(self, head: str | SupportsIndex, level: float) -> None:
        """Sets the level (m) of a head of water in joints, by its name or its place in the case.

        It acts where the flow is found: at the start of static stages, and in dynamic ones with `flow = "steady"` or
        `"transient"`. A model whose flow is held from now on raises InvalidArgumentError.
        """
        self._core.call("enmm_set_head", self._inlet(NameKind.HEAD, head), number("level", level))

    def set_rain(self, rain: str | SupportsIndex, rate: float) -> None:
        """Sets the rate (m/s, that is m3/s on each m2 in plan) of rain on joints; it acts as `set_head` does."""
        self._core.call("enmm_set_rain", self._inlet(NameKind.RAIN, rain), number("rate", rate))

    def set_drain(self, drain: str | SupportsIndex, is_active: bool) -> None:
        """Lets a drain act or not; a switch, which is never interpolated and else acts as `set_head` does."""
        self._core.call("enmm_set_drain", self._inlet(NameKind.DRAIN, drain), int(bool(is_active)))

    def jump(self) -> None:
        """Makes all inputs that have been set since the last step act at once from the start of the next one.

        That is what a lost anchor does, also where inputs are interpolated. What is set after this call goes its way
        from there.
        """
        self._core.call("enmm_jump")

    @property
    def inputs(self) -> Inputs:
        """Gravity, acceleration of the base, height of the water and factor on strengths that are set now."""
        gravity, base = (c_double * 2)(), (c_double * 2)()
        level, factor = c_double(), c_double()
        self._core.call("enmm_get_inputs", gravity, base, byref(level), byref(factor))
        return Inputs(tuple(gravity), tuple(base), level.value, factor.value)

    @property
    def flow_inputs(self) -> FlowInputs:
        """Levels of heads, rates of rain and which drains act, as they are set now."""

        def given(kind: NameKind) -> dict[str, float]:
            names = enumerate(self.names(kind))
            return {name: self._core.get("enmm_get_inlet_input", c_double, kind, k) for k, name in names}

        drains = {name: value != 0.0 for name, value in given(NameKind.DRAIN).items()}
        return FlowInputs(given(NameKind.HEAD), given(NameKind.RAIN), drains)

    def block_force(self, block: SupportsIndex) -> tuple[float, float, float]:
        """Force x, y (N/m) and moment (N*m/m) that are set on a block now."""
        force, moment = (c_double * 2)(), c_double()
        self._core.call("enmm_get_block_force", index("block", block), force, byref(moment))
        return force[0], force[1], moment.value

    def port_inputs(self, port: Port | str | SupportsIndex) -> PortInputs:
        """Traction, pressure and velocity that are set on a port now; 0 where its kind takes no such input."""
        traction, pressure, velocity = (c_double * 2)(), c_double(), (c_double * 2)()
        self._core.call("enmm_get_port_inputs", self._port(port), traction, byref(pressure), velocity)
        return PortInputs(tuple(traction), pressure.value, tuple(velocity))

    def set_strength_factor(self, f: float) -> None:
        """Sets the factor by which cohesion, tan(friction angle) and tensile strength are multiplied.

        It acts on all joints, and on rock that yields or breaks; 1 is the strength of the case.
        """
        self._core.call("enmm_set_strength_factor", number("f", f))

    @property
    def parameters(self) -> Parameters:
        """Parameters of the case by name, such as "joint_law.weak.friction", to be read and set."""
        return self._parameters

    # Observation.

    @property
    def ports(self) -> Ports:
        """Ports of the case by name."""
        return self._ports

    @property
    def block_count(self) -> int:
        """Number of blocks, excavated ones included.

        It grows when rock breaks and when a stage parts blocks; blocks that are there keep their ids.
        """
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
            Event(EventKind(kind), none.get(of, of), time, none.get(other, other), depth, self._name_of(kind, of))
            for kind, of, time, other, depth in zip(*columns, strict=True)
        ]

    @property
    def cuts(self) -> list[Cut]:
        """Sections of rock that have broken so far, in order. Going back to a saved state goes back to its own."""
        rows = self._rows(self._cuts, "enmm_get_cuts", False)
        fields = [rows[name].tolist() for name in CUT_FIELDS]
        return [
            Cut(block, part, SectionFailure(failure), time, (a, b), (c, d), *others)
            for block, part, failure, time, a, b, c, d, *others in zip(*fields, strict=True)
        ]

    @property
    def blocks_max(self) -> int:
        """Most blocks that the model can have: those of its last stage, and `fracture.parts_max` more.

        The latter only where rock can break.
        """
        return int(self._core.get("enmm_blocks_max", c_size_t))

    def _name_of(self, kind: int, subject: int) -> str | None:
        """Name of the subject of an event."""
        if subject == _abi.NO_JOINT:
            return None
        if kind in (EventKind.SLIPPED, EventKind.BROKEN):
            return self.names(NameKind.JOINT)[subject]
        return self._core.text("enmm_name", NameKind.BLOCK, subject)

    def names(self, kind: NameKind) -> tuple[str, ...]:
        """Names of all things of a kind, by their numbers. They never change, but parts of blocks come behind.

        What the case does not name has a stand-in: "joint[2]" is a joint of the case by its place there,
        "bedding trace 4" (or "joint_set[1] trace 4") a trace of a joint set, "rock bridge 7" a rock bridge, "trace 9"
        any other joint trace, which a region of another law has parted or which surrounds an island, and "block 3" a
        block.
        """
        kind = NameKind(kind)
        if kind is NameKind.BLOCK or kind not in self._names:
            count = self._core.get("enmm_name_count", c_size_t, kind)
            self._names[kind] = tuple(self._core.text("enmm_name", kind, k) for k in range(count))
        return self._names[kind]

    def monitor(self, monitor: str | SupportsIndex) -> MonitorState:
        """State of a monitor of the case, by its name or its place there. Raises NotFoundError for another name."""
        of = self._named(NameKind.MONITOR, monitor) if isinstance(monitor, str) else index("monitor", monitor)
        raw = self._core.read("enmm_get_monitor_state", _abi.MonitorState, of)
        return MonitorState(*(getattr(raw, name) for name in MonitorState._fields))

    def monitor_stress(self, monitor: str | SupportsIndex) -> MonitorStress:
        """Stress at a monitor of the case with `stress = true`; NaN where the rock has been excavated.

        Raises NotFoundError for another name, InvalidArgumentError for a monitor that reads no stress.
        """
        of = self._named(NameKind.MONITOR, monitor) if isinstance(monitor, str) else index("monitor", monitor)
        raw = self._core.read("enmm_get_monitor_stress", _abi.MonitorStress, of)
        return MonitorStress(*(getattr(raw, name) for name in MonitorStress._fields))

    def joint_monitor(self, monitor: str | SupportsIndex) -> JointMonitorState:
        """State of a monitor of a joint, by its name or its place in the case; NaN where a side has been excavated.

        Raises NotFoundError for another name.
        """
        of = self._named(NameKind.JOINT_MONITOR, monitor) if isinstance(monitor, str) else index("monitor", monitor)
        raw = self._core.read("enmm_get_joint_monitor_state", _abi.JointMonitorState, of)
        return JointMonitorState(*(getattr(raw, name) for name in JointMonitorState._fields))

    def head(self, head: str | SupportsIndex) -> InletState:
        """Water that flows at a head of the case, by its name or its place there. Raises NotFoundError."""
        return self._inlet_state(NameKind.HEAD, head)

    def rain(self, rain: str | SupportsIndex) -> InletState:
        """Water that joints take from rain of the case, by its name or its place there. Raises NotFoundError."""
        return self._inlet_state(NameKind.RAIN, rain)

    def drain(self, drain: str | SupportsIndex) -> InletState:
        """Water that flows at a drain of the case, by its name or its place there. Raises NotFoundError."""
        return self._inlet_state(NameKind.DRAIN, drain)

    def _inlet_state(self, kind: NameKind, of: str | SupportsIndex) -> InletState:
        raw = self._core.read("enmm_get_inlet_state", _abi.InletState, kind, self._inlet(kind, of))
        return InletState(*(getattr(raw, name) for name in InletState._fields))

    def _inlet(self, kind: NameKind, of: str | SupportsIndex) -> int:
        return self._named(kind, of) if isinstance(of, str) else index(kind.name.lower(), of)

    def _named(self, kind: NameKind, name: str) -> int:
        return number_of(kind.name.lower(), name, {name: k for k, name in enumerate(self.names(kind))})

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

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draws the blocks where they are now by matplotlib, in the colour of their displacement; returns the axes."""
        return _plots.model(self, ax)

    def _repr_html_(self) -> str:
        if not self.is_alive:
            return _html.facts([("model", repr(self))])
        rows = [("case", self._source.name), ("time", f"{self.time:g} s"), ("blocks", str(self.block_count))]
        rows += [("port", f"{name}: {port.kind.name.lower()}") for name, port in self.ports.items()]
        moved = f"{self.totals().displacement_max:.4g} m"
        return _html.facts([*rows, ("largest displacement", moved)])

    def find_block_at(self, x: float, y: float) -> int:
        """Block at a place (m) now, the lowest id where blocks meet. Raises NotFoundError where no rock is."""
        return int(self._core.get("enmm_find_block_at", c_uint32, *numbers(x=x, y=y)))

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
        place = path("folder", folder)
        self._core.call("enmm_record", text("folder", place))
        return Recording(self, place)

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

    def restore(self, state: State, *, keep_parameters: bool = False) -> None:
        """Goes back to a saved state of this model, or of another model of the same case.

        The state can be used again, and brings its parameters along. With `keep_parameters` it may be one of a model
        that differs in values of parameters, and this model keeps its own. Raises StateError for a state of another
        case; the model then stays as it is.
        """
        _check_state(state)
        self._core.call("enmm_state_restore_with", state.handle, _abi.KEEP_PARAMETERS if keep_parameters else 0)
        self._is_started = False

    def serialize(self, state: State | None = None) -> bytes:
        """A state, without one that of now, as bytes for a file or another process.

        They contain version, hash of the case and checksum. Raises StateError for a state of another case.
        """
        if state is None:
            with self.save() as now:
                return self.serialize(now)
        _check_state(state)
        return _serialized(self._core, state)

    def deserialize(self, data: bytes | bytearray | memoryview, *, keep_parameters: bool = False) -> State:
        """Makes a state of bytes that `serialize` gave, in this process or another, or of a `checkpoint.enmm` of a run.

        With `keep_parameters` the bytes may be of a model that differs in values of parameters; the state then has
        those of this model. Raises StateError for bytes that are damaged, or of another case or version.
        """
        try:
            # A view refuses what is no buffer, of which `bytes` would make zeros or a copy.
            whole = bytes(memoryview(data))
        except TypeError:
            kind = type(data).__name__
            raise TypeError(f"data: is of type {kind}, must be the bytes that `serialize` gave") from None
        flags = _abi.KEEP_PARAMETERS if keep_parameters else 0
        return self._state("enmm_state_deserialize_with", whole, len(whole), flags)

    def _state(self, name: str, *arguments: object) -> State:
        handle = c_void_p()
        self._core.call(name, *arguments, byref(handle))
        return State(self._core.library, handle, self._source, self._core)

    def _rows(self, rows: Rows, name: str, copy: bool, *arguments: object) -> npt.NDArray[np.void]:
        def fetch(*buffer: object) -> None:
            self._core.call(name, *arguments, *buffer)

        view = rows.fill(fetch)
        return view.copy() if copy else view

    def _port(self, port: Port | str | SupportsIndex) -> int:
        if isinstance(port, str):
            return self._ports[port].index
        if not isinstance(port, Port):
            return index("port", port)
        if not port.belongs_to(self._core):
            raise invalid(f"port: {port.name!r} is one of another model; use that of this one")
        return port.index


def _check_state(state: State) -> None:
    if not isinstance(state, State):
        kind = type(state).__name__
        raise TypeError(f"state: is of type {kind}, must be a State of `save`, or of `deserialize` for bytes")


def _path(given: str | os.PathLike[str]) -> Path:
    if isinstance(given, Mapping) or hasattr(given, "model"):
        raise TypeError("path: is a case, must be the path of a case file; use `Case.of(case).model()`")
    return path("path", given)


def _library(given: Library | str | os.PathLike[str] | None) -> Library:
    return given if isinstance(given, Library) else load_library(given)
