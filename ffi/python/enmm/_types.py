"""Values that models give and take. SI units per metre of thickness; x to the right, y upwards."""

from typing import NamedTuple

from ._abi import EventKind


class StepInfo(NamedTuple):
    """What a communication step did."""

    time: float
    """Time that the model has reached (s): t + h."""
    steps: int
    """Internal steps, parts of one included."""
    dt: float
    """Largest internal step (s), at most the critical one."""
    event_count: int
    """Events of this step."""
    first_event: int
    """Index of the first of them: `model.events(info.first_event)` returns them."""
    halved: int
    """Internal steps that were redone in halves."""
    unsettled: int
    """Sub-steps whose contact forces did not settle; 0 in a sound run."""


class Energies(NamedTuple):
    """Energies now and works since the start (J per metre of thickness).

    kinetic + strain + potential + damping + yielding equals contact_work + support_work + bolt_work + radiation +
    external_work + baseline + residual.
    """

    kinetic: float
    """Kinetic energy."""
    strain: float
    """Strain energy."""
    potential: float
    """Potential energy of gravity, from the undeformed state on."""
    stored: float
    """Energy in the springs of contacts and supports."""
    friction: float
    """Energy that slip turned into heat."""
    contact_work: float
    """Work of contact forces on the blocks."""
    support_work: float
    """Work of supports on the blocks."""
    damping: float
    """Energy that damping took."""
    external_work: float
    """Work of loads and inputs, and of gravity while it grows or changes."""
    baseline: float
    """Energy of the start, less what left with excavated blocks."""
    contact_dissipation: float
    """Energy that contacts lost in other ways than slip."""
    residual: float
    """Energy that appeared from nowhere: the error of the time steps."""
    yielding: float
    """Energy that yielding rock took."""
    bolt_work: float
    """Work of bolts on the blocks."""
    radiation: float
    """Work of quiet boundaries and free-field columns: less what waves carry away."""
    bolt_stored: float
    """Energy in bolts."""
    bolt_installed: float
    """Energy that bolts were installed with by their pretension."""
    bolt_dissipation: float
    """Energy that bolts lost by yielding and rupture: bolt_installed - bolt_work - bolt_stored."""
    fracture: float
    """Energy of fracture of joints that soften."""


class Totals(NamedTuple):
    """Sums and extremes over the model."""

    displacement_max: float
    """Largest displacement (m)."""
    velocity_max: float
    """Largest velocity (m/s)."""
    penetration_max: float
    """Largest penetration of the whole run (m)."""
    unbalanced: float
    """Net over applied force; near 0 at rest."""
    critical_dt: float
    """Critical internal step (s)."""
    open_contacts: int
    """Contacts without force."""
    slipping_contacts: int
    """Contacts at their shear limit."""
    locked_contacts: int
    """Contacts below their shear limit."""
    detached_blocks: int
    """Blocks that have lost their last contact at least once."""
    slipped_joints: int
    """Joints that have slipped."""
    failed_blocks: int
    """Blocks that have failed."""
    overlap_max: float
    """Greatest depth of overlaps of blocks so far (m), see `EventKind.OVERLAPPED`; 0 for none."""
    overlapping_pairs: int
    """Pairs of blocks that have overlapped."""
    broken_length: float
    """Bonded length that has broken, of rock bridges and joints with an energy of fracture (m)."""
    broken_joints: int
    """Joints whose last bond has broken."""


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


class PortState(NamedTuple):
    """A port now.

    A block fills all but the last three values; a boundary displacement, velocity and stress; joints the last three.
    What is not filled is 0.
    """

    displacement_x: float
    """Displacement of the mass centroid, or mean along the boundary, x (m)."""
    displacement_y: float
    """The same, y (m)."""
    velocity_x: float
    """Velocity of the mass centroid, or mean along the boundary, x (m/s)."""
    velocity_y: float
    """The same, y (m/s)."""
    rotation: float
    """Rotation of the block (rad, counter-clockwise)."""
    angular_velocity: float
    """Angular velocity of the block (rad/s, counter-clockwise)."""
    contact_force_x: float
    """Sum of the contact forces on the block, x (N/m)."""
    contact_force_y: float
    """The same, y (N/m)."""
    stress_xx: float
    """Mean stress in the block, or in the blocks along the boundary, xx (Pa, tension positive)."""
    stress_yy: float
    """The same, yy (Pa, tension positive)."""
    stress_xy: float
    """The same, xy (Pa)."""
    normal_force: float
    """Sum of the normal forces across the joints (N/m, compression positive)."""
    shear_force: float
    """Sum of the magnitudes of the shear forces along the joints (N/m)."""
    slip: float
    """Largest slip that a contact of the joints has summed up (m)."""
