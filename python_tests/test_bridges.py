"""A slope whose rock bridges break: the same bits through the C library, both FMUs, rollback and another process."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from fmu_support import Fmu, bits
from test_ctypes_life import fingerprint

H = 0.001
STEPS = 300
# A block on a plane of 40 degrees with three bridges, which break one after the other while a force grows.
CASE = """
title = "Bridges that break"
domain.outline = [[-4, -2], [14, -2], [14, 0], [10, 0], [10, 3.9], [0, 3.9], [0, 0], [-4, 0]]
domain.joint_law = "joint"
mesh.size = 1.3
mesh.angle_deg = 8
joint = [
    { points = [[0, 0], [1, 0]] }, { points = [[1.4, 0], [5, 0]] }, { points = [[5.3, 0], [8.7, 0]] },
    { points = [[9, 0], [10, 0]] },
]
bridge = [
    { points = [[1, 0], [1.4, 0]], law = "rock" }, { points = [[5, 0], [5.3, 0]], law = "rock" },
    { points = [[8.7, 0], [9, 0]], law = "rock" },
]
rock.r = { density = 2600, young = 10e9, poisson = 0.25 }
joint_law.joint.friction_deg = 30
solver.communication_step = 0.001
gravity = { x = 6.3, y = -7.5 }
fix = [{ block = [5, -1] }]
[joint_law.rock]
friction_deg = 45
residual_friction_deg = 30
cohesion = 0.35e6
residual_cohesion = 0
tension = 0.2e6
tension_energy = 20
shear_energy = 1e3
[[port]]
name = "block"
block = [5, 2]
[[stage]]
name = "break"
kind = "dynamic"
duration = 1.0
damping = 0.1
"""
MOTIONS = ["displacement_x", "displacement_y", "rotation", "velocity_x", "velocity_y", "angular_velocity"]


@pytest.fixture(scope="module")
def case(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("bridges") / "bridges.toml"
    path.write_text(CASE)
    return path


def push(k: int) -> float:
    return 3e3 * k


def act(model, first: int, last: int) -> None:
    for k in range(first, last):
        model.ports["block"].set_force(push(k), 0.0)
        model.do_step(k * H, H)


def state(model) -> tuple:
    return (*fingerprint(model), model.serialize())


def middle(package, case) -> int:
    """The first step after which some of the bridges have broken and some hold."""
    with package.Model.from_file(case) as model:
        model.start()
        broken = []
        for k in range(STEPS):
            act(model, k, k + 1)
            broken.append(model.totals().broken_length)
        assert broken[0] < 0.5 and broken[-1] == pytest.approx(1.0, rel=0.03), broken
        kinds = [event.kind.name for event in model.events()]
        assert kinds.count("BROKEN") == 3, kinds
    found = [k for k, length in enumerate(broken) if 0.0 < length < 0.95]
    assert found, broken
    return found[0] + 1


CHILD = """
import sys
import enmm
sys.path.insert(0, sys.argv[1])
from test_bridges import STEPS, act, state
with enmm.Model.from_file(sys.argv[2]) as model, open(sys.argv[3], "rb") as file:
    model.restore(model.deserialize(file.read()))
    act(model, int(sys.argv[4]), STEPS)
    sys.stdout.write(repr(state(model)))
"""


def test_a_failure_goes_on_to_the_same_bits(package, case, tmp_path):
    half = middle(package, case)
    with package.Model.from_file(case) as model:
        model.start()
        act(model, 0, half)
        here, file = state(model), tmp_path / "state.bin"
        file.write_bytes(model.serialize())
        with model.save() as saved:
            act(model, half, STEPS)
            expected = state(model)
            assert expected != here
            for _ in range(2):
                model.restore(saved)
                assert state(model) == here
                act(model, half, STEPS)
                assert state(model) == expected
    arguments = [sys.executable, "-c", CHILD, str(Path(__file__).parent), str(case), str(file), str(half)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    output = subprocess.run(arguments, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert output.returncode == 0, output.stderr
    assert output.stdout == repr(expected)


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_breaks_the_bridges_with_the_bits_of_the_library(package, enmm, opened, case, tmp_path, version):
    half = middle(package, case)
    path = tmp_path / "bridges.fmu"
    done = enmm("fmu", case, "-o", path, "--fmi", version)
    assert done.returncode == 0, done.stderr
    instance = opened(Fmu.unpack(path, tmp_path / "bridges")).initialize()
    names = [f"block.{name}" for name in MOTIONS] + ["broken_length"]

    def run(first: int, last: int) -> None:
        for k in range(first, last):
            instance.check(instance.set({"block.force_x": push(k)}))
            instance.check(instance.step(k * H, H))

    run(0, half)
    saved, here = instance.save(), bits(instance.get(*names))
    run(half, STEPS)
    expected = bits(instance.get(*names))
    instance.check(instance.restore(saved))
    assert bits(instance.get(*names)) == here
    run(half, STEPS)
    assert bits(instance.get(*names)) == expected
    with package.Model.from_file(case) as model:
        model.start()
        act(model, 0, STEPS)
        block = max(model.blocks(), key=lambda block: block["displacement_x"])
        own = [float(block[name]) for name in MOTIONS]
        assert bits([*own, model.totals().broken_length]) == expected
