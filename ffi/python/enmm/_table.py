"""Tables of results: columns by name, as numpy arrays or as a data frame."""

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from . import _html

_HEAD = re.compile(r"(.*?) \[([^\]]*)\]")


class Table(dict[str, npt.NDArray[Any]]):
    """Columns of equal length by name: a dict of arrays, so `pandas.DataFrame(table)` and the like take it.

    `to_pandas` and `to_xarray` take the units along; they need pandas and xarray.
    """

    units: dict[str, str]
    """Unit of every column, empty for a number without one and for text."""

    def __init__(self, columns: Mapping[str, Any], units: Mapping[str, str] | None = None) -> None:
        super().__init__({name: np.asarray(values) for name, values in columns.items()})
        self.units = {name: (units or {}).get(name, "") for name in self}

    @classmethod
    def of_rows(cls, rows: Sequence[Mapping[str, Any]], first: Sequence[str] = ()) -> "Table":
        """The table of rows that have the same names, those of `first` in front."""
        names = sorted(rows[0], key=lambda name: first.index(name) if name in first else len(first)) if rows else []
        return cls({name: [row[name] for row in rows] for name in names})

    @classmethod
    def read_csv(cls, path: Path) -> "Table":
        """A CSV file of the program, whose heads hold units: `time [s]`."""
        with path.open(newline="", encoding="utf-8") as file:
            heads, *rows = list(csv.reader(file))
        found = [_HEAD.fullmatch(head) for head in heads]
        names = [match[1] if match else head for match, head in zip(found, heads, strict=True)]
        units = {name: match[2] for name, match in zip(names, found, strict=True) if match}
        columns = [_column([row[k] for row in rows]) for k in range(len(names))]
        return cls(dict(zip(names, columns, strict=True)), units)

    def __missing__(self, name: object) -> NoReturn:
        raise KeyError(f"{name!r}: there is no such column; there are: {', '.join(self)}")

    @property
    def rows(self) -> int:
        """Number of rows."""
        return next((len(values) for values in self.values()), 0)

    def to_numpy(self) -> npt.NDArray[np.void]:
        """A structured array with a field for each column."""
        array = np.empty(self.rows, [(name, values.dtype) for name, values in self.items()])
        for name, values in self.items():
            array[name] = values
        return array

    def to_pandas(self) -> Any:
        """A data frame of pandas; units are in its `attrs["units"]`."""
        import pandas

        frame = pandas.DataFrame(dict(self))
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_xarray(self) -> Any:
        """A data set of xarray over the time, or over the rows where there is none; each variable has its `units`."""
        import xarray

        data: Any = xarray
        along = "time" if "time" in self else "row"
        variables = {name: (along, values, {"units": self.units[name]}) for name, values in self.items()}
        return data.Dataset(variables)

    def label(self, name: str) -> str:
        """Name and unit, as on the axis of a plot."""
        return f"{name} ({self.units[name]})" if self.units[name] else name

    def _repr_html_(self) -> str:
        return _html.columns([self.label(name) for name in self], self, self.rows)

    def __repr__(self) -> str:
        return f"<enmm.Table: {self.rows} rows of {', '.join(self)}>"


def _column(values: list[str]) -> npt.NDArray[Any]:
    for kind in (int, float):
        try:
            return np.array([kind(value) for value in values], dtype=kind)
        except ValueError:
            continue
    return np.array(values)
