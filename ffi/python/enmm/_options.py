"""Options of functions, checked where they are given: what is wrong names the argument, its value and its limits."""

import math
import operator
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, SupportsFloat, SupportsIndex, overload

from ._errors import invalid


def number(name: str, value: SupportsFloat) -> float:
    """A number of any library as Python's."""
    try:
        if not isinstance(value, str | bytes | bytearray):
            return float(value)
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{name}: is {_shown(value)}, must be one number")


def numbers(**values: SupportsFloat) -> list[float]:
    """Numbers by the names of their arguments."""
    return [number(name, value) for name, value in values.items()]


@overload
def real(name: str, value: None, low: float, high: float) -> None: ...
@overload
def real(name: str, value: SupportsFloat, low: float, high: float) -> float: ...
def real(name: str, value: SupportsFloat | None, low: float, high: float) -> float | None:
    """A number within bounds, or None."""
    if value is None:
        return None
    found = number(name, value)
    if math.isnan(found) or not low <= found <= high:
        raise invalid(f"{name}: is {found:g}, must be from {low:g} to {high:g}; leave it out for the default")
    return found


@overload
def whole(name: str, value: None, low: int, high: int) -> None: ...
@overload
def whole(name: str, value: SupportsIndex, low: int, high: int) -> int: ...
def whole(name: str, value: SupportsIndex | None, low: int, high: int) -> int | None:
    """A whole number within bounds, or None."""
    if value is None:
        return None
    found = index(name, value)
    if not low <= found <= high:
        raise invalid(f"{name}: is {found}, must be from {low} to {high}; leave it out for the default")
    return found


def index(name: str, value: SupportsIndex) -> int:
    """A whole number."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: is {_shown(value)}, must be a whole number") from None


def path(name: str, value: "str | os.PathLike[str]") -> Path:
    """A path; `~` is the home of the user."""
    text = os.fspath(value) if isinstance(value, str | os.PathLike) else value
    if not isinstance(text, str):
        raise TypeError(f"{name}: is {_shown(value)}, must be a path: a str or a pathlib.Path")
    return Path(text).expanduser() if text.startswith("~") else Path(text)


def word(name: str, value: str, known: Sequence[str]) -> str:
    """One of a few words."""
    if value not in known:
        raise invalid(f"{name}: is {_shown(value)}, must be one of {', '.join(known)}")
    return value


def words(options: dict[str, Any]) -> list[object]:
    """Options that are given, as the program takes them."""
    given = [(f"--{name.replace('_', '-')}", value) for name, value in options.items()]
    given = [(name, value) for name, value in given if value is not None and value is not False]
    return [word for name, value in given for word in ([name] if value is True else [name, value])]


def _shown(value: object) -> str:
    """A value in a message, no longer than a line."""
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
