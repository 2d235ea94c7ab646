"""Results as HTML, for notebooks."""

import base64
import html
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ._errors import invalid
from ._kinds import is_dict, is_list

_ROWS = 10
"""Rows of a table that are shown."""

_PICTURE = 64 << 20
"""Largest picture that is shown (bytes)."""

_PAGE = 1 << 30
"""Largest page that is shown (bytes)."""


class Record(dict[str, Any]):
    """A dict with the look of a table in notebooks: what the program prints as one JSON object."""

    def _repr_html_(self) -> str:
        return facts((name.replace("_", " "), words(value)) for name, value in self.items())


def words(value: Any) -> str:
    """A value in a few words: of a collapse its factor, of a long list its length."""
    match value:
        case {"factor": factor, "end": end, "limit": limit}:
            return number(factor) if end == "found" else f"{str(end).replace('_', ' ')} {number(limit)}"
        case _ if is_dict(value):
            return ", ".join(f"{name} {words(inner)}" for name, inner in value.items())
        case _ if is_list(value):
            return _listed(value)
        case None:
            return "none"
        case _:
            return number(value)


def _listed(values: list[Any]) -> str:
    """A list of texts or of a few values; of any other its length."""
    if values and all(isinstance(item, str) for item in values):
        return "; ".join(values)
    if len(values) > 4 or any(isinstance(item, dict | list) for item in values):
        return f"{len(values)} entries"
    return ", ".join(map(words, values)) or "none"


def number(value: Any) -> str:
    """A number with six digits; any other value as text."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def facts(rows: Iterable[tuple[str, str]]) -> str:
    """A table of names and values."""
    cells = "".join(
        f'<tr><th scope="row" style="text-align:left">{html.escape(name)}</th>'
        f'<td style="text-align:left">{html.escape(value)}</td></tr>'
        for name, value in rows
    )
    return f"<table>{cells}</table>"


def columns(heads: Sequence[str], values: Mapping[str, Any], rows: int) -> str:
    """The first rows of columns, and how many more there are."""
    shown = [column[:_ROWS].tolist() for column in values.values()]
    head = "".join(f'<th scope="col">{html.escape(name)}</th>' for name in heads)
    lines = "".join(
        f"<tr>{''.join(f'<td>{html.escape(number(value))}</td>' for value in row)}</tr>"
        for row in zip(*shown, strict=True)
    )
    more = f"<p>… {rows - _ROWS} more rows</p>" if rows > _ROWS else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table>{more}"


def picture(path: Path, words: str) -> str:
    """A picture of the program in the page; nothing where it was not drawn."""
    data = _read(path, _PICTURE)
    return png(data, words) if data.startswith(b"\x89PNG") else ""


def _read(path: Path, most: int) -> bytes:
    """A file of a folder of results; empty where it is longer than `most`, no file, or a link, which could lead to any
    file of the reader."""
    if path.is_symlink() or not path.is_file():
        return b""
    # What comes to the place between this look and the opening is neither followed nor waited for.
    flags = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    with open(path, "rb", opener=lambda name, mode: os.open(name, mode | flags)) as file:
        return file.read() if os.fstat(file.fileno()).st_size <= most else b""


def png(data: bytes, words: str) -> str:
    """A PNG in the page."""
    source = base64.b64encode(data).decode()
    return f'<img alt="{html.escape(words)}" style="max-width:46em;width:100%" src="data:image/png;base64,{source}">'


def frame(page: Path, height: int) -> str:
    """A page of results in a frame, which needs no file beside it. Its scripts cannot reach the notebook: the page may
    come from a stranger."""
    source = html.escape(_read(page, _PAGE).decode(), quote=True)
    if not source:
        raise invalid(f"{page}: is no regular file of at most {_PAGE} bytes, so it is not shown: open it in a browser")
    style = f"width:100%;height:{height}px;border:0"
    rights = "allow-scripts allow-downloads"
    return f'<div><iframe title="Results of enmm" sandbox="{rights}" style="{style}" srcdoc="{source}"></iframe></div>'
