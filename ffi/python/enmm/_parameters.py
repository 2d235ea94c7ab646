"""Parameters of the case by name: strengths of joints, rock, damping, water, bolts."""

from collections.abc import Mapping, MutableMapping
from ctypes import byref, c_double, c_int32, c_size_t, c_uint32
from typing import NamedTuple, SupportsFloat

import numpy as np

from ._core import Core, pointer
from ._mapping import Named
from ._options import number


class Parameter(NamedTuple):
    """What a parameter is."""

    name: str
    """Name, such as "joint_law.weak.friction"."""
    unit: str
    """SI unit, angles in radians; empty for a number."""
    description: str
    """Meaning."""
    low: float
    """Least value."""
    high: float
    """Greatest value."""
    tunable: bool
    """Whether it may change at any time; others only before the start."""


class Parameters(Named[float], MutableMapping[str, float]):
    """Parameters of a model and their values now, by name.

    `model.parameters["joint_law.weak.friction"] = math.radians(24)` sets one, `update` several at once: all, or none
    when one is refused. Before the start the model is built anew with the values, and inputs stay; after it a tunable
    parameter acts from the next step on, until a stage of the case changes it. Values are part of saved states. An
    unknown name is a NotFoundError, which is a KeyError.
    """

    _noun = "parameter"

    def __init__(self, core: Core) -> None:
        names = [core.text("enmm_parameter_name", k) for k in range(core.get("enmm_parameter_count", c_size_t))]
        super().__init__(core, names)
        self.built: dict[str, float] = {}
        """Those with which the model was built anew."""

    def info(self, name: str) -> Parameter:
        """Unit, meaning and range of a parameter."""
        index = self.index(name)
        low, high, tunable = c_double(), c_double(), c_int32()
        self._core.call("enmm_parameter_range", index, byref(low), byref(high), byref(tunable))
        unit = self._core.text("enmm_parameter_unit", index)
        description = self._core.text("enmm_parameter_description", index)
        return Parameter(name, unit, description, low.value, high.value, bool(tunable.value))

    def __getitem__(self, name: str) -> float:
        return float(self._core.get("enmm_get_parameter", c_double, self.index(name)))

    def __setitem__(self, name: str, value: SupportsFloat) -> None:
        self._set({name: number(name, value)})

    def __delitem__(self, name: str) -> None:
        raise TypeError("parameters cannot be removed; set another value")

    def update(self, *values: Mapping[str, float], **named: float) -> None:  # type: ignore[override]
        """Sets several parameters at once: all, or none when one is refused."""
        self._set({name: number(name, value) for name, value in dict(*values, **named).items()})

    def _set(self, values: Mapping[str, float]) -> None:
        indices = np.array([self.index(name) for name in values], dtype=np.uint32)
        numbers = np.array(list(values.values()), dtype=np.float64)
        before = self._core.text("enmm_case_hash")
        self._core.call("enmm_set_parameters", pointer(indices, c_uint32), indices.size, pointer(numbers, c_double))
        if self._core.text("enmm_case_hash") != before:
            self.built.update(values)
