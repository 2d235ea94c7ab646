"""What a model has by name."""

from collections.abc import Iterator, Mapping
from typing import TypeVar

from . import _html
from ._core import Core
from ._errors import NotFoundError, Status

T_co = TypeVar("T_co", covariant=True)


class Named(Mapping[str, T_co]):
    """Things of a model by name, in the order of the case. An unknown name is a NotFoundError, which is a KeyError."""

    _noun = "thing"

    def __init__(self, core: Core, names: list[str]) -> None:
        self._core = core
        self._by_name = {name: k for k, name in enumerate(names)}

    def index(self, name: str) -> int:
        """Number of the one with this name."""
        return number_of(self._noun, name, self._by_name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._by_name)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    def _repr_html_(self) -> str:
        return _html.facts((name, str(value)) for name, value in self.items())

    def __repr__(self) -> str:
        return f"<enmm.{type(self).__name__} {dict(self)}>"


def number_of(noun: str, name: object, names: Mapping[str, int]) -> int:
    """Number of a name. Raises NotFoundError with those that there are."""
    if not isinstance(name, str) or name not in names:
        known = ", ".join(names) or "none"
        raise NotFoundError(f"no {noun} is named {name!r}; {noun}s of the case: {known}", Status.NOT_FOUND)
    return names[name]
