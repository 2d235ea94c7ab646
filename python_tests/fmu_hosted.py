"""FMUs through a host in C, which a test may run on an emulator: `ffi/fmi/tests/c/host.c`, compiled for a platform."""

import struct
import subprocess
from pathlib import Path

from fmu_support import OK, Fmu, size

KINDS = {"Real": "R", "Float64": "R", "Integer": "I", "Int32": "I", "Boolean": "B"}
WINDOWS = ("win64", "x86_64-windows")


class HostedInstance:
    """An instance in a host, called as an `Instance` of `fmu_support`. `host` is the command of the host."""

    def __init__(self, fmu: Fmu, platform: str, host: list[str]):
        self.fmu, self.states = fmu, 0
        (library,) = (fmu.folder / "binaries" / platform).iterdir()
        resources = f"{fmu.resources}/"
        if platform in WINDOWS:  # The emulator shows the file system as drive Z.
            library, resources = f"Z:{library}", f"Z:{resources}"
        if fmu.version == 2:
            resources = fmu.uri().replace("file:///", "file:///Z:/" if platform in WINDOWS else "file:///")
        words = [*host, str(fmu.version), str(library), resources, fmu.token]
        self.process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self) -> "HostedInstance":
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        assert self.process.wait(timeout=60) == 0, "the host ended badly"
        self.process.stdout.close()

    def call(self, *words) -> list[str]:
        """Has the host do one thing; returns what it answers behind the status."""
        print(*words, file=self.process.stdin, flush=True)
        status, *values = self.process.stdout.readline().split() or ["nothing"]
        assert status == str(OK), (words, status)
        return values

    def initialize(self, start=0.0) -> "HostedInstance":
        """From instantiated to step mode."""
        self.call("initialize", digits(start))
        return self

    def run(self, steps: int, h: float, first=0) -> "HostedInstance":
        """Takes `steps` steps from the point `first` of a grid with the spacing h on."""
        for k in range(first, first + steps):
            self.call("step", digits(k * h), digits(h))
        return self

    def get(self, *names: str) -> list[float]:
        """Values of variables, arrays flat."""
        variables = [self.fmu.variables[name] for name in names]
        return [
            number(value)
            for v in variables
            for value in self.call("get", KINDS[v.type], v.valueReference, size(v))
        ]

    def set(self, values: dict) -> int:
        """Sets variables by name."""
        for name, value in values.items():
            v = self.fmu.variables[name]
            self.call("set", KINDS[v.type], v.valueReference, 1, digits(value))
        return OK

    def save(self) -> int:
        """The number of a saved state."""
        self.call("save")
        self.states += 1
        return self.states - 1

    def restore(self, state: int) -> int:
        self.call("restore", state)
        return OK

    def serialize(self, state: int) -> bytes:
        return bytes.fromhex("".join(self.call("serialize", state)))

    @staticmethod
    def check(status: int):
        assert status == OK


def digits(value: float) -> str:
    """The bits of a number."""
    return struct.pack(">d", value).hex()


def number(text: str) -> float:
    """The number with these bits."""
    (value,) = struct.unpack(">d", bytes.fromhex(text))
    return value
