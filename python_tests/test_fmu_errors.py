"""Whatever an importer does wrong is a status and a log line, never a crash, and a saved state still restores."""

import ctypes
import json
import os
import re
import subprocess
import sys
from ctypes import c_bool, c_char_p, c_double, c_int, c_size_t, c_uint32, c_void_p
from pathlib import Path

import pytest
import fmu_support
from fmu_support import C_TYPES, DISCARD, ERROR, FATAL, OK, TYPES, WARNING, Instance, fmpy, functions_of, size

H = 0.01
NAN, INF = float("nan"), float("inf")
# Twenty arguments: more than any function has.
NOTHING = [c_void_p(None)] * 20


def recovers(instance, state, expected):
    """The saved state restores, and the run goes on with the expected bits."""
    instance.check(instance.restore(state))
    assert instance.run(2, H, first=2).everything() == expected


@pytest.fixture
def running(fmu, opened):
    """An instance after two steps, its saved state, and the bits two steps later."""
    instance = opened(fmu).initialize(stop=1.0).run(2, H)
    state = instance.save()
    expected = instance.run(2, H, first=2).everything()
    instance.check(instance.restore(state))
    return instance, state, expected


@pytest.mark.parametrize(
    ("t", "h"),
    [
        (0.02, NAN),
        (0.02, INF),
        (0.02, -INF),
        (0.02, 0.0),
        (0.02, -0.0),
        (0.02, -0.01),
        (0.02, 1e300),
        (0.02, 0.99),
        (NAN, 0.01),
        (INF, 0.01),
        (-0.01, 0.01),
        (0.0, 0.01),
        (0.03, 0.01),
        (0.0201, 0.01),
    ],
)
def test_bad_steps(running, t, h):
    instance, state, expected = running
    before = instance.everything()
    with instance.complaint():
        assert instance.step(t, h) == ERROR
    assert instance.everything() == before
    if instance.version == 3:
        assert not instance.early and not instance.terminate_wanted and not instance.event_wanted
        assert instance.last_time == pytest.approx(0.02, abs=1e-12)
    assert instance.step(0.02, H) == ERROR, "only a saved state, a reset or the end lead out"
    recovers(instance, state, expected)


def test_step_to_the_stop_time_and_not_past_it(fmu, opened):
    instance = opened(fmu).initialize(stop=0.05).run(4, H)
    state = instance.save()
    with instance.complaint("stop time"):
        assert instance.step(4 * H, 1.001 * H) == ERROR
    instance.check(instance.restore(state))
    instance.check(instance.step(4 * H, 0.05 - 4 * H))
    with instance.complaint("stop time"):
        assert instance.step(0.05, H) == ERROR


def test_no_stop_time_is_no_limit(incline_fmu, opened):
    instance = opened(incline_fmu).initialize()
    for k in range(3):
        instance.check(instance.step(k * 0.5, 0.5))


@pytest.mark.parametrize(("start", "stop"), [(NAN, None), (INF, None), (0.0, NAN), (0.0, -1.0), (5.0, 4.0), (0.0, INF)])
def test_bad_times_of_an_experiment(fmu, opened, start, stop):
    instance = opened(fmu)
    with instance.complaint():
        assert instance.set_up(start, stop) == ERROR
    instance.check(instance.reset())
    instance.initialize().run(1, H)


@pytest.mark.parametrize("bad", [NAN, INF, -INF, 1e308])
def test_bad_values_are_refused_and_the_old_ones_hold(running, bad):
    instance, state, expected = running
    for v in instance.fmu.named("input"):
        old = instance.get(v.name)
        values = list(old)
        values[-1] = bad
        with instance.complaint(v.name):
            assert instance.set_raw(v.type, [v.valueReference], values) == ERROR
        assert instance.get(v.name) == old
        instance.check(instance.restore(state))
    recovers(instance, state, expected)


@pytest.mark.parametrize("bad", [NAN, INF, -INF, 1e308])
def test_bad_parameters_are_refused(fmu, opened, bad):
    instance = opened(fmu)
    instance.check(instance.set_up())
    state = instance.save()
    for v in fmu.named("parameter"):
        if v.type in ("Integer", "Int32", "Boolean"):
            continue
        old = instance.get(v.name)
        with instance.complaint(v.name):
            assert instance.set({v.name: bad}) == ERROR
        assert instance.get(v.name) == old
        instance.check(instance.restore(state))
    instance.check(instance.exit_initialization())


def test_one_bad_value_spoils_the_whole_call(running):
    """Nothing of a call holds when one of its values is refused."""
    instance, state, expected = running
    names = ["gravity_x", "base_acceleration_x", "base_acceleration_y"]
    references = [instance.fmu.variables[name].valueReference for name in names]
    old = instance.get(*names)
    assert instance.set_raw("Real" if instance.version == 2 else "Float64", references, [1.0, 2.0, NAN]) == ERROR
    assert instance.get(*names) == old
    recovers(instance, state, expected)


def test_parameters_are_fixed_after_initialization(running):
    instance, state, expected = running
    for v in (v for v in instance.fmu.named("parameter") if v.variability == "fixed"):
        old = instance.get(v.name)
        with instance.complaint(v.name):
            assert instance.set({v.name: old[0]}) == ERROR
        instance.check(instance.restore(state))
    recovers(instance, state, expected)


@pytest.mark.parametrize("reference", [10_000, 2**31 - 1, 2**31, 2**32 - 1])
def test_unknown_references(running, reference):
    instance, state, expected = running
    known = instance.fmu.variables["gravity_x"].valueReference
    kinds = C_TYPES[instance.version]
    for kind in kinds:
        for references in ([reference], [known, reference], [reference, known]):
            for refused in (
                instance.get_raw(kind, references)[0],
                instance.set_raw(kind, references, [0] * len(references)),
            ):
                assert refused == ERROR
                instance.check(instance.restore(state))
    recovers(instance, state, expected)


def test_empty_calls_are_fine(running):
    instance, state, expected = running
    for kind in TYPES[instance.version]:
        assert instance.get_raw(kind, [])[0] == OK
        assert instance.set_raw(kind, [], []) == OK
    assert instance.call("GetString", None, c_size_t(0), None, c_size_t(0)) == OK
    recovers(instance, state, expected)


def test_the_same_reference_twice(running):
    instance, _, _ = running
    reference = instance.fmu.variables["gravity_y"].valueReference
    kind = "Real" if instance.version == 2 else "Float64"
    assert instance.get_raw(kind, [reference, reference]) == (OK, [-9.81, -9.81])
    assert instance.set_raw(kind, [reference, reference], [-9.0, -8.0]) == OK
    assert instance.get("gravity_y") == [-8.0]


# Functions that must not be called here at all.
LIFE = ("FreeInstance", "Instantiate", "GetVersion", "GetTypesPlatform")


def test_every_function_stands_missing_arguments(running):
    """NULL for every argument; then every count says that there is something behind the NULL."""
    instance, state, expected = running
    prefix = f"fmi{instance.version}"
    names = [name for name in functions_of(instance.fmu) if not name.startswith(LIFE)]
    assert len(names) > 35
    for name in names:
        before = len(instance.log)
        status = instance.call(name, *NOTHING)
        assert status in (OK, DISCARD, ERROR), name
        if status == ERROR:
            assert len(instance.log) > before and instance.log[-1][2].startswith(f"{prefix}{name}: "), name
        instance.check(instance.restore(state))
        if re.match(r"[GS]et(Real|Integer|Boolean|String|Float|U?Int|Binary|Clock|Interval|Shift|Output|Debug)", name):
            if name.endswith("Status"):
                continue
            counts = [c_void_p(None), c_size_t(1), c_void_p(None), c_void_p(None), c_size_t(1)]
            if name == "SetDebugLogging":
                counts = [c_int(1), c_size_t(1), c_void_p(None)]
            assert instance.call(name, *counts, *NOTHING[:6]) == ERROR, name
            instance.check(instance.restore(state))
    recovers(instance, state, expected)


@pytest.mark.parametrize("pointer", [None, 1, 12345, 2**63, 2**64 - 1])
def test_every_function_stands_a_wrong_instance(fmu, opened, pointer):
    instance = opened(fmu).initialize()
    right, instance.pointer = instance.pointer, pointer
    if pointer == right:
        pointer += 7
    prefix = f"fmi{fmu.version}"
    for name in functions_of(fmu):
        if not name.startswith(LIFE):
            assert instance.call(name, *NOTHING) == ERROR, name
    free = getattr(instance.library, f"{prefix}FreeInstance")
    free.restype = free.argtypes = None
    free(c_void_p(pointer))
    instance.pointer = right
    instance.run(1, H)


def test_functions_of_other_kinds_refuse(running):
    instance, state, expected = running
    refused = {
        2: "EnterEventMode NewDiscreteStates EnterContinuousTimeMode CompletedIntegratorStep SetTime "
        "SetContinuousStates "
        "GetDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates GetDirectionalDerivative "
        "CancelStep",
        3: "EnterEventMode EnterStepMode EvaluateDiscreteStates UpdateDiscreteStates EnterConfigurationMode "
        "ExitConfigurationMode GetNumberOfVariableDependencies GetVariableDependencies GetDirectionalDerivative "
        "GetAdjointDerivative EnterContinuousTimeMode CompletedIntegratorStep SetTime SetContinuousStates "
        "GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates "
        "GetNumberOfEventIndicators GetNumberOfContinuousStates ActivateModelPartition",
    }
    for name in refused[instance.version].split():
        with instance.complaint(name):
            assert instance.call(name, *NOTHING) == ERROR, name
        instance.check(instance.restore(state))
    recovers(instance, state, expected)


def test_other_kinds_of_instances_are_refused(fmu, opened):
    if fmu.version == 2:
        for kind in (0, 2, -1, 2**31 - 1):
            instance = opened(fmu, kind=kind)
            assert instance.pointer is None and instance.log[-1][0] == ERROR
        return
    for function in ("ModelExchange", "ScheduledExecution"):
        instance = opened(fmu, function=function)
        assert instance.pointer is None and instance.log[-1][0] == ERROR


TOKEN = "00000000-0000-5000-8000-000000000000"


@pytest.mark.parametrize(
    "options",
    [
        {"token": TOKEN},
        {"token": ""},
        {"token": None},
        {"token": b"\xff\xfe"},
        {"name": ""},
        {"name": None},
        {"resources": None},
        {"resources": ""},
        {"resources": "/nowhere/at/all"},
        {"resources": "file:///nowhere/at/all"},
        {"resources": "http://example.org/resources"},
        {"resources": "relative/resources"},
        {"resources": b"file:///\xff\xfe"},
    ],
    ids=lambda options: "-".join(map(str, options.items())),
)
@pytest.mark.parametrize("logging", [False, True])
def test_instances_that_cannot_be(fmu, opened, options, logging):
    instance = opened(fmu, logging=logging, **options)
    assert instance.pointer is None
    assert [status for status, _, _ in instance.log] == [ERROR]
    assert instance.log[0][1] == "logStatusError" and len(instance.log[0][2]) > 20


def test_missing_and_damaged_resources(fmu, opened, tmp_path):
    copy = fmu.copy_to(tmp_path / "copy")
    place = copy.resources / "case.json"
    text = place.read_text(encoding="utf-8")
    for bad in ("", "{}", text[: len(text) // 2], text.replace("26", "27", 1), "\0" * 100):
        place.write_text(bad, encoding="utf-8")
        instance = opened(copy)
        assert instance.pointer is None and "case.json" in instance.log[-1][2]
    place.unlink()
    instance = opened(copy)
    assert instance.pointer is None and "case.json" in instance.log[-1][2]


def test_no_callbacks(fmu):
    """Without a logger nothing is told; FMI 2 without its functions gives no instance."""
    library = fmu.load()
    if fmu.version == 2:
        with Instance(fmu, callbacks=False) as instance:
            assert instance.pointer is None
        empty = fmu_support.Callbacks()
        make = library.fmi2Instantiate
        pointer = make(b"a", 1, fmu.token.encode(), fmu.uri().encode(), ctypes.addressof(empty), 0, 1)
        assert make(b"a", 1, b"wrong", fmu.uri().encode(), ctypes.addressof(empty), 0, 1) is None
    else:
        with Instance(fmu):  # Sets the types of the function.
            pass
        make = library.fmi3InstantiateCoSimulation
        rest = [False, True, False, False, None, 0, None, fmu_support.LOGGER_3(), fmu_support.UPDATE_3()]
        pointer = make(b"a", fmu.token.encode(), str(fmu.resources).encode(), *rest)
        assert make(b"a", b"wrong", str(fmu.resources).encode(), *rest) is None
    quiet = Instance.__new__(Instance)
    quiet.fmu, quiet.version, quiet.library, quiet.pointer, quiet.log = fmu, fmu.version, library, pointer, []
    quiet.start, quiet.on_log = 0.0, None
    quiet.initialize().run(2, H)
    assert quiet.step(0.0, NAN) == ERROR
    quiet.free()


# Modes. For each call: the modes in which it is legal, for FMI 2 and 3.
MODES = ["instantiated", "initialization", "step", "terminated", "error"]
LEGAL = {
    "set_up": ("instantiated", "instantiated"),
    "exit_initialization": ("initialization", "initialization"),
    "step": ("step", "step"),
    "terminate": ("step", "step"),
    "get": ("initialization step terminated error", "initialization step terminated error"),
    "get_start": ("initialization step terminated error", "instantiated initialization step terminated error"),
    "set": ("instantiated initialization step", "instantiated initialization step"),
    "parameter": ("instantiated initialization", "instantiated initialization"),
    "derivative": ("step terminated error", "step terminated error"),
    "save": (" ".join(MODES), " ".join(MODES)),
    "logging": (" ".join(MODES), " ".join(MODES)),
    "reset": (" ".join(MODES), " ".join(MODES)),
}


def in_mode(instance, mode):
    if mode == "initialization":
        instance.check(instance.set_up())
    if mode in ("step", "terminated", "error"):
        instance.initialize()
    if mode == "terminated":
        instance.check(instance.terminate())
    if mode == "error":
        assert instance.step(0.0, NAN) == ERROR
    return instance


def attempt(instance, call):
    kind = "Real" if instance.version == 2 else "Float64"
    reference = lambda name: [instance.fmu.variables[name].valueReference]
    output = instance.fmu.block_outputs()[0]
    parameter = next(v for v in instance.fmu.named("parameter") if v.type == kind)
    match call:
        case "set_up":
            return instance.set_up()
        case "step":
            return instance.step(0.0, H)
        case "get":
            return instance.get_raw(kind, reference(output))[0]
        case "get_start":
            return instance.get_raw(kind, reference("gravity_x"))[0]
        case "set":
            return instance.set_raw(kind, reference("gravity_x"), [0.0])
        case "parameter":
            return instance.set_raw(kind, reference(parameter.name), [float(parameter.start)])
        case "derivative":
            return instance.derivative(output)[0]
        case "save":
            return instance.free_state(instance.save())
        case "logging":
            return instance.call("SetDebugLogging", c_int(0), c_size_t(0), None)
        case _:
            return getattr(instance, call)()


@pytest.mark.parametrize("mode", MODES)
def test_calls_by_mode(fmu, opened, mode):
    for call, legal in LEGAL.items():
        instance = in_mode(opened(fmu), mode)
        state, before = instance.save(), len(instance.log)
        status = attempt(instance, call)
        if mode in legal[fmu.version - 2].split():
            assert status == OK, (call, instance.log[-1:])
            assert len(instance.log) == before
        else:
            assert status == ERROR, call
            assert instance.log[-1][0] == ERROR and len(instance.log) > before
            instance.check(instance.restore(state))
            instance.check(instance.reset())
            instance.initialize().run(1, H)
        instance.free()


@pytest.mark.parametrize("mode", MODES)
def test_an_instance_ends_in_every_mode_with_states_left(fmu, mode):
    instance = in_mode(Instance(fmu), mode)
    instance.save()
    pointer = instance.pointer
    instance.free()
    assert not [text for status, _, text in instance.log if status == FATAL]
    instance.pointer = pointer
    assert instance.step(0.0, H) == ERROR, "freed"
    instance.free()


# Logging.


def levels(instance):
    return {category for _, category, _ in instance.log}


def test_errors_are_told_with_logging_off(fmu, opened):
    instance = opened(fmu, logging=False).initialize().run(2, H)
    assert instance.log == []
    instance.step(0.02, NAN)
    ((status, category, text),) = instance.log
    assert (status, category) == (ERROR, "logStatusError")
    assert text.startswith(f"fmi{fmu.version}DoStep: ") and "NaN" in text


def test_everything_is_told_with_logging_on(fmu, opened):
    instance = opened(fmu, logging=True).initialize()
    assert levels(instance) == {"logAll"}
    for k in range(40):
        instance.check(instance.step(k * H, H))
    assert "logEvents" in levels(instance) or fmu.case == "coupled_slope"
    declared = {c.name for c in fmu.description.logCategories} if hasattr(fmu.description, "logCategories") else None
    assert declared is None or levels(instance) <= declared


def debug(instance, on, *categories):
    names = (c_char_p * max(len(categories), 1))(*(name.encode() for name in categories))
    flag = c_int(on) if instance.version == 2 else c_bool(on)
    return instance.call("SetDebugLogging", flag, c_size_t(len(categories)), names)


def test_categories_filter(incline_fmu, opened):
    instance = opened(incline_fmu)
    instance.check(debug(instance, True, "logEvents"))
    instance.initialize().run(30, H)
    assert levels(instance) == {"logEvents"}
    instance.check(debug(instance, False))
    before = len(instance.log)
    instance.check(instance.reset())
    instance.initialize().run(30, H)
    assert len(instance.log) == before
    instance.check(debug(instance, True))
    instance.check(instance.reset())
    instance.initialize()
    assert "logAll" in levels(instance)


def test_unknown_category_is_refused_and_changes_nothing(fmu, opened):
    instance = opened(fmu).initialize()
    with instance.complaint("logNonsense"):
        assert debug(instance, True, "logAll", "logNonsense") == ERROR
    before = len(instance.log)
    instance.run(2, H)
    assert len(instance.log) == before


def test_logger_may_call_back(fmu, opened):
    """A message comes when the instance is free again: the logger may use it."""
    heard = []

    def ask(instance):
        heard.append(
            instance.get_raw(
                "Real" if instance.version == 2 else "Float64", [instance.fmu.variables["gravity_y"].valueReference]
            )
        )

    instance = opened(fmu, on_log=ask).initialize()
    assert instance.step(0.0, NAN) == ERROR
    assert heard == [(OK, [-9.81])]


# A child that ends on a crash would take the tests with it, so what may crash is also tried in one of its own.
FUZZ = """
import json, random, re, sys
sys.path.insert(0, sys.argv[1])
from ctypes import *
from pathlib import Path
from fmu_support import Fmu, Instance, fmpy
import subprocess
task = json.load(sys.stdin)
folder = Path(task["folder"])
fmu = Fmu(Path(task["path"]), folder, fmpy.read_model_description(str(folder), validate=False))
names = task["names"]
dice = random.Random(task["seed"])
references, room = (c_uint32 * 16)(), (c_uint8 * 65536)()
instance = Instance(fmu).initialize()
state = instance.save()
pointers = [c_void_p(None), cast(references, c_void_p), byref(references, 4), byref(references, 1)]
counts = [c_size_t(k) for k in (0, 1, 3)]
huge = [c_size_t(2**60), c_size_t(2**64 - 1)]
rest = [c_void_p(None), *counts, cast(room, c_void_p), byref(room, 64), byref(room, 257)]
for _ in range(task["calls"]):
    name = dice.choice(names)
    references[:] = [dice.choice([0, dice.randrange(100), dice.randrange(2**32)]) for _ in references]
    arguments = [dice.choice(pointers), dice.choice(counts), *(dice.choice(rest) for _ in range(4))]
    if fmu.version == 3 and re.match("[GS]et(Float|U?Int[0-9]|Boolean)", name):
        arguments[3] = dice.choice(counts + huge)
    if name in ("DoStep", "SetTime", "SetupExperiment", "EnterInitializationMode", "ActivateModelPartition"):
        times = [c_double(dice.choice([0.0, -1.0, 1e9, float("nan"), 0.01])) for _ in range(3)]
        arguments = [*times, c_int(1), *(dice.choice([c_void_p(None), byref(room, 8 * k)]) for k in range(4))]
    before = len(instance.log)
    status = instance.call(name, *arguments)
    assert 0 <= status <= 3, (name, status)
    assert status != 3 or len(instance.log) > before, name
    if dice.random() < 0.3:
        instance.check(instance.restore(state))
instance.check(instance.restore(state))
instance.run(2, 0.01)
print("sound")
"""


@pytest.mark.parametrize("seed", [1, 2])
def test_random_calls_never_crash(fmu, seed):
    names = functions_of(fmu)
    # Texts and sizes behind valid pointers would be the importer's own lie.
    unfit = (
        *LIFE,
        "SetDebugLogging",
        "SetString",
        "Serialize",
        "Deserialize",
        "DeSerialize",
        "SetFMU",
        "FreeFMU",
        "GetFMU",
    )
    names = [name for name in names if not name.startswith(unfit)]
    task = {"folder": str(fmu.folder), "path": str(fmu.path), "names": names, "seed": seed, "calls": 400}
    command = [sys.executable, "-c", FUZZ, str(Path(__file__).parent)]
    done = subprocess.run(
        command, input=json.dumps(task), capture_output=True, text=True, timeout=120, check=False, env={**os.environ}
    )
    assert done.returncode == 0 and done.stdout.strip() == "sound", (done.returncode, done.stderr[:800])


def test_tolerances_are_taken(fmu, opened):
    for tolerance in (None, 1e-4, 0.0, NAN, -1.0):
        instance = opened(fmu)
        assert instance.set_up(tolerance=tolerance) == OK
        instance.check(instance.exit_initialization())
        instance.run(1, H)


def test_arrays_of_wrong_length_are_refused(running):
    instance, state, expected = running
    if instance.version == 2:
        assert all(size(v) == 1 for v in instance.fmu.description.modelVariables)
        return
    v = instance.fmu.variables["block_force_x"]
    for count in (0, 1, size(v) - 1, size(v) + 1, 1000):
        if count == size(v):
            continue
        with instance.complaint("number of values"):
            assert instance.get_raw("Float64", [v.valueReference], count)[0] == ERROR
        instance.check(instance.restore(state))
        with instance.complaint("number of values"):
            assert instance.set_raw("Float64", [v.valueReference], [0.0] * count) == ERROR
        instance.check(instance.restore(state))
    recovers(instance, state, expected)


def test_references_are_read_as_unsigned(running):
    instance, _, _ = running
    time_like = c_uint32(2**32 - 1)
    values = (c_double * 1)()
    name = "GetReal" if instance.version == 2 else "GetFloat64"
    assert instance.call(name, ctypes.byref(time_like), c_size_t(1), values, c_size_t(1)) == ERROR
    assert str(2**32 - 1) in instance.log[-1][2]


ABSURD = {"block_on_incline": {"block.force_x": 1e15}, "coupled_slope": {"toe.moment": 1e15}}


def test_a_step_that_fails_is_discarded_and_told(running):
    """A force that no contact can bear: the model stands where it stood, and a sound input lets it go on."""
    instance, state, expected = running
    instance.check(instance.set(ABSURD[instance.fmu.case]))
    before = instance.everything()
    with instance.complaint("discarded"):
        assert instance.step(0.02, H) == DISCARD
    assert instance.log[-1][:2] == (DISCARD, "logStatusDiscard")
    assert instance.everything() == before
    if instance.version == 3:
        assert instance.last_time == 0.02 and not instance.early
    else:
        time, status = c_double(), c_int()
        assert instance.call("GetRealStatus", c_int(2), ctypes.byref(time)) == OK and time.value == 0.02
        assert instance.call("GetStatus", c_int(0), ctypes.byref(status)) == OK and status.value == DISCARD
    recovers(instance, state, expected)


def test_an_equilibrium_that_does_not_exist_is_an_error(fmu, opened):
    instance = opened(fmu)
    instance.check(instance.set_up())
    state = instance.save()
    instance.check(instance.set(ABSURD[fmu.case]))
    with instance.complaint("equilibrium"):
        assert instance.exit_initialization() == ERROR
    instance.check(instance.restore(state))
    instance.check(instance.exit_initialization())
    instance.run(1, H)
    instance.check(instance.reset())
    instance.initialize().run(1, H)


@pytest.mark.parametrize("extreme", [{"gravity_y": 1e4}, {"base_acceleration_x": -1e4}, {"strength_factor": 0.0}])
def test_extreme_inputs_give_finite_outputs(running, extreme):
    instance, state, expected = running
    instance.check(instance.set(extreme))
    assert instance.step(0.02, H) in (OK, DISCARD)
    assert all(abs(value) < INF for value in instance.get(*instance.fmu.outputs()))
    recovers(instance, state, expected)


def test_a_lost_equilibrium_is_a_warning_and_masters_go_on(slope_fmu, opened):
    """Half the force that holds the toe: the call warns, the log says why, and FMPy runs the slope as it slides."""
    lost = {"toe.force_x": 0.45e6, "toe.force_y": 0.28e6}
    instance = opened(slope_fmu, logging=True)
    instance.check(instance.set_up(0.0, None))
    instance.check(instance.set(lost))
    assert instance.exit_initialization() == WARNING
    assert any("not at rest at time 0" in text for _, _, text in instance.log), instance.log
    instance.check(instance.step(0.0, 0.05))
    result = fmpy.simulate_fmu(
        str(slope_fmu.path), start_values=lost, stop_time=0.05, step_size=0.01, output=["toe.displacement_x"]
    )
    (moved,) = instance.get("toe.displacement_x")
    assert moved < 0.0 and result["toe.displacement_x"][-1] == moved
