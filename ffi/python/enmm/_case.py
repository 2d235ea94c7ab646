"""Cases: what a user writes, as text and as a table of values."""

import html
import os
import tomllib
from collections.abc import Mapping
from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from . import _toml
from ._core import text as c_text
from ._errors import CaseError, CaseFileError, Status
from ._library import load_library

if TYPE_CHECKING:
    from ._model import Model

_RECORDS = ("file", "acceleration", "velocity", "displacement")
_FILES = (
    "domain.geometry_file",
    *(f"base_motion[].{key}" for key in _RECORDS),
    *(f"quiet[].{key}" for key in _RECORDS),
)
"""Keys whose values are files beside the case."""


class Case:
    """A case: the rock, its joints, loads and stages. It does not change; `with_values` makes another one.

    Made by `from_file`, `from_string` or `from_dict`, which check it as the program does: unknown keys, types, ranges,
    names and files that are missing are a CaseError with line and key. `docs/case.schema.json` lists the keys. It goes
    through pickle as its text; the files that it names are not taken along and must be found at the same place.
    """

    def __init__(self, toml: str, base_dir: str | os.PathLike[str] = ".") -> None:
        self._text = toml
        self._base = Path(base_dir).absolute()
        load_library().call("enmm_check_case", c_text("toml", toml), c_text("base_dir", self._base))
        self._table: dict[str, Any] = tomllib.loads(toml)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Self:
        """Reads a case file; files that it names are sought beside it."""
        path = Path(path)
        try:
            toml = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            message = f"{path}: cannot read the file ({error}); check its path and permissions"
            raise CaseFileError(message, Status.FILE_ERROR) from error
        try:
            return cls(toml, path.parent)
        except CaseError as error:
            shown = str(error)
            named = f"{path}{shown.removeprefix('case')}" if shown.startswith("case:") else shown
            raise CaseError(named, error.status) from None

    @classmethod
    def from_string(cls, toml: str, base_dir: str | os.PathLike[str] = ".") -> Self:
        """Reads a case from text in TOML, called "case" in messages; files that it names are sought in `base_dir`."""
        return cls(toml, base_dir)

    @classmethod
    def from_dict(cls, table: Mapping[str, Any], base_dir: str | os.PathLike[str] = ".") -> Self:
        """Makes a case of the tables and values that a case file has: `{"domain": {"outline": [...]}, ...}`.

        Values may be numpy's. Lines in messages are those of `to_toml`.
        """
        return cls(_toml.dumps(table), base_dir)

    @classmethod
    def of(cls, case: "Case | str | os.PathLike[str] | Mapping[str, Any]") -> "Case":
        """The case itself, that of a path, or that of a dict."""
        if isinstance(case, Case):
            return case
        return cls.from_dict(case) if isinstance(case, Mapping) else cls.from_file(case)

    @property
    def title(self) -> str:
        """Title, empty without one."""
        return str(self._table.get("title", ""))

    @property
    def base_dir(self) -> Path:
        """Directory of the files that the case names."""
        return self._base

    def to_toml(self) -> str:
        """The text: that which was read, or the one that was made of a dict."""
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """The tables and values; changing them does not change the case."""
        return deepcopy(self._table)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a case file. The files that the case names stay where they are and are named by their full path."""
        Path(path).write_text(self._with_full_paths(), encoding="utf-8")

    def __getitem__(self, key: str) -> Any:
        """A value by its key, such as `case["joint_law.plane.friction_deg"]` or `case["joint_set[0].seed"]`."""
        return deepcopy(_toml.get(self._table, key))

    def with_values(self, values: Mapping[str, Any]) -> "Case":
        """The same case with other values: `{"joint_law.plane.friction_deg": 30, "stage[1].duration": 2}`.

        A key may be one that the case leaves out; the table that it lies in must be there. Comments are lost.
        """
        table = self.to_dict()
        for key, value in values.items():
            _toml.put(table, key, value)
        return Case.from_dict(table, self._base)

    def model(self) -> "Model":
        """The model of the case, for a host that drives it step by step."""
        from ._model import Model

        return Model.from_string(self._text, self._base)

    @property
    def digest(self) -> str:
        """Fingerprint of the case with the files that it names, 16 hexadecimal digits, equal for equal models.

        It is `Model.case_hash`, and the model is built to find it. Random values are not part of it.
        """
        with self.model() as model:
            return model.case_hash

    def _files(self) -> list[tuple[str, Path]]:
        """Keys and full paths of the files that the case names."""
        found = []
        for name in _FILES:
            table, _, key = name.replace("[]", "").rpartition(".")
            there = self._table.get(table, {})
            rows = there if isinstance(there, list) else [there]
            keys = [f"{table}[{k}]" if isinstance(there, list) else table for k in range(len(rows))]
            found += [(f"{at}.{key}", self._base / row[key]) for at, row in zip(keys, rows, strict=True) if key in row]
        return found

    def _with_full_paths(self) -> str:
        files = self._files()
        if not files:
            return self._text
        table = self.to_dict()
        for key, path in files:
            _toml.put(table, key, str(path))
        return _toml.dumps(table)

    def __reduce__(self) -> tuple[type["Case"], tuple[str, str]]:
        return Case, (self._text, str(self._base))

    def __eq__(self, other: object) -> bool:
        same = isinstance(other, Case) and self._table == other._table
        return same and [path for _, path in self._files()] == [path for _, path in other._files()]  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash(_toml.dumps(_sorted(self._table)))

    def _repr_html_(self) -> str:
        title, text = html.escape(self.title or "Case"), html.escape(self.to_toml())
        return f"<details><summary>{title}</summary><pre>{text}</pre></details>"

    def __repr__(self) -> str:
        tables = ", ".join(name for name in self._table if name != "title")
        return f"<enmm.Case {self.title!r}: {tables}>"


def _sorted(value: Any) -> Any:
    """The same value with the keys of all tables in alphabetical order."""
    if isinstance(value, dict):
        return {key: _sorted(value[key]) for key in sorted(value)}
    return [_sorted(inner) for inner in value] if isinstance(value, list) else value
