"""A slope whose rock bridges break: the same bits through the C library, both FMUs, rollback and another process."""

from pathlib import Path

import pytest
from elsewhere import gone_on_elsewhere
from fmu_support import Fmu, bits
from test_ctypes_life import fingerprint

H = 0.001
STEPS = 300
CASE = Path(__file__).parents[1] / "ffi/capi/tests/cases/bridges.toml"
MOTIONS = ["displacement_x", "displacement_y", "rotation", "velocity_x", "velocity_y", "angular_velocity"]


def push(k: int) -> float:
    return 3e3 * k


def act(model, first: int, last: int) -> None:
    for k in range(first, last):
        model.ports["block"].set_force(push(k), 0.0)
        model.do_step(k * H, H)


def state(model) -> tuple:
    return (*fingerprint(model), model.serialize())


def middle(package) -> int:
    """The first step after which some of the bridges have broken and some hold."""
    with package.Model.from_file(CASE) as model:
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


def test_a_failure_goes_on_to_the_same_bits(package, tmp_path):
    half = middle(package)
    with package.Model.from_file(CASE) as model:
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
    assert gone_on_elsewhere("test_bridges", CASE, file, half) == repr(expected)


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_breaks_the_bridges_with_the_bits_of_the_library(package, enmm, opened, tmp_path, version):
    half = middle(package)
    path = tmp_path / "bridges.fmu"
    done = enmm("fmu", CASE, "-o", path, "--fmi", version)
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
    with package.Model.from_file(CASE) as model:
        model.start()
        act(model, 0, STEPS)
        block = max(model.blocks(), key=lambda block: block["displacement_x"])
        own = [float(block[name]) for name in MOTIONS]
        assert bits([*own, model.totals().broken_length]) == expected
