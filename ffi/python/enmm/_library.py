"""Finding and loading the C library, and calling it."""

import ctypes
import os
import sys
import threading
from pathlib import Path
from typing import Any

from . import _abi
from ._errors import LibraryError, Status, error_of

_VARIABLE = "ENMM_LIBRARY"
_REMEDY = (
    "build it with `cargo build --release -p enmm-capi` in the repository of enmm, "
    f"then set {_VARIABLE} to the file, or pass its path as `library`"
)


class Library:
    """The C library, loaded and checked; `load_library` makes it."""

    path: str
    """The file, or the name that the system found it by."""

    def __init__(self, path: str) -> None:
        self.path = path
        try:
            self._dll = ctypes.CDLL(path)
        except OSError as error:
            raise LibraryError(f"{path}: cannot be loaded ({error}); {_REMEDY}") from error
        self.functions: dict[str, Any] = {}
        # Asked for first: a library of another version may lack functions.
        self._declare("enmm_abi_version")
        found = self.functions["enmm_abi_version"]()
        if found != _abi.ABI_VERSION:
            versions = f"has ABI version {found}, this package needs {_abi.ABI_VERSION}"
            raise LibraryError(f"{path}: {versions}; use those of one version")
        for name in _abi.FUNCTIONS:
            self._declare(name)
        self._raised = threading.local()

    def _declare(self, name: str) -> None:
        function = getattr(self._dll, name, None)
        if function is None:
            raise LibraryError(f"{self.path}: has no function {name}, so it is no enmm of this version; {_REMEDY}")
        function.restype, function.argtypes = _abi.FUNCTIONS[name]
        self.functions[name] = function

    @property
    def version(self) -> str:
        """Version of the library, such as "0.1.0"."""
        text: bytes = self.functions["enmm_version"]()
        return text.decode()

    def call(self, name: str, *arguments: Any) -> None:
        """Calls a function that returns a status.

        A failure is raised with the message of this thread. An exception that a callback raised meanwhile is raised
        when the call itself is done, or has been interrupted by it; with another failure it is the cause.
        """
        self.judge(*self.attempt(name, *arguments))

    def attempt(self, name: str, *arguments: Any) -> tuple[int, str, BaseException | None]:
        """Calls a function; returns status, message and the first exception that a callback raised."""
        outer = getattr(self._raised, "list", None)
        raised: list[BaseException] = []
        self._raised.list = raised
        try:
            status: int = self.functions[name](*arguments)
            # Of this thread, and its latest: callbacks run before the library keeps the message of the call.
            message: bytes = self.functions["enmm_last_error"]() if status else b""
        finally:
            self._raised.list = outer
        return status, message.decode(errors="replace"), raised[0] if raised else None

    @staticmethod
    def judge(status: int, message: str, raised: BaseException | None) -> None:
        """Raises what came of a call."""
        if raised is not None and status in (Status.OK, Status.INTERRUPTED):
            raise raised
        if status:
            raise error_of(status, message) from raised

    def keep_raised(self, error: BaseException) -> None:
        """Keeps an exception of a callback for the call that it was made in."""
        raised: list[BaseException] | None = getattr(self._raised, "list", None)
        if raised is not None:
            raised.append(error)


_loaded: dict[str, Library] = {}
_lock = threading.Lock()


def load_library(path: str | os.PathLike[str] | None = None) -> Library:
    """Loads the C library, once for each file.

    It is sought at `path`, which may be its directory; without one in the environment variable ENMM_LIBRARY; without
    that beside this package, in `target/release` of the repository that the package lies in, and where the system
    looks for libraries. A path that is given, either way, is the only one that is tried.

    Raises LibraryError with all places that were looked at and the remedy.
    """
    given = os.fspath(path) if path is not None else os.environ.get(_VARIABLE)
    if given:
        return _load_file(given, "`library`" if path is not None else _VARIABLE)
    name = _file_name()
    places = [folder / name for folder in _folders()]
    for place in places:
        if place.is_file():
            return _load(str(place))
    try:
        return _load(name)
    except LibraryError as error:
        if not isinstance(error.__cause__, OSError):
            raise
        looked = "\n".join(f"  {place}" for place in places)
        message = f"the C library of enmm was not found; looked for\n{looked}\n  {name} of the system\n{_REMEDY}"
        raise LibraryError(message) from error


def _load_file(given: str, origin: str) -> Library:
    file = Path(given)
    if file.is_dir():
        file /= _file_name()
    if not file.is_file():
        raise LibraryError(f"{origin} names {given}, but there is no file {file}; {_REMEDY}")
    return _load(str(file.resolve()))


def _load(path: str) -> Library:
    with _lock:
        if path not in _loaded:
            _loaded[path] = Library(path)
        return _loaded[path]


def _file_name() -> str:
    if sys.platform == "win32":
        return "enmm.dll"
    return "libenmm.dylib" if sys.platform == "darwin" else "libenmm.so"


def _folders() -> list[Path]:
    package = Path(__file__).resolve().parent
    folders = [package]
    for parent in package.parents:
        if (parent / "include" / "enmm.h").is_file() and (parent / "Cargo.toml").is_file():
            target = os.environ.get("CARGO_TARGET_DIR")
            folders += [parent / target / "release"] if target else []
            folders.append(parent / "target" / "release")
            break
    return folders
