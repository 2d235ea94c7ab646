"""A bar that breaks off a wall: the same bits through the C library, both FMUs, returns and another process."""

from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from elsewhere import gone_on_elsewhere
from fmu_support import Fmu, bits
from test_ctypes_life import fingerprint

H = 1 / 1024
STEPS = 64
CASE = Path(__file__).parents[1] / "ffi/capi/tests/cases/breaking.toml"
MOTIONS = ["displacement_x", "displacement_y", "rotation", "velocity_x", "velocity_y", "angular_velocity"]
COUNTS = ["part_count", "cut_count", "cut_length"]


def act(model, first: int, last: int) -> None:
    for k in range(first, last):
        model.do_step(k * H, H)


def state(model) -> tuple:
    return (*fingerprint(model), model.serialize(), model.cuts)


def step_of_the_break(model) -> int:
    """Goes on until the bar has broken; the number of steps."""
    for k in range(STEPS):
        act(model, k, k + 1)
        if model.cuts:
            return k + 1
    raise AssertionError("the bar holds")


def test_a_bar_breaks_to_the_same_bits(package, tmp_path):
    with package.Model.from_file(CASE) as model, model.save() as whole:
        assert (model.block_count, model.blocks_max, model.cuts) == (1, 4, [])
        half = step_of_the_break(model)
        file = tmp_path / "state.bin"
        file.write_bytes(model.serialize())
        act(model, half, STEPS)
        expected = state(model)
        blocks = model.blocks(copy=True)
        assert model.block_count == 2 and blocks["id"].tolist() == [0, 1]
        (cut,) = model.cuts
        assert (cut.block, cut.part, cut.failure.name) == (0, 1, "BENT")
        assert 0 < cut.time <= half * H and 1 <= cut.share < 1.2 and abs(cut.first[0]) < 0.3
        event = next(event for event in model.events() if event.kind.name == "CUT")
        assert (event.subject, event.other, event.name, event.time) == (0, 1, "block 0", cut.time)
        assert model.names(package.NameKind.BLOCK) == ("block 0", "block 1")
        for _ in range(3):
            model.restore(whole)
            assert model.block_count == 1 and model.cuts == []
            act(model, 0, STEPS)
            assert state(model) == expected
    assert gone_on_elsewhere("test_breaks", CASE, file, half) == repr(expected)


def test_a_record_of_a_host_follows_the_break_and_the_return(package, tmp_path):
    with package.Model.from_file(CASE) as model, model.save() as whole:
        model.record(tmp_path / "results")
        act(model, 0, STEPS)
        model.restore(whole)
        act(model, 0, STEPS)
        model.end_record()
    result = package.Result(tmp_path / "results")
    (found,) = result.summary["breaks"]
    assert found["block"] == 0 and found["part"] == 1
    assert len((tmp_path / "results/blocks.csv").read_text(encoding="utf-8").splitlines()) == 3


@pytest.fixture(scope="module", params=[2, 3])
def breaking(request, enmm, tmp_path_factory) -> Fmu:
    folder = tmp_path_factory.mktemp("breaks")
    path = folder / "breaking.fmu"
    done = enmm("fmu", CASE, "-o", path, "--fmi", request.param)
    assert done.returncode == 0, done.stderr
    return Fmu.unpack(path, folder / "breaking")


def test_an_fmu_breaks_the_bar_with_the_bits_of_the_library(package, opened, breaking):
    instance = opened(breaking).initialize()
    names = [*(f"bar.{name}" for name in MOTIONS), *COUNTS]

    def run(first: int, last: int) -> None:
        for k in range(first, last):
            instance.check(instance.step(k * H, H))

    saved, here = instance.save(), bits(instance.get(*names))
    run(0, STEPS)
    expected = instance.get(*names)
    assert expected[-3:-1] == [2, 1]
    instance.check(instance.restore(saved))
    assert bits(instance.get(*names)) == here
    run(0, STEPS)
    assert bits(instance.get(*names)) == bits(expected)
    with package.Model.from_file(CASE) as model:
        act(model, 0, STEPS)
        block = model.blocks()[0]
        own = [float(block[name]) for name in MOTIONS]
        assert bits(own) == bits(expected[: len(own)])


def test_fmpy_sees_the_parts(breaking):
    assert validate_fmu(str(breaking.path)) == []
    arrays = ["block_x", "block_y"] if breaking.version == 3 else []
    rows = fmpy.simulate_fmu(
        str(breaking.path), stop_time=STEPS * H, step_size=H, output_interval=H, output=[*COUNTS, *arrays]
    )
    assert rows["part_count"].tolist()[0] == 1 and rows["part_count"].tolist()[-1] == 2
    assert (np.diff(rows["cut_count"]) >= 0).all() and rows["cut_length"][-1] == pytest.approx(1.0, rel=0.05)
    for name in arrays:
        assert rows[name].shape[1] == 4
        assert (rows[name][0][1:] == 0).all() and (rows[name][-1][:2] != 0).all() and (rows[name][-1][2:] == 0).all()
