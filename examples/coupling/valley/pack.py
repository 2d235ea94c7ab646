"""Valley: two FMUs, a slope and the reservoir in front of it, as one SSP.

    enmm fmu examples/cases/coupled_slope.toml --fmi 2 -o slope.fmu
    python examples/coupling/valley/pack.py slope.fmu -o valley.ssp
    python examples/coupling/valley/pack.py slope.fmu -o valley.ssp --run

The first call makes the FMU of the slope, the second compiles the reservoir (reservoir.c, by `cc` or what the variable
CC names) and packs both with their connections (SystemStructure.ssd) and parameters (slope.ssv, reservoir.ssv). With
`--run` the importer ecos (`pip install ecospy`) runs it for 2 s by steps of 10 ms.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PLATFORMS = {"linux": ("linux64", ".so"), "darwin": ("darwin64", ".dylib"), "win32": ("win64", ".dll")}
STEP, END = 0.01, 2.0
SHOWN = ("reservoir::level", "slope::face.displacement_x", "slope::toe.displacement_x", "slope::toe.displacement_y")


def reservoir(path):
    """Compiles and packs the FMU of the reservoir."""
    place, suffix = PLATFORMS[sys.platform]
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / f"reservoir{suffix}"
        compiler = os.environ.get("CC", "cc").split()
        source = FOLDER / "reservoir.c"
        subprocess.run([*compiler, "-std=c99", "-O2", "-shared", "-fPIC", source, "-lm", "-o", library], check=True)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.write(FOLDER / "modelDescription.xml", "modelDescription.xml")
            archive.write(library, f"binaries/{place}/{library.name}")
    return path


def pack(slope, path):
    """Packs both FMUs, their connections and their parameters as an SSP."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(FOLDER / "SystemStructure.ssd", "SystemStructure.ssd")
        archive.write(slope, "resources/slope.fmu")
        archive.write(reservoir(Path(folder) / "reservoir.fmu"), "resources/reservoir.fmu")
        for name in ("slope.ssv", "reservoir.ssv"):
            archive.write(FOLDER / name, f"resources/{name}")
    return path


def run(path):
    """Runs an SSP by ecos; returns the last values of what is shown."""
    import ctypes

    tbb = Path(sys.prefix) / "lib" / "libtbb.so.12"
    if tbb.exists():  # ecos looks for it, and the Python package `tbb` puts it here.
        ctypes.CDLL(str(tbb), ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=str(path), step_size=STEP) as simulation:
        simulation.init(parameter_set="wet")
        simulation.step(round(END / STEP))
        return {name: simulation.get_real(name) for name in SHOWN}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slope", type=Path, help="FMU of examples/cases/coupled_slope.toml, FMI 2")
    parser.add_argument("-o", "--output", type=Path, default=Path("valley.ssp"))
    parser.add_argument("--run", action="store_true", help="run it by ecos")
    options = parser.parse_args()
    path = pack(options.slope, options.output)
    print(f"wrote {path}")
    if options.run:
        for name, value in run(path).items():
            print(f"{name:30} {value:.9f} m")


if __name__ == "__main__":
    main()
