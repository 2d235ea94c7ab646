"""The process around the FMUs: odd folders, memory, unloading, both versions at once, loggers of all importers."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from fmpy import simulate_fmu
from fmu_support import Fmu, Instance

H = 0.01
HERE = str(Path(__file__).parent)


@pytest.mark.parametrize("folder", ["with blank", "Böschung", "a%20b", "100%", "#1 & ;", "日本", "x" * 120, "a+b=c"])
def test_odd_folders(fmu, tmp_path, folder):
    copy = fmu.copy_to(tmp_path / folder)
    with Instance(copy) as instance:
        instance.initialize().run(1, H)


@pytest.mark.parametrize(
    "form", ["file:{path}", "file://{path}", "file://localhost{path}", "file://{path}/", "FILE://{path}"]
)
def test_forms_of_the_resource_location(fmus, form):
    fmu = fmus["block_on_incline_fmi2.fmu"]
    path = fmu.resources.as_uri().removeprefix("file://")
    with Instance(fmu, resources=form.format(path=path)) as instance:
        assert instance.pointer, instance.log


def test_unencoded_location_with_blank_and_umlaut(fmus, tmp_path):
    copy = fmus["block_on_incline_fmi2.fmu"].copy_to(tmp_path / "a b ü")
    with Instance(copy, resources=f"file://{copy.resources}") as instance:
        assert instance.pointer, instance.log


def test_fmu_with_blank_and_umlaut_in_fmpy(fmu, tmp_path):
    path = shutil.copy(fmu.path, tmp_path / "Böschung eins.fmu")
    result = simulate_fmu(str(path), stop_time=0.02, output_interval=H, output=fmu.block_outputs()[:1])
    assert len(result) == 3


CHILD = """
import os, sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from fmu_support import Fmu, Instance, fmpy
folder = Path(sys.argv[2])
description = fmpy.read_model_description(str(folder), validate=False)
if os.getuid() == 0:
    os.setgid(65534); os.setuid(65534)
os.chdir("/")
fmu = Fmu(Path("x_fmi0.fmu"), folder, description)
instance = Instance(fmu).initialize().run(2, 0.01)
assert not os.access(folder, os.W_OK) and not os.access(fmu.resources, os.W_OK)
print(instance.everything().hex())
"""


def test_read_only_folder_of_another_user(fmu, opened, tmp_path_factory):
    """Nobody, who may write nowhere, from another working folder."""
    folder = Path("/var/tmp") / f"enmm-{os.getpid()}-{fmu.path.stem}"
    try:
        shutil.copytree(fmu.folder, folder)
        for place in [folder, *folder.rglob("*")]:
            place.chmod(stat.S_IRUSR | stat.S_IRGRP | stat.S_IROTH | (0o111 if place.is_dir() else 0))
        before = sorted(folder.rglob("*"))
        environment = {"PATH": os.environ["PATH"], "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, "-c", CHILD, HERE, str(folder)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, env=environment)
        assert done.returncode == 0, done.stderr
        assert done.stdout.strip() == opened(fmu).initialize().run(2, H).everything().hex()
        assert sorted(folder.rglob("*")) == before
    finally:
        for place in [folder, *folder.rglob("*")]:
            if place.is_dir():
                place.chmod(0o755)
        shutil.rmtree(folder)


def test_nothing_is_printed_and_no_file_is_left(fmu, tmp_path):
    script = f"""
import sys
sys.path.insert(0, {HERE!r})
from pathlib import Path
from fmu_support import Fmu, Instance, fmpy
folder = Path({str(fmu.folder)!r})
fmu = Fmu(Path("x_fmi0.fmu"), folder, fmpy.read_model_description(str(folder), validate=False))
instance = Instance(fmu, logging=True).initialize().run(3, 0.01)
instance.step(0.0, float("nan"))
instance.terminate()
instance.free()
"""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert not list(tmp_path.iterdir())


MEMORY = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from fmu_support import Fmu, Instance, fmpy
folder = Path(sys.argv[2])
fmu = Fmu(Path("x_fmi0.fmu"), folder, fmpy.read_model_description(str(folder), validate=False))

def resident():
    return next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmRSS")) / 1024

def cycle():
    with Instance(fmu) as instance:
        instance.initialize().run(1, 0.01)
        state = instance.save()
        instance.deserialize(instance.serialize(state))
        instance.run(1, 0.01, first=1)
        instance.restore(state)
        if fmu.version == 3:
            instance.snapshot()
        instance.step(0.0, -1.0)

for _ in range(20):
    cycle()
before = resident()
for _ in range(int(sys.argv[3])):
    cycle()
print(resident() - before)
"""


def test_two_hundred_lives_need_no_memory(incline_fmu):
    command = [sys.executable, "-c", MEMORY, HERE, str(incline_fmu.folder), "200"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 5.0, "MB"


def test_thirty_lives_of_the_slope_need_no_memory(slope_fmu):
    command = [sys.executable, "-c", MEMORY, HERE, str(slope_fmu.folder), "30"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 5.0, "MB"


UNLOAD = """
import ctypes, sys
sys.path.insert(0, sys.argv[1])
from _ctypes import dlclose
from pathlib import Path
from fmu_support import Fmu, Instance, fmpy
folder = Path(sys.argv[2])
fmu = Fmu(Path("x_fmi0.fmu"), folder, fmpy.read_model_description(str(folder), validate=False))
name = fmu.library.name
seen = set()
for k in range(5):
    library = ctypes.CDLL(str(fmu.library))
    instance = Instance(fmu, library=library, logging=True).initialize(threads=1 + k % 2).run(2, 0.01)
    seen.add(instance.everything()[:64])
    instance.free()
    dlclose(library._handle)
    instance.library = library = None
assert len(seen) == 1
print("sound")
"""


def test_library_is_unloaded_and_loaded_again(fmu):
    command = [sys.executable, "-c", UNLOAD, HERE, str(fmu.folder)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, "sound"), done.stderr


def test_all_four_in_one_process(fmus, opened):
    """Both versions of both cases, each in two folders, stepped in turn."""
    expected = {name: opened(fmu).initialize().run(3, H).everything() for name, fmu in fmus.items()}
    instances = [(name, opened(fmu).initialize()) for name, fmu in fmus.items() for _ in range(2)]
    for k in range(3):
        for _, instance in instances:
            instance.run(1, H, first=k)
    assert all(instance.everything() == expected[name] for name, instance in instances)


def test_the_same_fmu_from_two_folders(fmu, opened, tmp_path):
    copy = fmu.copy_to(tmp_path / "copy")
    one, other = opened(fmu).initialize(), opened(copy).initialize()
    state = one.serialize(one.run(3, H).save())
    status, taken = other.deserialize(state)
    assert status == 0
    other.check(other.restore(taken))
    assert other.everything() == one.everything()


def test_fifty_instances_at_once(fmus, opened):
    fmu = fmus["block_on_incline_fmi3.fmu"]
    instances = [opened(fmu, name=f"block {k}").initialize() for k in range(50)]
    for k in range(3):
        for instance in instances:
            instance.run(1, H, first=k)
    assert len({instance.everything() for instance in instances}) == 1


def test_library_of_one_case_refuses_resources_of_another(fmus, opened):
    for version in (2, 3):
        one, other = (fmus[f"{case}_fmi{version}.fmu"] for case in ("block_on_incline", "coupled_slope"))
        mixed = Fmu(one.path, one.folder, one.description)
        place = other.uri() if version == 2 else str(other.resources)
        instance = opened(mixed, resources=place)
        assert instance.pointer is None and "token" in instance.log[-1][2]
