"""Samples: counter-based random numbers, Latin hypercube, correlation by a Gaussian copula.

The program draws the same samples to the bit (crate `sample`), so sums are written out in its order.

Sample k of a variable depends on the seed, the name of the variable and k alone, so it is the same on every machine,
for any number of workers, and after a restart. The generator is Philox4x64-10 (J. K. Salmon et al., Parallel random
numbers: as easy as 1, 2, 3, SC 2011) as numpy has it: key (seed, first 8 bytes of SHA-256 of the name, big-endian),
counter k; the first word of the first block it then gives, without its lowest 11 bits, plus a half, over 2^53.
"""

import hashlib
import math
from collections.abc import Mapping
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import invalid
from ._normal import probability
from ._variables import Distribution, Seeds, Variable

METHODS = ("monte_carlo", "latin_hypercube")
_STANDARD = NormalDist()


def uniform(seed: int, name: str, k: int) -> float:
    """The random number within 0 and 1 of a variable for sample `k`; neither 0 nor 1."""
    word = int(_words(seed, name, k, 1)[0])
    return ((word >> 11) + 0.5) / 2**53


def _words(seed: int, name: str, k: int, count: int) -> npt.NDArray[np.uint64]:
    label = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "big")
    generator = np.random.Philox(key=np.array([seed, label], np.uint64), counter=np.array([k, 0, 0, 0], np.uint64))
    return np.asarray(generator.random_raw(count))


def _strata(seed: int, name: str, n: int) -> npt.NDArray[np.int64]:
    """The strata of `n` samples in a random order: which of `n` equal parts each sample lies in."""
    order = np.argsort(_words(seed, name + " strata", 0, n), kind="stable")
    return np.argsort(order, kind="stable")


def draw(
    variables: Mapping[str, Variable],
    n: int,
    seed: int,
    method: str,
    correlations: Mapping[tuple[str, str], float],
) -> list[dict[str, Any]]:
    """The values of `n` samples by key."""
    if method not in METHODS:
        raise invalid(f"method: is {method!r}, must be one of {', '.join(METHODS)}")
    if not 1 <= n <= 10**7:
        raise invalid(f"n: is {n}, must be from 1 to 10000000")
    if not 0 <= seed < 2**64:
        raise invalid(f"seed: is {seed}, must be from 0 to 2^64 - 1")
    names = [name for name, variable in variables.items() if isinstance(variable, Distribution)]
    chance = np.array([[uniform(seed, name, k) for name in names] for k in range(n)]).reshape(n, len(names))
    strata = np.array([_strata(seed, name, n) for name in names]).reshape(len(names), n).T
    stratified = method == "latin_hypercube"
    if correlations:
        factor = _cholesky(names, correlations)
        start = (strata + chance) / n if stratified else chance
        normals = np.array([_correlated(factor, row) for row in start])
        if stratified:  # The ranks of the correlated numbers choose the strata, so that each is still taken once.
            strata = np.argsort(np.argsort(normals, axis=0, kind="stable"), axis=0, kind="stable")
        else:
            chance = np.vectorize(probability, otypes=[float])(normals)
    if stratified:
        chance = (strata + chance) / n
    column = {name: i for i, name in enumerate(names)}
    return [{name: _value(of, k, chance, column.get(name)) for name, of in variables.items()} for k in range(n)]


def _value(variable: Variable, k: int, chance: npt.NDArray[np.float64], column: int | None) -> float | int:
    if isinstance(variable, Seeds):
        return variable.first + k
    return variable.value(float(chance[k, column]))


def _correlated(factor: list[list[float]], row: npt.NDArray[np.float64]) -> list[float]:
    """Correlated normal variables from independent numbers within 0 and 1."""
    normals = [_STANDARD.inv_cdf(float(u)) for u in row]
    found = []
    for factors in factor:
        total = 0.0
        for a, b in zip(factors, normals, strict=False):
            total += a * b
        found.append(total)
    return found


def _cholesky(names: list[str], correlations: Mapping[tuple[str, str], float]) -> list[list[float]]:
    """Lower factor of the matrix of correlations, row by row up to the diagonal."""
    matrix = np.eye(len(names)).tolist()
    for (a, b), value in correlations.items():
        for name in (a, b):
            if name not in names:
                raise invalid(
                    f"correlations: {name!r} is no variable with a distribution; there are: {', '.join(names)}"
                )
        if a == b or not -1 < value < 1:
            raise invalid(f"correlations: that of {a!r} and {b!r} is {value}, must be of two and within -1 and 1")
        i, j = names.index(a), names.index(b)
        matrix[i][j] = matrix[j][i] = float(value)
    factor: list[list[float]] = []
    for i, given in enumerate(matrix):
        row: list[float] = []
        for j, above in enumerate([*factor, row]):
            rest = given[j]
            for a, b in zip(row, above, strict=False):
                rest -= a * b
            if j == i:
                if not rest > 0:
                    raise invalid("correlations: no variables can have them all at once; bring some nearer to 0")
                rest = math.sqrt(rest)
            row.append(rest if j == i else rest / above[j])
        factor.append(row)
    return factor
