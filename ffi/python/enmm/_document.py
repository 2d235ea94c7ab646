"""Gives the fields of named tuples the texts below them in the source, so that `help` shows meanings and units."""

import re
import sys
from pathlib import Path

_FIELD = re.compile(r'^    (\w+): [^\n]+\n    """(.+?)"""', re.MULTILINE | re.DOTALL)
_CLASS = re.compile(r"^class (\w+)\(NamedTuple\):\n", re.MULTILINE)


def document(*modules: str) -> None:
    """Documents the fields of the named tuples of modules of this package; where the source is not there, none."""
    for name in modules:
        module = sys.modules[f"{__package__}.{name}"]
        path = Path(module.__file__ or "")
        if path.suffix != ".py" or not path.is_file():
            continue
        _, *parts = _CLASS.split(path.read_text(encoding="utf-8"))
        for kind, body in zip(parts[::2], parts[1::2], strict=True):
            end = re.search(r"^\S", body, re.MULTILINE)
            for field, text in _FIELD.findall(body[: end.start()] if end else body):
                getattr(vars(module)[kind], field).__doc__ = " ".join(text.split())
