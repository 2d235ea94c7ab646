"""The Python package: saved states, threads, messages, and memory."""

import gc
import math
import multiprocessing
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

ONE_BLOCK = """
title = "A block that rests on its base"
[domain]
{domain}
[mesh]
size = 1.0
[rock.a]
density = 2000
young = 1e9
poisson = 0.2
[[fix]]
edge = [[0, 0], [2, 0]]
[[stage]]
name = "rest"
kind = "dynamic"
duration = 1.0
"""
SQUARE = "[[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]"
GEOJSON = """{"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [SQUARE]}},
    {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1, 1]}}]}"""


def fingerprint(model) -> tuple:
    """Everything that can be read of a model, to the last bit."""
    arrays = (model.blocks(), model.contacts(), *(model.polygon(block) for block in range(model.block_count)))
    ports = tuple(port.state() for port in model.ports.values())
    return (*(array.tobytes() for array in arrays), model.time, model.energies(), model.totals(), model.events(), ports)


def act(model, first: int, last: int) -> None:
    """Steps `first` to `last` of a run whose inputs change, by the case's own step."""
    step = model.communication_step
    for k in range(first, last):
        factor = 1.0 - 0.02 * k
        model.ports["toe"].set_force(factor * 0.9e6, factor * 0.56e6)
        model.set_water_level(6.0 + 0.1 * k)
        model.do_step(model.time, step)


@pytest.fixture
def case(cases) -> Path:
    return cases / "coupled_slope.toml"


# Saved states.


def test_rollback_keeps_every_bit(package, slope):
    slope.interpolation = package.Interpolation.LINEAR
    act(slope, 0, 5)
    with slope.save() as saved:
        at_save = fingerprint(slope)
        act(slope, 5, 15)
        expected = fingerprint(slope)
        assert expected != at_save
        slope.interpolation = package.Interpolation.HOLD
        slope.set_gravity(3.0, -5.0)
        slope.do_step(slope.time, 0.123)
        for _ in range(2):
            slope.restore(saved)
            assert fingerprint(slope) == at_save and slope.interpolation is package.Interpolation.LINEAR
            act(slope, 5, 15)
            assert fingerprint(slope) == expected


def test_a_state_goes_to_another_model_of_the_case(package, case, slope, incline):
    act(slope, 0, 5)
    saved = slope.save()
    act(slope, 5, 10)
    expected = fingerprint(slope)
    slope.close()
    with package.Model.from_file(case) as other:
        other.restore(saved)
        act(other, 5, 10)
        assert fingerprint(other) == expected
    before = fingerprint(incline)
    with pytest.raises(package.StateError):
        incline.restore(saved)
    with pytest.raises(package.StateError):
        incline.serialize(saved)
    assert fingerprint(incline) == before
    saved.close()


SCRIPT = """
import sys
import enmm
sys.path.insert(0, sys.argv[1])
from test_ctypes_life import act, fingerprint
with enmm.Model.from_file(sys.argv[2]) as model, open(sys.argv[3], "rb") as file:
    model.restore(model.deserialize(file.read()))
    assert model.interpolation is enmm.Interpolation.LINEAR
    act(model, 5, 15)
    sys.stdout.write(repr(fingerprint(model)))
"""


def test_a_state_goes_to_another_process(package, slope, case, tmp_path):
    slope.interpolation = package.Interpolation.LINEAR
    act(slope, 0, 5)
    file = tmp_path / "state.bin"
    file.write_bytes(slope.serialize())
    act(slope, 5, 15)
    arguments = [sys.executable, "-c", SCRIPT, str(Path(__file__).parent), str(case), str(file)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    output = subprocess.run(arguments, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert output.returncode == 0, output.stderr
    assert output.stdout == repr(fingerprint(slope))


def test_serialised_states_are_equal_and_come_back(slope):
    act(slope, 0, 3)
    with slope.save() as saved:
        data = slope.serialize(saved)
        assert data == slope.serialize(saved) == slope.serialize()
    act(slope, 3, 6)
    for form in (data, bytearray(data), memoryview(data)):
        with slope.deserialize(form) as state:
            slope.restore(state)
            assert slope.serialize() == data


def test_only_buffers_are_states(slope):
    for other in (8, 10**12, [0, 1], "text", None):
        with pytest.raises(TypeError):
            slope.deserialize(other)


def test_damaged_states_are_refused(package, slope, incline):
    act(slope, 0, 2)
    data = slope.serialize()
    before = fingerprint(slope)
    size = len(data)
    for place in sorted({*range(64), *range(64, size, size // 97), *range(size - 16, size)}):
        for bit in (0x01, 0x80):
            damaged = bytearray(data)
            damaged[place] ^= bit
            with pytest.raises(package.StateError) as caught:
                slope.deserialize(damaged)
            assert caught.value.status is package.Status.WRONG_STATE and str(caught.value)
    for length in (0, 1, 7, 8, 64, size // 2, size - 1):
        with pytest.raises(package.StateError):
            slope.deserialize(data[:length])
    for other in (data + b"\0", b"\0" * size, bytes(range(256))):
        with pytest.raises(package.StateError):
            slope.deserialize(other)
    with pytest.raises(package.StateError):
        incline.deserialize(data)
    assert fingerprint(slope) == before
    slope.deserialize(data).close()


# Threads.


def run_alone(package, case, which: int) -> tuple:
    with package.Model.from_file(case) as model:
        model.set_gravity(0.1 * which, -9.81)
        act(model, 0, 20)
        return fingerprint(model)


def test_models_on_threads_keep_the_bits_of_serial_runs(package, case):
    serial = [run_alone(package, case, which) for which in range(2)]
    assert serial[0] != serial[1]
    with ThreadPoolExecutor(2) as pool:
        runs = [pool.submit(run_alone, package, case, which % 2) for which in range(4)]
        assert [run.result() for run in runs] == serial * 2


PLATE = """
title = "Plate of more than 4096 covers, so that a step is worth threads"
domain.outline = [[0, 0], [1, 0], [1, 1], [0, 1]]
mesh.size = 0.014
rock.rock = { density = 2500, young = 1e9, poisson = 0.25 }
fix = [{ edge = [[0, 0], [1, 0]] }]
stage = [{ name = "shake", kind = "dynamic", duration = 1.0 }]
"""


def test_a_model_with_threads_goes_on_in_a_forked_process(package):
    """`multiprocessing` that forks: the child steps with threads of its own, and gives the bits of its parent."""
    with package.Model.from_string(PLATE) as model:
        model.threads = 2
        model.do_step(0.0, 1e-4)
        context = multiprocessing.get_context("fork")
        answers = context.SimpleQueue()

        def work():
            model.do_step(1e-4, 1e-4)
            answers.put(model.blocks().tobytes())

        child = context.Process(target=work, daemon=True)
        child.start()
        child.join(60)
        hangs = child.is_alive()
        child.kill()
        assert not hangs and child.exitcode == 0
        model.do_step(1e-4, 1e-4)
        assert answers.get() == model.blocks().tobytes()


def test_failures_tell_their_own_thread(package, case):
    def provoke(which: int) -> set[str]:
        texts = set()
        with package.Model.from_file(case) as model:
            for _ in range(200):
                with pytest.raises(package.InvalidArgumentError) as caught:
                    model.set_block_force(1000 + which, 0.0, 0.0)
                texts.add(str(caught.value))
        return texts

    with ThreadPoolExecutor(4) as pool:
        for which, texts in enumerate(pool.map(provoke, range(4))):
            assert len(texts) == 1 and str(1000 + which) in texts.pop()


def test_one_thread_at_a_time_uses_a_model(package, incline):
    incline.start()
    begin, statuses = threading.Event(), []

    def drive() -> float:
        begin.set()
        for _ in range(1000):
            try:
                return incline.do_step(0.0, 20.0).time
            except package.BusyError:
                # The other thread was in a call just then.
                continue
        return math.nan

    with ThreadPoolExecutor(1) as pool:
        run = pool.submit(drive)
        begin.wait(60)
        while not run.done():
            try:
                incline.energies()
            except package.BusyError as error:
                statuses.append(error.status)
            # Gives the other thread the time to begin.
            time.sleep(1e-3)
        assert run.result() == pytest.approx(20.0)
    assert set(statuses) == {package.Status.BUSY}


# Messages.


def test_messages_reach_the_host(package, incline):
    lines = []

    def write(level, message):
        # The model can be used meanwhile.
        lines.append((level, message, incline.time))

    incline.set_log(write)
    incline.start()
    assert [level for level, _, _ in lines] == [package.LogLevel.INFO]
    assert "initial equilibrium" in lines[0][1]
    incline.do_step(0.0, 1.0)
    # The start, each event, and that the slope has failed.
    assert len(lines) == 2 + len(incline.events()) and all(time == 1.0 for _, _, time in lines[1:])
    assert any("block 1 moved beyond the failure displacement" in message for _, message, _ in lines)
    assert "the slope has failed by sliding: 1 block" in lines[-1][1]
    incline.set_log(None)
    incline.do_step(incline.time, 0.1)
    with pytest.raises(package.TimeError):
        incline.do_step(0.0, 0.1)
    assert len(lines) == 2 + len(incline.events())


def test_a_failed_step_is_logged_as_an_error(package, incline):
    lines = []
    incline.set_log(lambda *line: lines.append(line))
    with pytest.raises(package.TimeError) as caught:
        incline.do_step(5.0, 0.1)
    assert lines[-1] == (package.LogLevel.ERROR, str(caught.value))


def test_warnings_of_the_case_come_at_once_and_once(package, tmp_path):
    (tmp_path / "square.geojson").write_text(GEOJSON.replace("SQUARE", SQUARE), encoding="utf-8")
    toml = ONE_BLOCK.format(domain='geometry_file = "square.geojson"')
    with package.Model.from_string(toml, tmp_path) as model:
        lines, later = [], []
        model.set_log(lambda *line: lines.append(line))
        assert [level for level, _ in lines] == [package.LogLevel.WARNING] and "1 Point not used" in lines[0][1]
        model.set_log(lambda *line: later.append(line))
        assert later == []


def test_exceptions_of_the_log_go_on_from_the_call(package, incline, capfd):
    def fail(level, message):
        raise KeyError(message)

    incline.set_log(fail)
    with pytest.raises(KeyError, match="initial equilibrium"):
        incline.start()
    with pytest.raises(KeyError, match="slipped"):
        incline.do_step(0.0, 0.5)
    assert incline.time == 0.5, "the step has been done"
    with pytest.raises(package.TimeError) as caught:
        incline.do_step(0.0, 0.5)
    assert isinstance(caught.value.__cause__, KeyError)

    def ask_for_nonsense(level, message):
        incline.polygon(77)

    incline.set_log(ask_for_nonsense)
    with pytest.raises(package.TimeError) as caught:
        incline.do_step(0.0, 0.5)
    assert isinstance(caught.value.__cause__, package.InvalidArgumentError)
    incline.set_log(None)
    assert incline.time == 0.5 and capfd.readouterr() == ("", "")


def test_a_log_that_is_dropped_is_never_followed(package, case):
    with package.Model.from_file(case) as model:
        for _ in range(50):
            model.set_log(lambda level, message: None)
        gc.collect()
        model.start()
        model.do_step(0.0, 0.01)


# Life and memory.


def test_models_and_states_end_with_their_objects(package, case):
    library = package.load_library()
    model = package.Model.from_file(case)
    state, handle = model.save(), model._core.handle
    model.set_log(lambda level, message, itself=model: None)
    del model
    gc.collect()
    with pytest.raises(package.DeadHandleError):
        library.call("enmm_start", handle)
    kept = state.handle
    del state
    with pytest.raises(package.DeadHandleError):
        library.call("enmm_state_free", kept)
    port = package.Model.from_file(case).ports["toe"]
    assert port.state().slip == 0, "a port keeps its model"


def resident() -> float:
    """Memory of this process (bytes)."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.parametrize("closing", [True, False])
def test_memory_stays_where_it_is(package, cases, closing):
    def cycle() -> None:
        model = package.Model.from_file(cases / "block_on_incline.toml")
        model.set_log(lambda level, message: None)
        model.do_step(0.0, 0.01)
        state = model.deserialize(model.serialize())
        model.restore(state)
        assert math.isfinite(model.blocks()["displacement_x"].sum() + model.contacts()["length"].sum())
        assert len(model.polygon(0)) > 3 and len(model.events()) > 0
        if closing:
            state.close()
            model.close()

    for _ in range(10):
        cycle()
    before = resident()
    for _ in range(200):
        cycle()
    assert resident() - before < 20e6


def test_empty_arrays_are_arrays(package):
    with package.Model.from_string(ONE_BLOCK.format(domain=f"outline = {SQUARE}")) as model:
        assert model.contacts().shape == (0,) and model.events() == [] and len(model.ports) == 0
        assert model.contacts().dtype == package.CONTACT_DTYPE and np.shares_memory(model.blocks(), model.blocks())


# Calls that end early.


def test_another_thread_ends_a_step_and_leaves_the_model_as_it_was(package, cases):
    with package.Model.from_file(cases / "coupled_slope.toml") as model:
        model.start()
        before, over = model.serialize(), threading.Event()

        def stop():
            while not over.wait(0.1):  # One that comes before the call has begun is lost.
                model.interrupt()

        thread = threading.Thread(target=stop)
        thread.start()
        try:
            with pytest.raises(package.CallInterruptedError, match="the model is as it was"):
                model.do_step(0.0, 1e8)
        finally:
            over.set()
            thread.join()
        assert model.serialize() == before
        model.interrupt()
        model.do_step(0.0, 0.01)


def test_progress_shows_how_far_a_call_has_come_and_may_end_it(package, cases):
    with package.Model.from_file(cases / "coupled_slope.toml") as model:
        seen, before = [], model.serialize()

        def stop(progress):
            seen.append(progress)
            with pytest.raises(package.BusyError):
                model.save()
            if len(seen) == 3:
                raise RuntimeError("enough")

        with pytest.raises(RuntimeError, match="enough"):
            model.do_step(0.0, 1e8, progress=stop)
        assert model.serialize() == before, "the equilibrium of the step is taken back too"
        assert seen[0].is_equilibrium and seen[0].time < seen[0].end
        steps = [progress for progress in seen if not progress.is_equilibrium]
        assert all(progress.end == 1e8 and progress.unbalanced == -1.0 for progress in steps)
        model.do_step(0.0, 0.1)
        assert len(seen) == 3, "a function sees the call alone that it was given to"


INTERRUPTED = """
import os, signal, sys, threading, time
import enmm

# Shells switch the signal off for what they begin in the background.
signal.signal(signal.SIGINT, signal.default_int_handler)
with enmm.Model.from_file(sys.argv[1]) as model:
    model.start()
    before, sent = model.serialize(), []

    def send():
        time.sleep(0.3)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=send).start()
    try:
        model.do_step(0.0, 1e8)
    except KeyboardInterrupt:
        print(time.monotonic() - sent[0], model.serialize() == before)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_ctrl_c_ends_a_step_and_leaves_the_model_as_it_was(package, cases):
    program = [sys.executable, "-c", INTERRUPTED, str(cases / "coupled_slope.toml")]
    result = subprocess.run(program, capture_output=True, text=True, timeout=60, check=False)
    assert result.returncode == 0, result.stderr
    late, same = result.stdout.split()
    print(f"KeyboardInterrupt {1e3 * float(late):.1f} ms after the signal")
    assert float(late) < 5.0 and same == "True"


# A start that is not at rest.


@pytest.mark.parametrize("call", ["start", "do_step"])
def test_a_lost_equilibrium_is_a_warning_once(package, cases, call):
    with package.Model.from_file(cases / "coupled_slope.toml") as model:
        model.ports["toe"].set_force(0.45e6, 0.28e6)
        seek = model.start if call == "start" else lambda: model.do_step(0.0, 0.01)
        with pytest.warns(package.EquilibriumWarning, match="not at rest at time 0") as caught:
            seek()
        assert [Path(warning.filename).name for warning in caught] == [Path(__file__).name]
        info = model.start_info()
        assert info.started and not info.settled and info.steps > 100 and info.unbalanced > 1e-3
        model.do_step(model.time, 0.01)


def test_an_equilibrium_that_is_reached_is_no_warning(package, cases, recwarn):
    with package.Model.from_file(cases / "coupled_slope.toml") as model:
        info = model.start()
        assert info.started and info.settled and not info.failed and info.unbalanced == 0.0
        model.restore(model.save())
        model.do_step(0.0, 0.01)
    assert not recwarn.list
