"""How work shows while it goes on: a bar in a notebook, a line on a terminal."""

import html
import sys
import time
from types import TracebackType
from typing import Any, Self

_PAUSE = 0.1
"""Time between two changes of what is shown (s)."""


def in_notebook() -> bool:
    """Whether this runs in a cell of a notebook."""
    shell = sys.modules.get("IPython")
    found = shell.get_ipython() if shell is not None else None
    return found is not None and hasattr(found, "kernel")


class Bar:
    """A bar with a line of text, which goes away at its end; nothing where it is not wanted.

    `wanted` None stands for a bar in notebooks alone.
    """

    def __init__(self, wanted: bool | None) -> None:
        self._notebook = in_notebook()
        self.shown = self._notebook if wanted is None else wanted
        self._handle: Any = None
        self._last = -1.0
        self._width = 0

    def say(self, text: str, share: float | None = None, *, at_once: bool = False) -> None:
        """Shows a text, with the share of the work that is done when it is known."""
        if not self.shown or not (at_once or time.monotonic() - self._last >= _PAUSE):
            return
        self._last = time.monotonic()
        if self._notebook:
            value = "" if share is None else f' value="{min(max(share, 0.0), 1.0):.4f}"'
            self._show(f'<progress max="1"{value} aria-label="progress"></progress> {html.escape(text)}')
        else:
            self._width = max(self._width, len(text))
            print(f"\r{text:<{self._width}}", end="", file=sys.stderr, flush=True)

    def _show(self, page: str) -> None:
        from IPython import display

        shown: Any = display
        if self._handle is None:
            self._handle = shown.display(shown.HTML(page), display_id=True)
        else:
            self._handle.update(shown.HTML(page))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._handle is not None:
            self._show("")
        elif self._width:
            print(f"\r{'':<{self._width}}\r", end="", file=sys.stderr, flush=True)


def clock(seconds: float) -> str:
    """`1 h 02 min`, `3 min 05 s` or `7 s`."""
    whole = int(min(seconds, 1e12) + 0.999999)
    h, m, s = whole // 3600, whole // 60 % 60, whole % 60
    return f"{h} h {m:02} min" if h else f"{m} min {s:02} s" if m else f"{s} s"
