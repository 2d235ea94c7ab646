"""A UM-Bridge server of a case: parameters in, outputs out, for PyMC, QMCPy, OpenTURNS, MUQ and other clients.

    import enmm.umbridge

    keys = {"joint_law.plane.friction_deg": "tangent", "joint_law.plane.cohesion": "value"}
    enmm.umbridge.serve("plane_slide.toml", keys, "factor_of_safety", port=4242)

A client then calls the model by its address: `umbridge.HTTPModel("http://localhost:4242", "enmm")([[0.7, 25e3]])`
gives `[[1.19]]`. Needs the package `umbridge`. Protocol: L. Seelinger et al., J. Open Source Software 8(83), 2023.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import umbridge

from ._case import Case
from ._errors import invalid
from ._program import CaseLike
from .ensemble._outputs import NAMES, Output, evaluate
from .ensemble._variables import transformed


_Model: Any = umbridge.Model


class CaseModel(_Model):  # type: ignore[misc, unused-ignore]
    """One input vector with a number for each key, one output vector with the numbers of the output.

    `keys` are keys of the case, or a dict from them to what the number is of: "value", "tangent" of an angle that the
    case has in degrees, or "log10". `output` is as that of `enmm.ensemble.run`; of a function that returns a dict
    `names` lists the entries to give. `options` are those of `enmm.fos`.
    """

    def __init__(
        self,
        case: CaseLike,
        keys: Sequence[str] | Mapping[str, str],
        output: Output = "factor_of_safety",
        *,
        name: str = "enmm",
        names: Sequence[str] = (),
        options: Mapping[str, Any] | None = None,
    ) -> None:
        _Model.__init__(self, name)
        if isinstance(output, str) and output not in NAMES:
            raise invalid(f"output: is {output!r}, must be one of {', '.join(NAMES)}, or a function of a case")
        self._case, self._output, self._options = Case.of(case), output, dict(options or {})
        self._keys = dict(keys) if isinstance(keys, Mapping) else dict.fromkeys(keys, "value")
        for key in self._keys:
            _ = self._case[key]
        self._names = list(names) or [output if isinstance(output, str) else "output"]

    def get_input_sizes(self, config: Any) -> list[int]:
        """One vector, a number for each key."""
        return [len(self._keys)]

    def get_output_sizes(self, config: Any) -> list[int]:
        """One vector, a number for each output."""
        return [len(self._names)]

    def supports_evaluate(self) -> bool:
        """It can be evaluated; it has no derivatives."""
        return True

    def __call__(self, parameters: list[list[float]], config: Any) -> list[list[float]]:
        """Works out one sample. Raises ValueError with the reason for a case without an answer."""
        given = zip(self._keys.items(), parameters[0], strict=True)
        answer = evaluate(
            self._case, {key: transformed(float(x), of) for (key, of), x in given}, self._output, self._options
        )
        if answer.message:
            raise ValueError(f"no answer for {parameters[0]}: {answer.message}")
        return [[float(answer.outputs[name]) for name in self._names]]


def serve(
    case: CaseLike,
    keys: Sequence[str] | Mapping[str, str],
    output: Output = "factor_of_safety",
    port: int = 4242,
    workers: int = 1,
    host: str = "127.0.0.1",
    **options: Any,
) -> None:
    """Serves a case on a port of this machine until it is interrupted, with as many samples at once as `workers`.

    `options` are those of `CaseModel`. Only programs on this machine reach the port, unless `host` is another address
    of it, such as "0.0.0.0" for all: then whoever reaches that can use the model.
    """
    model = CaseModel(case, keys, output, **options)
    # `serve_models` takes no address and would listen at all of them.
    bridge: Any = umbridge
    web = bridge.um.web
    here = SimpleNamespace(**{**vars(web), "run_app": partial(web.run_app, host=host)})
    with patch.object(bridge.um, "web", here):
        bridge.serve_models([model], port, max_workers=workers)
