"""Saved states of the FMUs: rollback, serialization, damage, foreign states, reset; always to the last bit."""

import ctypes
import json
import subprocess
import sys
from pathlib import Path

import pytest
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmu_support import ERROR, OK, WARNING, bits, c_void_p

H = 0.01
PUSH = {"block_on_incline": {"block.force_x": 3e3}, "coupled_slope": {"toe.force_x": 0.7e6, "water_level": 7.0}}


def plain_run(fmu, opened, steps=12):
    return opened(fmu).initialize().run(steps, H).everything()


def serialized(instance):
    return instance.serialize(instance.save())


def test_rollback_gives_the_same_bits(fmu, opened):
    expected = plain_run(fmu, opened)
    instance = opened(fmu).initialize().run(5, H)
    state, here = instance.save(), instance.everything()
    for _ in range(2):
        instance.check(instance.set(PUSH[fmu.case]))
        instance.run(7, H, first=5)
        assert instance.everything() != expected
        instance.check(instance.restore(state))
        assert instance.everything() == here
    assert instance.run(7, H, first=5).everything() == expected
    instance.check(instance.free_state(state))


def test_state_holds_inputs_parameters_and_the_mode(fmu, opened):
    instance = opened(fmu)
    instance.check(instance.set_up())
    young = next(v.name for v in fmu.named("parameter") if "young" in v.name)
    instance.check(instance.set({young: 7e9}))
    state = instance.save()
    instance.check(instance.set({young: 8e9} | PUSH[fmu.case]))
    instance.check(instance.exit_initialization(), WARNING)
    instance.run(2, H)
    soft = instance.save()
    instance.check(instance.restore(state))
    assert instance.get(young) == [7e9]
    instance.check(instance.set({young: 9e9}))
    instance.check(instance.exit_initialization())
    instance.check(instance.restore(soft))
    assert instance.get(young) == [8e9] and instance.get(*PUSH[fmu.case]) == list(PUSH[fmu.case].values())
    instance.run(1, H, first=2)


def test_saving_over_a_state_replaces_it(fmu, opened):
    instance = opened(fmu).initialize()
    state = instance.save()
    number = state.value
    here = instance.run(2, H).everything()
    name = "GetFMUstate" if fmu.version == 2 else "GetFMUState"
    instance.check(instance.call(name, ctypes.byref(state)))
    assert state.value == number
    instance.run(1, H, first=2)
    instance.check(instance.restore(state))
    assert instance.everything() == here


def test_state_in_the_middle_of_the_internal_grid(fmu, opened):
    """A state between two internal steps goes on with the same bits."""
    odd = 0.0037
    instance = opened(fmu).initialize().run(3, odd)
    state = instance.save()
    expected = instance.run(4, odd, first=3).everything()
    instance.check(instance.restore(state))
    assert instance.run(4, odd, first=3).everything() == expected
    other = opened(fmu)
    status, copy = other.deserialize(instance.serialize(state))
    assert status == OK
    other.check(other.restore(copy))
    assert other.run(4, odd, first=3).everything() == expected


def test_serialized_state_goes_on_in_another_instance(fmu, opened):
    expected = plain_run(fmu, opened)
    first = opened(fmu).initialize().run(5, H)
    data = first.serialize(first.save())
    assert data == first.serialize(first.save()), "the same state has the same bytes"
    first.free()
    second = opened(fmu, name="another")
    status, state = second.deserialize(data)
    assert status == OK
    second.check(second.restore(state))
    second.check(second.free_state(state))
    assert second.run(7, H, first=5).everything() == expected


CHILD = """
import json, sys
sys.path.insert(0, sys.argv[1])
from fmu_support import Fmu, Instance, fmpy
from pathlib import Path
task = json.load(sys.stdin)
folder = Path(task["folder"])
fmu = Fmu(Path(task["path"]), folder, fmpy.read_model_description(str(folder), validate=False))
instance = Instance(fmu)
status, state = instance.deserialize(bytes.fromhex(task["state"]))
assert status == 0, instance.log
instance.check(instance.restore(state))
print(instance.run(7, 0.01, first=5).everything().hex())
"""


def test_serialized_state_goes_on_in_a_fresh_process(fmu, opened):
    expected = plain_run(fmu, opened)
    first = opened(fmu).initialize().run(5, H)
    data = first.serialize(first.save())
    task = {"folder": str(fmu.folder), "path": str(fmu.path), "state": data.hex()}
    command = [sys.executable, "-c", CHILD, str(Path(__file__).parent)]
    done = subprocess.run(command, input=json.dumps(task), capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == expected.hex()


def damaged(data: bytes):
    """Bytes that are no state: one bit flipped at many places, cut, doubled, lengthened, others, none."""
    for position in {*range(0, min(len(data), 96)), *range(96, len(data), max(1, len(data) // 60)), len(data) - 1}:
        yield f"bit in byte {position}", data[:position] + bytes([data[position] ^ 0x10]) + data[position + 1 :]
    for length in (0, 1, 7, 8, 31, 64, len(data) // 2, len(data) - 1):
        yield f"cut to {length}", data[:length]
    yield "lengthened", data + b"\0"
    yield "doubled", data + data
    yield "zeros", bytes(len(data))
    yield "ones", b"\xff" * len(data)
    # Fields that may be taken for lengths.
    for position in range(0, 64, 8):
        yield f"huge at {position}", data[:position] + b"\xff" * 8 + data[position + 8 :]


def test_damaged_states_are_refused_and_harm_nothing(fmu, opened):
    instance = opened(fmu).initialize().run(3, H)
    good, here = instance.save(), instance.everything()
    data = instance.serialize(good)
    for what, bad in damaged(data):
        before = len(instance.log)
        status, state = instance.deserialize(bad)
        assert status == ERROR and state.value is None, what
        assert len(instance.log) == before + 1 and instance.log[-1][0] == ERROR, what
    assert instance.everything() == here
    instance.check(instance.restore(good))
    expected = instance.run(2, H, first=3).everything()
    instance.check(instance.restore(good))
    assert instance.run(2, H, first=3).everything() == expected


def test_states_of_other_fmus_are_refused(fmus, opened):
    instances = {name: opened(fmu).initialize() for name, fmu in fmus.items()}
    data = {name: one.serialize(one.save()) for name, one in instances.items()}
    for name, instance in instances.items():
        for other, foreign in data.items():
            status, state = instance.deserialize(foreign)
            assert (status == OK) == (name == other)
            if name != other:
                assert instance.log[-1][0] == ERROR
        instance.run(1, H)


def test_states_of_other_instances_freed_ones_and_none_are_refused(fmu, opened):
    one, other = (opened(fmu).initialize() for _ in range(2))
    state = other.save()
    for wrong in (state, c_void_p(None), c_void_p(0xDEADBEEF)):
        with one.complaint():
            assert one.restore(wrong) == ERROR
    assert one.free_state(c_void_p(None)) == OK, "freeing no state is fine"
    freed = one.save()
    number = c_void_p(freed.value)
    one.check(one.free_state(freed))
    assert freed.value is None
    assert one.restore(number) == ERROR
    assert one.free_state(number) == ERROR
    assert one.run(1, H).everything() == other.run(1, H).everything()


def test_wrong_sizes_are_refused(fmu, opened):
    instance = opened(fmu).initialize()
    state = instance.save()
    data = instance.serialize(state)
    name = "SerializeFMUstate" if fmu.version == 2 else "SerializeFMUState"
    for wrong in (0, 1, len(data) - 1, len(data) + 1):
        room = (ctypes.c_uint8 * (len(data) + 8))()
        assert instance.call(name, state, room, ctypes.c_size_t(wrong)) == ERROR
        assert not any(room), "nothing is written"


def test_restore_leads_out_of_an_error(fmu, opened):
    expected = plain_run(fmu, opened)
    instance = opened(fmu).initialize().run(5, H)
    state = instance.save()
    for _ in range(2):
        assert instance.step(5 * H, float("nan")) == ERROR
        assert instance.step(5 * H, H) == ERROR, "a step after an error"
        instance.check(instance.restore(state))
    assert instance.run(7, H, first=5).everything() == expected


def test_reset_is_a_new_beginning(fmu, opened):
    expected = plain_run(fmu, opened)
    instance = opened(fmu)
    fresh = None
    parameter = next(v.name for v in fmu.named("parameter") if "friction" in v.name)
    for disturb in ("run", "error", "initialization", "parameter", "terminated", "nothing"):
        if disturb in ("run", "error", "terminated"):
            instance.initialize(**PUSH[fmu.case]).run(3, H)
        if disturb == "error":
            assert instance.step(3 * H, -1.0) == ERROR
        if disturb == "terminated":
            instance.check(instance.terminate())
        if disturb in ("initialization", "parameter"):
            instance.check(instance.set_up(3.0, 9.0))
            instance.check(instance.set({parameter: 0.2}))
        if disturb == "parameter":
            instance.check(instance.exit_initialization(), WARNING)
            instance.check(instance.step(3.0, H))
        instance.check(instance.reset())
        state = serialized(instance)
        fresh = fresh or state
        assert state == fresh == serialized(opened(fmu)), disturb
    instance.initialize()
    assert instance.run(12, H).everything() == expected


def test_interleaved_instances_do_not_touch_each_other(fmus, opened):
    """Instances of all four FMUs in turn, with a rollback in between."""
    expected = {name: plain_run(fmu, opened) for name, fmu in fmus.items()}
    for repeat in range(2):
        instances = {name: opened(fmu, name=f"{name} {repeat}").initialize() for name, fmu in fmus.items()}
        for k in range(12):
            for instance in instances.values():
                if k == 6:
                    state = instance.save()
                    instance.run(1, H, first=k)
                    instance.check(instance.restore(state))
                instance.run(1, H, first=k)
        assert {name: one.everything() for name, one in instances.items()} == expected


def test_states_of_every_mode_can_be_restored(fmu, opened):
    instance = opened(fmu)
    states = [instance.save()]
    instance.check(instance.set_up())
    states.append(instance.save())
    instance.check(instance.exit_initialization())
    states.append(instance.save())
    instance.run(2, H)
    instance.check(instance.terminate())
    states.append(instance.save())
    instance.check(instance.restore(states[0]))
    instance.initialize()
    instance.check(instance.restore(states[1]))
    instance.check(instance.exit_initialization())
    instance.check(instance.restore(states[2]))
    instance.run(1, H)
    instance.check(instance.restore(states[3]))
    assert instance.step(2 * H, H) == ERROR, "terminated"


# The same through the slave classes of FMPy.


def slave(fmu):
    description = fmu.description
    of_version = FMU2Slave if fmu.version == 2 else FMU3Slave
    made = of_version(
        instanceName="slave",
        guid=fmu.token,
        unzipDirectory=str(fmu.folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    made.instantiate()
    return made


def slave_in_step_mode(fmu):
    made = slave(fmu)
    if fmu.version == 2:
        made.setupExperiment(startTime=0.0)
    made.enterInitializationMode()
    made.exitInitializationMode()
    return made


def slave_outputs(made, fmu):
    references = [fmu.variables[name].valueReference for name in fmu.block_outputs()]
    return bits(made.getReal(references) if fmu.version == 2 else made.getFloat64(references))


def slave_steps(made, first, steps):
    for k in range(first, first + steps):
        made.doStep(k * H, H)


def test_fmpy_rolls_back_and_serializes(fmu):
    get, put, free, write, read = (
        ("getFMUstate", "setFMUstate", "freeFMUstate", "serializeFMUstate", "deSerializeFMUstate")
        if fmu.version == 2
        else ("getFMUState", "setFMUState", "freeFMUState", "serializeFMUState", "deserializeFMUState")
    )
    one = slave_in_step_mode(fmu)
    slave_steps(one, 0, 4)
    state = getattr(one, get)()
    data = getattr(one, write)(state)
    slave_steps(one, 4, 4)
    expected = slave_outputs(one, fmu)
    getattr(one, put)(state)
    slave_steps(one, 4, 4)
    assert slave_outputs(one, fmu) == expected
    getattr(one, free)(state)
    one.terminate()
    one.freeInstance()

    other = slave(fmu)
    getattr(other, put)(getattr(other, read)(data))
    slave_steps(other, 4, 4)
    assert slave_outputs(other, fmu) == expected
    with pytest.raises(Exception):
        getattr(other, read)(data[:-1])
    with pytest.raises(Exception):
        getattr(other, read)(bytes(reversed(data)))
    assert slave_outputs(other, fmu) == expected
    other.terminate()
    other.freeInstance()


def test_many_states_at_once(incline_fmu, opened):
    """A hundred states, restored in a mixed order."""
    instance = opened(incline_fmu).initialize()
    states = []
    for k in range(100):
        states.append((instance.save(), bits(instance.get(*incline_fmu.block_outputs()))))
        instance.run(1, 0.002, first=k)
    for k in range(100):
        state, outputs = states[k * 37 % 100]
        instance.check(instance.restore(state))
        assert bits(instance.get(*incline_fmu.block_outputs())) == outputs
    for state, _ in states:
        instance.check(instance.free_state(state))
