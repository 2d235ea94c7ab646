"""Twin of a slope: friction and cohesion of its plane from three noisy monitors, and a forecast of the next shaking.

    python examples/coupling/twin.py [-o PICTURE.png]

A wedge of three blocks rests on a plane. A first shaking finds it dry, a second one with water in the plane, and
three monitors measure how far it slips, with noise. Friction and cohesion are not known. An ensemble smoother with
multiple data assimilation (A. A. Emerick and A. C. Reynolds, Computers & Geosciences 55, 2013) begins with wide guesses
and moves them until the slopes of the ensemble slip as the measured one; the scatter that is left says how well they
are known. Water tells friction from cohesion: it takes away normal force, and so friction alone. Every slope of the
ensemble then is a saved state, from which it goes on into a shaking that has not happened yet. Needs matplotlib
and the package enmm.
"""

import argparse
import math
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

try:
    import enmm
except ImportError:  # Not installed: that of this repository, with the library that cargo built.
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "ffi" / "python"))
    import enmm

STEP = 0.02
# Shakings (start and length in s, amplitude in m/s²) and the water pressure in the plane (Pa) meanwhile.
SHAKINGS = [(0.1, 0.3, 3.0, 0.0), (1.1, 0.3, 2.2, 30e3), (2.1, 0.4, 2.5, 15e3)]
MEASURED, END = 2.0, 3.2
MONITORS = {"crest": [28.0, 28.0], "middle": [16.0, 20.0], "toe": [6.0, 7.5]}
NOISE = 2e-3
"""Standard deviation of a measurement (m)."""
INFLATIONS = (28 / 3, 7.0, 4.0, 2.0)
"""Factors on the variance of the data in each round, coarse first; their inverses sum to 1, so the data count once."""
TRUTH = {"friction_deg": 35.0, "cohesion": 42e3}
# Normal variables behind the two: tan(friction), and the logarithm of the cohesion in Pa.
PRIOR_MEAN, PRIOR_SD = np.array([math.tan(math.radians(34.0)), math.log(50e3)]), np.array([0.04, 0.3])


def slope(friction_deg, cohesion):
    """The slope: 30 m high, face 60°, plane 35°, tension crack of 7 m, two joints across the wedge."""
    outline = [[-16.73, -10], [36, -10], [36, 30], [17.3205081, 30], [-1.7320508, -3.0], [-16.73, -3]]
    across = [([8.0, 5.6016602], [0.0, 20.0]), ([18.0, 12.6037356], [6.0, 34.0])]
    joints = [{"points": [[0.0, 0.0], [32.8474042, 23.0]], "law": "plane"}]
    joints += [{"points": [[32.8474042, 23.0], [32.8474042, 30.0]], "law": "crack"}]
    joints += [{"points": list(points), "law": "across"} for points in across]
    return enmm.Case.from_dict(
        {
            "title": "Twin of a slope",
            "domain": {"outline": outline},
            "mesh": {"size": 4.0, "origin": [0.31, 0.17]},
            "joint": joints,
            "rock": {"gneiss": {"density": 2650.0, "young": 5e9, "poisson": 0.25}},
            "joint_law": {
                "plane": {"friction_deg": float(friction_deg), "cohesion": float(cohesion)},
                "crack": {"friction_deg": 0.0},
                "across": {"friction_deg": 45.0, "cohesion": 50e3},
            },
            "fix": [{"block": [10.0, -6.0]}],
            "port": [{"name": name, "block": point} for name, point in MONITORS.items()]
            + [{"name": "plane", "joint": [[0.0, 0.0], [32.8474042, 23.0]]}],
            "stage": [
                {"name": "gravity", "kind": "static", "duration": 4.0, "convergence": 1e-5},
                {"name": "shaken", "kind": "dynamic", "duration": END, "damping": 0.1},
            ],
        }
    )


def parameters(normals):
    """Friction (degrees) and cohesion (Pa) from the normal variables."""
    return {"friction_deg": math.degrees(math.atan(max(normals[0], 0.02))), "cohesion": math.exp(min(normals[1], 15.0))}


def slip(values, until=MEASURED, state=None):
    """Displacement (m) of the three monitors at every tenth of a second up to `until`, and the state there.

    A slope begins at rest, or goes on from a saved state; parts of a path are the same bits as the whole.
    """
    with slope(**values).model() as model:
        if state is None:
            model.start()
        else:
            model.restore(state)
        rows = []
        for k in range(round(model.time / STEP), round(until / STEP)):
            t = (k + 0.5) * STEP
            shaking = [s for s in SHAKINGS if s[0] <= t < s[0] + s[1]]
            pressure = next((s[3] for s in SHAKINGS if t < s[0] + s[1] + 0.3), 0.0)
            start, length, amplitude, _ = shaking[0] if shaking else (t, 1.0, 0.0, 0.0)
            model.set_base_acceleration(amplitude * math.sin(math.pi * (t - start) / length), 0.0)
            model.ports["plane"].set_pressure(pressure)
            model.do_step(k * STEP, STEP)
            if (k + 1) % 5 == 0:
                ports = [model.ports[name].state() for name in MONITORS]
                rows.append([math.hypot(port.displacement_x, port.displacement_y) for port in ports])
        return np.array(rows), model.save()


def smooth(measured, members, executor, inflations=INFLATIONS, seed=1):
    """Ensemble smoother with multiple data assimilation; returns the normal variables after each round."""
    draw = np.random.Generator(np.random.Philox(seed))
    ensemble = [PRIOR_MEAN + PRIOR_SD * draw.standard_normal((members, 2))]
    data = measured.ravel()
    for inflation in inflations:
        now = ensemble[-1]
        paths = np.array([rows.ravel() for rows, _ in executor.map(slip, map(parameters, now))])
        noise = inflation * NOISE**2
        of_values, of_paths = now - now.mean(axis=0), paths - paths.mean(axis=0)
        spread = of_paths.T @ of_paths / (members - 1) + noise * np.eye(data.size)
        gain = np.linalg.solve(spread, of_paths.T @ of_values / (members - 1))
        perturbed = data + math.sqrt(noise) * draw.standard_normal(paths.shape)
        ensemble.append(now + (perturbed - paths) @ gain)
    return ensemble


def run(members=50, inflations=INFLATIONS, executor=None):
    """Measures the true slope, finds its strength, and forecasts; returns everything that the picture shows."""
    executor = executor or ThreadPoolExecutor()
    path, state = slip(TRUTH)
    measured = path + NOISE * np.random.Generator(np.random.Philox(101)).standard_normal(path.shape)
    ensemble = smooth(measured, members, executor, inflations)
    last = [parameters(normals) for normals in ensemble[-1]]
    found = list(executor.map(slip, last))
    states = [pickle.dumps(state) for _, state in found]
    ahead = executor.map(lambda values, data: slip(values, END, pickle.loads(data))[0], last, states)
    forecast = np.array([np.vstack([rows, more]) for (rows, _), more in zip(found, ahead, strict=True)])
    return {
        "measured": measured,
        "truth": np.vstack([path, slip(TRUTH, END, state)[0]]),
        "ensemble": ensemble,
        "forecast": forecast,
        "true": np.array([math.tan(math.radians(TRUTH["friction_deg"])), math.log(TRUTH["cohesion"])]),
    }


def draw(result, path):
    """Draws the parameters before and after, and the slip that was measured and that is forecast."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(11, 5), layout="constrained")
    left, right = figure.subplots(1, 2)
    rounds = len(result["ensemble"]) - 1
    for k, color in ((0, "#b8c4d6"), (rounds, "#1f5fa8")):
        friction, cohesion = np.array([list(parameters(of).values()) for of in result["ensemble"][k]]).T
        left.plot(
            friction, cohesion / 1e3, "o", ms=4, color=color, label="guesses" if k == 0 else f"after {rounds} rounds"
        )
    left.plot(TRUTH["friction_deg"], TRUTH["cohesion"] / 1e3, "x", color="#c0392b", ms=11, mew=2.5, label="true")
    left.set(xlabel="friction [°]", ylabel="cohesion [kPa]", ylim=(0, 140))
    left.legend(frameon=False)
    t = 0.1 * np.arange(1, len(result["truth"]) + 1)
    of_toe = 1e3 * result["forecast"][:, :, 2]
    right.fill_between(t, of_toe.min(axis=0), of_toe.max(axis=0), color="#1f5fa8", alpha=0.25, label="ensemble")
    right.plot(t, 1e3 * result["truth"][:, 2], color="#c0392b", lw=1.2, label="true slope")
    measured = result["measured"][:, 2]
    right.plot(t[: len(measured)], 1e3 * measured, ".", color="black", label="measured at the toe")
    right.axvline(MEASURED, color="0.5", lw=0.8, ls="--")
    right.set(xlabel="time [s]", ylabel="displacement [mm]")
    right.legend(frameon=False)
    figure.suptitle("Strength of a slope from its monitors, and a forecast of the next shaking")
    figure.savefig(path, dpi=110)


def main():
    """Runs the twin and leaves a picture."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", default="twin.png", help="picture to write")
    arguments = parser.parse_args()
    result = run()
    draw(result, arguments.o)
    for k, of in enumerate(result["ensemble"]):
        (tangent, log), (tangent_sd, log_sd) = of.mean(axis=0), of.std(axis=0, ddof=1)
        friction = math.degrees(math.atan(tangent))
        kilo = math.exp(log) / 1e3
        print(f"round {k}  friction {friction:6.2f}° ± {math.degrees(tangent_sd / (1 + tangent**2)):5.2f}°", end="  ")
        print(f"cohesion {kilo:6.2f} kPa ± {kilo * log_sd:5.2f} kPa")
    print(f"true     friction {TRUTH['friction_deg']:6.2f}°          cohesion {TRUTH['cohesion'] / 1e3:6.2f} kPa")
    print(f"wrote {arguments.o}")


if __name__ == "__main__":
    main()
