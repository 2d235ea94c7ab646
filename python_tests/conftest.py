"""What the Python tests share: the results of one short run, and the program. `cargo xtask test` sets both up."""

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
