"""What the Python tests share: the results of one short run, the program, and the C library with its package.

`cargo xtask test` sets all of them up.
"""

import os
import subprocess
from pathlib import Path

import pytest
from fmu_support import Fmu, Instance


def from_environment(name: str) -> Path:
    """The existing path that the variable holds; a missing one fails the test, because no test may be skipped."""
    value = os.environ.get(name)
    if not value:
        pytest.fail(f"{name} is not set: run `cargo xtask test`, which sets it", pytrace=False)
    path = Path(value)
    if not path.exists():
        pytest.fail(f"{name}={value} does not exist: run `cargo xtask test`", pytrace=False)
    return path


@pytest.fixture(scope="session")
def results() -> Path:
    """Folder with the results of `short.toml`."""
    return from_environment("ENMM_RESULTS")


@pytest.fixture(scope="session")
def short_case() -> Path:
    """The case behind `results`."""
    return Path(__file__).with_name("short.toml")


@pytest.fixture(scope="session")
def program() -> str:
    """A browser that draws pages without a window; tests of pages are skipped without it."""
    # Its package is there with the tests of pages alone.
    import browser

    found = browser.find()
    if not found:
        pytest.skip("there is no Chromium on this machine (Debian: apt-get install chromium)")
    return found


@pytest.fixture(scope="session")
def enmm():
    """Runs the program with arguments; returns the completed process with text output."""
    program = from_environment("ENMM_BIN")

    def run(*arguments):
        words = [str(program), *map(str, arguments)]
        return subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)

    return run


FMUS = [f"{case}_fmi{version}.fmu" for case in ("block_on_incline", "coupled_slope") for version in (2, 3)]


@pytest.fixture(scope="session")
def fmus(tmp_path_factory) -> dict[str, Fmu]:
    """The four FMUs by file name, unpacked."""
    packed, folder = from_environment("ENMM_FMUS"), tmp_path_factory.mktemp("fmus")
    return {name: Fmu.unpack(packed / name, folder / name.removesuffix(".fmu")) for name in FMUS}


@pytest.fixture(params=FMUS, ids=lambda name: name.removesuffix(".fmu"))
def fmu(request, fmus) -> Fmu:
    """Each FMU in turn."""
    return fmus[request.param]


@pytest.fixture(params=[2, 3], ids=["fmi2", "fmi3"])
def incline_fmu(request, fmus) -> Fmu:
    """The block on an incline in both versions."""
    return fmus[f"block_on_incline_fmi{request.param}.fmu"]


@pytest.fixture(params=[2, 3], ids=["fmi2", "fmi3"])
def slope_fmu(request, fmus) -> Fmu:
    """The coupled slope in both versions."""
    return fmus[f"coupled_slope_fmi{request.param}.fmu"]


@pytest.fixture
def opened():
    """Makes instances that end with the test."""
    instances = []

    def make(fmu: Fmu, **options) -> Instance:
        instances.append(Instance(fmu, **options))
        return instances[-1]

    yield make
    for instance in instances:
        instance.free()


@pytest.fixture(scope="session")
def library() -> Path:
    """The C library."""
    return from_environment("ENMM_LIBRARY")


@pytest.fixture(scope="session")
def cases() -> Path:
    """Folder of the example cases."""
    return Path(__file__).parents[1] / "examples" / "cases"


@pytest.fixture(scope="session")
def package(library):
    """The package, with the library that `ENMM_LIBRARY` names."""
    import enmm as package  # Only here: without `cargo xtask test` it is not on the path, which `library` tells first.

    assert package.load_library().path == str(library.resolve())
    return package


@pytest.fixture
def incline(package, cases):
    with package.Model.from_file(cases / "block_on_incline.toml") as model:
        yield model


@pytest.fixture
def slope(package, cases):
    with package.Model.from_file(cases / "coupled_slope.toml") as model:
        yield model
