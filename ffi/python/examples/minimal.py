"""A slope whose toe is held by a force that fades: prints how far its toe and its face have moved.

Run:  python ffi/python/examples/minimal.py [CASE.toml]
"""

import sys
from pathlib import Path

import enmm

SLOPE = enmm.examples()["coupled_slope"]
FORCE = (0.9e6, 0.56e6)
"""Force (N/m) that the case puts on the toe at the start."""


def main(case: Path) -> None:
    with enmm.Model.from_file(case) as model:
        model.start()
        model.interpolation = enmm.Interpolation.LINEAR
        toe, face = model.ports["toe"], model.ports["face"]
        print(f"enmm {enmm.load_library().version}, {model.block_count} blocks")
        print("  t (s)  hold (-)    toe (mm)   face (mm)  sliding contacts")
        for tenth in range(11):
            if tenth > 0:
                toe.set_force(*((1 - 0.1 * tenth) * part for part in FORCE))
                model.do_step(model.time, 0.1)
            states = (toe.state(), face.state())
            moved = [(of.displacement_x**2 + of.displacement_y**2) ** 0.5 * 1e3 for of in states]
            slipping = model.totals().slipping_contacts
            print(f"{model.time:7.2f}  {1 - 0.1 * tenth:8.2f}  {moved[0]:10.4f}  {moved[1]:10.4f}  {slipping:16d}")
        for event in model.events():
            of = "a contact off the joints" if event.subject is None else event.subject
            print(f"{event.time:7.4f}  {event.kind.name.lower()}: {of}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else SLOPE)
