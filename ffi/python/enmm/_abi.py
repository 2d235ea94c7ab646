"""Structures and functions of `include/enmm.h`, field by field and in its order."""

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_int32, c_size_t, c_uint32, c_uint64, c_void_p
from typing import Any

import numpy as np

ABI_VERSION = 1
NO_JOINT = 0xFFFF_FFFF
UINT32_MAX = 0xFFFF_FFFF


def _doubles(*names: str) -> list[tuple[str, Any]]:
    return [(name, c_double) for name in names]


class StepInfo(ctypes.Structure):
    """`enmm_step_info`."""

    _fields_ = [
        ("struct_size", c_size_t),
        ("time", c_double),
        ("steps", c_uint64),
        ("dt", c_double),
        ("event_count", c_size_t),
        ("first_event", c_size_t),
        ("halved", c_uint64),
        ("unsettled", c_uint64),
    ]


class BlockState(ctypes.Structure):
    """`enmm_block_state`."""

    _fields_ = [
        ("struct_size", c_size_t),
        ("id", c_uint32),
        ("flags", c_uint32),
        *_doubles("centroid_x", "centroid_y", "displacement_x", "displacement_y", "rotation"),
        *_doubles("velocity_x", "velocity_y", "angular_velocity"),
        *_doubles("mean_stress_xx", "mean_stress_yy", "mean_stress_xy"),
        *_doubles("area", "mass", "kinetic_energy", "strain_energy"),
        ("contact_count", c_uint32),
        ("reserved", c_uint32),
        ("largest_penetration", c_double),
    ]


class Energies(ctypes.Structure):
    """`enmm_energies`."""

    _fields_ = [
        ("struct_size", c_size_t),
        *_doubles("kinetic", "strain", "potential", "stored", "friction", "contact_work", "support_work"),
        *_doubles("damping", "external_work", "baseline", "contact_dissipation", "residual"),
        *_doubles("yielding", "bolt_work", "radiation", "bolt_stored", "bolt_installed", "bolt_dissipation"),
    ]


class Totals(ctypes.Structure):
    """`enmm_totals`."""

    _fields_ = [
        ("struct_size", c_size_t),
        *_doubles("displacement_max", "velocity_max", "penetration_max", "unbalanced", "critical_dt"),
        ("open_contacts", c_uint32),
        ("slipping_contacts", c_uint32),
        ("locked_contacts", c_uint32),
        ("detached_blocks", c_uint32),
        ("slipped_joints", c_uint32),
        ("failed_blocks", c_uint32),
    ]


class Contact(ctypes.Structure):
    """`enmm_contact`."""

    _fields_ = [
        ("struct_size", c_size_t),
        ("state", c_int32),
        ("law", c_uint32),
        ("node_block", c_uint32),
        ("edge_block", c_uint32),
        *_doubles("position_x", "position_y", "normal_x", "normal_y", "length", "normal_stress", "shear_stress"),
    ]


class Event(ctypes.Structure):
    """`enmm_event`."""

    _fields_ = [("struct_size", c_size_t), ("kind", c_int32), ("subject", c_uint32), ("time", c_double)]


class PortState(ctypes.Structure):
    """`enmm_port_state`."""

    _fields_ = [
        ("struct_size", c_size_t),
        *_doubles("displacement_x", "displacement_y", "velocity_x", "velocity_y", "rotation", "angular_velocity"),
        *_doubles("contact_force_x", "contact_force_y", "stress_xx", "stress_yy", "stress_xy"),
        *_doubles("normal_force", "shear_force", "slip"),
    ]


STRUCTURES: dict[str, type[ctypes.Structure]] = {
    "enmm_step_info": StepInfo,
    "enmm_block_state": BlockState,
    "enmm_energies": Energies,
    "enmm_totals": Totals,
    "enmm_contact": Contact,
    "enmm_event": Event,
    "enmm_port_state": PortState,
}
"""Structures by their name in C."""

LOG_CALLBACK = ctypes.CFUNCTYPE(None, c_void_p, c_int32, c_char_p)
"""`enmm_log_callback`."""


def dtype_of(structure: type[ctypes.Structure]) -> np.dtype[np.void]:
    """The numpy type with the same fields at the same offsets."""
    names = [field[0] for field in structure._fields_]
    formats = [np.dtype(field[1]) for field in structure._fields_]
    offsets = [getattr(structure, name).offset for name in names]
    layout = {"names": names, "formats": formats, "offsets": offsets, "itemsize": ctypes.sizeof(structure)}
    return np.dtype(layout)  # type: ignore[call-overload, no-any-return, unused-ignore]


_DOUBLE, _SIZE, _U32, _I32 = POINTER(c_double), POINTER(c_size_t), POINTER(c_uint32), POINTER(c_int32)
_MODEL = _STATE = c_void_p
_OUT_HANDLE = POINTER(c_void_p)

FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "enmm_version": (c_char_p, []),
    "enmm_abi_version": (c_uint32, []),
    "enmm_last_error": (c_char_p, []),
    "enmm_create_from_file": (c_int32, [c_char_p, _OUT_HANDLE]),
    "enmm_create_from_string": (c_int32, [c_char_p, c_char_p, _OUT_HANDLE]),
    "enmm_check_case": (c_int32, [c_char_p, c_char_p]),
    "enmm_destroy": (None, [_MODEL]),
    "enmm_start": (c_int32, [_MODEL]),
    "enmm_do_step": (c_int32, [_MODEL, c_double, c_double, POINTER(StepInfo)]),
    "enmm_get_time": (c_int32, [_MODEL, _DOUBLE]),
    "enmm_get_internal_step": (c_int32, [_MODEL, _DOUBLE]),
    "enmm_get_communication_step": (c_int32, [_MODEL, _DOUBLE]),
    "enmm_get_stop_time": (c_int32, [_MODEL, _DOUBLE]),
    "enmm_set_threads": (c_int32, [_MODEL, c_size_t]),
    "enmm_set_log_callback": (c_int32, [_MODEL, LOG_CALLBACK, c_void_p]),
    "enmm_case_hash": (c_int32, [_MODEL, c_char_p, c_size_t, _SIZE]),
    "enmm_set_gravity": (c_int32, [_MODEL, c_double, c_double]),
    "enmm_set_block_force": (c_int32, [_MODEL, c_uint32, c_double, c_double, c_double]),
    "enmm_set_block_forces": (c_int32, [_MODEL, _U32, c_size_t, _DOUBLE, _DOUBLE, _DOUBLE]),
    "enmm_set_base_acceleration": (c_int32, [_MODEL, c_double, c_double]),
    "enmm_set_water_level": (c_int32, [_MODEL, c_double]),
    "enmm_set_boundary_traction": (c_int32, [_MODEL, c_uint32, c_double, c_double]),
    "enmm_set_boundary_pressure": (c_int32, [_MODEL, c_uint32, c_double]),
    "enmm_set_joint_pressure": (c_int32, [_MODEL, c_uint32, c_double]),
    "enmm_set_strength_factor": (c_int32, [_MODEL, c_double]),
    "enmm_set_interpolation": (c_int32, [_MODEL, c_int32]),
    "enmm_get_interpolation": (c_int32, [_MODEL, _I32]),
    "enmm_block_count": (c_int32, [_MODEL, _SIZE]),
    "enmm_get_block_states": (c_int32, [_MODEL, POINTER(BlockState), c_size_t, _SIZE]),
    "enmm_get_energies": (c_int32, [_MODEL, POINTER(Energies)]),
    "enmm_get_totals": (c_int32, [_MODEL, POINTER(Totals)]),
    "enmm_get_contacts": (c_int32, [_MODEL, POINTER(Contact), c_size_t, _SIZE]),
    "enmm_get_events": (c_int32, [_MODEL, c_size_t, POINTER(Event), c_size_t, _SIZE]),
    "enmm_get_block_polygon": (c_int32, [_MODEL, c_uint32, _DOUBLE, c_size_t, _SIZE]),
    "enmm_block_hole_count": (c_int32, [_MODEL, c_uint32, _SIZE]),
    "enmm_get_block_hole": (c_int32, [_MODEL, c_uint32, c_uint32, _DOUBLE, c_size_t, _SIZE]),
    "enmm_find_block_at": (c_int32, [_MODEL, c_double, c_double, _U32]),
    "enmm_port_count": (c_int32, [_MODEL, _SIZE]),
    "enmm_find_port": (c_int32, [_MODEL, c_char_p, _U32]),
    "enmm_port_name": (c_int32, [_MODEL, c_uint32, c_char_p, c_size_t, _SIZE]),
    "enmm_port_kind": (c_int32, [_MODEL, c_uint32, _I32]),
    "enmm_port_block": (c_int32, [_MODEL, c_uint32, _U32]),
    "enmm_get_port_state": (c_int32, [_MODEL, c_uint32, POINTER(PortState)]),
    "enmm_state_save": (c_int32, [_MODEL, _OUT_HANDLE]),
    "enmm_state_restore": (c_int32, [_MODEL, _STATE]),
    "enmm_state_free": (c_int32, [_STATE]),
    "enmm_state_serialize": (c_int32, [_MODEL, _STATE, c_char_p, c_size_t, _SIZE]),
    "enmm_state_deserialize": (c_int32, [_MODEL, c_char_p, c_size_t, _OUT_HANDLE]),
}
"""Result and arguments of every function."""
