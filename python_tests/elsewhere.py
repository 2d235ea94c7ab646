"""What a saved state becomes in another process."""

import os
import subprocess
import sys
from pathlib import Path

CHILD = """
import importlib
import sys
import enmm
sys.path.insert(0, sys.argv[1])
test = importlib.import_module(sys.argv[2])
with enmm.Model.from_file(sys.argv[3]) as model, open(sys.argv[4], "rb") as file:
    model.restore(model.deserialize(file.read()))
    test.act(model, int(sys.argv[5]), test.STEPS)
    sys.stdout.write(repr(test.state(model)))
"""


def gone_on_elsewhere(test: str, case: Path, state: Path, step: int) -> str:
    """The end, by `state` of a test module, to which its `act` takes a saved state from a step on in a new process."""
    arguments = [sys.executable, "-c", CHILD, str(Path(__file__).parent), test, str(case), str(state), str(step)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    output = subprocess.run(arguments, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert output.returncode == 0, output.stderr
    return output.stdout
