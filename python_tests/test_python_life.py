"""Programs and folders of the package end with those that began them; what workers send back is whole."""

import asyncio
import gc
import multiprocessing
import os
import pickle
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pytest

CASES = Path(__file__).parents[1] / "examples" / "cases"
INCLINE = CASES / "block_on_incline.toml"
SLOW = CASES / "fractured_slope.toml"

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


def left(folder: Path) -> list[str]:
    """What the package has left in a temporary folder."""
    return [path.name for path in folder.glob("enmm-*")]


def wait_for(condition, what: str) -> None:
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.02)


@pytest.fixture
def temporary(tmp_path, monkeypatch) -> Path:
    """A temporary folder of the test's own."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path


def quick(package, friction: float):
    return package.Case.from_file(INCLINE).with_values(
        {"joint_law.joint.friction_deg": friction, "stage[1].duration": 0.02, "output.frames": False}
    )


def work(case, is_killed: bool):
    """Runs a case in a worker, where the program may be killed."""
    import enmm

    start = subprocess.Popen

    def killed(*words, **options):
        process = start(*words, **options)
        process.kill()
        return process

    subprocess.Popen = killed if is_killed else start
    try:
        return enmm.run(case, threads=1, pictures=False)
    finally:
        subprocess.Popen = start


def test_thirty_runs_on_two_processes_lose_those_that_fail_alone(package, temporary):
    cases = [quick(package, 35.0 + 0.1 * k) for k in range(30)]
    fast = {"initial_velocity": [{"block": [0.683, 0.183], "velocity": [9000.0, 0.0]}]}
    cases[3] = cases[3].with_values(fast | {"stage": [{"name": "fly", "kind": "dynamic", "duration": 0.1}]})
    results, failures = [], {}
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(work, case, k == 7) for k, case in enumerate(cases)]
        for k, future in enumerate(futures):
            try:
                results.append(future.result())
            except Exception as error:
                failures[k] = error
    assert len(results) == 28 and sorted(failures) == [3, 7]
    assert isinstance(failures[3], package.RunError) and "runaway" in str(failures[3])
    assert failures[3].result.summary["status"] == "failed" and failures[3].result.checkpoint.is_file()
    assert isinstance(failures[7], ChildProcessError) and "signal 9" in str(failures[7])
    assert all(result.checkpoint.is_file() and not result.pictures for result in results)
    del results, failures, futures, future
    gc.collect()
    assert left(temporary) == []


def test_results_take_their_files_along(package, temporary):
    result = package.run(quick(package, 36.0).with_values({"output.frames": True}))
    data = pickle.dumps(result)
    last = result.frames[-1].points
    result.close()
    with pytest.raises(package.InvalidArgumentError, match="closed, and their temporary directory is gone"):
        pickle.dumps(result)
    with pytest.raises(package.InvalidArgumentError, match="give an `output` to keep them"):
        result.frames[-1]
    copy = pickle.loads(data)
    assert (copy.frames[-1].points == last).all() and copy.pictures and copy.checkpoint.is_file()
    del copy
    gc.collect()
    assert left(temporary) == []


def children(number: int) -> list[int]:
    """Processes that a process has started (Linux)."""
    text = Path(f"/proc/{number}/task/{number}/children").read_text(encoding="utf-8")
    return [int(child) for child in text.split()]


def is_running(number: int) -> bool:
    try:
        state = Path(f"/proc/{number}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


@pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc")
def test_the_program_ends_with_a_caller_that_is_killed_and_its_folder_is_swept(package, temporary):
    script = f"import enmm; enmm.run({str(SLOW)!r}, threads=1)"
    with subprocess.Popen([sys.executable, "-c", script]) as caller:
        wait_for(lambda: children(caller.pid), "the program starts")
        (program,) = children(caller.pid)
        wait_for(lambda: list(temporary.glob("enmm-*/*/history.csv")), "the program writes")
        caller.kill()
    wait_for(lambda: not is_running(program), "the program ends")
    (folder,) = left(temporary)
    # A lock that is young may be one that its process has not taken yet.
    os.utime(temporary / folder / "lock", (0, 0))
    script = "from enmm import _places; _places.remove(_places.make())"
    subprocess.run([sys.executable, "-c", script], check=True)
    assert left(temporary) == []


def test_a_run_that_takes_too_long_ends_with_a_checkpoint(package, tmp_path):
    with pytest.raises(TimeoutError, match="had not ended after 0.5 s"):
        package.run(SLOW, tmp_path / "out", threads=1, timeout=0.5)
    assert (tmp_path / "out" / "checkpoint.enmm").is_file()
    with pytest.raises(package.InvalidArgumentError, match="timeout: is -1"):
        package.run(SLOW, timeout=-1)


def test_asynchronous_runs_go_beside_others_and_end_their_programs(package, temporary):
    async def both() -> list:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.5):
                await package.aio.fos(SLOW, threads=1)
        return await asyncio.gather(*(package.aio.run(quick(package, phi), pictures=False) for phi in (36.0, 37.0)))

    results = asyncio.run(both())
    assert [result.summary["status"] for result in results] == ["finished", "finished"]
    del results
    gc.collect()
    assert left(temporary) == []


def test_an_exception_of_a_progress_function_ends_the_program(package, temporary):
    def stop(line: str) -> None:
        raise RuntimeError(line)

    for call in (package.run, package.fos):
        with pytest.raises(RuntimeError, match="trial|simulated|building"):
            call(SLOW if call is package.run else INCLINE, threads=1, progress=stop)
    gc.collect()
    assert left(temporary) == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks")
def test_objects_of_a_parent_keep_their_files_when_a_fork_ends(package, temporary):
    result = package.run(quick(package, 36.0), pictures=False)
    fork = multiprocessing.get_context("fork").Process(target=result.close)
    fork.start()
    fork.join()
    assert fork.exitcode == 0 and result.checkpoint.is_file()
