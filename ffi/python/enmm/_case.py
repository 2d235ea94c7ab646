"""Cases: what a user writes, as text and as a table of values."""

import html
import os
import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, cast

from . import _toml
from ._core import text as c_text
from ._core import unheard
from ._errors import CaseError, CaseFileError, Status, invalid
from ._kinds import is_dict, is_list
from ._library import load_library
from ._options import path as path_of

if TYPE_CHECKING:
    from ._core import LogFunction
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
        self._text = checked_text(toml)
        self._base = path_of("base_dir", base_dir).absolute()
        load_library().call("enmm_check_case", c_text("toml", toml), c_text("base_dir", self._base))
        self._table: dict[str, Any] = tomllib.loads(toml)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Self:
        """Reads a case file; files that it names are sought beside it."""
        path = path_of("path", path)
        try:
            toml = path.read_text(encoding="utf-8-sig")
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

        Values may be numpy's, any sequences of numbers, and shapes of shapely (of a polygon its outline). Lines in
        messages are those of `to_toml`.
        """
        if not isinstance(table, Mapping):
            raise invalid(f"table: is of type {type(table).__name__}, must be a dict of the tables of a case")
        return cls(_toml.dumps(table), base_dir)

    @classmethod
    def of(cls, case: "Case | str | os.PathLike[str] | Mapping[str, Any]") -> "Case":
        """The case itself, that of a path, or that of a dict."""
        if isinstance(case, Case):
            return case
        return cls.from_dict(case) if isinstance(case, Mapping) else cls.from_file(file_of(case))

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
        path = path_of("path", path)
        try:
            path.write_text(self._with_full_paths(), encoding="utf-8")
        except OSError as error:
            message = f"{path}: cannot write the case ({error.strerror}); choose a folder that is there and yours"
            raise CaseFileError(message, Status.FILE_ERROR) from error

    def __getitem__(self, key: str) -> Any:
        """A value by its key, such as `case["joint_law.plane.friction_deg"]` or `case["joint_set[0].seed"]`."""
        return deepcopy(_toml.get(self._table, key))

    def __contains__(self, key: object) -> bool:
        """Whether the case has a key, such as `"water" in case` or `"joint_law.plane.cohesion" in case`."""
        return isinstance(key, str) and _toml.has(self._table, key)

    def __iter__(self) -> Iterator[str]:
        """The names of its tables and values."""
        return iter(self._table)

    def with_values(self, values: Mapping[str, Any]) -> "Case":
        """The same case with other values: `{"joint_law.plane.friction_deg": 30, "stage[1].duration": 2}`.

        A key may be one that the case leaves out, and so may a table without a name, such as `output`; what is named,
        such as a law, must be there. Comments are lost.
        """
        if not isinstance(values, Mapping):
            raise invalid(f"values: is of type {type(values).__name__}, must be a dict of keys and values")
        table = self.to_dict()
        for key, value in values.items():
            _toml.put(table, key, value)
        return Case.from_dict(table, self._base)

    def model(self, *, log: "LogFunction | None" = None) -> "Model":
        """The model of the case, for a host that drives it step by step; `log` is as of `Model.from_file`."""
        from ._model import Model

        return Model.from_string(self._text, self._base, log=log)

    def fmu(self, path: str | os.PathLike[str], *, fmi: int = 3) -> Path:
        """Packs the case as an FMU; see `enmm.fmu`."""
        from ._doors import fmu

        return fmu(self, path, fmi=fmi)

    @property
    def digest(self) -> str:
        """Fingerprint of the case with the files that it names, 16 hexadecimal digits, equal for equal models.

        It is `Model.case_hash`, and the model is built to find it. Title, `output`, notes and random values are no part
        of it, since they do not act on the model.
        """
        # Its warnings are none of a number.
        with self.model(log=unheard) as model:
            return model.case_hash

    def _files(self) -> list[tuple[str, Path]]:
        """Keys and full paths of the files that the case names."""
        found: list[tuple[str, Path]] = []
        for name in _FILES:
            table, _, key = name.replace("[]", "").rpartition(".")
            there = self._table.get(table, {})
            rows = there if is_list(there) else [there]
            keys = [f"{table}[{k}]" if is_list(there) else table for k in range(len(rows))]
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


def checked_text(toml: str) -> str:
    """The text of a case. Refuses the path of one."""
    if not isinstance(toml, str):
        raise TypeError(f"toml: is of type {type(toml).__name__}, must be the text of a case")
    if toml.endswith(".toml") and "\n" not in toml:
        raise invalid(f"toml: is {toml!r}, must be the text of a case; read a file by `from_file`")
    return toml


def file_of(case: object) -> Path:
    """The path of a case file. Raises CaseFileError where there is none."""
    if isinstance(case, str) and "\n" in case:
        raise invalid("case: is a text of several lines, must be a path; give `Case.from_string(text)`")
    if not isinstance(case, str | os.PathLike):
        kind = type(case).__name__
        raise TypeError(f"case: is of type {kind}, must be a Case, the path of a case file or a dict of tables")
    path = path_of("case", cast("str | os.PathLike[str]", case))
    if not path.is_file():
        raise CaseFileError(f"{path}: there is no such case file; check the path", Status.FILE_ERROR)
    return path


def _sorted(value: Any) -> Any:
    """The same value with the keys of all tables in alphabetical order."""
    if is_dict(value):
        return {key: _sorted(value[key]) for key in sorted(value)}
    return [_sorted(inner) for inner in value] if is_list(value) else value
