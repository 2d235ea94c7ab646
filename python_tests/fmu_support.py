"""FMUs through their C functions alone, in one shape for both versions, so that a test may also call what is wrong."""

import ctypes
import itertools
import shutil
import struct
import subprocess
import zipfile
from contextlib import contextmanager
from ctypes import (
    POINTER,
    byref,
    c_bool,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_int32,
    c_size_t,
    c_uint8,
    c_uint32,
    c_void_p,
)
from dataclasses import dataclass, field
from pathlib import Path

import fmpy

OK, WARNING, DISCARD, ERROR, FATAL = range(5)
CO_SIMULATION = 1

TYPES = {
    2: {"Real": "Real", "Integer": "Integer", "Boolean": "Boolean"},
    3: {"Float64": "Float64", "Int32": "Int32", "Boolean": "Boolean"},
}
C_TYPES = {
    2: {"Real": c_double, "Integer": c_int, "Boolean": c_int},
    3: {"Float64": c_double, "Int32": c_int32, "Boolean": c_bool},
}


def functions_of(fmu) -> list[str]:
    """Functions of the version of an FMU that its library exports, without their `fmi2` or `fmi3`."""
    output = subprocess.run(["nm", "-D", "--defined-only", str(fmu.library)], capture_output=True, text=True, check=True)
    names, prefix = [line.split()[-1] for line in output.stdout.splitlines()], f"fmi{fmu.version}"
    return [name.removeprefix(prefix) for name in names if name.startswith(prefix)]


LOGGER_2 = ctypes.CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p, c_char_p)
LOGGER_3 = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)
UPDATE_3 = ctypes.CFUNCTYPE(
    None, c_void_p, c_double, c_bool, c_bool, c_bool, c_bool, POINTER(c_bool), POINTER(c_double)
)


class Callbacks(ctypes.Structure):
    """`fmi2CallbackFunctions`."""

    _fields_ = [
        ("logger", LOGGER_2),
        ("allocate", c_void_p),
        ("free", c_void_p),
        ("step_finished", c_void_p),
        ("environment", c_void_p),
    ]


def bits(values) -> bytes:
    """The numbers to the last bit; 0.0 and -0.0 differ, and so do two NaN."""
    values = list(values)
    return struct.pack(f"{len(values)}d", *values)


@dataclass(eq=False)
class Fmu:
    """An unpacked FMU."""

    path: Path
    folder: Path
    description: object = field(repr=False, default=None)

    @classmethod
    def unpack(cls, path: Path, folder: Path) -> "Fmu":
        """Unpacks an FMU into a folder."""
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        return cls(path, folder, fmpy.read_model_description(str(folder), validate=False))

    @property
    def version(self) -> int:
        return int(self.description.fmiVersion[0])

    @property
    def case(self) -> str:
        return self.path.name.rsplit("_fmi", 1)[0]

    @property
    def token(self) -> str:
        return self.description.guid if self.version == 2 else self.description.instantiationToken

    @property
    def resources(self) -> Path:
        return self.folder / "resources"

    @property
    def library(self) -> Path:
        """The library for this platform."""
        place = fmpy.platform if self.version == 2 else fmpy.platform_tuple
        (library,) = (self.folder / "binaries" / place).iterdir()
        return library

    @property
    def variables(self) -> dict:
        return {v.name: v for v in self.description.modelVariables}

    def named(self, causality: str) -> list:
        """Variables of a causality, except texts."""
        return [v for v in self.description.modelVariables if v.causality == causality and v.type != "String"]

    def outputs(self) -> list[str]:
        """Names of all outputs that are numbers."""
        return [v.name for v in self.named("output") if v.type != "Binary"]

    def block_outputs(self) -> list[str]:
        """Names of outputs of ports and monitors, which are functions of the state alone."""
        return [name for name in self.outputs() if "." in name]

    def copy_to(self, folder: Path) -> "Fmu":
        shutil.copytree(self.folder, folder)
        return Fmu(self.path, folder, self.description)

    def load(self) -> ctypes.CDLL:
        return load_library(self.library)

    def uri(self) -> str:
        return self.resources.resolve().as_uri()


LIBRARIES: dict[Path, ctypes.CDLL] = {}


def load_library(path: Path) -> ctypes.CDLL:
    """The library at a path; it stays loaded."""
    if path not in LIBRARIES:
        LIBRARIES[path] = ctypes.CDLL(str(path))
    return LIBRARIES[path]


class Instance:
    """An instance of an FMU. Calls return the status; what they tell beside it is kept in the instance."""

    def __init__(self, fmu: Fmu, **options):
        self.fmu, self.version = fmu, fmu.version
        self.library = options.pop("library", None) or fmu.load()
        self.log: list[tuple[int, str, str]] = []
        self.on_log = options.pop("on_log", None)
        self.on_update = options.pop("on_update", None)
        self.early = self.terminate_wanted = self.event_wanted = None
        self.last_time = None
        self.start = 0.0
        make = self._make2 if self.version == 2 else self._make3
        self.pointer = make(
            options.pop("name", "slope"),
            options.pop("token", fmu.token),
            options.pop("resources", fmu.uri() if self.version == 2 else str(fmu.resources) + "/"),
            options.pop("logging", False),
            **options,
        )

    def _heard(self, status, category, text):
        self.log.append((status, category.decode(), text.decode()))
        if self.on_log:
            self.on_log(self)

    def _make2(self, name, token, resources, logging, kind=CO_SIMULATION, callbacks=True):
        def heard(_environment, _name, status, category, form, text):
            assert form == b"%s"
            self._heard(status, category, text)

        self.logger = LOGGER_2(heard)
        self.callbacks = Callbacks(self.logger, None, None, None, None)
        make = self.library.fmi2Instantiate
        make.restype = c_void_p
        make.argtypes = [c_char_p, c_int, c_char_p, c_char_p, c_void_p, c_int, c_int]
        functions = ctypes.addressof(self.callbacks) if callbacks else None
        return make(encoded(name), kind, encoded(token), encoded(resources), functions, 0, int(logging))

    def _make3(self, name, token, resources, logging, early_return=False, event_mode=False, function="CoSimulation"):
        def heard(_environment, status, category, text):
            self._heard(status, category, text)

        def updated(_environment, time, *rest):
            *flags, wanted, when = rest
            answer = self.on_update(self, time, *flags)
            wanted[0] = answer is not None
            when[0] = time if answer is None else answer

        self.logger = LOGGER_3(heard)
        self.updater = UPDATE_3(updated) if self.on_update else UPDATE_3()
        make = getattr(self.library, f"fmi3Instantiate{function}")
        make.restype = c_void_p
        first = [c_char_p, c_char_p, c_char_p, c_bool, c_bool]
        texts = [encoded(text) for text in (name, token, resources)]
        if function != "CoSimulation":
            make.argtypes = [*first, c_void_p, LOGGER_3, c_void_p, c_void_p, c_void_p]
            return make(*texts, False, logging, None, self.logger, None, None, None)
        make.argtypes = [*first, c_bool, c_bool, c_void_p, c_size_t, c_void_p, LOGGER_3, UPDATE_3]
        return make(*texts, False, logging, event_mode, early_return, None, 0, None, self.logger, self.updater)

    # A call by its name without the prefix; the two versions spell some differently.

    def call(self, name: str, *arguments) -> int:
        function = getattr(self.library, f"fmi{self.version}{name}")
        function.restype = c_int
        function.argtypes = None
        return function(c_void_p(self.pointer), *arguments)

    def _state_call(self, stem: str) -> str:
        return stem.replace("State", "state").replace("Deser", "DeSer") if self.version == 2 else stem

    # Life cycle.

    def set_up(self, start=0.0, stop=None, tolerance=None) -> int:
        """Gives the times and enters initialization mode."""
        self.start = start
        times = [c_double(start), self._flag(stop is not None), c_double(stop if stop is not None else 0.0)]
        tolerances = [self._flag(tolerance is not None), c_double(tolerance or 0.0)]
        if self.version == 2:
            status = self.call("SetupExperiment", *tolerances, *times)
            return status or self.call("EnterInitializationMode")
        return self.call("EnterInitializationMode", *tolerances, *times)

    def _flag(self, value):
        return c_int(value) if self.version == 2 else c_bool(value)

    def exit_initialization(self) -> int:
        return self.call("ExitInitializationMode")

    def initialize(self, start=0.0, stop=None, **values) -> "Instance":
        """From instantiated to step mode, with start values."""
        assert self.pointer, self.log
        self.check(self.set_up(start, stop))
        self.check(self.set(values))
        # A warning says that the slope is not at rest, as some start values make it.
        self.check(self.exit_initialization(), WARNING)
        return self

    def check(self, status: int, *others: int):
        assert status in (OK, *others), (status, self.log[-3:])

    def step(self, t: float, h: float) -> int:
        if self.version == 2:
            return self.call("DoStep", c_double(t), c_double(h), c_int(1))
        flags = [c_bool(True) for _ in range(3)]
        time = c_double(-1.0)
        status = self.call("DoStep", c_double(t), c_double(h), c_bool(True), *map(byref, flags), byref(time))
        self.event_wanted, self.terminate_wanted, self.early = (flag.value for flag in flags)
        self.last_time = time.value
        return status

    def run(self, steps: int, h: float, first=0) -> "Instance":
        """Takes `steps` steps from the point `first` of a grid with the spacing h on."""
        for k in range(first, first + steps):
            self.check(self.step(self.start + k * h, h))
        return self

    def terminate(self) -> int:
        return self.call("Terminate")

    def reset(self) -> int:
        return self.call("Reset")

    def free(self):
        if self.pointer:
            function = getattr(self.library, f"fmi{self.version}FreeInstance")
            function.restype, function.argtypes = None, None
            function(c_void_p(self.pointer))
            self.pointer = None

    def __enter__(self) -> "Instance":
        return self

    def __exit__(self, *_):
        self.free()

    # Values.

    def get_raw(self, kind: str, references, n_values=None):
        """Status and values of variables of one type by value reference."""
        count = len(references) if n_values is None else n_values
        values = (C_TYPES[self.version][kind] * count)()
        handles = (c_uint32 * len(references))(*references)
        sizes = [c_size_t(len(references)), values] + ([c_size_t(count)] if self.version == 3 else [])
        return self.call(f"Get{kind}", handles, *sizes), list(values)

    def set_raw(self, kind: str, references, values) -> int:
        array = (C_TYPES[self.version][kind] * len(values))(*values)
        handles = (c_uint32 * len(references))(*references)
        sizes = [c_size_t(len(references)), array] + ([c_size_t(len(values))] if self.version == 3 else [])
        return self.call(f"Set{kind}", handles, *sizes)

    def get(self, *names: str) -> list[float]:
        """Values of variables, arrays flat; every call must succeed."""
        found = []
        for name in names:
            v = self.fmu.variables[name]
            status, values = self.get_raw(v.type, [v.valueReference], size(v))
            self.check(status)
            found += values
        return found

    def set(self, values: dict) -> int:
        """Sets variables by name."""
        for name, value in values.items():
            v = self.fmu.variables[name]
            if status := self.set_raw(v.type, [v.valueReference], [value] if size(v) == 1 else value):
                return status
        return OK

    def everything(self) -> bytes:
        """The bits of all outputs, and of the whole state where it is an output."""
        found = bits(self.get(*self.fmu.outputs()))
        return found + self.snapshot() if self.version == 3 else found

    def snapshot(self) -> bytes:
        reference = c_uint32(self.fmu.variables["snapshot"].valueReference)
        length, data = c_size_t(), c_void_p()
        self.check(self.call("GetBinary", byref(reference), c_size_t(1), byref(length), byref(data), c_size_t(1)))
        return ctypes.string_at(data, length.value)

    def derivative(self, name: str, order=1):
        """Status and derivative of an output."""
        v = self.fmu.variables[name]
        values = (c_double * size(v))()
        function = "GetRealOutputDerivatives" if self.version == 2 else "GetOutputDerivatives"
        sizes = [c_size_t(1), byref(c_int(order)), values] + ([c_size_t(size(v))] if self.version == 3 else [])
        return self.call(function, byref(c_uint32(v.valueReference)), *sizes), list(values)

    def set_rate(self, name: str, rate: float) -> int:
        """Sets the first derivative of an input (FMI 2)."""
        reference, order, value = c_uint32(self.fmu.variables[name].valueReference), c_int(1), c_double(rate)
        return self.call("SetRealInputDerivatives", byref(reference), c_size_t(1), byref(order), byref(value))

    # Saved states.

    def save(self) -> c_void_p:
        state = c_void_p()
        self.check(self.call(self._state_call("GetFMUState"), byref(state)))
        assert state.value
        return state

    def restore(self, state: c_void_p) -> int:
        return self.call(self._state_call("SetFMUState"), state)

    def free_state(self, state: c_void_p) -> int:
        return self.call(self._state_call("FreeFMUState"), byref(state))

    def serialize(self, state: c_void_p) -> bytes:
        length = c_size_t()
        self.check(self.call(self._state_call("SerializedFMUStateSize"), state, byref(length)))
        data = (c_uint8 * length.value)()
        self.check(self.call(self._state_call("SerializeFMUState"), state, data, length))
        return bytes(data)

    def deserialize(self, data: bytes):
        """Status and state."""
        state = c_void_p()
        buffer = (c_char * max(len(data), 1)).from_buffer_copy(data or b"\0")
        status = self.call(self._state_call("DeserializeFMUState"), buffer, c_size_t(len(data)), byref(state))
        return status, state

    # Messages.

    @contextmanager
    def complaint(self, word=""):
        """Within, a call must log an error (with this word)."""
        before = len(self.log)
        yield
        news = self.log[before:]
        assert any(status >= DISCARD and word in text for status, _, text in news), (word, news)


def size(variable) -> int:
    """Number of values of a variable."""
    lengths = [int(dimension.start) for dimension in variable.dimensions]
    return lengths[0] if lengths else 1


def encoded(text):
    return text.encode() if isinstance(text, str) else text


def grid(h: float, end: float):
    """Points of time k*h before the end."""
    return itertools.takewhile(lambda t: t < end - 1e-9, (k * h for k in itertools.count()))
