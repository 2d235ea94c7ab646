"""Ensembles: many samples of a case with uncertain values, and the probability of failure.

from enmm.ensemble import Normal, Seeds, run

found = run(
    "plane_slide.toml",
    {"joint_law.plane.friction_deg": Normal(35, 3), "joint_law.plane.cohesion": Normal(25e3, 5e3, low=0)},
    n=1000,
    store="runs.sqlite",
)
print(found.probability_of_failure, found.interval(), found.beta, found.sensitivity())
found.report("plane_slide.html")
"""

from ._driver import EnsembleError, run
from ._sampling import draw, uniform
from ._store import Store
from ._summary import Ensemble, Interval, wilson
from ._variables import Distribution, Exponential, LogNormal, Normal, Seeds, Triangular, Uniform, from_case, from_tables

__all__ = [
    "Distribution",
    "Ensemble",
    "EnsembleError",
    "Exponential",
    "Interval",
    "LogNormal",
    "Normal",
    "Seeds",
    "Store",
    "Triangular",
    "Uniform",
    "draw",
    "from_case",
    "from_tables",
    "run",
    "uniform",
    "wilson",
]
