"""Puts schema and example cases into the wheel, and the library and the program; names the platform it is for.

`cargo xtask wheel` sets ENMM_BINARIES to the folder that holds them; cross builds set ENMM_PLATFORM to their platform
as well, such as win-amd64. The library lies in the package, where `enmm fmu` finds it too, and the program among the
scripts. Licences and the list of all parts are in the metadata. The
package calls the library by ctypes, so one wheel serves every Python of a platform.
"""

import os
import re
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NAMES = {
    "linux": ("libenmm.so", "enmm"),
    "macosx": ("libenmm.dylib", "enmm"),
    "win": ("enmm.dll", "enmm.exe"),
}


# Files of the repository that go along, and their places in the data of the package.
DATA = {"docs/case.schema.json": "case.schema.json", "examples/cases": "cases"}

# Licences of all crates in the binaries, and the list of these crates.
LICENSES = "LICENSES"
LIST = "sbom.cdx.json"


class WheelHook(BuildHookInterface):
    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        repository = Path(self.root).parents[1]
        build_data["force_include"] |= {str(repository / file): f"enmm/data/{place}" for file, place in DATA.items()}
        given = os.environ.get("ENMM_BINARIES")
        if not given:
            return
        platform = os.environ.get("ENMM_PLATFORM") or sysconfig.get_platform()
        library, program = NAMES[platform.split("-")[0]]
        folder = Path(given)
        missing = [name for name in (library, program, LICENSES, LIST) if not (folder / name).is_file()]
        if missing:
            raise FileNotFoundError(f"{folder} lacks {', '.join(missing)}: run `cargo xtask wheel`")
        build_data["pure_python"] = False
        binaries = [folder / name for name in (library, program)]
        build_data["tag"] = f"py3-none-{tag(platform, binaries)}"
        build_data["force_include"][str(folder / library)] = f"enmm/{library}"
        build_data["shared_scripts"][str(folder / program)] = program
        metadata = f"enmm-{self.metadata.version}.dist-info"
        build_data["force_include"] |= {
            str(folder / LICENSES): f"{metadata}/licenses/{LICENSES}",
            str(folder / LIST): f"{metadata}/sboms/{LIST}",
        }


def tag(platform: str, binaries: list[Path]) -> str:
    """The tag of a platform: on Linux with the oldest C library that has all functions which the binaries use."""
    name = re.sub(r"\W", "_", platform)
    if not name.startswith("linux_"):
        return name
    versions = [int(found) for path in binaries for found in re.findall(rb"GLIBC_2\.(\d+)", path.read_bytes())]
    return f"manylinux_2_{max(versions)}_{name.removeprefix('linux_')}"
