"""Files that come with the package: the schema of cases and the example cases."""

import json
from functools import cache
from pathlib import Path
from typing import Any

_PACKED = Path(__file__).parent / "data"
_REPOSITORY = Path(__file__).parents[3]


def _place(name: str, in_repository: str) -> Path:
    """A file of the wheel, or that of the repository that the package lies in."""
    packed = _PACKED / name
    return packed if packed.exists() else _REPOSITORY / in_repository


def schema() -> dict[str, Any]:
    """The JSON Schema of cases: every key with its meaning, unit and limits."""
    found: dict[str, Any] = json.loads(_place("case.schema.json", "docs/case.schema.json").read_text(encoding="utf-8"))
    return found


@cache
def single_tables() -> frozenset[str]:
    """Tables that a case has once at most and without a name of its own, such as `output`."""
    return frozenset(name for name, of in schema()["properties"].items() if "$ref" in of or "anyOf" in of)


def examples() -> dict[str, Path]:
    """The example cases by name: `enmm.run(enmm.examples()["plane_slide"])`."""
    folder = _place("cases", "examples/cases")
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}

