"""What the Python tests share: the results of one short run, the program, and the C library with its package.

`cargo xtask test` sets all of them up.
"""

import os
import subprocess
from pathlib import Path

import pytest


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
def enmm():
    """Runs the program with arguments; returns the completed process with text output."""
    program = from_environment("ENMM_BIN")

    def run(*arguments):
        words = [str(program), *map(str, arguments)]
        return subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)

    return run


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
