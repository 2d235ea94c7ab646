"""A handle of the C library with what calls need: buffers, checked arguments, the way of log messages."""

import ctypes
import itertools
import os
import weakref
from collections.abc import Callable, Generator
from contextlib import contextmanager
from ctypes import POINTER, byref, c_double, c_size_t, c_void_p
from typing import Any, NoReturn, SupportsIndex

import numpy as np
import numpy.typing as npt

from . import _abi, _options
from ._abi import LogLevel
from ._errors import BufferTooSmallError, invalid
from ._library import Library
from ._values import Progress

LogFunction = Callable[[LogLevel, str], object]
ProgressFunction = Callable[[Progress], object]


def dtype_of(structure: type[ctypes.Structure]) -> np.dtype[np.void]:
    """The numpy type with the same fields at the same offsets, which older names find, too."""
    names = [field[0] for field in structure._fields_]
    formats = [np.dtype(field[1]) for field in structure._fields_]
    offsets = [getattr(structure, name).offset for name in names]
    older = _abi.OLDER_NAMES.get(structure.__name__, {})
    titles = [older.get(name) for name in names]
    size = ctypes.sizeof(structure)
    layout = {"names": names, "formats": formats, "offsets": offsets, "titles": titles, "itemsize": size}
    return np.dtype(layout)  # type: ignore[call-overload, no-any-return, unused-ignore]


class Rows:
    """A buffer of C structures that calls fill anew, and the numpy view of it."""

    def __init__(self, structure: type[ctypes.Structure]) -> None:
        self._structure = structure
        self._dtype = dtype_of(structure)
        self._make(1)

    def _make(self, capacity: int) -> None:
        self._capacity = capacity
        self._buffer = (self._structure * capacity)()
        self._view: npt.NDArray[np.void] = np.frombuffer(memoryview(self._buffer), self._dtype)
        # What is written here would not reach the model.
        self._view.flags.writeable = False

    def fill(self, fetch: Callable[[Any, int, Any], None]) -> npt.NDArray[np.void]:
        """Lets `fetch` fill the buffer, a larger one when it must be; returns the view of what was written."""
        written = c_size_t()
        while True:
            self._buffer[0].struct_size = ctypes.sizeof(self._structure)
            try:
                fetch(self._buffer, self._capacity, byref(written))
            except BufferTooSmallError:
                self._make(written.value)
            else:
                return self._view[: written.value]


class Sink:
    """A log function of a host; the library knows it by its key, so that nothing dead is ever followed."""

    def __init__(self, library: Library, function: LogFunction) -> None:
        self.library, self.function = library, function
        self.key = next(_keys)
        _sinks[self.key] = self


_keys = itertools.count(1)
_sinks: "weakref.WeakValueDictionary[int, Sink]" = weakref.WeakValueDictionary()


def _deliver(user: int | None, level: int, message: bytes | None) -> None:
    sink = _sinks.get(user or 0)
    if sink is None:
        return
    try:
        known = LogLevel(level) if level in set(LogLevel) else LogLevel.INFO
        sink.function(known, (message or b"").decode(errors="replace"))
    except BaseException as error:  # Nothing may leave through C; the call that this belongs to raises it.
        sink.library.keep_raised(error)


def _show(core: "Core | None", raw: _abi.Progress) -> None:
    if core is not None and core.progress is not None:
        core.progress(Progress(*(getattr(raw, name) for name in Progress._fields)))


def _keep(core: "Core | None", error: BaseException) -> None:
    if core is not None:
        core.library.keep_raised(error)


def _looks(reference: "weakref.ref[Core]") -> Generator[int, Any, None]:
    """Shows calls in progress to their host, one by each `send`; yields 1 where the call is to end.

    It is a generator because the interpreter handles signals where Python code is entered: the KeyboardInterrupt of
    Ctrl+C comes out of the `yield`, where it is caught. From a function it would come before any `try`, and be lost.
    """
    answer = 0
    while True:
        try:
            while True:
                place = yield answer
                answer = 0
                _show(reference(), place.contents)
        except GeneratorExit:
            return
        except BaseException as error:  # Nothing may leave through C; the call that this belongs to raises it.
            answer = 1
            _keep(reference(), error)


# One for the whole process, so that it is there as long as any library may call it.
_deliver_from_c = _abi.LOG_CALLBACK(_deliver)
_nowhere = _abi.LOG_CALLBACK()


class Core:
    """A model of the library. Its end, by `close` or by the collector, destroys the model."""

    def __init__(self, library: Library, creator: str, *arguments: Any) -> None:
        self.library = library
        handle = c_void_p()
        library.call(creator, *arguments, byref(handle))
        self.handle = handle
        self.close = weakref.finalize(self, library.functions["enmm_destroy"], handle)
        self._sink: Sink | None = None
        self.progress: ProgressFunction | None = None
        looks = _looks(weakref.ref(self))
        next(looks)
        self._look = _abi.PROGRESS_CALLBACK(looks.send)
        self.call("enmm_set_progress_callback", self._look, None)

    def call(self, name: str, *arguments: Any) -> None:
        """Calls a function with the handle of the model before its arguments."""
        self.library.call(name, self.handle, *arguments)

    @contextmanager
    def watched(self, progress: ProgressFunction | None) -> Generator[None]:
        """Shows calls within it to a function; one that a function calls has its own."""
        outer, self.progress = self.progress, progress
        try:
            yield
        finally:
            self.progress = outer

    def get(self, name: str, kind: Any, *arguments: Any) -> Any:
        """A number that a function writes behind its last pointer."""
        value = kind()
        self.call(name, *arguments, byref(value))
        return value.value

    def read(self, name: str, structure: type[ctypes.Structure], *arguments: Any) -> Any:
        """A structure that a function writes behind its last pointer."""
        value = structure()
        value.struct_size = ctypes.sizeof(structure)
        self.call(name, *arguments, byref(value))
        return value

    def text(self, name: str, *arguments: Any) -> str:
        """A text that a function writes."""
        count = c_size_t()
        self.call(name, *arguments, None, 0, byref(count))
        buffer = ctypes.create_string_buffer(count.value)
        self.call(name, *arguments, buffer, count.value, byref(count))
        return buffer.value.decode()

    def points(self, name: str, *arguments: Any) -> npt.NDArray[np.float64]:
        """Points that a function writes, one in each row."""
        count = c_size_t()
        self.call(name, *arguments, None, 0, byref(count))
        xy = np.empty((count.value, 2))
        self.call(name, *arguments, pointer(xy, c_double), count.value, byref(count))
        return xy

    def __reduce__(self) -> NoReturn:
        remedy = "send the model, which pickles, and take `model.ports[name]` or `model.parameters` there"
        raise TypeError(f"ports and parameters go with their model: {remedy}")

    def set_log(self, function: LogFunction | None) -> None:
        """Sets where messages go."""
        if function is not None and not callable(function):
            raise TypeError(f"callback: is {function!r}, must be a function of level and text, or None")
        sink = None if function is None else Sink(self.library, function)
        callback, key = (_nowhere, None) if sink is None else (_deliver_from_c, sink.key)
        before, self._sink = self._sink, sink  # Now, because a message of this call may set another.
        status, message, raised = self.library.attempt("enmm_set_log_callback", self.handle, callback, key)
        if status and self._sink is sink:
            self._sink = before
        self.library.judge(status, message, raised)


def unheard(level: LogLevel, message: str) -> None:
    """The log of a model whose messages another one has given."""


def pointer(array: npt.NDArray[Any], kind: Any) -> Any:
    """Address of the first value of a contiguous array."""
    address: Any = array.ctypes
    return address.data_as(POINTER(kind))


def index(name: str, value: SupportsIndex) -> int:
    """A number that fits into 32 bits: ctypes would cut off the others."""
    whole = _options.index(name, value)
    if not 0 <= whole <= _abi.UINT32_MAX:
        raise invalid(f"{name}: is {whole}, must be at least 0 and at most {_abi.UINT32_MAX}")
    return whole


def text(name: str, value: str | os.PathLike[str]) -> bytes:
    """A text or a path as C takes it."""
    if not isinstance(value, str | os.PathLike):
        raise TypeError(f"{name}: is {value!r}, must be a text")
    encoded = os.fspath(value).encode("utf-8", "surrogateescape")
    if b"\0" in encoded:
        raise invalid(f"{name}: has a zero character, which ends a text in C; take it out")
    return encoded


def ids_of(values: npt.ArrayLike) -> npt.NDArray[np.uint32]:
    """Block ids of any array of whole numbers."""
    array = np.atleast_1d(np.asarray(values))
    if array.ndim != 1:
        raise invalid(f"ids: has {array.ndim} dimensions, must have 1")
    if array.size and array.dtype.kind not in "iu":
        raise invalid(f"ids: holds values of type {array.dtype}, must hold whole numbers")
    for value in array[(array < 0) | (array > _abi.UINT32_MAX)][:1].tolist():
        index("ids", value)
    return np.ascontiguousarray(array, dtype=np.uint32)


def values_of(name: str, values: npt.ArrayLike, count: int) -> npt.NDArray[np.float64]:
    """One number for each block: one for all of them, or as many as there are."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: is {values!r}, must be a number or as many numbers as there are blocks") from None
    if array.shape not in ((), (count,)):
        raise invalid(f"{name}: has the shape {array.shape}, must be a number or have the shape ({count},)")
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))
