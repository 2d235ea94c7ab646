"""Case files as text: tables of Python values to TOML, and keys such as `joint_set[0].seed` in such tables."""

import json
import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np

from . import _data
from ._errors import InvalidArgumentError, invalid
from ._kinds import is_dict, is_list

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_PART = re.compile(r"""\.?([A-Za-z0-9_-]+|"[^"]*")|\[(\d+)\]""")


def dumps(table: Mapping[str, Any]) -> str:
    """The TOML of a table. Numbers read back to the same bits; numpy's become Python's."""
    return "\n".join(_lines(plain(table, ""), ())) + "\n"


def plain(value: Any, key: str) -> Any:
    """A value made of Python's dicts, lists, texts and numbers alone. Raises InvalidArgumentError with the key."""
    if isinstance(value, Mapping):
        table: dict[Any, Any] = dict(value)  # type: ignore[arg-type, unused-ignore]
        for name in table:
            if not isinstance(name, str):
                raise invalid(f"{key or 'case'}: has the key {name!r}, must have texts as keys")
        return {name: plain(inner, f"{key}.{name}" if key else name) for name, inner in table.items()}
    if isinstance(value, np.generic):
        return plain(value.item(), key)
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Real | Decimal):
        return float(value)
    if hasattr(value, "__geo_interface__"):
        return plain(_points(value.__geo_interface__, key), key)
    if hasattr(value, "__array__"):
        return plain(np.asarray(value).tolist(), key)
    if isinstance(value, Sequence) and not isinstance(value, bytes | bytearray | memoryview):
        items: list[Any] = list(value)  # type: ignore[arg-type, unused-ignore]
        return [plain(inner, f"{key}[{k}]") for k, inner in enumerate(items)]
    remedy = "leave the key out" if value is None else "give a number, text, bool, list or dict"
    raise invalid(f"{key or 'case'}: is {value!r}, which no case file can hold; {remedy}")


def _points(shape: Mapping[str, Any], key: str) -> Any:
    """The points of a shape: of a polygon those of its outline, each once."""
    match shape:
        case {"type": "Point" | "LineString" | "MultiPoint", "coordinates": points}:
            found = points
        case {"type": "Polygon", "coordinates": [outline]}:
            found = outline[:-1]
        case {"type": "Polygon"}:
            raise invalid(f"{key}: is a polygon with holes, must be one outline; give holes as `domain.holes`")
        case _:
            raise invalid(f"{key}: is a {shape.get('type')}, must be a Point, LineString or Polygon; give each part")
    places = [found] if shape["type"] == "Point" else found
    if any(len(place) != 2 for place in places):
        raise invalid(f"{key}: has points with a z, must be in the plane; drop it, by `shapely.force_2d`")
    return found


def _lines(table: dict[str, Any], place: tuple[str, ...]) -> list[str]:
    tables = {key: value for key, value in table.items() if _is_table(value)}
    lines = [f"{_name(key)} = {_text(value)}" for key, value in table.items() if key not in tables]
    for key, value in tables.items():
        inner = (*place, _name(key))
        single = is_dict(value)
        head = f"[{'.'.join(inner)}]" if single else f"[[{'.'.join(inner)}]]"
        rows: list[dict[str, Any]] = [value] if single else value
        for one in rows:
            lines += ["", head, *_lines(one, inner)]
    return lines


def _is_table(value: Any) -> bool:
    return is_dict(value) or is_list(value) and bool(value) and all(map(is_dict, value))


def _name(key: str) -> str:
    return key if _BARE.fullmatch(key) else _text(key)


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if is_list(value):
        return f"[{', '.join(map(_text, value))}]"
    if is_dict(value):
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


def has(table: Any, key: str) -> bool:
    """Whether a key has a value."""
    try:
        get(table, key)
    except InvalidArgumentError:
        return False
    return True


def put(table: Any, key: str, value: Any) -> None:
    """Sets the value of a key. The table that it lies in must exist, or be one that a case has once at most; the key
    itself may be new."""
    *way, last = parse_key(key)
    if way and way[0] not in table and way[0] in _data.single_tables():
        table[way[0]] = {}
    for k, part in enumerate(way):
        table = _step(table, part, key, k)
    place: Any = table
    if isinstance(last, int) or not is_dict(table):
        _step(table, last, key, len(way))
    place[last] = plain(value, key)


def _step(table: Any, part: str | int, key: str, k: int) -> Any:
    if isinstance(part, int):
        if is_list(table) and part < len(table):
            return table[part]
        there = f"it holds {len(table)}, counted from 0" if is_list(table) else "this is no list"
        raise invalid(f"{key}: the case has no entry [{part}] here; {there}")
    if is_dict(table) and part in table:
        return table[part]
    names = ", ".join(table) if is_dict(table) and table else "none"
    what = "key" if k else "table"
    raise invalid(f"{key}: the case has no {what} {part!r} here; there are: {names}")
