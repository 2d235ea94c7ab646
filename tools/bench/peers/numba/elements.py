"""Element updates of a Numba kernel, which `cargo xtask bench --peers` times beside those of enmm on one thread.

    VENV/bin/pip install -r tools/bench/peers/numba/requirements.txt
    VENV/bin/python tools/bench/peers/numba/elements.py 10000

The kernel does what the engine's element stage does on the same number of elements: corotated constant-strain
triangles, their forces summed to nodes, and the kick of the nodes. It leaves out damping and the exact mass metric.
"""

import json
import sys
import time

import numba
import numpy as np
from numba import njit

PASSES = 100
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


def seconds_per_pass(elements):
    """Seconds of the quickest pass, and elements of the mesh."""
    corners, gradients, area, mass, size = mesh(elements)
    random = np.random.default_rng(1)
    displacement = 1e-6 * size * random.standard_normal((len(mass), 2))
    velocity, force = np.zeros_like(displacement), np.zeros_like(displacement)
    dt = 0.3 * size * (DENSITY / (3 * (LAMBDA + MU))) ** 0.5
    best = float("inf")
    for _ in range(PASSES):
        start = time.perf_counter()
        step(corners, gradients, area, mass, displacement, velocity, force, dt)
        best = min(best, time.perf_counter() - start)
    if not np.isfinite(displacement).all():
        sys.exit("displacements are not finite")
    return best, len(corners)


def main():
    """Prints seconds for a million element updates as one JSON object."""
    seconds, elements = seconds_per_pass(int(sys.argv[1]))
    told = {
        "program": f"Numba {numba.__version__}",
        "settings": f"corotated elements, their forces and the kick, quickest of {PASSES} passes, 8-byte numbers",
        "seconds": 1e6 * seconds / elements,
        "elements": elements,
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
