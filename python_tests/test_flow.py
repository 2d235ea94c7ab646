"""Water in the joint below a dam: heads, rain and a drain of a host, with the same bits in the library and both FMUs."""

from pathlib import Path

import pytest
from fmpy.validation import validate_fmu
from fmu_support import Fmu, bits

H = 1 / 256
STEPS = 8
CASE = Path(__file__).parents[1] / "ffi/capi/tests/cases/dam.toml"
DRAINING = CASE.with_name("draining_dam.toml")
WEIGHT = 9810.0
T = WEIGHT * 1e-12 / (12 * 1e-3)
PORT = ["water_pressure", "water_pressure_max", "uplift"]
TOTALS = ["water_entered", "water_left", "flow_residual", "seepage_height", "water_stored", "flow_parted",
          "flow_parted_pieces"]
INPUTS = ["heel.head", "toe.head", "crest.rate", "row.active"]
OUTPUTS = ["heel.inflow", "toe.inflow", "crest.inflow", "crest.run_off", "row.outflow"]
OUTPUTS += [f"base.{name}" for name in PORT] + TOTALS


def inputs(k: int) -> dict[str, float]:
    """Inputs of step `k`."""
    return {"heel.head": 9.0 - 0.1 * k, "toe.head": 4.0 + 0.05 * k, "crest.rate": 1e-9 * k, "row.active": k % 4 > 1}


def act(model, first: int, last: int, parts: int = 1) -> None:
    for k in range(first, last):
        given = inputs(k)
        model.set_head("heel", given["heel.head"])
        model.set_head(1, given["toe.head"])
        model.set_rain("crest", given["crest.rate"])
        model.set_drain("row", given["row.active"])
        for part in range(parts):
            model.do_step((k + part / parts) * H, H / parts)


def outputs(model) -> list[float]:
    """Numbers of the library in the order of `OUTPUTS`."""
    rain, port, totals = model.rain("crest"), model.ports["base"].state(), model.totals()
    inlets = [model.head(0).inflow, model.head("toe").inflow, rain.inflow, rain.run_off, model.drain("row").outflow]
    return inlets + [getattr(port, name) for name in PORT] + [getattr(totals, name) for name in TOTALS]


def test_pressures_and_flows_are_those_by_hand(package):
    with package.Model.from_file(CASE) as model:
        model.start()
        assert model.flow_inputs == ({"heel": 9.0, "toe": 4.0}, {"crest": 0.0}, {"row": False})
        model.set_head("toe", 5.0)
        model.do_step(0.0, H)
        port = model.ports["base"].state()
        assert port.uplift == pytest.approx(WEIGHT * 20 * (6 + 2) / 2, rel=1e-12)
        assert port.water_pressure == pytest.approx(WEIGHT * 4, rel=1e-12)
        assert port.water_pressure_max == pytest.approx(WEIGHT * 6, rel=1e-12)
        assert model.head("heel").inflow == pytest.approx(T * 4 / 20, rel=1e-12)
        assert model.head("toe").outflow == pytest.approx(T * 4 / 20, rel=1e-12)
        model.set_drain("row", True)
        model.do_step(H, H)
        assert model.drain("row").outflow == pytest.approx(T * (6 / 5 + 2 / 15), rel=1e-12)
        totals = model.totals()
        assert totals.water_entered > 0
        assert totals.water_left == pytest.approx(totals.water_entered, rel=1e-12)
        assert totals.flow_residual <= 1e-12 * T and totals.seepage_height == 3.0
        assert model.flow_inputs.drains == {"row": True}


def test_values_that_cannot_be_are_refused(package):
    with package.Model.from_file(CASE) as model:
        with pytest.raises(package.NotFoundError, match="no head is named 'hill'; heads of the case: heel, toe"):
            model.set_head("hill", 1.0)
        with pytest.raises(package.InvalidArgumentError, match='level of head "heel"'):
            model.set_head("heel", float("inf"))
        with pytest.raises(package.InvalidArgumentError, match='rate of rain "crest"'):
            model.set_rain("crest", -1.0)
        with pytest.raises(package.InvalidArgumentError, match="number of drains, 1"):
            model.set_drain(1, True)
    with package.Model.from_string(CASE.read_text(encoding="utf-8").split("flow = \"steady\"")[0]) as held:
        held.set_head("heel", 8.0)
        held.start()
        assert held.ports["base"].state().uplift == pytest.approx(WEIGHT * 20 * 3, rel=1e-12)
        with pytest.raises(package.InvalidArgumentError, match='flow = "steady"'):
            held.set_head("heel", 9.0)


def test_copies_and_returns_have_the_same_bits(package):
    with package.Model.from_file(CASE) as model:
        model.start()
        act(model, 0, 3)
        with model.save() as saved:
            data = model.serialize()
            act(model, 3, STEPS)
            expected, end = bits(outputs(model)), model.serialize()
            model.restore(saved)
            act(model, 3, STEPS)
            assert bits(outputs(model)) == expected and model.serialize() == end
    with package.Model.from_file(CASE) as other:
        other.restore(other.deserialize(data))
        act(other, 3, STEPS)
        assert bits(outputs(other)) == expected and other.serialize() == end


def fmu_of(case: Path, enmm, version: int, folder: Path) -> Fmu:
    path = folder / "dam.fmu"
    done = enmm("fmu", case, "-o", path, "--fmi", version)
    assert done.returncode == 0, done.stderr
    return Fmu.unpack(path, folder / "dam")


@pytest.fixture(scope="module", params=[2, 3])
def dam(request, enmm, tmp_path_factory) -> Fmu:
    return fmu_of(CASE, enmm, request.param, tmp_path_factory.mktemp("dam"))


def test_an_fmu_moves_the_water_with_the_bits_of_the_library(package, opened, dam):
    moves_the_water(CASE, package, opened, dam)


@pytest.mark.parametrize("version", [2, 3])
def test_flow_that_goes_on_in_time_has_the_same_bits_everywhere(package, opened, enmm, tmp_path, version):
    expected = moves_the_water(DRAINING, package, opened, fmu_of(DRAINING, enmm, version, tmp_path))
    for parts in (2, 8):
        with package.Model.from_file(DRAINING) as model:
            model.start()
            act(model, 0, STEPS, parts)
            assert bits(outputs(model)) == bits(expected)
            entered, left, _, _, stored, *_ = (getattr(model.totals(), name) for name in TOTALS)
            assert abs(stored) > 1e-6 * entered > 0
            assert abs(entered - left - stored) <= 1e-12 * (entered + left) + 1e-15


def moves_the_water(case: Path, package, opened, dam: Fmu) -> list[float]:
    """Outputs of an FMU of `case` after all steps, which are those after a return, and those of the library."""
    assert validate_fmu(str(dam.path)) == []
    instance = opened(dam).initialize()

    def run(first: int, last: int) -> None:
        for k in range(first, last):
            instance.check(instance.set(inputs(k)))
            instance.check(instance.step(k * H, H))

    run(0, 3)
    saved = instance.save()
    run(3, STEPS)
    expected = instance.get(*OUTPUTS)
    assert expected[OUTPUTS.index("crest.inflow")] > 0 and expected[OUTPUTS.index("row.outflow")] > 0
    instance.check(instance.restore(saved))
    run(3, STEPS)
    assert bits(instance.get(*OUTPUTS)) == bits(expected)
    with package.Model.from_file(case) as model:
        model.start()
        act(model, 0, STEPS)
        assert bits(outputs(model)) == bits(expected)
    return expected


def test_inputs_before_the_start_belong_to_the_equilibrium(package, opened, dam):
    instance = opened(dam).initialize(**{"heel.head": 8.0, "row.active": True})
    with package.Model.from_file(CASE) as model:
        model.set_head("heel", 8.0)
        model.set_drain("row", True)
        model.start()
        assert bits(instance.get(*OUTPUTS)) == bits(outputs(model))
        assert model.drain("row").outflow == pytest.approx(T * (5 / 5 + 1 / 15), rel=1e-12)


def test_variables_of_water_stand_behind_all_others(enmm, tmp_path, dam):
    names = list(dam.variables)
    own = [*INPUTS, *OUTPUTS]
    assert sorted(names[-len(own) :]) == sorted(own)
    dry = tmp_path / "dry.toml"
    text = CASE.read_text(encoding="utf-8")
    for table in ("flow", "head", "rain", "drain"):
        start = text.index(f"{table} = ")
        text = text[:start] + text[text.index("]\n" if table != "flow" else "}\n", start) + 2 :]
    dry.write_text(text.replace('flow = "steady"\nflow_every = 2\n', ""), encoding="utf-8")
    done = enmm("fmu", dry, "-o", tmp_path / "dry.fmu", "--fmi", dam.version)
    assert done.returncode == 0, done.stderr
    others = Fmu.unpack(tmp_path / "dry.fmu", tmp_path / "dry")
    assert list(others.variables) == names[: -len(own)]
