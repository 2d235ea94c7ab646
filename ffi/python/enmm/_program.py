"""Finding the program `enmm` and running it."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import IO, Any

from . import _places
from ._case import Case, file_of
from ._errors import CallInterruptedError, CaseError, LibraryError, Status, StepError, invalid
from ._html import Record
from ._kinds import is_dict
from ._library import _folders
from ._options import real

_VARIABLE = "ENMM_PROGRAM"
BAD_INPUT, FAILED, SLOPE_FAILED, INTERRUPTED = 2, 3, 4, 130

CaseLike = Case | str | os.PathLike[str] | Mapping[str, Any]
"""A case, the path of a case file, or the tables of one as a dict."""


def program() -> Path:
    """The program `enmm` that `run`, `fos`, `bound` and `check` call.

    It is sought at the path in the environment variable ENMM_PROGRAM; without that among the scripts of this Python,
    where the wheel puts it, in `target/release` of the repository that the package lies in, and on the PATH. Raises
    LibraryError with all places that were looked at and the remedy.
    """
    name = "enmm.exe" if sys.platform == "win32" else "enmm"
    given = os.environ.get(_VARIABLE)
    if given:
        if Path(given).is_file():
            return Path(given)
        raise LibraryError(f"{_VARIABLE} names {given}, but there is no such file; set it to the program or unset it")
    schemes = [sysconfig.get_path("scripts"), sysconfig.get_path("scripts", f"{os.name}_user")]
    places = [Path(folder) / name for folder in schemes] + [folder / name for folder in _folders()[1:]]
    found = next((place for place in places if place.is_file()), None) or shutil.which(name)
    if found:
        return Path(found)
    looked = "\n".join(f"  {place}" for place in places)
    remedy = f"install the wheel, or build it with `cargo build --release -p enmm-cli` and set {_VARIABLE} to the file"
    raise LibraryError(f"the program enmm was not found; looked for\n{looked}\n  {name} on the PATH\n{remedy}")


@contextmanager
def case_file(case: CaseLike) -> Generator[Path]:
    """The path of a case file; a case that is none yet is written to a temporary one.

    Its name is that of its text, by which the program knows results of another case.
    """
    if not isinstance(case, Case | Mapping):
        yield file_of(case)
        return
    case = Case.of(case)
    import hashlib  # Here, so that the import of the package stays short.

    folder = _places.make()
    try:
        path = folder / f"case-{hashlib.sha256(case.to_toml().encode()).hexdigest()[:12]}.toml"
        case.save(path)
        yield path
    finally:
        _places.remove(folder)


Hear = Callable[[str], bool]
"""Is called with each line as it is printed; whether the line is used up."""


class Leash:
    """What ends programs: each ends with its standard input, whose other end is here."""

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._held: list[IO[str]] = []
        self.is_ended = False

    def hold(self, end: IO[str]) -> None:
        """Takes the other end of a standard input."""
        with self._guard:
            self._held.append(end)
            if self.is_ended:
                end.close()

    def end(self) -> None:
        """Ends the programs that it holds, and those to come."""
        with self._guard:
            self.is_ended = True
            for end in self._held:
                end.close()


LEASH: ContextVar[Leash | None] = ContextVar("LEASH", default=None)
"""The leash of programs that are called in this context; each has one of its own without it."""


def call(
    words: Sequence[object], *, show: bool = False, hear: Hear | None = None, timeout: float | None = None
) -> tuple[int, str, str]:
    """Runs the program; returns its exit status, standard output and error.

    It ends with this process, after `timeout` (s), which is then a TimeoutError, and when an exception leaves; an
    interrupt is passed on to it. `hear` is called with each line of both outputs, unless errors are shown.
    """
    seconds = real("timeout", timeout, 1e-3, 1e9)
    stream = None if show else subprocess.PIPE
    command = [str(program()), "--with-caller", *map(str, words)]
    pipe = subprocess.PIPE
    process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=stream, encoding="utf-8", errors="replace")
    leash, own, late = LEASH.get() or Leash(), Leash(), threading.Event()
    if process.stdin is not None:
        own.hold(process.stdin)
        leash.hold(process.stdin)
        process.stdin = None  # Else `communicate` would close it.

    def end_late() -> None:
        late.set()
        own.end()

    clock = threading.Timer(seconds or 0.0, end_late)
    clock.daemon = True
    with process:
        if seconds is not None:
            clock.start()
        try:
            out, error = process.communicate() if hear is None else _listen(process, hear)
        except BaseException as raised:
            if isinstance(raised, KeyboardInterrupt) and sys.platform != "win32":
                process.send_signal(signal.SIGINT)  # The program then writes its checkpoint.
                process.wait()
            raise
        finally:
            clock.cancel()
            own.end()
    if late.is_set() and process.returncode == INTERRUPTED:
        raise TimeoutError(f"the program enmm had not ended after {seconds:g} s and was ended; give a longer `timeout`")
    if leash.is_ended and process.returncode == INTERRUPTED:
        raise CallInterruptedError("the program enmm was ended before it was done", Status.INTERRUPTED)
    return process.returncode, out, error or ""


def answer(words: Sequence[object], given: str) -> tuple[int, str, str]:
    """Runs a short command that reads its standard input; returns as `call`."""
    command = [str(program()), *map(str, words)]
    done = subprocess.run(command, input=given, capture_output=True, encoding="utf-8", errors="replace", check=False)
    return done.returncode, done.stdout, done.stderr


def _listen(process: "subprocess.Popen[str]", hear: Hear) -> tuple[str, str]:
    """What a process prints until it ends, without the lines that are used up."""
    kept: tuple[list[str], list[str]] = ([], [])
    raised: list[BaseException] = []

    def read(stream: IO[str] | None, lines: list[str]) -> None:
        lines.extend(line for line in stream or () if not hear(line.rstrip("\n")))

    def read_errors() -> None:
        try:
            read(process.stderr, kept[1])
        except BaseException as error:  # Raised by the call, not lost with its thread.
            raised.append(error)
            process.terminate()

    reader = threading.Thread(target=read_errors, daemon=True)
    reader.start()
    read(process.stdout, kept[0])
    process.wait()
    reader.join()
    if raised:
        raise raised.pop()  # Kept by nothing here, so that it ends with its results.
    return "".join(kept[0]), "".join(kept[1])


def record(words: Sequence[object], hear: Hear | None = None, timeout: float | None = None) -> Record:
    """Runs a command that prints one JSON object; raises what it reports as an error."""
    status, out, error = call([*words, "--json"], hear=hear, timeout=timeout)
    found: Any = None
    with suppress(ValueError):
        found = json.loads(out)
    if not is_dict(found):
        raise failure(status, message_of(status, error))
    if "error" in found:
        raise failure(status, in_python(str(found["error"])))
    return Record(found)


def printed(words: Sequence[object]) -> str:
    """Runs a command that prints text; returns it. Raises what it reports as an error."""
    status, out, error = call(words)
    if status:
        raise failure(status, message_of(status, error))
    return out


def message_of(status: int, error: str) -> str:
    """The message of the program: its last error with what follows it."""
    lines = [line.strip() for line in error.splitlines() if line.strip()]
    first = max((k for k, line in enumerate(lines) if line.startswith("error: ")), default=len(lines) - 1)
    if not lines:
        return f"the program ended with the status {status} and no message"
    return in_python(" ".join(lines[first:]).removeprefix("error: "))


def in_python(message: str) -> str:
    """A message of the program with the names of arguments instead of options."""
    message = message.replace("replace them with --force", "replace them by overwrite=True")
    message = re.sub(r"(?<!\S)-o\b", "`output`", message)
    return re.sub(r"(?<![\w-])--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), message)


def failure(status: int, message: str) -> BaseException:
    """The exception for an exit status of the program."""
    if status < 0:
        return ChildProcessError(f"the program enmm was ended by signal {-status}; run it again")
    if status == BAD_INPUT:
        # The parser of the arguments names one; a case has a file.
        is_argument = re.match(r"invalid value|unexpected argument|[a-z_]+: ", message) is not None
        return invalid(message) if is_argument else CaseError(message, Status.INVALID_CASE)
    if status == INTERRUPTED:
        return KeyboardInterrupt(message)
    return StepError(message, Status.NUMERICAL_FAILURE)

