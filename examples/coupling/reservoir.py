"""Reservoir: its level rises, stays and is drawn down fast; water in the joints of the slope follows late.

    python examples/coupling/reservoir.py [-o PICTURE.png]

Two models are coupled. The reservoir balances inflow, outlet and the water that the moving slope displaces; a store of
joint water follows its level with a delay, as seepage does. The slope gets the level on its face and the pressure of
the joint water on its weak plane, part by part, and gives its displacement back. Days of a real reservoir are seconds
here: the slope answers its loads without inertia of its own, until it slides. While the level rises the water on the
face pushes the slope back; after the fast drawdown the joint water is left behind, and the slope slides until it has
drained. Needs matplotlib and the package enmm.
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
WEIGHT = 1000.0 * 9.81
STEP = 0.02
DURATION = 10.0
# Toe force (N/m): holds the dry slope with little to spare.
TOE = np.array([0.515e6, 0.32e6])
# Ends of the weak plane inside the rock, and the number of parts that get a pressure each.
PLANE = np.array([[21.4, 10.2], [53.0866, 30.0]])
PARTS = 8


def slope_model():
    """The slope with water on its face alone and a port for each part of its weak plane."""
    text = CASE.read_text(encoding="utf-8").replace("level = 6.0", "level = 6.0\njoints = false")
    for k in range(PARTS):
        a, b = (PLANE[0] + (PLANE[1] - PLANE[0]) * (k + end) / PARTS for end in (-1e-6, 1.0 + 1e-6))
        text += f'\n[[port]]\nname = "part_{k}"\njoint = [[{a[0]}, {a[1]}], [{b[0]}, {b[1]}]]\n'
    return enmm.Model.from_string(text)


class Reservoir:
    """Level of the reservoir and of the water in the joints (m)."""

    area = 40.0
    """Surface per metre of depth (m²/m)."""
    delay = 2.5
    """Time (s) in which joint water follows."""

    def __init__(self):
        self.level, self.joints, self.time = 6.0, 6.0, 0.0

    @staticmethod
    def flow(t):
        """Inflow less outflow (m³/s per metre of depth)."""
        if t < 4.0:
            return 130.0
        return 0.0 if t < 5.5 else (-470.0 if t < 6.5 else 0.0)

    def advance(self, h, displaced):
        """Goes on by h (s) while the slope displaces so much water (m³/m)."""
        self.level += (self.flow(self.time + 0.5 * h) * h + displaced) / self.area
        self.joints += (self.level - self.joints) * -np.expm1(-h / self.delay)
        self.time += h


def joint_pressures(level):
    """Mean pressure (Pa) of still water with this level on each part of the plane."""
    heights = np.linspace(PLANE[0, 1], PLANE[1, 1], 20 * PARTS + 1)
    middles = 0.5 * (heights[1:] + heights[:-1])
    return WEIGHT * np.clip(level - middles, 0.0, None).reshape(PARTS, -1).mean(axis=1)


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
            moved = np.array(slope.ports["toe"].state()[:2]) - start
            rows.append((k * STEP, reservoir.level, reservoir.joints, np.hypot(*moved), slope.totals().velocity_max))
            # The toe block of some 4 m height pushes water away while it moves out.
            wet = np.clip(reservoir.level - 10.2, 0.0, 4.0)
            out = -moved[0] * wet
            reservoir.advance(STEP, out - pushed)
            pushed = out
            slope.set_water_level(reservoir.level)
            for part, pressure in enumerate(joint_pressures(reservoir.joints)):
                slope.ports[f"part_{part}"].set_pressure(pressure)
            slope.do_step(k * STEP, STEP)
        after = [slope.polygon(k) for k in range(slope.block_count)]
        events = slope.events()
    return {"rows": np.array(rows), "before": before, "after": after, "events": events}


def draw(result, path):
    """Draws levels, displacement and the slope."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    t, level, joints, moved, speed = result["rows"].T
    figure = pyplot.figure(figsize=(11, 6.5), layout="constrained")
    axes = figure.subplot_mosaic([["l", "s"], ["u", "s"], ["v", "s"]], width_ratios=[1, 1.1])
    axes["l"].plot(t, level, color="#1f5fa8", lw=2, label="reservoir")
    axes["l"].plot(t, joints, color="#c0392b", lw=1.5, ls="--", label="water in the joints")
    axes["l"].set_ylabel("level [m]")
    axes["l"].legend(frameon=False)
    axes["u"].plot(t, 1000.0 * moved, color="black")
    axes["u"].set_ylabel("toe displacement [mm]")
    axes["v"].semilogy(t, np.maximum(speed, 1e-8), color="black", lw=0.8)
    axes["v"].set_ylabel("largest velocity [m/s]")
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
        print(f"t {row[0]:5.2f} s  level {row[1]:6.2f} m  joints {row[2]:6.2f} m  toe {1000 * row[3]:8.3f} mm")
    print(f"{len(result['events'])} events; wrote {arguments.o}")


if __name__ == "__main__":
    main()
