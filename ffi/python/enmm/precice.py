"""An adapter for preCICE (version 3): a slope and other solvers, coupled over a part of its boundary.

    from enmm.precice import Adapter

    adapter = Adapter(
        "slope.toml",
        points=[[20, 8], [34, 30]],                       # the wet face
        mesh="Slope-Mesh",
        read={"Pressure": "pressure"},
        write={"Displacement": "displacement", "Velocity": "velocity"},
    )
    adapter.run("Slope", "precice-config.xml")

The facets of the part lie between neighbouring boundary nodes, and the vertices of the mesh are their middles. A facet
gives the mean of displacement and velocity along it and takes a uniform traction or pressure, so the work of what it
takes is force times displacement of its vertex, exactly: forces are conservative on this mesh, displacements,
velocities, tractions and pressures are consistent. Implicit coupling works by saved states, which restore every bit.

It needs the package `pyprecice` and the library libprecice. Manual of both: precice.org (G. Chourdakis et al., preCICE
v2, Open Research Europe 2:51, 2022; the calls here are those of version 3).
"""

import importlib
import itertools
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._abi import Interpolation
from ._case import Case
from ._errors import Status, StepError, invalid
from ._model import Model, State
from ._program import CaseLike

Array = npt.NDArray[np.float64]
READ = ("force", "traction", "pressure", "velocity")
WRITE = ("displacement", "velocity", "force")
_SOLVES_MAX = 30
"""Times that a step is tried for a displacement that is imposed."""


class Adapter:
    """A model whose boundary along `points` exchanges values with other solvers.

    `points` is a line of two or more points (m) along the outer boundary. `read` and `write` map names of data in the
    configuration of preCICE to what they are: read "force" (N per metre of depth, on each vertex), "traction" (Pa),
    "pressure" (Pa, scalar, positive into the rock) or "velocity" (m/s); write "displacement" (m), "velocity" (m/s), or,
    where a velocity is read, "force": that of this model on the other one (N per metre of depth).

    What is read changes linearly over a time window, or with `interpolation` HOLD has its new value throughout.

    A velocity that is read is imposed at the end of each window by forces on the facets, which are constant over it:
    the method of A. Gravouil and A. Combescure (Int. J. Numer. Meth. Engng 50, 2001), which is stable where an imposed
    displacement is not. The other solver must hold the force, too. The forces are found by Newton's method over a saved
    state as far as rounding lets it, at least to `tolerance` relative to the velocity.
    """

    model: Model
    """The model, at the time that the coupling has reached; its static stages are done at the creation."""
    positions: Array
    """Vertices (m): the middles of the facets, in the order of the line."""
    lengths: Array
    """Lengths of the facets (m)."""

    def __init__(
        self,
        case: CaseLike,
        points: Sequence[Sequence[float]],
        mesh: str,
        read: Mapping[str, str],
        write: Mapping[str, str],
        *,
        interpolation: Interpolation = Interpolation.LINEAR,
        tolerance: float = 1e-9,
    ) -> None:
        _check("read", read, READ)
        _check("write", write, WRITE)
        self._imposed = "velocity" in read.values()
        if self._imposed and len(read) > 1:
            raise invalid("read: has a velocity beside others, must have it alone")
        if "force" in write.values() and not self._imposed:
            raise invalid("write: has a force, which is only known where a velocity is read")
        if len(points) < 2:
            raise invalid(f"points: has {len(points)}, must have at least two, along the boundary")
        self._mesh, self._read, self._write, self._tolerance = mesh, dict(read), dict(write), tolerance
        ends = _facets(Case.of(case), np.asarray(points, dtype=float))
        self.positions, self.lengths = ends.mean(axis=1), np.hypot(*(ends[:, 1] - ends[:, 0]).T)
        self.model = _with_ports(Case.of(case), mesh, ends).model()
        self.model.interpolation = Interpolation.HOLD if self._imposed else interpolation
        self.model.start()
        self._ports = [self.model.ports[_port(mesh, k)] for k in range(len(ends))]
        self._start = self.displacement()
        self._force = np.zeros_like(self.positions)
        self._compliance: tuple[float, Array] | None = None

    def displacement(self) -> Array:
        """Mean displacement of every facet (m) since the start of the case, a row for each."""
        return np.array([[state.displacement_x, state.displacement_y] for state in self._states()])

    def velocity(self) -> Array:
        """Mean velocity of every facet (m/s), half an internal step ago."""
        return np.array([[state.velocity_x, state.velocity_y] for state in self._states()])

    def _states(self) -> Any:
        return (port.state() for port in self._ports)

    def run(self, participant: str, config: str | os.PathLike[str], library: Any = None) -> None:
        """Takes part in a coupled simulation until preCICE ends it.

        `participant` is the name of this solver in the configuration `config`. `library` is the module of preCICE, the
        installed one without it. Displacements count from time 0. Raises StepError when a step
        fails, or when no force leads to a velocity that is imposed.
        """
        precice = library or importlib.import_module("precice")
        coupling = precice.Participant(participant, os.fspath(config), 0, 1)
        dimensions = coupling.get_mesh_dimensions(self._mesh)
        if dimensions != 2:
            raise invalid(f"mesh: {self._mesh!r} has {dimensions} dimensions in {config}, must have 2")
        vertices = coupling.set_mesh_vertices(self._mesh, self.positions)
        if coupling.requires_initial_data():
            self._give(coupling, vertices)
        coupling.initialize()
        kept: tuple[State, Array] | None = None
        while coupling.is_coupling_ongoing():
            if coupling.requires_writing_checkpoint():
                kept = self.model.save(), self._force.copy()
            dt = coupling.get_max_time_step_size()
            given = {name: coupling.read_data(self._mesh, name, vertices, dt) for name in self._read}
            self.step(dt, {of: np.asarray(given[name]) for name, of in self._read.items()})
            self._give(coupling, vertices)
            coupling.advance(dt)
            if coupling.requires_reading_checkpoint() and kept is not None:
                self.model.restore(kept[0])
                self._force = kept[1].copy()
        coupling.finalize()

    def _give(self, coupling: Any, vertices: Any) -> None:
        now = {"displacement": self.displacement() - self._start, "velocity": self.velocity(), "force": -self._force}
        for name, of in self._write.items():
            coupling.write_data(self._mesh, name, vertices, now[of])

    def step(self, dt: float, values: Mapping[str, Array]) -> None:
        """Advances the model by `dt` (s) under "force", "traction", "pressure" or "velocity", a row for each facet."""
        if self._imposed:
            self._impose(dt, np.asarray(values["velocity"], dtype=float))
            return
        traction = np.zeros_like(self.positions)
        if "force" in values:
            traction += values["force"] / self.lengths[:, None]
        if "traction" in values:
            traction += values["traction"]
        for port, (tx, ty) in zip(self._ports, traction.tolist(), strict=True):
            port.set_traction(tx, ty)
        if "pressure" in values:
            for port, pressure in zip(self._ports, np.ravel(values["pressure"]).tolist(), strict=True):
                port.set_pressure(pressure)
        self.model.do_step(self.model.time, dt)

    def _impose(self, dt: float, wanted: Array) -> None:
        with self.model.save() as start:
            if self._compliance is None or self._compliance[0] != dt:
                self._compliance = dt, self._probe(dt, start)
            scale = max(float(np.abs(wanted).max()), 1e-9 * float(self.lengths.max()) / dt)
            least, best = np.inf, self._force
            for _ in range(_SOLVES_MAX):
                self._apply(dt, self._force)
                miss = (wanted - self.velocity()).ravel()
                size = float(np.abs(miss).max())
                if size < least:
                    best = self._force
                # On to where rounding ends it: what is left here is force that the two sides do not share.
                done = least <= self._tolerance * scale and size >= 0.25 * least
                least = min(size, least)
                self.model.restore(start)
                if done:
                    self._force = best
                    self._apply(dt, best)
                    return
                self._force = self._force + np.linalg.solve(self._compliance[1], miss).reshape(-1, 2)
        raise StepError(
            f"no force was found in {_SOLVES_MAX} solves that leads to the velocity at the end of the step: it misses "
            f"by {least:.2e} m/s; take a shorter time window, or read a force",
            Status.NUMERICAL_FAILURE,
        )

    def _apply(self, dt: float, force: Array) -> None:
        for port, (tx, ty) in zip(self._ports, (force / self.lengths[:, None]).tolist(), strict=True):
            port.set_traction(tx, ty)
        self.model.do_step(self.model.time, dt)

    def _probe(self, dt: float, start: State) -> Array:
        """Velocity at the end of a step by a unit force on each facet, column by column."""
        unit = 1e-3 * 9.81 * float(self.model.blocks()["mass"].sum()) / len(self.lengths)
        self._apply(dt, self._force)
        rest = self.velocity().ravel()
        columns: list[npt.NDArray[np.float64]] = []
        for k in range(self._force.size):
            self.model.restore(start)
            probe = self._force.copy()
            probe.ravel()[k] += unit
            self._apply(dt, probe)
            columns.append((self.velocity().ravel() - rest) / unit)
        self.model.restore(start)
        return np.array(columns).T


def _check(name: str, given: Mapping[str, str], known: Sequence[str]) -> None:
    wrong = [f"{data}: {of!r}" for data, of in given.items() if of not in known]
    if wrong or not given:
        raise invalid(f"{name}: has {', '.join(wrong) or 'no data'}, must map names of data to {', '.join(known)}")


def _facets(case: Case, points: Array) -> Array:
    """Ends of the facets along a line: an array of shape (facets, 2, 2)."""
    with case.model() as model:
        outlines = [
            outline for block in range(model.block_count) for outline in (model.polygon(block), *model.holes(block))
        ]
    near = 1e-7 * float(np.ptp(np.concatenate(outlines), axis=0).max())
    edges = np.concatenate([np.stack([outline, np.roll(outline, -1, axis=0)], axis=1) for outline in outlines])
    found: list[Array] = []
    for a, b in itertools.pairwise(points):
        length = float(np.hypot(*(b - a)))
        along = (edges - a) @ (b - a) / length
        across = np.abs((edges - a) @ np.array([a[1] - b[1], b[0] - a[0]]) / length)
        inside = (across < near) & (along > -near) & (along < length + near)
        chosen = edges[inside.all(axis=1)]
        there = float(np.abs(np.diff(along[inside.all(axis=1)], axis=1)).sum())
        if abs(there - length) > 10 * near:
            raise invalid(
                f"points: from {a.tolist()} to {b.tolist()} are {length:.6g} m, of which {there:.6g} m are whole "
                f"facets of the outer boundary; end the line at a corner of the outline, or at a boundary node: "
                f"{_nearest(edges[:, 0], a)}, {_nearest(edges[:, 0], b)}"
            )
        found.append(chosen[np.argsort(along[inside.all(axis=1)].mean(axis=1))])
    return np.concatenate(found)


def _nearest(nodes: Array, point: Array) -> list[float]:
    place: list[float] = nodes[np.argmin(np.hypot(*(nodes - point).T))].tolist()
    return place


def _port(mesh: str, k: int) -> str:
    return f"{''.join(c if c.isalnum() and c.isascii() else '_' for c in mesh)}_{k}"


def _with_ports(case: Case, mesh: str, ends: Array) -> Case:
    """The case with a boundary port for each facet."""
    table = case.to_dict()
    added = [{"name": _port(mesh, k), "boundary": of.tolist()} for k, of in enumerate(ends)]
    table["port"] = [*table.get("port", []), *added]
    return Case.from_dict(table, case.base_dir)
