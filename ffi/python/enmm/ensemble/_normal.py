"""Probability of the normal distribution, the same bits as in the program (`crates/ensemble/src/normal.rs`).

`statistics.NormalDist.cdf` is not used, since its formula differs between versions of Python.
"""

import math

_FAR = 2.0
_DEPTH = 100


def probability(z: float) -> float:
    """Probability of a standard normal variable below `z`.

    The series of G. Marsaglia, Evaluating the normal distribution, J. Stat. Software 11(4), 2004, and far from the mean
    the continued fraction of Laplace, which keeps the digits of small probabilities.
    """
    density = math.exp(-0.5 * (z * z)) / math.sqrt(2.0 * math.pi)
    if abs(z) <= _FAR:
        term = total = z
        k = 1.0
        while True:
            k += 2.0
            term = term * (z * z) / k
            if total + term == total:
                return 0.5 + total * density
            total += term
    size = fraction = abs(z)
    for k in range(_DEPTH, 0, -1):
        fraction = size + k / fraction
    beyond = density / fraction
    return beyond if z < 0.0 else 1.0 - beyond
