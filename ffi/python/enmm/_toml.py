"""Case files as text: tables of Python values to TOML, and keys such as `joint_set[0].seed` in such tables."""

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._errors import invalid

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_PART = re.compile(r"""\.?([A-Za-z0-9_-]+|"[^"]*")|\[(\d+)\]""")


def dumps(table: Mapping[str, Any]) -> str:
    """The TOML of a table. Numbers read back to the same bits; numpy's become Python's."""
    return "\n".join(_lines(plain(table, ""), ())) + "\n"


def plain(value: Any, key: str) -> Any:
    """A value made of Python's dicts, lists, texts and numbers alone. Raises InvalidArgumentError with the key."""
    if isinstance(value, Mapping):
        for name in value:
            if not isinstance(name, str):
                raise invalid(f"{key or 'case'}: has the key {name!r}, must have texts as keys")
        return {name: plain(inner, f"{key}.{name}" if key else name) for name, inner in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist(), key)
    if isinstance(value, list | tuple):
        return [plain(inner, f"{key}[{k}]") for k, inner in enumerate(value)]
    if isinstance(value, bool | int | float | str):
        return value
    remedy = "leave the key out" if value is None else "give a number, text, bool, list or dict"
    raise invalid(f"{key or 'case'}: is {value!r}, which no case file can hold; {remedy}")


def _lines(table: dict[str, Any], place: tuple[str, ...]) -> list[str]:
    tables = {key: value for key, value in table.items() if _is_table(value)}
    lines = [f"{_name(key)} = {_text(value)}" for key, value in table.items() if key not in tables]
    for key, value in tables.items():
        inner = (*place, _name(key))
        single = isinstance(value, dict)
        head = f"[{'.'.join(inner)}]" if single else f"[[{'.'.join(inner)}]]"
        for one in [value] if single else value:
            lines += ["", head, *_lines(one, inner)]
    return lines


def _is_table(value: Any) -> bool:
    rows = isinstance(value, list) and value and all(isinstance(inner, dict) for inner in value)
    return isinstance(value, dict) or bool(rows)


def _name(key: str) -> str:
    return key if _BARE.fullmatch(key) else _text(key)


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_name(key)} = {_text(inner)}' for key, inner in value.items())}}}"
    return repr(value)


def parse_key(key: str) -> list[str | int]:
    """The parts of a key: names, and places in lists from 0 on."""
    parts: list[str | int] = []
    at = 0
    while at < len(key):
        found = _PART.match(key, at)
        if found is None or (found[0].startswith(".") and at == 0):
            break
        parts.append(int(found[2]) if found[2] else found[1].strip('"'))
        at = found.end()
    if at < len(key) or not parts or isinstance(parts[0], int):
        raise invalid(f"key: is {key!r}, must be such as joint_law.plane.friction_deg or joint_set[0].seed")
    return parts


def get(table: Any, key: str) -> Any:
    """The value of a key. Raises InvalidArgumentError when there is none."""
    for k, part in enumerate(parse_key(key)):
        table = _step(table, part, key, k)
    return table


def put(table: Any, key: str, value: Any) -> None:
    """Sets the value of a key. The table that it lies in must exist; the key itself may be new."""
    *way, last = parse_key(key)
    for k, part in enumerate(way):
        table = _step(table, part, key, k)
    if isinstance(last, int) or not isinstance(table, dict):
        _step(table, last, key, len(way))
    table[last] = plain(value, key)


def _step(table: Any, part: str | int, key: str, k: int) -> Any:
    if isinstance(part, int):
        if isinstance(table, list) and part < len(table):
            return table[part]
        there = f"it holds {len(table)}, counted from 0" if isinstance(table, list) else "this is no list"
        raise invalid(f"{key}: the case has no entry [{part}] here; {there}")
    if isinstance(table, dict) and part in table:
        return table[part]
    names = ", ".join(table) if isinstance(table, dict) and table else "none"
    what = "key" if k else "table"
    raise invalid(f"{key}: the case has no {what} {part!r} here; there are: {names}")
