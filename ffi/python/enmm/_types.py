"""Events and inputs of models."""

from typing import NamedTuple

from ._abi import EventKind, SectionFailure


class Event(NamedTuple):
    """Something that happened for the first time."""

    kind: EventKind
    """What happened."""
    subject: int | None
    """Block id; for a slip the number of the joint trace, or None for a contact that lies on none.

    Of two blocks that overlap the lower id.
    """
    time: float
    """End of the internal step in which it happened (s), as `Model.time` counts."""
    other: int | None = None
    """Higher id of two blocks that overlap; None for events of other kinds."""
    depth: float = 0.0
    """Depth of an overlap when it was found (m); 0 for events of other kinds."""
    name: str | None = None
    """Name of the joint or block, as `Model.names` gives it; None for a contact that lies on no joint."""


class Cut(NamedTuple):
    """A section of rock that has broken and is a joint since then."""

    block: int
    """Block that broke; its part with its reference point keeps the id."""
    part: int
    """Id of the part that is new."""
    failure: SectionFailure
    """How it broke."""
    time: float
    """End of the internal step in which it broke (s), as `Model.time` counts."""
    first: tuple[float, float]
    """First end in the reference configuration (m)."""
    second: tuple[float, float]
    """Second end (m)."""
    share: float
    """Share of its strength that it carried, 1 or a little more."""
    normal_force: float
    """Normal force that it carried (N/m, tension positive)."""
    shear_force: float
    """Shear force that it carried (N/m)."""
    moment: float
    """Bending moment about its middle that it carried (N*m/m)."""


CUT_FIELDS = (
    "block", "part", "failure", "time", "first_x", "first_y", "second_x", "second_y", "share", "normal_force",
    "shear_force", "moment",
)  # fmt: skip
"""Fields of `enmm_cut` in the order of `Cut`."""


class Inputs(NamedTuple):
    """Inputs of the whole model that are set now."""

    gravity: tuple[float, ...]
    """Gravity x, y (m/s2)."""
    base_acceleration: tuple[float, ...]
    """Acceleration of the base x, y (m/s2)."""
    water_level: float
    """Height of the water (m); 0 without water."""
    strength_factor: float
    """Factor on the strength of all joints."""


class PortInputs(NamedTuple):
    """Inputs of a port that are set now; 0 where its kind takes no such input."""

    traction: tuple[float, ...]
    """Traction x, y on the boundary (Pa)."""
    pressure: float
    """Pressure on the faces (Pa)."""
    velocity: tuple[float, ...]
    """Velocity x, y (m/s) of the supports, or of the wave that comes in."""


class FlowInputs(NamedTuple):
    """Inputs of water that flows in joints that are set now, by the names of the case."""

    heads: dict[str, float]
    """Level of each head (m)."""
    rains: dict[str, float]
    """Rate of each rain (m/s)."""
    drains: dict[str, bool]
    """Whether each drain acts."""
