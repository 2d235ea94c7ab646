"""Earthquake: a block on an incline and a jointed slope under an accelerogram that is fed as base acceleration.

    python examples/coupling/earthquake.py [-o PICTURE.png] [--accelerogram FILE.csv]

The accelerogram is made here (filtered noise under an envelope, always the same) unless a file gives one: two columns,
time (s) and horizontal acceleration (in g), comments after #. Every communication step sets the acceleration at its
end and lets the engine go there linearly. The block has an answer to compare with: Newmark's sliding block, integrated
here on the same record. Needs matplotlib and the package enmm; the slope has no closed form.
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

CASES = enmm.examples()
G = 9.81
STEP = 0.01
INCLINE = np.radians(30.0)
FRICTION_DEG = 38.0


def synthetic(duration=10.0, peak=0.45, seed=4):
    """Times (s) and accelerations (m/s²): noise about 2 Hz that swells, stays and decays."""
    t = np.arange(0.0, duration + STEP / 2, STEP)
    noise = np.random.RandomState(seed).standard_normal(t.size)
    a, velocity, place = np.zeros(t.size), 0.0, 0.0
    omega, damping = 2.0 * np.pi * 2.0, 0.4
    for k, push in enumerate(noise):
        force = push - 2.0 * damping * omega * velocity - omega**2 * place
        velocity += STEP * force
        place += STEP * velocity
        a[k] = force - push
    envelope = np.clip(t / 1.5, 0.0, 1.0) ** 2 * np.exp(-0.6 * np.clip(t - 5.0, 0.0, None))
    a = a * envelope
    # Without a mean and a slope the base ends at rest.
    a -= envelope * np.sum(a) / np.sum(envelope)
    return t, a * peak * G / np.max(np.abs(a))


def from_file(path):
    """Times and accelerations (m/s²) of a record in g, at the steps of the coupling."""
    rows = np.loadtxt(path, delimiter=",", comments="#")
    t = np.arange(0.0, rows[-1, 0], STEP)
    return t, G * np.interp(t, rows[:, 0], rows[:, 1])


def drive(model, t, a, observe):
    """Runs a model through a record; returns what `observe` saw after each step."""
    model.interpolation = enmm.Interpolation.LINEAR
    model.start()
    seen = [observe(model)]
    for k in range(1, t.size):
        model.set_base_acceleration(a[k], 0.0)
        model.do_step(t[k - 1], t[k] - t[k - 1])
        seen.append(observe(model))
    return np.array(seen)


def block_model():
    """The block of the example, with a friction that holds it until the base shakes."""
    text = (CASES["block_on_incline"]).read_text(encoding="utf-8")
    return enmm.Model.from_string(text.replace("friction_deg = 20.0", f"friction_deg = {FRICTION_DEG}"))


def newmark(t, a, parts=20):
    """Slip (m) down the incline of a rigid block on a base with the horizontal acceleration a (m/s²)."""
    slip, velocity, slips = 0.0, 0.0, [0.0]
    sine, cosine, friction = np.sin(INCLINE), np.cos(INCLINE), np.tan(np.radians(FRICTION_DEG))
    for k in range(1, t.size):
        h = (t[k] - t[k - 1]) / parts
        for part in range(parts):
            base = a[k - 1] + (a[k] - a[k - 1]) * (part + 0.5) / parts
            drive_ = G * sine - base * cosine
            hold = friction * max(0.0, G * cosine + base * sine)
            gain = drive_ - hold if velocity > 0.0 or drive_ > hold else 0.0
            before, velocity = velocity, max(0.0, velocity + h * gain)
            slip += 0.5 * h * (before + velocity)
        slips.append(slip)
    return np.array(slips)


def run(accelerogram=None):
    """Runs both couplings; returns everything that the picture shows."""
    t, a = from_file(accelerogram) if accelerogram else synthetic()
    down = np.array([np.cos(INCLINE), -np.sin(INCLINE)])
    with block_model() as model:
        block = drive(model, t, a, lambda m: m.ports["block"].state()[:2]) @ down
    with enmm.Model.from_file(CASES["coupled_slope"]) as model:
        outlines = [model.polygon(k) for k in range(model.block_count)]
        slope = drive(model, t, a, lambda m: [np.hypot(*m.ports[p].state()[:2]) for p in ("toe", "face")])
        after = [model.polygon(k) for k in range(model.block_count)]
        events = model.events()
    return {
        "t": t,
        "a": a,
        "block": block - block[0],
        "newmark": newmark(t, a),
        "slope": slope - slope[0],
        "before": outlines,
        "after": after,
        "events": events,
    }


def draw(result, path):
    """Draws record, slips and the slope before and after."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(11, 7), layout="constrained")
    axes = figure.subplot_mosaic([["a", "s"], ["b", "s"], ["c", "s"]], width_ratios=[1, 1.1])
    t = result["t"]
    axes["a"].plot(t, result["a"] / G, color="#444444", lw=0.9)
    axes["a"].set_ylabel("base acceleration [g]")
    axes["b"].plot(t, result["block"], color="#c0392b", lw=2.5, label="block, engine")
    axes["b"].plot(t, result["newmark"], color="black", lw=1, ls="--", label="Newmark, rigid")
    axes["b"].set_ylabel("slip of the block [m]")
    axes["c"].plot(t, result["slope"][:, 0], color="#1f5fa8", label="toe block")
    axes["c"].plot(t, result["slope"][:, 1], color="#2e8b57", label="face, mean")
    axes["c"].set_ylabel("displacement of the slope [m]")
    axes["c"].set_xlabel("time [s]")
    axes["b"].legend(frameon=False)
    axes["c"].legend(frameon=False)
    for name, colour, width in (("before", "#bbbbbb", 0.8), ("after", "#1f5fa8", 1.2)):
        for outline in result[name]:
            closed = np.vstack([outline, outline[:1]])
            axes["s"].plot(closed[:, 0], closed[:, 1], color=colour, lw=width)
    axes["s"].set_aspect("equal")
    axes["s"].set_xlim(17, 57)
    axes["s"].set_ylim(5, 32)
    axes["s"].set_title("blocks before (grey) and after (blue)", fontsize=10)
    axes["s"].set_xlabel("x [m]")
    axes["s"].set_ylabel("y [m]")
    figure.suptitle("A block and a jointed slope under the same earthquake")
    figure.savefig(path, dpi=110)


def main():
    """Runs the coupling and leaves a picture."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", default="earthquake.png", help="picture to write")
    parser.add_argument("--accelerogram", help="CSV with time (s) and acceleration (g)")
    arguments = parser.parse_args()
    result = run(arguments.accelerogram)
    draw(result, arguments.o)
    print(f"block slips {result['block'][-1]:.4f} m, Newmark's {result['newmark'][-1]:.4f} m")
    print(f"toe of the slope moves {result['slope'][-1, 0]:.4f} m, {len(result['events'])} events")
    print(f"wrote {arguments.o}")


if __name__ == "__main__":
    main()
