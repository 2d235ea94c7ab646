"""Places that a case names by `[[port]]`, where a host reads and acts."""

from ctypes import c_int32, c_size_t, c_uint32

from . import _abi
from ._abi import Input, Interpolation, PortKind
from ._core import Core
from ._errors import invalid
from ._mapping import Named
from ._options import number, numbers
from ._values import PortState


class Port:
    """A port of a model; it keeps the library's model alive, until that is closed."""

    name: str
    """Name in the case."""
    index: int
    """Number among the ports of the model."""
    kind: PortKind
    """What it is of, and so which inputs it takes."""
    block: int
    """Id of its block, or of that of the first edge of a boundary or joint."""

    def __init__(self, core: Core, index: int) -> None:
        self._core, self.index = core, index
        self.name = core.text("enmm_port_name", index)
        self.kind = PortKind(core.get("enmm_port_kind", c_int32, index))
        self.block = core.get("enmm_port_block", c_uint32, index)

    def __repr__(self) -> str:
        return f"<enmm.Port {self.name!r}: {self.kind.name.lower()}, block {self.block}>"

    def belongs_to(self, core: Core) -> bool:
        """Whether it is a port of this model."""
        return self._core is core

    def state(self) -> PortState:
        """Motion, stress and contact force now."""
        raw = self._core.read("enmm_get_port_state", _abi.PortState, self.index)
        return PortState(*(getattr(raw, name) for name in PortState._fields))

    def set_force(self, fx: float, fy: float, moment: float = 0.0) -> None:
        """Sets force and moment on the block of a block port, as `Model.set_block_force`."""
        if self.kind is not PortKind.BLOCK:
            kind = self.kind.name.lower()
            raise invalid(f"port: {self.name!r} is of kind {kind}, must be of a block; use its own input")
        self._core.call("enmm_set_block_force", self.block, *numbers(fx=fx, fy=fy, moment=moment))

    def set_traction(self, tx: float, ty: float) -> None:
        """Sets traction (Pa) on a boundary port, as `Model.set_boundary_traction`."""
        self._core.call("enmm_set_boundary_traction", self.index, *numbers(tx=tx, ty=ty))

    def set_velocity(self, vx: float, vy: float) -> None:
        """Sets the velocity (m/s) of a moved support, or of the wave that comes in through a quiet boundary.

        As `Model.set_port_velocity`.
        """
        self._core.call("enmm_set_port_velocity", self.index, *numbers(vx=vx, vy=vy))

    def set_displacement(self, ux: float, uy: float) -> None:
        """Sets the displacement (m) of a moved support, as `Model.set_port_displacement`."""
        self._core.call("enmm_set_port_displacement", self.index, *numbers(ux=ux, uy=uy))

    def set_interpolation(self, mode: Interpolation) -> None:
        """Sets how the inputs of this port go through a communication step, from the next one on."""
        self._core.call("enmm_set_input_interpolation", int(Input.PORT), self.index, int(mode))

    def set_pressure(self, p: float) -> None:
        """Sets fluid pressure (Pa) on a boundary port or in the joints of a joint port.

        As `Model.set_boundary_pressure` and `Model.set_joint_pressure`.
        """
        of = "joint" if self.kind is PortKind.JOINT else "boundary"
        self._core.call(f"enmm_set_{of}_pressure", self.index, number("p", p))


class Ports(Named[Port]):
    """Ports of a model by name, in the order of the case. An unknown name is a NotFoundError, which is a KeyError."""

    _noun = "port"

    def __init__(self, core: Core) -> None:
        self._ports = [Port(core, index) for index in range(core.get("enmm_port_count", c_size_t))]
        super().__init__(core, [port.name for port in self._ports])

    def __getitem__(self, name: str) -> Port:
        return self._ports[self.index(name)]
