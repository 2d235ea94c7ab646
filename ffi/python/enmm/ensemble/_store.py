"""The store of samples: a SQLite file in WAL mode with a row for each sample that is done, committed at once."""

import json
import os
import sqlite3
import time
from collections.abc import Iterable
from typing import Any, NamedTuple

from .._closing import Closing

_SCHEMA = """
create table if not exists sample (
    key text primary key, k integer not null, status text not null, given text not null, outputs text not null,
    message text not null, seconds real not null, version text not null, finished text not null
) without rowid
"""


class Row(NamedTuple):
    """A sample that is done."""

    status: str
    """`done`, or `failed` when the case itself has no answer."""
    outputs: dict[str, Any]
    """What the sample gave."""
    message: str
    """Why it failed."""


class Store(Closing):
    """Samples by key. One process at a time writes; others may read. Keep it on a disk of the machine of the driver."""

    def __init__(self, path: str | os.PathLike[str] | None) -> None:
        self._database = sqlite3.connect(os.fspath(path) if path is not None else ":memory:", timeout=60)
        self._database.execute("pragma journal_mode = wal")
        self._database.execute("pragma synchronous = full")
        with self._database:
            self._database.execute(_SCHEMA)

    def add(self, key: str, k: int, values: dict[str, Any], row: Row, seconds: float, version: str) -> None:
        """Adds a sample, in the place of an earlier one of this key; it is on the disk when this returns."""
        now = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        texts = (json.dumps(values), json.dumps(row.outputs), row.message, seconds, version, now)
        with self._database:
            self._database.execute(
                "insert or replace into sample values (?, ?, ?, ?, ?, ?, ?, ?, ?)", (key, k, row.status, *texts)
            )

    def find(self, keys: Iterable[str]) -> dict[str, Row]:
        """The samples of those of the keys that are there."""
        found: dict[str, Row] = {}
        for key in keys:
            row = self._database.execute("select status, outputs, message from sample where key = ?", (key,)).fetchone()
            if row is not None:
                found[key] = Row(row[0], json.loads(row[1]), row[2])
        return found

    def __len__(self) -> int:
        return int(self._database.execute("select count(*) from sample").fetchone()[0])

    def close(self) -> None:
        """Closes the file."""
        self._database.close()
