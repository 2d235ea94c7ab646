"""Other importers of FMUs than FMPy reach the bits of plain calls: ecos (FMI 2 and 3) and libcosim (FMI 2).

Their packages have libraries for Linux on x86-64 alone, as `requirements.txt` says; elsewhere these tests are skipped.
"""

import importlib.util
import math
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from fmpy.validation import validate_fmu
from fmu_support import Fmu, bits

H, END = 0.01, 0.5
WAY = ("displacement_x", "displacement_y")

# Each prints the numbers behind a mark, since importers print as well.
ECOS = """
import ctypes, sys
from pathlib import Path
ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), ctypes.RTLD_GLOBAL)
from ecospy import EcosSimulation, EcosSimulationStructure

path, h, steps, *names = sys.argv[1:]
structure = EcosSimulationStructure()
structure.add_model("model", path)
with EcosSimulation(structure=structure, step_size=float(h)) as simulation:
    simulation.init()
    simulation.step(int(steps))
    print("RESULT", *(simulation.get_real(f"model::{name}").hex() for name in names))
"""
LIBCOSIM = """
import sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

path, h, steps, *names = sys.argv[1:]
execution = CosimExecution.from_step_size(round(1e9 * float(h)))
model = execution.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name="model"))
observer = CosimObserver.create_last_value()
execution.add_observer(observer)
references = {variable.name.decode(): variable.reference for variable in execution.slave_variables(model)}
execution.step(int(steps))
values = observer.last_real_values(model, [references[name] for name in names])
print("RESULT", *(value.hex() for value in values))
"""


IMPORTERS = {"ecos-2": (ECOS, 2), "ecos-3": (ECOS, 3), "libcosim-2": (LIBCOSIM, 2)}


@pytest.mark.parametrize(("program", "version"), IMPORTERS.values(), ids=IMPORTERS)
@pytest.mark.parametrize(("case", "port"), [("block_on_incline", "block"), ("coupled_slope", "toe")])
def test_other_importers_reach_the_same_bits(fmus, opened, case, port, program, version):
    package = "ecospy" if program is ECOS else "libcosimpy"
    if importlib.util.find_spec(package) is None:
        pytest.skip(f"{package} has no library for this platform")
    fmu = fmus[f"{case}_fmi{version}.fmu"]
    names, steps = [f"{port}.{name}" for name in WAY], round(END / H)
    own = opened(fmu).initialize().run(steps, H).get(*names)
    assert all(own)
    words = [sys.executable, "-c", program, str(fmu.path), str(H), str(steps), *names]
    host = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    assert host.returncode == 0, host.stdout + host.stderr
    (line,) = [line for line in host.stdout.splitlines() if line.startswith("RESULT ")]
    assert bits(map(float.fromhex, line.split()[1:])) == bits(own)


VALLEY = Path(__file__).parents[1] / "examples" / "coupling" / "valley"


def valley_by_hand(slope, reservoir, steps, friction, inflow):
    """Both FMUs of the valley by plain calls: values are exchanged after each step."""
    slope.initialize(**{"joint_law.weak.friction": friction, "water_level": 6.0})
    reservoir.initialize(inflow=inflow)
    for k in range(steps):
        slope.check(slope.set({"water_level": reservoir.get("level")[0]}))
        reservoir.check(reservoir.set({"displacement_x": slope.get("face.displacement_x")[0]}))
        slope.run(1, H, first=k)
        reservoir.run(1, H, first=k)
    return reservoir.get("level") + slope.get("face.displacement_x", "toe.displacement_x", "toe.displacement_y")


def test_a_slope_and_a_reservoir_are_coupled_by_ecos(fmus, opened, tmp_path):
    """The SSP of the valley, with the parameters of its SSV, and the same two FMUs by plain calls: the same bits."""
    for package in ("ecospy", "fmpy"):
        if importlib.util.find_spec(package) is None:
            pytest.skip(f"{package} has no library for this platform")
    fmu = fmus["coupled_slope_fmi2.fmu"]
    words = [sys.executable, str(VALLEY / "pack.py"), str(fmu.path), "-o", str(tmp_path / "valley.ssp"), "--run"]
    host = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    assert host.returncode == 0, host.stdout + host.stderr
    shown = [float(line.split()[1]) for line in host.stdout.splitlines() if "::" in line]
    with zipfile.ZipFile(tmp_path / "valley.ssp") as archive:
        archive.extract("resources/reservoir.fmu", tmp_path)
    reservoir = Fmu.unpack(tmp_path / "resources" / "reservoir.fmu", tmp_path / "reservoir")
    assert validate_fmu(str(reservoir.path)) == []
    by_hand = lambda *parameters: valley_by_hand(opened(fmu), opened(reservoir), 200, *parameters)
    last = lambda *parameters: [round(value, 9) for value in by_hand(*parameters)]
    assert shown == last(math.radians(25.5), 195.0)
    assert shown != last(math.radians(26.0), 195.0), "the friction of the SSV is that of the run"
