"""What only FMI 3 has: early return, intermediate update, arrays, binaries, and calls of types that no variable has."""

import ctypes
from ctypes import byref, c_bool, c_double, c_size_t, c_uint32, c_void_p

import pytest
from fmpy import simulate_fmu
from fmpy.fmi3 import FMU3Slave
import fmu_support
from fmu_support import ERROR, OK, bits, size

H = 0.01


@pytest.fixture
def sliding(fmus):
    return fmus["block_on_incline_fmi3.fmu"]


@pytest.fixture(params=["block_on_incline_fmi3.fmu", "coupled_slope_fmi3.fmu"], ids=["incline", "slope"])
def three(request, fmus):
    return fmus[request.param]


# Early return.


def test_step_returns_at_the_first_slip(sliding, opened):
    instance = opened(sliding, early_return=True).initialize()
    instance.check(instance.step(0.0, 0.5))
    assert instance.early and not instance.terminate_wanted and not instance.event_wanted
    assert 0.0 < instance.last_time < 0.02
    assert instance.get("event_count")[0] >= 1
    assert instance.get("last_event_time") == [pytest.approx(instance.last_time, abs=1e-12)]
    assert instance.get("time") == [instance.last_time]
    # From there on, with the same bits as a run that was not interrupted.
    t = instance.last_time
    instance.check(instance.step(t, 0.5 - t))
    assert not instance.early and instance.last_time == pytest.approx(0.5, abs=1e-12)
    whole = opened(sliding).initialize()
    whole.check(whole.step(0.0, 0.5))
    assert not whole.early and whole.last_time == 0.5
    assert bits(instance.get(*sliding.block_outputs())) == bits(whole.get(*sliding.block_outputs()))


def test_a_wrong_begin_after_an_early_return_is_refused(sliding, opened):
    instance = opened(sliding, early_return=True).initialize()
    instance.check(instance.step(0.0, 0.5))
    assert instance.early
    with instance.complaint():
        assert instance.step(0.5, 0.1) == ERROR


def test_no_early_return_unless_allowed(sliding, opened):
    instance = opened(sliding, early_return=False).initialize()
    instance.check(instance.step(0.0, 0.5))
    assert not instance.early and instance.last_time == 0.5
    assert instance.get("event_count")[0] >= 1


def test_rollback_over_an_early_return(sliding, opened):
    instance = opened(sliding, early_return=True).initialize()
    state = instance.save()
    for _ in range(2):
        instance.check(instance.step(0.0, 0.5))
        assert instance.early
        found = instance.everything()
        instance.check(instance.restore(state))
    instance.check(instance.step(0.0, 0.5))
    assert instance.everything() == found


def test_fmpy_goes_on_after_early_returns(sliding):
    names = ["block.displacement_x"]
    plain = simulate_fmu(str(sliding.path), output=names, output_interval=H, stop_time=0.3)
    early = simulate_fmu(str(sliding.path), output=names, output_interval=H, stop_time=0.3, early_return_allowed=True)
    assert early[names[0]][-1] == pytest.approx(plain[names[0]][-1], abs=1e-9)


# Intermediate update.


def test_updates_come_at_internal_steps(three, opened):
    told = []
    name = three.block_outputs()[0]

    def look(instance, time, set_requested, get_allowed, finished, can_return):
        assert get_allowed and finished and not set_requested
        told.append((time, can_return, *instance.get("time", name)))

    instance = opened(three, on_update=look).initialize().run(3, H)
    times = [row[0] for row in told]
    assert times == sorted(set(times)) and times[-1] == pytest.approx(3 * H, abs=1e-9)
    assert all(time == own for time, _, own, _ in told)
    assert not any(can_return for _, can_return, *_ in told), "early return was not allowed"
    (internal,) = instance.get("internal_dt")
    assert len(times) == pytest.approx(3 * H / internal, abs=1)
    # Looking changes nothing.
    assert instance.everything() == opened(three).initialize().run(3, H).everything()


def test_derivatives_and_arrays_in_an_update(three, opened):
    seen = []

    def look(instance, time, *_):
        name = next(n for n in three.block_outputs() if n.endswith("displacement_x"))
        status, values = instance.derivative(name)
        assert status == OK and values == instance.get(name.replace("displacement", "velocity"))
        assert len(instance.get("block_x")) == size(three.variables["block_x"])
        seen.append(time)

    opened(three, on_update=look).initialize().run(1, H)
    assert seen


@pytest.mark.parametrize("wanted", [0.0123, 0.02, 0.015, 0.0001, 0.09999])
def test_early_return_on_request(three, opened, wanted):
    """The importer may ask in an update to return, at the time that it gives."""

    def ask(_instance, time, _set, _get, _finished, can_return):
        return wanted if can_return and time < wanted + 1e-12 else None

    instance = opened(three, on_update=ask, early_return=True).initialize()
    state = instance.save()
    instance.check(instance.step(0.0, 0.1))
    (internal,) = instance.get("internal_dt")
    if not instance.get("event_count")[0]:
        assert instance.early
        assert wanted - 1e-9 <= instance.last_time <= max(wanted, internal) + 1e-9
    assert instance.get("time") == [instance.last_time]
    t = instance.last_time
    for _ in range(5):
        if t < 0.1 - 1e-12:
            instance.check(instance.step(t, 0.1 - t))
            t = instance.last_time
    assert t == pytest.approx(0.1, abs=1e-9)
    plain = opened(three).initialize()
    plain.check(plain.step(0.0, 0.1))
    assert instance.get(*three.block_outputs()) == pytest.approx(plain.get(*three.block_outputs()), rel=1e-6, abs=1e-6)
    instance.check(instance.restore(state))


@pytest.mark.parametrize("when", [float("nan"), float("inf"), -1.0, 0.0])
def test_nonsense_times_of_an_early_return(three, opened, when):
    instance = opened(three, on_update=lambda *_: when, early_return=True).initialize()
    instance.check(instance.step(0.0, H))
    assert 0.0 < instance.last_time <= H + 1e-12
    instance.check(instance.step(instance.last_time, H))


def test_illegal_calls_in_an_update_end_the_step(three, opened):
    """Setting, stepping, saving or freeing within an update is refused; the instance and its states survive."""
    wrong = {
        "set": lambda i: i.set({"gravity_x": 1.0}),
        "step": lambda i: i.step(0.0, H),
        "terminate": lambda i: i.terminate(),
        "reset": lambda i: i.reset(),
        "exit": lambda i: i.exit_initialization(),
        "restore": lambda i: i.restore(c_void_p(1)),
    }
    for name, call in wrong.items():
        statuses = []
        # The step within must not overwrite what the one without tells.
        instance = opened(three, on_update=lambda i, *_: statuses.append(call(i)))
        instance.initialize()
        state = instance.save()
        status = instance.step(0.0, H)
        assert set(statuses) == {ERROR}, name
        if name != "restore":
            assert status == ERROR, name
        instance.on_update = lambda *_: None
        instance.check(instance.restore(state))
        instance.run(2, H)


def test_freeing_in_an_update_is_no_crash(three, opened):
    def free(instance, *_):
        pointer = instance.pointer
        instance.free()
        instance.pointer = pointer

    instance = opened(three, on_update=free).initialize()
    assert instance.step(0.0, H) in (OK, ERROR)


def test_fmpy_slave_updates(sliding):
    told = []

    def update(_environment, time, *_):
        told.append(time)

    made = FMU3Slave(
        instanceName="slave",
        guid=sliding.token,
        unzipDirectory=str(sliding.folder),
        modelIdentifier=sliding.description.coSimulation.modelIdentifier,
    )
    made.instantiate(intermediateUpdate=update)
    made.enterInitializationMode()
    made.exitInitializationMode()
    _, _, early, last = made.doStep(0.0, H)
    assert not early and last == H and told and told[-1] == pytest.approx(H)
    made.terminate()
    made.freeInstance()


# Arrays and binaries.


def test_arrays_and_scalars_in_one_call(three, opened):
    instance = opened(three).initialize().run(2, H)
    names = ["block_x", "time", "block_velocity_y", "kinetic_energy"]
    references = [three.variables[name].valueReference for name in names]
    count = sum(size(three.variables[name]) for name in names)
    status, values = instance.get_raw("Float64", references, count)
    assert status == OK and values == instance.get(*names)
    status, values = instance.get_raw(
        "Int32", [three.variables["block_contact_count"].valueReference], size(three.variables["block_contact_count"])
    )
    assert status == OK and sum(values) > 0


def test_arrays_agree_with_ports(fmus, opened):
    fmu = fmus["block_on_incline_fmi3.fmu"]
    instance = opened(fmu).initialize().run(20, H)
    for word in ("displacement_x", "displacement_y", "velocity_x", "velocity_y", "rotation", "stress_xx", "stress_xy"):
        assert instance.get(f"block.{word}")[0] in instance.get(f"block_{word}"), word


def test_snapshot_is_the_whole_state(three, opened):
    one, other = (opened(three).initialize().run(3, H) for _ in range(2))
    assert one.snapshot() == other.snapshot() == one.snapshot()
    assert len(one.snapshot()) > 1000
    other.run(1, H, first=3)
    assert one.snapshot() != other.snapshot()
    text = (three.folder / "modelDescription.xml").read_text(encoding="utf-8")
    assert 'mimeType="application/x-enmm-state"' in text


def test_binary_calls(three, opened):
    instance = opened(three).initialize()
    state = instance.save()
    reference = three.variables["snapshot"].valueReference
    twice, sizes, values = (c_uint32 * 2)(reference, reference), (c_size_t * 2)(), (c_void_p * 2)()
    assert instance.call("GetBinary", twice, c_size_t(2), sizes, values, c_size_t(2)) == OK
    assert sizes[0] == sizes[1] > 0
    for n, n_values in ((2, 1), (1, 2), (2, 0)):
        assert instance.call("GetBinary", twice, c_size_t(n), sizes, values, c_size_t(n_values)) == ERROR
        instance.check(instance.restore(state))
    other = c_uint32(three.variables["time"].valueReference)
    assert instance.call("GetBinary", byref(other), c_size_t(1), sizes, values, c_size_t(1)) == ERROR
    instance.check(instance.restore(state))
    data = ctypes.create_string_buffer(b"abc")
    address = c_void_p(ctypes.addressof(data))
    one = (c_uint32 * 1)(reference)
    assert instance.call("SetBinary", one, c_size_t(1), byref(c_size_t(3)), byref(address), c_size_t(1)) == ERROR


ABSENT = "Float32 Int8 UInt8 Int16 UInt16 UInt32 Int64 UInt64 String Clock".split()


@pytest.mark.parametrize("kind", ABSENT)
@pytest.mark.parametrize("verb", ["Get", "Set"])
def test_types_that_no_variable_has(sliding, opened, kind, verb):
    instance = opened(sliding).initialize()
    references, room = (c_uint32 * 1)(0), (c_double * 1)()
    assert instance.call(f"{verb}{kind}", None, c_size_t(0), None, c_size_t(0)) == OK
    with instance.complaint(f"fmi3{verb}{kind}"):
        assert instance.call(f"{verb}{kind}", references, c_size_t(1), room, c_size_t(1)) == ERROR


def test_huge_counts_are_refused(three, opened):
    instance = opened(three).initialize()
    state = instance.save()
    references, room = (c_uint32 * 1)(three.variables["threads"].valueReference), (c_double * 4)()
    for kind in ("Int32", "Float64", "Boolean"):
        for verb in ("Get", "Set"):
            for count in (2**31, 2**40, 2**60, 2**63, 2**64 - 1):
                assert instance.call(f"{verb}{kind}", references, c_size_t(1), room, c_size_t(count)) == ERROR
                instance.check(instance.restore(state))


def test_step_needs_its_four_pointers(three, opened):
    instance = opened(three).initialize()
    state = instance.save()
    flags = [c_bool() for _ in range(3)]
    places = [*map(byref, flags), byref(c_double())]
    for missing in range(4):
        given = [None if k == missing else place for k, place in enumerate(places)]
        with instance.complaint("NULL"):
            assert instance.call("DoStep", c_double(0.0), c_double(H), c_bool(True), *given) == ERROR
        instance.check(instance.restore(state))
    instance.run(2, H)


def test_required_intermediate_variables(three):
    """Known references are taken, unknown ones refused."""
    heard = []
    logger = fmu_support.LOGGER_3(lambda _environment, status, _category, text: heard.append((status, text)))
    with fmu_support.Instance(three):  # Sets the types of the function.
        pass
    make = three.load().fmi3InstantiateCoSimulation
    names = three.block_outputs()[:2]

    def made(references):
        array = (c_uint32 * len(references))(*references)
        head = [b"a", three.token.encode(), str(three.resources).encode(), False, False, False, False]
        return make(*head, ctypes.addressof(array), len(references), None, logger, fmu_support.UPDATE_3())

    pointer = made([three.variables[name].valueReference for name in names])
    assert pointer and not heard
    three.load().fmi3FreeInstance(c_void_p(pointer))
    assert made([1_000_000]) is None and heard


def test_resource_path_with_and_without_its_separator(three, opened):
    for text in (str(three.resources), str(three.resources) + "/", str(three.resources) + "//"):
        assert opened(three, resources=text).pointer
