"""Finding the program `enmm` and running it."""

import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from ._case import Case
from ._errors import CaseError, CaseFileError, LibraryError, Status, StepError
from ._html import Record
from ._library import _folders

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
def case_file(case: CaseLike) -> Iterator[Path]:
    """The path of a case file; a case that is none yet is written to a temporary one."""
    if isinstance(case, str | os.PathLike):
        if not Path(case).is_file():
            raise CaseFileError(f"{case}: there is no such case file; check the path", Status.FILE_ERROR)
        yield Path(case)
        return
    with tempfile.TemporaryDirectory(prefix="enmm-") as folder:
        path = Path(folder) / "case.toml"
        Case.of(case).save(path)
        yield path


Hear = Callable[[str], bool]
"""Is called with each line as it is printed; whether the line is used up."""


def call(
    words: Sequence[object], *, show: bool = False, given: str | None = None, hear: Hear | None = None
) -> tuple[int, str, str]:
    """Runs the program; returns its exit status, standard output and error. An interrupt is passed on to it.

    `given` is its standard input. `hear` is called with each line of both outputs, unless errors are shown.
    """
    stream = None if show else subprocess.PIPE
    command = [str(program()), *map(str, words)]
    source = subprocess.PIPE if given is not None else None
    with subprocess.Popen(command, stdin=source, stdout=subprocess.PIPE, stderr=stream, encoding="utf-8") as process:
        try:
            out, error = process.communicate(given) if hear is None else _listen(process, hear)
        except KeyboardInterrupt:
            if sys.platform != "win32":
                process.send_signal(signal.SIGINT)  # The program then writes its checkpoint.
            process.wait()
            raise
    return process.returncode, out, error or ""


def _listen(process: "subprocess.Popen[str]", hear: Hear) -> tuple[str, str]:
    """What a process prints until it ends, without the lines that are used up."""
    kept: tuple[list[str], list[str]] = ([], [])

    def read(stream: IO[str] | None, lines: list[str]) -> None:
        lines.extend(line for line in stream or () if not hear(line.rstrip("\n")))

    reader = threading.Thread(target=read, args=(process.stderr, kept[1]), daemon=True)
    reader.start()
    read(process.stdout, kept[0])
    process.wait()
    reader.join()
    return "".join(kept[0]), "".join(kept[1])


def record(words: Sequence[object], hear: Hear | None = None) -> Record:
    """Runs a command that prints one JSON object; raises what it reports as an error."""
    status, out, error = call([*words, "--json"], hear=hear)
    try:
        found = json.loads(out)
    except ValueError:
        found = {"error": message_of(status, error)}
    if isinstance(found, dict) and "error" in found:
        raise failure(status, str(found["error"]))
    return Record(found)


def message_of(status: int, error: str) -> str:
    """The message of the last line of standard error."""
    lines = [line for line in error.splitlines() if line.strip()]
    return lines[-1].removeprefix("error: ") if lines else f"the program ended with the status {status} and no message"


def failure(status: int, message: str) -> BaseException:
    """The exception for an exit status of the program."""
    if status < 0:
        return ChildProcessError(f"the program enmm was ended by signal {-status}; run it again")
    if status == BAD_INPUT:
        return CaseError(message, Status.INVALID_CASE)
    if status == INTERRUPTED:
        return KeyboardInterrupt(message)
    return StepError(message, Status.NUMERICAL_FAILURE)
