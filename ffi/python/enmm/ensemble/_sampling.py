"""Samples: the program draws them (crate `enmm-ensemble`), so that it and this package have the same ones to the bit.

Sample k of a variable depends on the seed, the name of the variable and k alone, so it is the same on every machine,
for any number of workers, and after a restart. The generator is Philox4x64-10 (J. K. Salmon et al., Parallel random
numbers: as easy as 1, 2, 3, SC 2011) as numpy has it: key (seed, first 8 bytes of SHA-256 of the name, big-endian),
counter k; the first word of the first block it then gives, without its lowest 11 bits, plus a half, over 2^53.
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .. import _program
from .._errors import invalid
from ._variables import Distribution, Variable

METHODS = ("monte_carlo", "latin_hypercube")


class Identity(NamedTuple):
    """What a stored sample depends on besides its values and the version."""

    case: str = ""
    """Fingerprint of the case."""
    output: str = ""
    """Name of the output."""
    options: Mapping[str, float | str] = {}
    """Options of the search."""


def uniform(seed: int, name: str, k: int) -> float:
    """The random number within 0 and 1 of a variable for sample `k`; neither 0 nor 1."""
    label = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "big")
    generator = np.random.Philox(key=np.array([seed, label], np.uint64), counter=np.array([k, 0, 0, 0], np.uint64))
    return ((int(generator.random_raw()) >> 11) + 0.5) / 2**53


def draw(
    variables: Mapping[str, Variable],
    n: int,
    seed: int,
    method: str,
    correlations: Mapping[tuple[str, str], float],
) -> list[dict[str, Any]]:
    """The values of `n` samples by key."""
    return draw_with_keys(variables, n, seed, method, correlations, Identity())[0]


def draw_with_keys(
    variables: Mapping[str, Variable],
    n: int,
    seed: int,
    method: str,
    correlations: Mapping[tuple[str, str], float],
    identity: Identity,
) -> tuple[list[dict[str, Any]], list[str]]:
    """The values of `n` samples by key, and the key of each in a store."""
    if method not in METHODS:
        raise invalid(f"method: is {method!r}, must be one of {', '.join(METHODS)}")
    if not 1 <= n <= 10**7:
        raise invalid(f"n: is {n}, must be from 1 to 10000000")
    if not 0 <= seed < 2**64:
        raise invalid(f"seed: is {seed}, must be from 0 to 2^64 - 1")
    _check(variables, correlations)
    request = {
        "random": [{"key": key, **variable.to_dict()} for key, variable in variables.items()],
        "random_correlation": [{"keys": keys, "value": float(value)} for keys, value in correlations.items()],
        "ensemble": {"samples": n, "sampling": method, "seed": seed},
        **identity._asdict(),
    }
    status, out, error = _program.answer(["draw"], json.dumps(request))
    if status != 0:
        raise invalid(_program.message_of(status, error).replace("random_correlation: ", "correlations: "))
    answer = json.loads(out)
    return [dict(zip(variables, row, strict=True)) for row in answer["samples"]], answer["keys"]


def _check(variables: Mapping[str, Variable], correlations: Mapping[tuple[str, str], float]) -> None:
    names = [name for name, variable in variables.items() if isinstance(variable, Distribution)]
    for (a, b), value in correlations.items():
        for name in (a, b):
            if name not in names:
                raise invalid(
                    f"correlations: {name!r} is no variable with a distribution; there are: {', '.join(names)}"
                )
        if a == b or not -1 < value < 1:
            raise invalid(f"correlations: that of {a!r} and {b!r} is {value}, must be of two and within -1 and 1")
