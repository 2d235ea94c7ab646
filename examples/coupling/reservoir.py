"""Reservoir: its level rises, stays and is drawn down fast; water in the hill behind the slope follows late.

    python examples/coupling/reservoir.py [-o PICTURE.png]

Two models are coupled. The reservoir balances inflow, outlet and the water that the moving slope displaces; the water
in the hill follows its level with a delay. The slope gets both levels: that of the reservoir presses on its face and is
the head where the weak plane crops out, that of the hill is the head of a fault that leads to the plane. Between them
the water flows by `[flow]`, which the stage finds again as the levels change; its pressures lift the slope. The slope
gives its displacement back. Days of a real reservoir are seconds here: the slope answers its loads without inertia of its own,
until it slides. While the level rises the water on the face pushes the slope back; after the fast drawdown the hill is
still full, and the slope slides until it has drained. Needs matplotlib and the package enmm.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

try:
    import enmm
except ImportError:  # Not installed: that of this repository, with the library that cargo built.
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "ffi" / "python"))
    import enmm

CASE = enmm.examples()["coupled_slope"]
STEP = 0.02
DURATION = 10.0
# Toe force (N/m): holds the dry slope with little to spare.
TOE = np.array([0.505e6, 0.314e6])
# Ends of the weak plane inside the rock.
PLANE = np.array([[20.5, 9.6376], [53.0866, 30.0]])
# A fault leads the water of the hill to the plane; the joints across it do not conduct.
FLOW = """
[flow]

[joint_law.fault]
friction_deg = 40
aperture = 1e-3

[[joint]]
points = [[22.0, 10.5749], [60.0, 6.0]]
law = "fault"

[[head]]
name = "hill"
edge = [[60, 0], [60, 30]]
level = 6.0
"""


def slope_model():
    """The slope with water on its face and in its weak plane, which follows both levels."""
    text = CASE.read_text(encoding="utf-8")
    for old, new in [
        ("level = 6.0", "level = 6.0\njoints = false"),
        ("[joint_law.weak]", "[joint_law.weak]\naperture = 2e-4"),
        ("[joint_law.cross]", "[joint_law.cross]\naperture = 0.0"),
        ('kind = "dynamic"', 'kind = "dynamic"\nflow = "steady"'),
    ]:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return enmm.Model.from_string(text + FLOW)


class Reservoir:
    """Level of the reservoir and of the water in the hill (m)."""

    area = 40.0
    """Surface per metre of depth (m²/m)."""
    delay = 2.5
    """Time (s) in which the water in the hill follows."""

    def __init__(self):
        self.level, self.hill, self.time = 6.0, 6.0, 0.0

    @staticmethod
    def flow(t):
        """Inflow less outflow (m³/s per metre of depth)."""
        if t < 4.0:
            return 130.0
        return 0.0 if t < 5.5 else (-470.0 if t < 6.5 else 0.0)

    def advance(self, h, displaced):
        """Goes on by h (s) while the slope displaces so much water (m³/m)."""
        self.level += (self.flow(self.time + 0.5 * h) * h + displaced) / self.area
        self.hill += (self.level - self.hill) * -np.expm1(-h / self.delay)
        self.time += h


def run():
    """Runs the coupling; returns everything that the picture shows."""
    reservoir, rows = Reservoir(), []
    with slope_model() as slope:
        slope.interpolation = enmm.Interpolation.LINEAR
        slope.ports["toe"].set_force(*TOE)
        slope.start()
        before = [slope.polygon(k) for k in range(slope.block_count)]
        start = np.array(slope.ports["toe"].state()[:2])
        pushed = 0.0
        for k in range(round(DURATION / STEP)):
            moved, plane = np.array(slope.ports["toe"].state()[:2]) - start, slope.ports["plane"].state()
            now = reservoir.level, reservoir.hill, np.hypot(*moved), slope.totals().velocity_max, plane.uplift
            rows.append((k * STEP, *now))
            # The toe block of some 4 m height pushes water away while it moves out.
            wet = np.clip(reservoir.level - 10.2, 0.0, 4.0)
            out = -moved[0] * wet
            reservoir.advance(STEP, out - pushed)
            pushed = out
            slope.set_water_level(reservoir.level)
            slope.set_head("hill", reservoir.hill)
            slope.do_step(k * STEP, STEP)
        after = [slope.polygon(k) for k in range(slope.block_count)]
        events = slope.events()
    return {"rows": np.array(rows), "before": before, "after": after, "events": events}


def draw(result, path):
    """Draws levels, displacement and the slope."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    t, level, hill, moved, speed, uplift = result["rows"].T
    figure = pyplot.figure(figsize=(11, 6.5), layout="constrained")
    axes = figure.subplot_mosaic([["l", "s"], ["p", "s"], ["u", "s"], ["v", "s"]], width_ratios=[1, 1.1])
    axes["l"].plot(t, level, color="#1f5fa8", lw=2, label="reservoir")
    axes["l"].plot(t, hill, color="#c0392b", lw=1.5, ls="--", label="water in the hill")
    axes["l"].set_ylabel("level [m]")
    axes["l"].legend(frameon=False)
    axes["p"].plot(t, 1e-6 * uplift, color="#c0392b")
    axes["p"].set_ylabel("uplift of the\nplane [MN/m]")
    axes["u"].plot(t, 1000.0 * moved, color="black")
    axes["u"].set_ylabel("toe displace-\nment [mm]")
    axes["v"].semilogy(t, np.maximum(speed, 1e-8), color="black", lw=0.8)
    axes["v"].set_ylabel("largest\nvelocity [m/s]")
    axes["v"].set_xlabel("time [s]")
    top = level.max()
    for outline in result["after"]:
        axes["s"].fill(outline[:, 0], outline[:, 1], facecolor="#efe6d8", edgecolor="#5b4a3a", lw=1.0)
    face = np.interp(top, [8.0, 30.0], [20.0, 34.0])
    axes["s"].fill([0, 20, face, 0], [8, 8, top, top], color="#1f5fa8", alpha=0.25, label="highest level")
    axes["s"].plot(*PLANE.T, color="#c0392b", lw=2, label="weak plane")
    axes["s"].set_aspect("equal")
    axes["s"].set_xlim(10, 60)
    axes["s"].legend(frameon=False, loc="lower right")
    axes["s"].set_xlabel("x [m]")
    axes["s"].set_ylabel("y [m]")
    figure.suptitle("A reservoir that rises and is drawn down fast, coupled with a jointed slope")
    figure.savefig(path, dpi=110)


def main():
    """Runs the coupling and leaves a picture."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", default="reservoir.png", help="picture to write")
    arguments = parser.parse_args()
    result = run()
    draw(result, arguments.o)
    rows = result["rows"]
    for t in (4.0, 5.4, 6.6, 9.98):
        row = rows[np.argmin(np.abs(rows[:, 0] - t))]
        levels = f"level {row[1]:6.2f} m  hill {row[2]:6.2f} m  uplift {1e-6 * row[5]:6.3f} MN/m"
        print(f"t {row[0]:5.2f} s  {levels}  toe {1000 * row[3]:8.3f} mm")
    print(f"{len(result['events'])} events; wrote {arguments.o}")


if __name__ == "__main__":
    main()
