"""How an ensemble shows while it goes on: samples, verdicts, the slowest, the last trial, as `enmm sample` shows them."""

import sys
import threading
import time
import uuid
from collections.abc import Callable
from typing import Any

from .._progress import Bar, clock
from ._store import Row

TrialHeard = Callable[[int, str], None]
"""Is called with the number of a sample and a line about its last trial; pickle can take it where workers are far."""


class Shown:
    """What is shown of the work on one output after the other. Trials may come from other threads."""

    def __init__(self, bar: Bar, limit: float, count: Callable[[int, int], object] | None) -> None:
        self._bar, self._limit, self._count = bar, limit, count
        self._lock = threading.Lock()
        self._line, self._share = "", 0.0

    def begin(self, name: str, deciding: str | None, rows: list[Row], wanted: int) -> None:
        """The work on an output begins with rows that are there."""
        self._name, self._deciding, self._wanted, self._stored = name, deciding, wanted, len(rows)
        self._done = self._answered = self._below = 0
        self._slowest: tuple[int, float] | None = None
        self._begun = time.monotonic()
        for row in rows:
            self._add(row)

    def _add(self, row: Row) -> None:
        self._done += 1
        if row.status == "done":
            self._answered += 1
            self._below += float(row.outputs[self._deciding or next(iter(row.outputs))]) < self._limit

    def note(self, sample: int, row: Row, seconds: float) -> None:
        """A sample is done."""
        self._add(row)
        if self._slowest is None or seconds > self._slowest[1]:
            self._slowest = (sample, seconds)
        if self._count is not None:
            self._count(self._done, self._wanted)
        with self._lock:
            self._line, self._share = self._text(), self._done / self._wanted
            self._bar.say(self._line, self._share, at_once=self._done == self._wanted)

    def trial(self, sample: int, text: str) -> None:
        """A trial of a sample has ended."""
        with self._lock:
            self._bar.say(f"{self._line}; sample {sample}: {text}".removeprefix("; "), self._share)

    def _text(self) -> str:
        parts = [f"{self._done} of {self._wanted} samples ({self._name.replace('_', ' ')})"]
        if self._answered:
            parts.append(f"{self._below} below the limit ({self._below / self._answered:.3f})")
        if self._slowest and self._slowest[1] >= 1.0:
            parts.append(f"slowest {self._slowest[0]} ({clock(self._slowest[1])})")
        rate = (self._done - self._stored) / max(time.monotonic() - self._begun, 1e-9)
        if rate > 0 and self._done < self._wanted:
            parts.append(f"about {clock((self._wanted - self._done) / rate)} left")
        return ", ".join(parts)


class DaskTrials:
    """Sends trials from the workers of Dask to its driver, as events of a topic."""

    def __init__(self) -> None:
        self.topic = f"enmm-{uuid.uuid4().hex}"

    def __call__(self, sample: int, text: str) -> None:
        """On a worker."""
        distributed: Any = sys.modules.get("distributed")
        if distributed is not None:
            distributed.get_worker().log_event(self.topic, {"sample": sample, "text": text})

    def subscribe(self, client: Any, hear: TrialHeard) -> Callable[[], None]:
        """On the driver; returns what ends it."""

        def take(event: Any) -> None:
            hear(event[1]["sample"], event[1]["text"])

        client.subscribe_topic(self.topic, take)
        return lambda: client.unsubscribe_topic(self.topic)
