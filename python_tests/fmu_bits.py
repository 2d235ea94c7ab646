"""Steps an FMU with a rollback and writes what it gives, to the last bit: `fmu_bits.py PACKED.fmu FOLDER`.

`outputs.txt` has a line for each communication step and output, `state.bin` the serialized state at the end.
"""

import sys
import tempfile
from pathlib import Path

from fmu_support import Fmu, Instance

H = 0.01
BEFORE, ASIDE, AFTER = 5, 3, 5


def main(packed: Path, folder: Path):
    folder.mkdir(parents=True, exist_ok=True)
    lines = []

    def note(instance, label):
        for name in fmu.outputs():
            lines.extend(f"{label} {name} {float(value).hex()}" for value in instance.get(name))

    def steps(instance, label, count, first):
        for k in range(first, first + count):
            instance.run(1, H, first=k)
            note(instance, f"{label} {k}")

    with tempfile.TemporaryDirectory() as unpacked:
        fmu = Fmu.unpack(packed, Path(unpacked))
        with Instance(fmu) as instance:
            instance.initialize()
            steps(instance, "before", BEFORE, 0)
            state = instance.save()
            instance.check(instance.set({"gravity_x": 0.5}))
            steps(instance, "aside", ASIDE, BEFORE)
            instance.check(instance.restore(state))
            steps(instance, "after", AFTER, BEFORE)
            (folder / "state.bin").write_bytes(instance.serialize(instance.save()))
    (folder / "outputs.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
