"""A coupled master: the toe of a slope rests on an anchored wall, which is a model of its own; its anchor loses force.

The wall tells a force and hears the displacement of the toe. Explicit coupling passes each once per step; implicit
coupling repeats the step from a saved state until both agree.
"""

import functools
import re
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy
import pytest
from fmu_support import DISCARD, Instance

PAGE = (Path(__file__).parents[1] / "docs" / "coupling.md").read_text(encoding="utf-8")

END = 0.4
PRELOAD = numpy.array([0.9e6, 0.56e6])
LOSS = 0.6
TOLERANCE = 1.0  # N/m, of some 1e6


@dataclass(frozen=True)
class Wall:
    """A mass behind a pad, held by an anchor: m·w'' = k_pad·(u − w) − k·w − c·w' − loss, from rest.

    The force on the toe is the preload less that of the pad. The displacement u of the toe is linear over a step, so
    that the step is exact.
    """

    pad: float = 2e9
    mass: float = 1e5
    anchor: float = 2e8
    damping: float = 1e6
    state: numpy.ndarray = field(default_factory=lambda: numpy.zeros((2, 2)))
    toe: numpy.ndarray = field(default_factory=lambda: numpy.zeros(2))

    def step(self, toe: numpy.ndarray, h: float) -> "Wall":
        """The wall after a step in which the toe has moved to `toe`; this one stays as it is."""
        way = transition(self.pad, self.mass, self.anchor, self.damping, h)
        stacked = numpy.vstack([self.state, self.toe, (toe - self.toe) / h, LOSS * PRELOAD])
        return replace(self, state=(way @ stacked)[:2], toe=toe.copy())

    def force(self) -> numpy.ndarray:
        return PRELOAD - self.pad * (self.toe - self.state[0])


@functools.cache
def transition(pad, mass, anchor, damping, h) -> numpy.ndarray:
    """Matrix exponential over h of the system of (w, w', u, u', loss)."""
    system = numpy.zeros((5, 5))
    system[0, 1] = system[2, 3] = 1.0
    system[1] = [-(pad + anchor) / mass, -damping / mass, pad / mass, 0.0, -1.0 / mass]
    halvings = 10
    small = system * (h / 2**halvings)
    term = way = numpy.eye(5)
    for k in range(1, 16):
        term = term @ small / k
        way = way + term
    for _ in range(halvings):
        way = way @ way
    return way


@dataclass
class Course:
    """What a coupled run leaves."""

    times: numpy.ndarray
    toe: numpy.ndarray
    force: numpy.ndarray
    iterations: list

    def error(self, reference: "Course") -> float:
        """Largest distance from the reference, at the times of both, by the largest displacement."""
        coarse, fine = sorted((self, reference), key=lambda course: len(course.times))
        stride = (len(fine.times) - 1) // (len(coarse.times) - 1)
        apart = numpy.linalg.norm(coarse.toe - fine.toe[::stride], axis=1)
        return float(apart.max() / numpy.linalg.norm(reference.toe, axis=1).max())

    def work(self) -> float:
        """Work of the force beyond the preload on the toe, by the trapezoidal rule."""
        mean = 0.5 * (self.force[1:] + self.force[:-1]) - PRELOAD
        return float((mean * numpy.diff(self.toe, axis=0)).sum())


class Torn(Exception):
    """The slope could not follow: a coupled run that has blown up."""


class Slope:
    """The FMU with its toe: force in, displacement since the start out."""

    def __init__(self, fmu, linear: bool):
        self.instance = Instance(fmu).initialize(interpolate_inputs=linear, **self.values(PRELOAD))
        self.rest = self.place()

    @staticmethod
    def values(force) -> dict:
        return {"toe.force_x": float(force[0]), "toe.force_y": float(force[1])}

    def place(self) -> numpy.ndarray:
        return numpy.array(self.instance.get("toe.displacement_x", "toe.displacement_y"))

    def step(self, t: float, h: float, force) -> numpy.ndarray:
        self.instance.check(self.instance.set(self.values(force)))
        status = self.instance.step(t, h)
        if status == DISCARD:
            raise Torn(f"the step at t = {t} was discarded")
        self.instance.check(status)
        return self.place() - self.rest


@functools.cache
def couple(fmu, h: float, master) -> Course:
    """Runs slope and wall to the end with a master, which takes one step of both; once for all tests."""
    slope, wall = Slope(fmu, linear=master is implicit), Wall()
    steps = round(END / h)
    toe, force, iterations = [numpy.zeros(2)], [wall.force()], []
    with slope.instance:
        for k in range(steps):
            wall, count = master(slope, wall, k * h, h)
            toe.append(wall.toe)
            force.append(wall.force())
            iterations.append(count)
    return Course(numpy.arange(steps + 1) * h, numpy.array(toe), numpy.array(force), iterations)


def explicit(slope, wall, t, h):
    """The force at the begin holds over the step."""
    return wall.step(slope.step(t, h, wall.force()), h), 1


def implicit(slope, wall, t, h):
    """The force is linear to its value at the end, which is found by fixed points with Aitken's relaxation."""
    state = slope.instance.save()
    force, omega, before = wall.force(), 1.0, None
    for count in range(1, 31):
        after = wall.step(slope.step(t, h, force), h)
        residual = after.force() - force
        if numpy.linalg.norm(residual) < TOLERANCE:
            break
        if before is not None:
            change = residual - before
            omega *= -float(before @ change) / float(change @ change)
        force, before = force + omega * residual, residual
        slope.instance.check(slope.instance.restore(state))
    else:
        raise AssertionError(f"no convergence at t = {t}")
    slope.instance.check(slope.instance.free_state(state))
    return after, count


@pytest.fixture
def reference(slope_fmu) -> Course:
    """Implicit coupling at a step that is a sixteenth of the coarsest."""
    return couple(slope_fmu, 0.00125, implicit)


@pytest.fixture
def explicit_errors(slope_fmu, reference):
    return {h: couple(slope_fmu, h, explicit).error(reference) for h in (0.01, 0.005, 0.0025)}


def test_wall_alone_swings_as_theory_says():
    """Toe held, anchor lost by 60 %: from rest to twice the new equilibrium, in half a period, without damping."""
    wall = replace(Wall(), damping=0.0)
    stiffness = wall.pad + wall.anchor
    half = numpy.pi * (wall.mass / stiffness) ** 0.5
    for _ in range(7):
        wall = wall.step(numpy.zeros(2), half / 7)
    assert wall.state[0] == pytest.approx(-2.0 * LOSS * PRELOAD / stiffness, rel=1e-9)
    assert wall.state[1] == pytest.approx(0.0, abs=1e-9)


def test_both_masters_have_one_limit(slope_fmu, reference):
    """Explicit coupling with a very small step comes to the reference of implicit coupling."""
    assert couple(slope_fmu, 0.000625, explicit).error(reference) < 0.02
    assert couple(slope_fmu, 0.0025, implicit).error(reference) < 0.02


def test_implicit_coupling_converges(slope_fmu, reference):
    errors = {}
    for h in (0.02, 0.01, 0.005):
        course = couple(slope_fmu, h, implicit)
        assert 2 <= max(course.iterations) <= 12
        errors[h] = course.error(reference)
    assert errors[0.02] < 0.4
    assert errors[0.02] > 3.0 * errors[0.01] > 6.0 * errors[0.005]


def test_explicit_coupling_errs_with_the_step(explicit_errors):
    """The error goes with H: first order, as the delay of the force."""
    # 10 ms are as long as friction is delayed in the slope: the error has begun to level off.
    assert explicit_errors[0.01] > 1.6 * explicit_errors[0.005] > 3.0 * explicit_errors[0.0025]


def test_implicit_coupling_beats_explicit(slope_fmu, reference, explicit_errors):
    for h, error in explicit_errors.items():
        assert couple(slope_fmu, h, implicit).error(reference) < 0.7 * error


def test_explicit_coupling_blows_up_where_implicit_holds(slope_fmu, reference):
    """The delay feeds energy into the pad: at 20 ms it throws the toe until the slope's step is discarded."""
    with pytest.raises(Torn):
        couple(slope_fmu, 0.02, explicit)
    assert couple(slope_fmu, 0.02, implicit).error(reference) < 0.4


def test_the_page_has_the_errors_of_both_masters(slope_fmu, reference):
    rows = dict(re.findall(r"^\| ([\d.]+) ms \| (.+) \|$", PAGE, re.MULTILINE))
    assert list(rows) == ["20", "10", "5", "2.5"]
    for step, row in rows.items():
        h = float(step) / 1000
        course = couple(slope_fmu, h, implicit)
        counts = course.iterations
        found = f"{course.error(reference):.3f} | {sum(counts) / len(counts):.1f} ({max(counts)})"
        blown = "diverges: the slope discards a step"
        before = blown if step == "20" else f"{couple(slope_fmu, h, explicit).error(reference):.3f}"
        assert row == f"{before} | {found}"


@pytest.mark.parametrize(
    ("case", "port", "steps"), [("block_on_incline", "block", 100), ("coupled_slope", "toe", 200)]
)
def test_the_page_has_the_values_to_compare_with(fmus, opened, case, port, steps):
    slope = opened(fmus[f"{case}_fmi2.fmu"]).initialize().run(steps, 0.01)
    found = slope.get(f"{port}.displacement_x", f"{port}.displacement_y")
    given = re.search(rf"{port}\s\(([^,]+), ([^)]+)\) m", PAGE)
    assert [float(text.replace("−", "-")) for text in given.groups()] == found


def test_rejected_iterations_leave_no_trace(slope_fmu):
    """An implicit step whose converged force is known gives the same bits in one go, without any rollback."""
    first, second = Slope(slope_fmu, linear=True), Slope(slope_fmu, linear=True)
    wall, h = Wall(), 0.01
    with first.instance, second.instance:
        for k in range(10):
            forces = []

            def remembered(slope, wall, t, h):
                step = slope.step
                slope.step = lambda t, h, force: (forces.append(force), step(t, h, force))[1]
                try:
                    return implicit(slope, wall, t, h)
                finally:
                    del slope.step

            wall, count = remembered(first, wall, k * h, h)
            assert count == len(forces) >= 2
            second.step(k * h, h, forces[-1])
            assert first.instance.everything() == second.instance.everything()


def test_two_slopes_push_each_other(slope_fmu):
    """Two FMUs in one master: a spring between their toes, iterated on both with rollback; mirror twins stay twins."""
    one, other = Slope(slope_fmu, linear=True), Slope(slope_fmu, linear=True)
    stiffness, h, force, counts = 5e8, 0.01, 0.5 * PRELOAD, []
    with one.instance, other.instance:
        for k in range(20):
            states = one.instance.save(), other.instance.save()
            for count in range(1, 31):
                places = [slope.step(k * h, h, force) for slope in (one, other)]
                wanted = 0.5 * PRELOAD - stiffness * (places[0] + places[1])
                if numpy.linalg.norm(wanted - force) < TOLERANCE:
                    break
                force = 0.5 * (force + wanted)
                for slope, state in zip((one, other), states):
                    slope.instance.check(slope.instance.restore(state))
            for slope, state in zip((one, other), states):
                slope.instance.check(slope.instance.free_state(state))
            counts.append(count)
            assert (places[0] == places[1]).all()
    assert max(counts) < 30
    # The toes give way until the spring bears what was taken from them.
    assert (numpy.abs(force) > numpy.abs(0.5 * PRELOAD)).all() and (places[0] < 0.0).all()


def lose_the_anchor(instance, h: float) -> numpy.ndarray:
    """Toe after 0.4 s when its force is lost at once in front of a reservoir of 20 m, whose level the rock raises.

    Implicit: the level goes linearly to its value at the end of each step, which is found by fixed points.
    """
    two, foot, width = instance.version == 2, 8.0, 20.0
    normal = numpy.array([-22.0, 14.0]) / numpy.hypot(14.0, 22.0)
    instance.initialize(water_level=20.0, interpolate_inputs=not two)
    face = lambda: numpy.array(instance.get("face.displacement_x", "face.displacement_y"))
    start, level = face(), 20.0
    instance.check(instance.set(Slope.values([0.0, 0.0])))
    if not two:
        instance.check(instance.call("EnterStepMode"))
    for k in range(round(END / h)):
        state, guess, relax, before = instance.save(), level, 0.7, None
        for _ in range(30):
            instance.check(instance.set({"water_level": level if two else guess}))
            if two:
                instance.check(instance.set_rate("water_level", (guess - level) / h))
            instance.check(instance.step(k * h, h))
            pushed = (face() - start) @ normal * (guess - foot) / -normal[0]
            residual = 20.0 + pushed / width - guess
            if abs(residual) < 1e-10:
                break
            if before is not None:
                relax *= -before / (residual - before)
            before, guess = residual, guess + relax * residual
            instance.check(instance.restore(state))
        else:
            raise AssertionError(f"no convergence in step {k}")
        level = guess
    return numpy.array(instance.get("toe.displacement_x", "toe.displacement_y"))


def test_a_jump_beside_ramps_keeps_the_second_order(slope_fmu, opened):
    """A derivative of the level (FMI 2) and event mode (FMI 3) keep the sudden loss apart from the linear level."""
    options = {"event_mode": True} if slope_fmu.version == 3 else {}
    toes = [lose_the_anchor(opened(slope_fmu, **options), h) for h in (0.04, 0.02, 0.01)]
    first, second = (numpy.linalg.norm(b - a) for a, b in zip(toes, toes[1:]))
    assert 3.0 < first / second < 5.0
    assert second < 1e-6 * numpy.linalg.norm(toes[-1])
