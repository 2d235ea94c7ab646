"""The adapter for preCICE: forces, checkpoints, and a column that is cut in two and coupled implicitly.

The coupling library is the stand-in `precice_stand_in`, which has the same calls.
"""

import json
import math
import threading

import numpy as np
import precice_stand_in
import pytest

MESH = 80.0 / math.sqrt(3)
"""Size of the mesh (m): its rows are 40 m high, so that both halves have the elements of the whole."""
WIDTH, HEIGHT = 2 * MESH, 800.0
DENSITY, SHEAR, POISSON = 1.0, 1e4, 2 / 11
MODULUS = 2 * SHEAR * (1 - POISSON) / (1 - 2 * POISSON)
PERIOD = 4 * HEIGHT * math.sqrt(DENSITY / MODULUS)
PUSH = 1e-3 * MODULUS / (DENSITY * HEIGHT)
"""Acceleration (m/s2) that sets in at once and stays."""
WINDOW = 0.01


@pytest.fixture(scope="module")
def adapter(package):
    from enmm.precice import Adapter

    return Adapter


def column(package, low, high):
    """An elastic column between two heights, confined at its sides; held at its foot where that is at 0."""
    sides = [{"edge": [[x, low], [x, high]], "axes": "x"} for x in (0.0, WIDTH)]
    foot = [{"edge": [[0.0, 0.0], [WIDTH, 0.0]]}] if low == 0.0 else []
    return package.Case.from_dict(
        {
            "title": "A column",
            "domain": {"outline": [[0.0, low], [WIDTH, low], [WIDTH, high], [0.0, high]]},
            "mesh": {"size": MESH, "origin": [0.0, 0.0]},
            "rock": {"rock": {"density": DENSITY, "young": 2 * SHEAR * (1 + POISSON), "poisson": POISSON}},
            "gravity": {"y": 0.0},
            "joint_law": {"none": {"friction_deg": 30.0}},
            "fix": foot + sides,
            "port": [{"name": "head", "boundary": [[0.0, high], [WIDTH, high]]}],
            "stage": [{"name": "shaken", "kind": "dynamic", "duration": 100.0, "damping": 0.0}],
            "solver": {"communication_step": WINDOW},
        }
    )


CUT = [[0.0, HEIGHT / 2], [WIDTH, HEIGHT / 2]]


def test_forces_are_conservative(package, adapter):
    upper = adapter(column(package, HEIGHT / 2, HEIGHT), CUT, "M", {"F": "force"}, {"D": "displacement"})
    model = upper.model
    assert np.allclose(upper.lengths, MESH) and np.allclose(
        upper.positions, [[MESH / 2, HEIGHT / 2], [1.5 * MESH, HEIGHT / 2]]
    )
    force = np.array([[0.0, 3.0], [0.0, 9.0]])
    for _ in range(40):
        upper.step(WINDOW, {"force": force})
    mass = model.blocks()["mass"].sum()
    # The force grows over the first window; velocities are half an internal step late.
    impulse = force[:, 1].sum() * (model.time - 0.5 * WINDOW - 0.5 * model.internal_step)
    assert mass * model.blocks()["velocity_y"][0] == pytest.approx(impulse, rel=1e-12)
    # Forces and displacements belong together: what a force at one place moves at another, moves it the same way round.
    with model.save() as start:
        compliance = upper._probe(WINDOW, start)
    assert np.allclose(compliance, compliance.T, rtol=1e-9, atol=1e-9 * np.abs(compliance).max())


def test_pressure_and_traction_are_force_by_length(package, adapter):
    case = column(package, HEIGHT / 2, HEIGHT)
    found = []
    for read, values in (
        ({"F": "force"}, {"force": np.array([[0.0, MESH], [0.0, MESH]])}),
        ({"T": "traction"}, {"traction": np.array([[0.0, 1.0], [0.0, 1.0]])}),
        ({"P": "pressure"}, {"pressure": np.array([1.0, 1.0])}),
    ):
        made = adapter(case, CUT, "M", read, {"V": "velocity"})
        made.step(WINDOW, values)
        found.append(made.velocity())
    assert np.allclose(found[0], found[1], rtol=1e-12, atol=0) and np.allclose(
        found[0], found[2], rtol=1e-9, atol=1e-15
    )


def test_a_velocity_is_imposed_by_the_force_that_leads_to_it(package, adapter):
    case = column(package, HEIGHT / 2, HEIGHT)
    pushed = adapter(case, CUT, "M", {"F": "force"}, {"V": "velocity"}, interpolation=package.Interpolation.HOLD)
    moved = adapter(case, CUT, "M", {"V": "velocity"}, {"F": "force"})
    for k in range(1, 6):
        force = np.array([[0.5 * k, 3.0 * k], [0.0, 9.0]])
        pushed.step(WINDOW, {"force": force})
        moved.step(WINDOW, {"velocity": pushed.velocity()})
        assert np.allclose(moved._force, force, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": [[0.0, HEIGHT / 2], [60.0, HEIGHT / 2]]}, "of which 46.188 m are whole facets"),
        ({"points": [[5.0, 500.0], [9.0, 500.0]]}, "0 m are whole facets"),
        ({"points": [[0.0, HEIGHT / 2]]}, "at least two"),
        ({"read": {"X": "heat"}}, "read: has X: 'heat'"),
        ({"read": {}}, "read: has no data"),
        ({"read": {"V": "velocity", "F": "force"}}, "must have it alone"),
        ({"write": {"F": "force"}}, "only known where a velocity is read"),
    ],
)
def test_wrong_interfaces_are_refused(package, adapter, change, message):
    good = {"points": CUT, "mesh": "M", "read": {"F": "force"}, "write": {"D": "displacement"}}
    with pytest.raises(package.InvalidArgumentError, match=message):
        adapter(column(package, HEIGHT / 2, HEIGHT), **{**good, **change})


def head_of(model):
    return model.ports["head"].state().displacement_y


def period(times, head):
    """First period by two upward passages through the mean of the oscillation."""
    level = PUSH * DENSITY * HEIGHT**2 / (2 * MODULUS)
    up = [k for k in range(1, len(head)) if head[k - 1] < level <= head[k]]
    passages = [times[k - 1] + (level - head[k - 1]) / (head[k] - head[k - 1]) * (times[k] - times[k - 1]) for k in up]
    return passages[1] - passages[0]


def coupled(package, adapter, path, end):
    """Runs the two halves as two solvers; returns the head over time, the forces on both sides, the iterations."""
    names = {"first": "Lower", "second": "Upper", "mesh": "Cut", "to_first": "Force", "to_second": "Velocity"}
    path.write_text(
        json.dumps(
            {**names, "window": WINDOW, "end": end, "limit": 5e-13 * DENSITY * WIDTH * HEIGHT * PUSH, "most": 30}
        )
    )
    halves = [column(package, *of) for of in ((0.0, HEIGHT / 2), (HEIGHT / 2, HEIGHT))]
    hold = {"interpolation": package.Interpolation.HOLD}
    lower = adapter(halves[0], CUT, "Cut", {"Force": "force"}, {"Velocity": "velocity"}, **hold)
    upper = adapter(halves[1], CUT, "Cut", {"Velocity": "velocity"}, {"Force": "force"})
    for half in (lower, upper):
        # The frame of the columns falls, and so they are pushed upwards.
        half.model.set_base_acceleration(0.0, -PUSH)
    record, applied, errors = [], [], []
    step = lower.step
    lower.step = lambda dt, values: (applied.append((lower.model.time, values["force"].copy())), step(dt, values))
    answer = upper.step
    upper.step = lambda dt, values: (
        answer(dt, values),
        record.append((upper.model.time, head_of(upper.model), upper._force.copy())),
    )

    def take_part(half, name):
        try:
            half.run(name, path, precice_stand_in)
        except BaseException as error:
            errors.append(error)
            precice_stand_in._running[str(path)].pass_to("broken")

    pair = [threading.Thread(target=take_part, args=part) for part in ((lower, "Lower"), (upper, "Upper"))]
    for thread in pair:
        thread.start()
    for thread in pair:
        thread.join()
    assert not errors, errors
    iterations = precice_stand_in._running[str(path)].iterations
    # The last iteration of every window is the one that counts.
    heads = {round(time / WINDOW): (time, head, force) for time, head, force in record}
    forces = {round(time / WINDOW) + 1: force for time, force in applied}
    gap = np.abs(lower.displacement() - upper.displacement()).max()
    return heads, forces, iterations, gap


def test_a_column_cut_in_two_has_the_period_of_the_whole(package, adapter, tmp_path):
    end = 1.5 * PERIOD
    heads, forces, iterations, gap = coupled(package, adapter, tmp_path / "coupling.json", end)
    with column(package, 0.0, HEIGHT).model() as whole:
        whole.set_base_acceleration(0.0, -PUSH)
        alone = [(0.0, 0.0)]
        while whole.time < end - 1e-9:
            whole.do_step(whole.time, WINDOW)
            alone.append((whole.time, head_of(whole)))
    together = [(0.0, 0.0), *((time, head) for time, head, _ in heads.values())]
    found, wanted = (period(*np.array(path).T) for path in (together, alone))
    # Velocities are equal at the ends of windows; displacements then differ by what falls with the window squared.
    assert gap < 1e-4 * max(head for _, head in together)
    assert np.mean(iterations) < 6
    assert abs(found / wanted - 1) < 1e-4
    assert abs(wanted / PERIOD - 1) < 5e-3
    largest = max(np.abs(force).max() for force in forces.values())
    unbalanced = max(np.abs(forces[k] + of).max() for k, (_, _, of) in heads.items())
    assert unbalanced < 1e-12 * largest, "what one half takes is what the other gives"
