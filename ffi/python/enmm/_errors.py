"""What can go wrong, as exceptions: one class for each status of the C library."""

import contextlib
import os
import sys
import warnings
from collections.abc import Iterable
from enum import IntEnum


class Status(IntEnum):
    """Status of a call (`enmm_status`)."""

    OK = 0
    NULL_ARGUMENT = 1
    DEAD_HANDLE = 2
    BUSY = 3
    INVALID_ARGUMENT = 4
    INVALID_CASE = 5
    FILE_ERROR = 6
    WRONG_TIME = 7
    NUMERICAL_FAILURE = 8
    BUFFER_TOO_SMALL = 9
    NOT_FOUND = 10
    WRONG_STATE = 11
    PANIC = 12
    INTERRUPTED = 13


class EnmmWarning(UserWarning):
    """Something that a user should know of a case or its results; `warnings.filterwarnings` chooses what it does."""


class EquilibriumWarning(EnmmWarning):
    """The model was not at rest at the end of its initial equilibrium, or the slope failed in it."""


_INNER = (os.path.dirname(__file__), contextlib.__file__)
"""Files whose calls are none of a user's."""


def warn(texts: Iterable[str], kind: type[EnmmWarning] = EnmmWarning) -> None:
    """Warns of the line that called the package."""
    depth, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_INNER):
        depth, frame = depth + 1, frame.f_back
    for text in texts:
        warnings.warn(text, kind, stacklevel=depth)


class LibraryError(OSError):
    """The C library was not found, cannot be loaded, or does not fit this package."""


class EnmmError(Exception):
    """A call that failed and changed nothing.

    `status` is that of the C library: a `Status`, or a plain number that this package does not know. The text has
    the fault, the value, the limit and the remedy.
    """

    status: int

    def __init__(self, message: str, status: int) -> None:
        super().__init__(message)
        self.status = status

    def __str__(self) -> str:
        return str(self.args[0])

    def __reduce__(self) -> tuple[type["EnmmError"], tuple[str, int]]:
        return type(self), (str(self), self.status)


class NullArgumentError(EnmmError):
    """A pointer or handle is NULL that must not be."""


class DeadHandleError(EnmmError):
    """The model or state was closed."""


class BusyError(EnmmError):
    """Another thread is using the model."""


class InvalidArgumentError(EnmmError, ValueError):
    """A value is not finite or out of range, or names something that does not exist."""


class CaseError(EnmmError, ValueError):
    """The case cannot be used; the message has file, line and key."""


class CaseFileError(EnmmError, OSError):
    """A file cannot be read."""


class TimeError(EnmmError, ValueError):
    """A communication step does not begin at the time of the model."""


class StepError(EnmmError, ArithmeticError):
    """The step failed numerically; the model stands where it stood before the call."""


class BufferTooSmallError(EnmmError):
    """A buffer is too small; this package makes them large enough."""


class NotFoundError(EnmmError, KeyError):
    """There is no such port, or no rock at this place."""


class StateError(EnmmError, ValueError):
    """The state is of another case or version, or its bytes are damaged."""


class PanicError(EnmmError):
    """An internal error of the library; the model can only be closed, all others are unharmed."""


class CallInterruptedError(EnmmError):
    """The call was ended by `Model.interrupt` or by its progress function; the model is as it was before the call."""


_CLASSES: dict[int, type[EnmmError]] = {
    Status.NULL_ARGUMENT: NullArgumentError,
    Status.DEAD_HANDLE: DeadHandleError,
    Status.BUSY: BusyError,
    Status.INVALID_ARGUMENT: InvalidArgumentError,
    Status.INVALID_CASE: CaseError,
    Status.FILE_ERROR: CaseFileError,
    Status.WRONG_TIME: TimeError,
    Status.NUMERICAL_FAILURE: StepError,
    Status.BUFFER_TOO_SMALL: BufferTooSmallError,
    Status.NOT_FOUND: NotFoundError,
    Status.WRONG_STATE: StateError,
    Status.PANIC: PanicError,
    Status.INTERRUPTED: CallInterruptedError,
}


def error_of(status: int, message: str) -> EnmmError:
    """The exception of a status; a status of a newer library gives the common class."""
    if status not in _CLASSES:
        return EnmmError(message or f"the library gave the unknown status {status}", status)
    return _CLASSES[status](message, Status(status))


def invalid(message: str) -> InvalidArgumentError:
    """The refusal of a value that C could not even be given."""
    return InvalidArgumentError(message, Status.INVALID_ARGUMENT)
