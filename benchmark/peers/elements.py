"""Element updates of a Numba kernel beside those of `enmm bench`, turn by turn on one thread.

    python3 -m venv VENV && VENV/bin/pip install -r benchmark/peers/requirements.txt
    VENV/bin/python benchmark/peers/elements.py target/release/enmm

The kernel does what the engine's element stage does on the same number of elements: corotated constant-strain
triangles, their forces summed to nodes, and the kick of the nodes. It leaves out damping and the exact mass metric.
"""

import json
import statistics
import subprocess
import sys
import time

import numpy as np
from numba import njit

SIZES = [10_000, 100_000]
ROUNDS = 5
MU = LAMBDA = 2e9
DENSITY = 2650.0


@njit(fastmath=False)
def step(corners, gradients, area, mass, displacement, velocity, force, dt):
    """Internal forces of all elements, then velocities and displacements of all nodes."""
    force[:] = 0.0
    for e in range(corners.shape[0]):
        f11, f12, f21, f22 = 1.0, 0.0, 0.0, 1.0
        for k in range(3):
            i = corners[e, k]
            gx, gy = gradients[e & 1, k, 0], gradients[e & 1, k, 1]
            f11 += displacement[i, 0] * gx
            f12 += displacement[i, 0] * gy
            f21 += displacement[i, 1] * gx
            f22 += displacement[i, 1] * gy
        a, b = f11 + f22, f21 - f12
        trace = np.sqrt(a * a + b * b)
        c, s = a / trace, b / trace
        volume = LAMBDA * (trace - 2.0)
        p11 = -area[e] * (2.0 * MU * (f11 - c) + volume * c)
        p12 = -area[e] * (2.0 * MU * (f12 + s) - volume * s)
        p21 = -area[e] * (2.0 * MU * (f21 - s) + volume * s)
        p22 = -area[e] * (2.0 * MU * (f22 - c) + volume * c)
        for k in range(3):
            i = corners[e, k]
            gx, gy = gradients[e & 1, k, 0], gradients[e & 1, k, 1]
            force[i, 0] += p11 * gx + p12 * gy
            force[i, 1] += p21 * gx + p22 * gy
    for i in range(mass.shape[0]):
        for axis in range(2):
            velocity[i, axis] += force[i, axis] / mass[i] * dt
            displacement[i, axis] += velocity[i, axis] * dt


def mesh(elements):
    """A square of right-angled triangles, the two of a cell one after the other."""
    cells = round((elements / 2) ** 0.5)
    size = 100.0 / cells
    row = cells + 1
    lower_left = (np.arange(cells)[:, None] * row + np.arange(cells)).ravel()
    corners = np.empty((2 * cells * cells, 3), np.uint32)
    corners[0::2] = np.stack([lower_left, lower_left + 1, lower_left + row], 1)
    corners[1::2] = np.stack([lower_left + row + 1, lower_left + row, lower_left + 1], 1)
    gradient = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]) / size
    gradients = np.stack([gradient, -gradient])
    area = np.full(len(corners), 0.5 * size * size)
    mass = np.bincount(corners.ravel(), np.repeat(area * DENSITY / 3.0, 3), row * row)
    return corners, gradients, area, mass, size


def numba_rate(elements):
    """Element updates per second, of the quickest pass."""
    corners, gradients, area, mass, size = mesh(elements)
    random = np.random.default_rng(1)
    displacement = 1e-6 * size * random.standard_normal((len(mass), 2))
    velocity, force = np.zeros_like(displacement), np.zeros_like(displacement)
    dt = 0.3 * size * (DENSITY / (3 * (LAMBDA + MU))) ** 0.5
    best = float("inf")
    for _ in range(100):
        start = time.perf_counter()
        step(corners, gradients, area, mass, displacement, velocity, force, dt)
        best = min(best, time.perf_counter() - start)
    assert np.isfinite(displacement).all()
    return len(corners) / best


def enmm_rate(program, elements):
    """Elements per second of the engine's element stage."""
    command = [program, "bench", "--json", "--no-limits", "--threads", "1", "--seconds", "1"]
    told = subprocess.run([*command, "--models", f"continuum_{elements}"], check=True, capture_output=True)
    return json.loads(told.stdout)["models"][0]["elements_per_second"]


def main():
    """Prints a table: medians of both, and of their ratio round by round."""
    program = sys.argv[1]
    numba_rate(1000)
    print("| elements | enmm M/s | Numba M/s | enmm / Numba |\n|---|---|---|---|")
    for elements in SIZES:
        rounds = [(enmm_rate(program, elements), numba_rate(elements)) for _ in range(ROUNDS)]
        ours, theirs = (statistics.median(column) / 1e6 for column in zip(*rounds))
        ratio = statistics.median(a / b for a, b in rounds)
        print(f"| {elements} | {ours:.0f} | {theirs:.0f} | {ratio:.2f} |")


if __name__ == "__main__":
    main()
