"""Steps an FMU with a rollback and writes what it gives, to the last bit.

    fmu_bits.py PACKED.fmu FOLDER [--before N] [--platform NAME --host COMMAND...]

`outputs.txt` has a line for each communication step and output, `state.bin` the serialized state at the end. With
`--host` the steps are those of the library of this platform in the host of this command (`fmu_hosted.py`).
"""

import argparse
import tempfile
from pathlib import Path

from fmu_hosted import HostedInstance
from fmu_support import Fmu, Instance

H = 0.01
BEFORE, ASIDE, AFTER = 5, 3, 5


def main(packed: Path, folder: Path, before: int, platform: str, host: list[str]):
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
        with HostedInstance(fmu, platform, host) if host else Instance(fmu) as instance:
            instance.initialize()
            steps(instance, "before", before, 0)
            state = instance.save()
            instance.check(instance.set({"gravity_x": 0.5}))
            steps(instance, "aside", ASIDE, before)
            instance.check(instance.restore(state))
            steps(instance, "after", AFTER, before)
            (folder / "state.bin").write_bytes(instance.serialize(instance.save()))
    (folder / "outputs.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("packed", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--before", type=int, default=BEFORE, help="steps before the rollback")
    parser.add_argument("--platform", help="folder of the library in the FMU")
    parser.add_argument("--host", nargs=argparse.REMAINDER, help="command of a host for this platform")
    words = parser.parse_args()
    main(words.packed, words.folder, words.before, words.platform, words.host)
