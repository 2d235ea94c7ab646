"""Runs of the FMUs: closed forms, and the same bits as through Rust and C, whatever the steps, threads and versions."""

import ctypes
import math
import subprocess
import threading
from ctypes import c_char_p, c_double, c_size_t, c_void_p
from pathlib import Path

import numpy
import pytest
from conftest import from_environment
from fmpy import simulate_fmu
from fmu_support import ERROR, OK, WARNING, Fmu, bits, size

ROOT = Path(__file__).parents[1]
CASES = ROOT / "examples" / "cases"
G, H = 9.81, 0.01
WAY = ("block.displacement_x", "block.displacement_y")


def slide(friction_deg, t=1.0, dip_deg=30.0):
    """Way of a block down an incline (C1)."""
    a, phi = math.radians(dip_deg), math.radians(friction_deg)
    return 0.5 * G * (math.sin(a) - math.cos(a) * math.tan(phi)) * t * t


def way(x, y):
    """Component down the incline."""
    return x * math.cos(math.radians(30)) - y * math.sin(math.radians(30))


def run_of(instance, h, end):
    """Steps of h up to the end."""
    return instance.run(round(end / h), h)


# C1 through simulate_fmu.


def test_c1_block_slides_by_the_closed_form(incline_fmu):
    names = ["block.displacement_x", "block.displacement_y", "block.velocity_x", "block.velocity_y"]
    result = simulate_fmu(str(incline_fmu.path), output=names, output_interval=H, stop_time=1.0)
    assert len(result) == 101
    for row in result:
        t, x, y, vx, vy = row
        assert way(x, y) == pytest.approx(slide(20.0, t), abs=1e-4)
        assert way(vx, vy) == pytest.approx(2.0 * slide(20.0, 1.0) * t, abs=2e-4 + 1e-3 * t)
    assert way(result[names[0]][-1], result[names[1]][-1]) == pytest.approx(0.906407, abs=1e-4)


@pytest.mark.parametrize(
    ("friction_deg", "exact"), [(0, 2.452500), (10, 1.703489), (15, 1.314291), (25, 0.471693), (35, 0.0)]
)
def test_c1_friction_is_a_parameter(incline_fmu, friction_deg, exact):
    names = ["block.displacement_x", "block.displacement_y"]
    result = simulate_fmu(
        str(incline_fmu.path),
        output=names,
        output_interval=0.1,
        stop_time=1.0,
        start_values={"joint_law.joint.friction": math.radians(friction_deg)},
    )
    assert slide(friction_deg) == pytest.approx(exact, abs=1e-6) or exact == 0.0
    assert way(result[names[0]][-1], result[names[1]][-1]) == pytest.approx(exact, abs=2e-4)


@pytest.mark.parametrize("factor", [0.5, 0.9])
def test_strength_factor_is_a_factor_on_the_tangent(incline_fmu, opened, factor):
    """Set after the equilibrium, because the block would slide while it is sought."""
    instance = opened(incline_fmu).initialize()
    instance.check(instance.set({"strength_factor": factor}))
    run_of(instance, H, 1.0)
    friction = math.degrees(math.atan(factor * math.tan(math.radians(20.0))))
    assert way(*instance.get(*WAY)) == pytest.approx(slide(friction), abs=2e-4)


# C4: a base pulse, from an input table.

BLOCK_ON_BASE = """
title = "Block on a base"
domain.outline = [[-3, -1], [9, -1], [9, 0], [2, 0], [2, 1], [0, 1], [0, 0], [-3, 0]]
mesh.size = 0.8
mesh.origin = [0.03, 0.01]
joint = [{ points = [[0, 0], [2, 0]] }]
joint_law.joint.friction_deg = 11.309932474020213
rock.r = { density = 2000, young = 50e9, poisson = 0.2 }
fix = [{ block = [5, -0.5] }]
solver.communication_step = 0.01
[[port]]
name = "block"
block = [1, 0.5]
[[stage]]
name = "settle"
kind = "static"
duration = 5.0
convergence = 1e-7
[[stage]]
name = "move"
kind = "dynamic"
duration = 2.0
damping = 0.1
"""


@pytest.mark.parametrize("begin", [0.0, 0.1])
@pytest.mark.parametrize("version", [2, 3])
def test_c4_base_pulse_slips_by_newmark(enmm, tmp_path, version, begin):
    (tmp_path / "base.toml").write_text(BLOCK_ON_BASE)
    path = tmp_path / "base.fmu"
    done = enmm("fmu", tmp_path / "base.toml", "-o", path, "--fmi", version)
    assert done.returncode == 0, done.stderr
    # A jump is two rows of the same time; FMPy takes the value after it.
    a = -0.5 * G
    rows = [(begin, a), (begin + 0.5, a), (begin + 0.5, 0.0), (begin + 1.5, 0.0)]
    rows = rows if begin == 0.0 else [(0.0, 0.0), (begin, 0.0), *rows]
    pulse = numpy.array(rows, dtype=[("time", float), ("base_acceleration_x", float)])
    names = ["base_acceleration_x", "block.displacement_x", "block.velocity_x"]
    result = simulate_fmu(str(path), input=pulse, output=names, output_interval=H, stop_time=begin + 1.5)
    time, slip, speed = result["time"] - begin, result["block.displacement_x"], result["block.velocity_x"]
    assert slip[-1] == pytest.approx(0.919687, abs=5e-4)
    peak = numpy.argmax(speed)
    assert time[peak] == pytest.approx(0.5, abs=1e-9)
    assert speed[peak] == pytest.approx(0.3 * G * 0.5, abs=2e-3)
    assert speed[(time > 0.01) & (time < 1.24)].min() > 0.0
    assert abs(speed[time > 1.26]).max() < 1e-4


# Bit for bit.


@pytest.fixture(scope="module")
def rust():
    """Final block states of a case through the Rust API: six bit patterns for each block."""

    def run(case, h, steps):
        command = [str(from_environment("ENMM_EXAMPLE")), str(CASES / f"{case}.toml"), repr(h), str(steps)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
        assert done.returncode == 0, done.stderr
        lines = [line.split() for line in done.stdout.splitlines()]
        return [tuple(words[1:]) for words in lines if words[0].isdigit()]

    return run


MOTIONS = ["displacement_x", "displacement_y", "rotation", "velocity_x", "velocity_y", "angular_velocity"]


def of_blocks(instance):
    columns = [instance.get(f"block_{name}") for name in MOTIONS]
    return [tuple(bits([value])[::-1].hex() for value in row) for row in zip(*columns)]


def of_port(instance, port):
    return tuple(bits(instance.get(f"{port}.{name}"))[::-1].hex() for name in MOTIONS)


PORT_BLOCK = {"block_on_incline": "block", "coupled_slope": "toe"}


@pytest.mark.parametrize("case", list(PORT_BLOCK))
def test_bits_are_those_of_the_rust_api(fmus, opened, rust, case):
    steps = 40
    expected = rust(case, H, steps)
    three = opened(fmus[f"{case}_fmi3.fmu"]).initialize().run(steps, H)
    assert of_blocks(three) == expected
    two = opened(fmus[f"{case}_fmi2.fmu"]).initialize().run(steps, H)
    assert of_port(two, PORT_BLOCK[case]) == of_port(three, PORT_BLOCK[case])
    assert of_port(two, PORT_BLOCK[case]) in expected


@pytest.fixture(scope="module")
def c_library():
    """The C library without the calls of its package."""
    return ctypes.CDLL(str(from_environment("ENMM_LIBRARY")))


@pytest.mark.parametrize("case", list(PORT_BLOCK))
def test_bits_are_those_of_the_c_abi(fmus, opened, c_library, case):
    from enmm._abi import BlockState, StepInfo  # Layouts only; every call here is a plain one.

    library, steps = c_library, 40
    model = c_void_p()
    path = c_char_p(str(CASES / f"{case}.toml").encode())
    assert library.enmm_create_from_file(path, ctypes.byref(model)) == 0
    assert library.enmm_start(model) == 0
    info = StepInfo(struct_size=ctypes.sizeof(StepInfo))
    for k in range(steps):
        assert library.enmm_do_step(model, c_double(k * H), c_double(H), ctypes.byref(info)) == 0
    count = c_size_t()
    assert library.enmm_block_count(model, ctypes.byref(count)) == 0
    states = (BlockState * count.value)()
    states[0].struct_size = ctypes.sizeof(BlockState)
    assert library.enmm_get_block_states(model, states, count, ctypes.byref(count)) == 0
    library.enmm_destroy(model)
    found = [tuple(bits([getattr(state, name)])[::-1].hex() for name in MOTIONS) for state in states]
    assert of_blocks(opened(fmus[f"{case}_fmi3.fmu"]).initialize().run(steps, H)) == found


def test_fmpy_and_plain_calls_give_the_same_bits(fmu, opened):
    names = fmu.block_outputs()
    result = simulate_fmu(str(fmu.path), output=names, output_interval=H, stop_time=0.2)
    instance = opened(fmu).initialize()
    for k, row in enumerate(result):
        if k:
            instance.check(instance.step(float(result["time"][k - 1]), float(row["time"] - result["time"][k - 1])))
        assert bits(list(row)[1:]) == bits(instance.get(*names)), k


# Steps.


@pytest.mark.parametrize("parts", [2, 10, 20])
def test_state_does_not_depend_on_the_communication_step(fmu, opened, parts):
    whole = opened(fmu).initialize().run(20, H)
    parted = opened(fmu).initialize().run(20 * parts, H / parts)
    a, b = whole.get(*fmu.block_outputs()), parted.get(*fmu.block_outputs())
    assert numpy.allclose(a, b, rtol=1e-6, atol=1e-6)
    if parts <= 10:
        assert bits(a) == bits(b), "on the grid, even the bits"


def test_odd_and_changing_steps_end_in_the_same_state(fmu, opened):
    whole = opened(fmu).initialize().run(20, H)
    odd, t = opened(fmu).initialize(), 0.0
    for k in range(200):
        h = min(0.2 - t, 0.0003 + 0.0011 * (k % 7))
        if h <= 1e-12:
            break
        odd.check(odd.step(t, h))
        t += h
    assert t == pytest.approx(0.2, abs=1e-12)
    assert numpy.allclose(whole.get(*fmu.block_outputs()), odd.get(*fmu.block_outputs()), rtol=1e-6, atol=1e-6)


def test_one_step_for_all(incline_fmu, opened):
    one = opened(incline_fmu).initialize()
    one.check(one.step(0.0, 1.0))
    assert way(*one.get(*WAY)) == pytest.approx(0.906407, abs=1e-4)
    assert one.get(*incline_fmu.block_outputs()) == opened(incline_fmu).initialize().run(100, H).get(
        *incline_fmu.block_outputs()
    )


@pytest.mark.parametrize("start", [-3.0, 100.0, 1e6])
def test_start_time_shifts_only_time(fmu, opened, start):
    plain = opened(fmu).initialize().run(10, H)
    shifted = opened(fmu).initialize(start=start, stop=start + 1.0)
    if fmu.version == 3:
        assert shifted.get("time") == [start]
    shifted.run(10, H)
    if fmu.version == 3:
        assert shifted.get("time") == [pytest.approx(start + 0.1, abs=1e-9)]
    a, b = plain.get(*fmu.block_outputs()), shifted.get(*fmu.block_outputs())
    assert numpy.allclose(a, b, rtol=1e-6, atol=1e-6)
    if abs(start) < 1e3:
        assert bits(a) == bits(b)


def test_time_and_last_successful_time(fmus, opened):
    for fmu in fmus.values():
        instance = opened(fmu).initialize()
        for k in range(3):
            instance.check(instance.step(k * H, H))
            if fmu.version == 3:
                assert instance.get("time") == [k * H + H] == [instance.last_time]
                assert not (instance.early or instance.terminate_wanted or instance.event_wanted)
            else:
                time = c_double()
                assert instance.call("GetRealStatus", ctypes.c_int(2), ctypes.byref(time)) == OK
                assert time.value == k * H + H
                wanted = ctypes.c_int(7)
                assert instance.call("GetBooleanStatus", ctypes.c_int(3), ctypes.byref(wanted)) == OK
                assert wanted.value == 0


# Inputs.


def test_force_moves_the_block(incline_fmu, opened):
    """A force down the incline on 2650 kg adds its acceleration."""
    force = 5e3
    instance = opened(incline_fmu).initialize()
    a = math.radians(30)
    instance.check(instance.set({"block.force_x": force * math.cos(a), "block.force_y": -force * math.sin(a)}))
    run_of(instance, H, 1.0)
    assert way(*instance.get(*WAY)) == pytest.approx(slide(20.0) + 0.5 * force / 2650.0, abs=1e-3)


def test_start_inputs_act_on_the_initial_equilibrium(slope_fmu, opened):
    """Water that is set before initialization ends loads the slope at rest; set later it comes as a shock."""
    calm = opened(slope_fmu).initialize(water_level=12.0)
    rough = opened(slope_fmu).initialize()
    assert calm.get("plane.normal_force") != rough.get("plane.normal_force")
    rough.check(rough.set({"water_level": 12.0}))
    calm.run(1, H), rough.run(1, H)
    assert calm.get(*slope_fmu.block_outputs()) != rough.get(*slope_fmu.block_outputs())


def test_output_is_unchanged_until_the_next_step(fmu, opened):
    instance = opened(fmu).initialize().run(3, H)
    before = instance.get(*fmu.block_outputs())
    instance.check(instance.set({"gravity_x": 1.0, "base_acceleration_y": 0.3}))
    assert instance.get(*fmu.block_outputs()) == before


def sped(instance, start):
    """Speed after a step of 0.1 s with a force of 1 m/s² down the incline."""
    a = math.radians(30)
    instance.initialize(**start)
    instance.check(instance.set({"block.force_x": 2650.0 * math.cos(a), "block.force_y": -2650.0 * math.sin(a)}))
    instance.check(instance.step(0.0, 0.1))
    return way(*instance.get("block.velocity_x", "block.velocity_y"))


def test_interpolated_inputs_ramp_over_the_step(incline_fmu, opened):
    """A force that is reached linearly does half the impulse of one that holds."""
    hold, linear = (sped(opened(incline_fmu), {"interpolate_inputs": flag}) for flag in (False, True))
    assert hold - linear == pytest.approx(0.05, abs=6e-4)


def test_start_inputs_do_not_ramp(incline_fmu, opened):
    """What was set before initialization ends holds from the first instant on, with interpolation too."""
    start = {"gravity_y": 0.0}
    hold, linear = (sped(opened(incline_fmu), start | {"interpolate_inputs": flag}) for flag in (False, True))
    assert hold == pytest.approx(0.1, abs=2e-4) and linear == pytest.approx(0.05, abs=6e-4)


def test_port_and_array_forces_add(fmus, opened):
    fmu = fmus["coupled_slope_fmi3.fmu"]
    blocks = size(fmu.variables["block_force_x"])
    by_port = opened(fmu).initialize().run(5, H)
    toe = next(
        k for k in range(blocks) if by_port.get("block_displacement_x")[k] == by_port.get("toe.displacement_x")[0]
    )
    by_array = opened(fmu)
    by_array.check(by_array.set_up())
    force = [0.0] * blocks
    force[toe] = 0.9e6
    by_array.check(by_array.set({"toe.force_x": 0.0, "block_force_x": force}))
    by_array.check(by_array.exit_initialization())
    assert bits(by_array.run(5, H).get(*fmu.block_outputs())) == bits(by_port.get(*fmu.block_outputs()))


def test_derivatives_are_the_velocities(fmu, opened):
    instance = opened(fmu).initialize().run(5, H)
    pairs = {"displacement_x": "velocity_x", "displacement_y": "velocity_y", "rotation": "angular_velocity"}
    told = 0
    for name in fmu.block_outputs():
        stem, _, word = name.rpartition(".")
        if word in pairs:
            status, values = instance.derivative(name)
            assert (status, values) == (OK, instance.get(f"{stem}.{pairs[word]}"))
            told += 1
    assert told >= 5
    assert instance.derivative("kinetic_energy") == (OK, [0.0]), "of which nothing but the value is known"
    state = instance.save()
    for name, order in ((fmu.block_outputs()[0], 2), (fmu.block_outputs()[0], 0), ("gravity_x", 1)):
        assert instance.derivative(name, order)[0] == ERROR
        instance.check(instance.restore(state))


def test_energies_close(incline_fmu, opened):
    instance = run_of(opened(incline_fmu).initialize(), H, 1.0)
    kinetic, heat, potential, residual = instance.get(
        "kinetic_energy", "friction_heat", "potential_energy", "energy_residual"
    )
    assert abs(residual) < 2e-3 * max(kinetic, heat, abs(potential))
    assert kinetic == pytest.approx(0.5 * 2650.0 * (2.0 * slide(20.0)) ** 2, rel=1e-3)
    assert heat == pytest.approx(
        2650.0 * G * math.cos(math.radians(30)) * math.tan(math.radians(20)) * slide(20.0), rel=2e-3
    )


def test_events_are_counted(incline_fmu, opened):
    instance = opened(incline_fmu).initialize()
    assert instance.get("event_count", "last_event_kind", "last_event_subject", "last_event_time") == [0, 0, -1, 0.0]
    run_of(instance, H, 1.0)
    count, slipped, kind, time = instance.get("event_count", "slipped_joints", "last_event_kind", "last_event_time")
    assert count >= slipped >= 1 and kind in (1, 2, 3) and 0.0 < time <= 1.0


@pytest.mark.parametrize("version", [2, 3])
def test_an_overlap_is_an_event_a_warning_and_two_outputs(enmm, opened, tmp_path, version):
    path = tmp_path / "soft.fmu"
    done = enmm("fmu", ROOT / "ffi" / "capi" / "tests" / "cases" / "soft.toml", "-o", path, "--fmi", version)
    assert done.returncode == 0, done.stderr
    fmu = Fmu.unpack(path, tmp_path / "unpacked")
    instance = opened(fmu, logging=True).initialize()
    assert instance.get("overlap_max", "overlapping_pairs") == [0.0, 0]
    run_of(instance, H, 0.1)
    depth, pairs = instance.get("overlap_max", "overlapping_pairs")
    assert 0.005 < depth < 0.04 and pairs == 1
    kinds = instance.get("event_count", "last_event_kind")
    assert kinds[0] >= 1 and kinds[1] in (2, 4)
    assert sum("blocks 0 and 1 overlap by" in text for _, _, text in instance.log) == 1


def test_a_slope_that_fails_is_a_warning_once(incline_fmu, opened):
    instance = opened(incline_fmu, logging=True).initialize()
    run_of(instance, 0.1, 1.0)
    told = [(status, text) for status, _, text in instance.log if "the slope has failed" in text]
    assert len(told) == 1 and told[0][0] == WARNING
    assert "by sliding: 1 block, largest displacement 0.73" in told[0][1]


# Threads.


def test_instances_in_two_threads_give_the_same_bits(fmu, opened):
    expected = opened(fmu).initialize().run(20, H).everything()
    found, failures = {}, []

    def work(name):
        try:
            for repeat in range(2):
                with_name = opened(fmu, name=f"{name} {repeat}").initialize().run(20, H)
                found[name, repeat] = with_name.everything()
        except BaseException as problem:  # A thread's failure is the test's.
            failures.append(problem)

    threads = [threading.Thread(target=work, args=(name,)) for name in ("a", "b")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures and len(found) == 4
    assert set(found.values()) == {expected}


def test_an_instance_may_move_between_threads(fmu, opened):
    expected = opened(fmu).initialize().run(4, H).everything()
    instance = opened(fmu).initialize()
    for k in range(4):
        thread = threading.Thread(target=instance.run, args=(1, H, k))
        thread.start()
        thread.join()
    assert instance.everything() == expected


def test_threads_of_a_step_do_not_change_the_bits(fmu, opened):
    one = opened(fmu).initialize().run(5, H)
    two = opened(fmu).initialize(threads=2).run(5, H)
    assert bits(one.get(*fmu.block_outputs())) == bits(two.get(*fmu.block_outputs()))


def test_both_versions_give_the_same_bits(fmus, opened):
    """Over the times for which importers were tried, and to the ends that `docs/coupling.md` quotes."""
    for case, end in (("block_on_incline", 1.0), ("coupled_slope", 2.0)):
        pair = [fmus[f"{case}_fmi{version}.fmu"] for version in (2, 3)]
        names = pair[0].outputs()
        runs = [run_of(opened(fmu).initialize(), H, end) for fmu in pair]
        first, second = (bits(run.get(*names)) for run in runs)
        assert first == second


def test_parameters_change_the_model(fmu, opened):
    """Outputs in initialization mode are already those of the parameters that hold."""
    instance = opened(fmu)
    instance.check(instance.set_up())
    (before,) = instance.get("critical_dt")
    young = next(v for v in fmu.named("parameter") if v.name.endswith(".young"))
    instance.check(instance.set({young.name: 4.0 * float(young.start)}))
    assert instance.get("critical_dt")[0] == pytest.approx(0.5 * before, rel=0.2)
    instance.check(instance.set({young.name: float(young.start)}))
    assert instance.get("critical_dt") == [before]
