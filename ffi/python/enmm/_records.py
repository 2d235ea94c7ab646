"""What the program prints as JSON objects, as types."""

from typing import Any, NotRequired, TypedDict


class MechanismBlock(TypedDict):
    """A block of a mechanism of limit analysis."""

    block: int
    """Block id."""
    x: float
    """Mass centroid, x (m)."""
    y: float
    """Mass centroid, y up (m)."""
    vx: float
    """Velocity relative to the fastest block, x."""
    vy: float
    """Velocity relative to the fastest block, y up."""
    spin: NotRequired[float]
    """Angular velocity, counter-clockwise (1/m)."""
    speed: NotRequired[float]
    """Largest speed in the block."""
    area: float
    """Area (m2)."""
    mass: float
    """Mass (kg/m)."""


class Collapse(TypedDict):
    """A factor of limit analysis."""

    factor: float | None
    """The factor; None when there is none within the limits."""
    end: str
    """How the search ended: `found`, or why it did not."""
    limit: float
    """The factor, or the limit that it is beyond."""
    meaning: NotRequired[str]
    """What the factor is, in words."""
    mechanism: NotRequired[list[MechanismBlock]]
    """The blocks that move."""
    way: NotRequired[str | None]
    """How they move, in words."""


class Bound(TypedDict):
    """Bounds of the factor of safety by limit analysis.

    Rock that yields has `lower`, `upper`, `triangles`, `programs`, `notes` and `warnings` alone; rigid blocks have all
    others.
    """

    associated: Collapse
    """Upper bound: joints dilate by their friction."""
    bare: Collapse | None
    """The same without the cohesion of joints that open."""
    catching: Collapse
    """Upper bound if no crossing lets a block pass."""
    level_tops: Collapse
    """Upper bound where corners pass over level tops."""
    level_tops_least: float | None
    """The least of the bounds over level tops."""
    estimate: Collapse | None
    """No bound: joints dilate as the case says."""
    lower: NotRequired[Collapse]
    """Lower bound, of rock that yields."""
    upper: NotRequired[Collapse]
    """Upper bound, of rock that yields."""
    bare_share: float | None
    """Share of the cohesion that opens."""
    bare_interfaces: int | None
    """Interfaces with cohesion that open."""
    factor_ends_drawn: float | None
    """Factor with the ends of joints as drawn, where joining them matters."""
    factor_ends_joined: float | None
    """Factor with the ends of joints joined."""
    blocks: int
    """Blocks."""
    free_blocks: int
    """Blocks that are not held."""
    interfaces: int
    """Interfaces between blocks."""
    points: int
    """Contacts at points."""
    corners: int
    """Contacts at corners."""
    programs: int
    """Linear programs that were solved."""
    triangles: NotRequired[dict[str, int]]
    """Triangles of each bound, of rock that yields."""
    notes: list[str]
    """Remarks."""
    warnings: list[str]
    """Warnings."""


class MemoryPart(TypedDict):
    """Memory of a part of the model."""

    heap: str
    """`model`, `state` or `buffers`."""
    part: str
    """What."""
    bytes: int
    """Size (bytes)."""


class Check(TypedDict):
    """Counts, areas, masses and warnings of a model that was built and not run."""

    blocks: int
    """Blocks."""
    block_areas: list[float]
    """Areas of the blocks (m2), ascending."""
    total_area: float
    """Area of all rock (m2)."""
    elements: int
    """Manifold elements."""
    physical_covers: int
    """Physical covers."""
    stars: int
    """Stars of the mesh that have a physical cover."""
    stars_by_cover_count: dict[str, int]
    """Stars by their number of physical covers."""
    cover_masses: list[float]
    """Masses of the covers (kg/m), ascending."""
    vertices: int
    """Distinct corners of the elements."""
    boundary_edges: int
    """Pieces of the boundaries of blocks."""
    initial_contacts: int
    """Contacts of the untouched model."""
    critical_dt: float
    """Stability limit of the step (s)."""
    friction_delay: float
    """Delay of friction in a dynamic stage (s)."""
    default_stiffness: float | None
    """Normal stiffness (Pa/m) of joints whose law gives none."""
    small_covers_treated: int
    """Covers that only equal thirds of their mass keep from ruling the step."""
    tiny_blocks: int
    """Blocks far smaller than the mesh."""
    merged_vertices: int
    """Ends and vertices that were merged."""
    ignored_joints: int
    """Joint traces that cut no rock."""
    memory_bytes: int
    """Memory that the model needs while it runs (bytes)."""
    memory: list[MemoryPart]
    """That memory by part."""
    extend_ends: float
    """Distance (m) within which ends of joints were joined to a line."""
    near_ends: float
    """Distance (m) within which ends of joints are listed."""
    trace_ends: list[dict[str, Any]]
    """Ends of joints near the outline or another joint."""
    crumbs: list[dict[str, Any]]
    """Blocks below the least area."""
    notes: list[str]
    """What the build has changed in the drawing."""
    warnings: list[str]
    """Warnings."""


class EnsembleRecord(TypedDict):
    """What `enmm sample` found."""

    samples: int
    """Samples."""
    without_answer: list[dict[str, Any]]
    """Samples whose case has no answer: `sample`, `message`."""
    doubtful: list[dict[str, Any]]
    """Samples whose factor is above the bound of limit analysis."""
    failures: int
    """Samples below the limit."""
    probability_of_failure: float
    """Share of the samples below the limit."""
    interval: list[float]
    """95 % interval of the probability (Wilson)."""
    beta: float
    """Reliability index."""
    beta_interval: list[float]
    """95 % interval of the reliability index."""
    mean: float
    """Mean of the output."""
    standard_deviation: float
    """Standard deviation of the output."""
    quantiles: list[list[float]]
    """Shares, and the outputs below which they lie."""
    rank_correlation: dict[str, float | None]
    """Rank correlation of the output with each key."""


class SweepRecord(TypedDict):
    """What `enmm sweep` found."""

    kind: str
    """`curve`, `contour` or `tornado`."""
    output: str
    """Name of the output of each sample: `level_tops`, `factor_of_safety` or `displacement`."""
    limit: float
    """Factor below which a slope counts as failed."""
    keys: list[dict[str, Any]]
    """Keys with their values: `key`, `values`."""
    samples: list[dict[str, Any]]
    """Samples: `values` by their keys, the output by its name, `status`."""
    without_answer: list[dict[str, Any]]
    """Samples whose case has no answer: `sample`, `message`."""
    doubtful: list[dict[str, Any]]
    """Samples whose factor is above the bound of limit analysis."""
    crossings: NotRequired[list[dict[str, Any]]]
    """Where the limit is passed: `value`, its neighbours `between`, of a contour the second value `at`."""
    of_the_case: NotRequired[float | None]
    """Output of the case itself, of changes one by one."""
    effects: NotRequired[list[dict[str, Any]]]
    """Effects of changes one by one: `key`, `outputs` as pairs of value and output, `range`."""
