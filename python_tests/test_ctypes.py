"""The Python package: library, motion, inputs, observation, errors. `test_ctypes_life` has states and threads."""

import ctypes
import math
import os
import pickle
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]


# The library.


def test_library_of_this_version_is_loaded_once(package, library):
    assert package.load_library() is package.load_library(library) is package.load_library(str(library.parent))
    text = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    assert package.load_library().version == re.search(r'^version = "(.+)"', text, re.MULTILINE)[1]


def test_package_has_the_version_of_the_library(package):
    text = (ROOT / "ffi" / "python" / "pyproject.toml").read_text(encoding="utf-8")
    assert re.search(r'^version = "(.+)"', text, re.MULTILINE)[1] == package.load_library().version


def test_missing_library_tells_places_and_remedy(package, tmp_path, monkeypatch):
    with pytest.raises(package.LibraryError, match="cargo build --release -p enmm-capi"):
        package.load_library(tmp_path / "absent.so")
    monkeypatch.setenv("ENMM_LIBRARY", str(tmp_path / "absent.so"))
    with pytest.raises(package.LibraryError, match="ENMM_LIBRARY names .*absent.so"):
        package.load_library()
    # A copy of the package that lies nowhere near a library.
    shutil.copytree(Path(package.__file__).parent, tmp_path / "enmm")
    script = "import enmm\ntry: enmm.load_library()\nexcept enmm.LibraryError as error: print(error)"
    answer = run_python(script, path=tmp_path, library=None)
    assert str(tmp_path / "enmm" / "libenmm.so") in answer or sys.platform != "linux"
    assert "of the system" in answer and "ENMM_LIBRARY" in answer


def test_library_beside_the_package_is_found(package, library, tmp_path):
    shutil.copytree(Path(package.__file__).parent, tmp_path / "enmm")
    shutil.copy(library, tmp_path / "enmm" / library.name)
    answer = run_python("import enmm; print(enmm.load_library().path)", path=tmp_path, library=None)
    assert answer.strip() == str(tmp_path / "enmm" / library.name)


def test_other_libraries_are_refused(package, tmp_path):
    broken = tmp_path / "libenmm.so"
    broken.write_bytes(b"no library")
    with pytest.raises(package.LibraryError, match="cannot be loaded"):
        package.load_library(broken)
    compiler = shutil.which("cc")
    assert compiler, "a C compiler is needed: apt-get install gcc"
    for version, problem in ((2, "has ABI version 2, this package needs 1"), (1, "has no function enmm_version")):
        other = tmp_path / f"other{version}.so"
        source = f"unsigned enmm_abi_version(void) {{ return {version}; }}"
        arguments = [compiler, "-shared", "-fPIC", "-x", "c", "-", "-o", str(other)]
        subprocess.run(arguments, input=source, text=True, check=True)
        with pytest.raises(package.LibraryError, match=problem):
            package.load_library(other)


def run_python(script: str, path: Path, library: Path | None) -> str:
    """Output of a new Python in an empty directory that has the package at `path`."""
    words = {"PYTHONPATH": str(path), "PYTHONDONTWRITEBYTECODE": "1"}
    kept = {name: value for name, value in os.environ.items() if name not in ("ENMM_LIBRARY", "CARGO_TARGET_DIR")}
    given = {} if library is None else {"ENMM_LIBRARY": str(library)}
    arguments = [sys.executable, "-c", script]
    return subprocess.run(
        arguments, env=kept | words | given, text=True, check=True, capture_output=True, timeout=120
    ).stdout


# Structures and functions are those of the header.


def header() -> str:
    return (ROOT / "include" / "enmm.h").read_text(encoding="utf-8")


def test_structures_have_the_offsets_of_c(package, tmp_path):
    compiler = shutil.which("cc")
    assert compiler, "a C compiler is needed: apt-get install gcc"
    lines, expected = [], []
    for name, structure in package._abi.STRUCTURES.items():
        lines.append(f'printf("%zu\\n", sizeof({name}));')
        expected.append(ctypes.sizeof(structure))
        for field, _ in structure._fields_:
            member = f"(({name} *)0)->{field}"
            lines.append(f'printf("%zu %zu\\n", offsetof({name}, {field}), sizeof({member}));')
            place = getattr(structure, field)
            expected.append((place.offset, place.size))
    source, program = tmp_path / "offsets.c", tmp_path / "offsets"
    text = f'#include <stdio.h>\n#include "enmm.h"\nint main(void) {{ {" ".join(lines)} }}'
    source.write_text(text, encoding="utf-8")
    subprocess.run([compiler, "-I", str(ROOT / "include"), str(source), "-o", str(program)], check=True)
    output = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    rows = [tuple(map(int, line.split())) for line in output.splitlines()]
    assert [row[0] if len(row) == 1 else row for row in rows] == expected


def test_numpy_types_have_the_layout_of_the_structures(package):
    pairs = ((package.BLOCK_DTYPE, "enmm_block_state"), (package.CONTACT_DTYPE, "enmm_contact"))
    for dtype, name in pairs:
        structure = package._abi.STRUCTURES[name]
        assert dtype.itemsize == ctypes.sizeof(structure)
        for field, kind in structure._fields_:
            inner, offset = dtype.fields[field][:2]
            assert (inner, offset) == (np.dtype(kind), getattr(structure, field).offset)


def test_values_of_models_have_the_fields_of_the_structures_in_their_order(package):
    generated = (package.Energies, package.Totals, package.StepInfo, package.PortState, package.MonitorState)
    for values in (*generated, package.Event):
        structure = getattr(package._abi, values.__name__)
        fields = tuple(field for field, _ in structure._fields_[1:] if field != "reserved")
        # Python tells the name of the subject as well.
        assert values._fields == fields + (("name",) if values is package.Event else ()), values.__name__


def test_every_structure_function_and_constant_of_the_header_is_there(package):
    text = re.sub(r"/\*.*?\*/", "", header(), flags=re.DOTALL)
    # The first of two names of a member.
    text = re.sub(r"ENMM_UNION \{ (\w+ \w+;) .*? \};", r"\1", text)
    bodies = dict(re.findall(r"typedef struct (\w+) \{(.*?)\}", text, flags=re.DOTALL))
    fields = {name: re.findall(r"(\w+);", body) for name, body in bodies.items()}
    assert fields == {name: [field for field, _ in of._fields_] for name, of in package._abi.STRUCTURES.items()}
    functions = re.findall(r"(enmm_\w+)\(([^()]*)\);", text)
    counts = {name: 0 if given == "void" else given.count(",") + 1 for name, given in functions}
    assert counts == {name: len(given) for name, (_, given) in package._abi.FUNCTIONS.items()}
    enums = {
        "ENMM_BLOCK_": package.BlockFlag,
        "ENMM_CONTACT_": package.ContactState,
        "ENMM_EVENT_": package.EventKind,
        "ENMM_INTERPOLATION_": package.Interpolation,
        "ENMM_LOG_": package.LogLevel,
        "ENMM_NAME_": package.NameKind,
        "ENMM_PORT_": package.PortKind,
    }
    values = re.findall(r"(ENMM_[A-Z_]+)(?: =)? (\d+)", text)
    status = re.search(r"enum enmm_status.*?\{(.*?)\};", text, flags=re.DOTALL)[1]
    assert re.findall(r"ENMM_(\w+) = (\d+)", status) == [(item.name, str(int(item))) for item in package.Status]
    for start, enum in enums.items():
        found = {name.removeprefix(start): int(value) for name, value in values if name.startswith(start)}
        assert found == {item.name: int(item) for item in enum}
    assert ("ENMM_ABI_VERSION", str(package.ABI_VERSION)) in values


# Motion.


def test_block_slides_as_the_closed_form(incline):
    incline.start()
    before = incline.ports["block"].state()
    info = incline.do_step(0.0, 1.0)
    after = incline.ports["block"].state()
    moved = np.array([after.displacement_x - before.displacement_x, after.displacement_y - before.displacement_y])
    slope_angle = math.radians(30)
    along = moved @ [math.cos(slope_angle), -math.sin(slope_angle)]
    assert along == pytest.approx(0.906407, rel=1e-4)
    assert abs(moved @ [math.sin(slope_angle), math.cos(slope_angle)]) < 1e-4
    assert (info.time, incline.time) == (1.0, 1.0)
    assert info.steps == round(1.0 / incline.internal_step) and info.dt == pytest.approx(incline.internal_step)
    assert (info.halved, info.unsettled) == (0, 0)
    assert after.velocity_x > 0 > after.velocity_y


def test_times_are_those_of_the_case(incline):
    assert (incline.time, incline.communication_step, incline.stop_time) == (0.0, 0.01, 1.0)
    parts = incline.communication_step / 10 / incline.internal_step
    assert parts == pytest.approx(round(parts), abs=1e-9) and parts >= 1


@pytest.mark.parametrize("parts", [1, 2, 10])
@pytest.mark.parametrize("name", ["block_on_incline", "coupled_slope"])
def test_splitting_a_step_keeps_every_bit(package, cases, name, parts):
    def run(count):
        with package.Model.from_file(cases / f"{name}.toml") as model:
            step = model.communication_step
            for k in range(20 * count):
                model.do_step(model.time, step / count if (k + 1) % count else (k + 1) // count * step - model.time)
            return model.blocks(copy=True).tobytes(), model.contacts(copy=True).tobytes(), model.energies()

    assert run(1) == run(parts)


def test_case_text_is_the_case_file(package, cases, incline):
    toml = (cases / "block_on_incline.toml").read_text(encoding="utf-8")
    with package.Model.from_string(toml, cases) as model:
        assert model.case_hash == incline.case_hash and re.fullmatch("[0-9a-f]{16}", model.case_hash)
        for each in (model, incline):
            each.do_step(0.0, 0.1)
        assert np.array_equal(model.blocks(), incline.blocks())


def test_threads_keep_every_bit(package, cases, slope):
    with package.Model.from_file(cases / "coupled_slope.toml") as other:
        other.threads = 2
        assert (other.threads, slope.threads) == (2, 1)
        for model in (other, slope):
            model.do_step(0.0, 0.05)
        assert other.blocks().tobytes() == slope.blocks().tobytes()
        for count in (0, 1025, -1, 2**64 + 1):
            with pytest.raises(package.InvalidArgumentError):
                other.threads = count
        assert other.threads == 2


# Inputs.


def test_wedge_slides_when_its_toe_force_is_halved(slope):
    slope.start()
    with slope.save() as held:
        moved = {}
        for factor in (1.0, 0.5):
            slope.restore(held)
            toe = slope.ports["toe"]
            before = toe.state()
            toe.set_force(factor * 0.9e6, factor * 0.56e6)
            slope.do_step(0.0, 0.5)
            after = toe.state()
            moved[factor] = (after.displacement_x - before.displacement_x, after.displacement_y - before.displacement_y)
    assert math.hypot(*moved[1.0]) < 1e-5
    assert moved[0.5][0] < -1e-3 and moved[0.5][1] < -5e-4, "down the plane, to the left"


INPUTS = {
    "gravity": lambda model: model.set_gravity(1.0, -9.81),
    "block force": lambda model: model.set_block_force(model.ports["toe"].block, 0.0, 0.0, 1e5),
    "block forces": lambda model: model.set_block_forces([model.ports["toe"].block], [1e5], [2e5]),
    "base acceleration": lambda model: model.set_base_acceleration(1.0, 0.0),
    "water level": lambda model: model.set_water_level(14.0),
    "traction": lambda model: model.set_boundary_traction("face", 2e4, 0.0),
    "pressure": lambda model: model.set_boundary_pressure("face", 5e4),
    "joint pressure": lambda model: model.set_joint_pressure(model.ports["plane"], 5e4),
    "strength": lambda model: model.set_strength_factor(0.5),
}


def after_input(slope, name, mode=0) -> bytes:
    slope.interpolation = mode
    if name:
        INPUTS[name](slope)
    slope.do_step(slope.time, 0.05)
    return slope.blocks()["displacement_x"].tobytes()


@pytest.mark.parametrize("name", INPUTS)
def test_input_changes_the_motion_and_how_depends_on_interpolation(package, slope, name):
    slope.start()
    with slope.save() as start:
        ways = {}
        for given, mode in ((None, 0), (name, 0), (name, 1)):
            slope.restore(start)
            assert slope.interpolation is package.Interpolation.HOLD
            ways[given, mode] = after_input(slope, given, mode)
        assert len(set(ways.values())) == 3
        slope.restore(start)
        assert after_input(slope, name) == ways[name, 0]


def test_ports_set_what_the_model_sets(slope):
    slope.start()
    ways = [
        (lambda: slope.set_block_force(slope.ports["toe"].block, 1e5, 2e5, 3e4), ("toe", "set_force", 1e5, 2e5, 3e4)),
        (lambda: slope.set_boundary_traction(slope.ports["face"].index, 1e4, 0), ("face", "set_traction", 1e4, 0)),
        (lambda: slope.set_boundary_pressure("face", 1e4), ("face", "set_pressure", 1e4)),
        (lambda: slope.set_joint_pressure("plane", 1e4), ("plane", "set_pressure", 1e4)),
    ]
    with slope.save() as start:
        for by_model, (port, method, *values) in ways:
            results = []
            for act in (by_model, lambda: getattr(slope.ports[port], method)(*values)):
                slope.restore(start)
                act()
                slope.do_step(0.0, 0.02)
                results.append(slope.blocks().tobytes())
            assert results[0] == results[1]


def test_block_forces_are_all_or_none(package, slope):
    slope.start()
    with slope.save() as start:
        slope.do_step(0.0, 0.02)
        expected = slope.blocks().tobytes()
        slope.restore(start)
        for arguments in (([1, 2], [1e6, math.nan], 0.0), ([1, 999], 1e6, 0.0), ([1, -1], 1e6, 0.0)):
            with pytest.raises(package.InvalidArgumentError):
                slope.set_block_forces(*arguments)
        for arguments in (([1, 2**32], 1e6, 0.0), ([1.0, 2.0], 1e6, 0.0), ([[1]], 1e6, 0.0), ([1, 2], [1e6], 0.0)):
            with pytest.raises(package.InvalidArgumentError):
                slope.set_block_forces(*arguments)
        slope.set_block_forces([], [], [])
        slope.do_step(0.0, 0.02)
        assert slope.blocks().tobytes() == expected


def test_block_forces_take_arrays_of_any_layout(slope):
    slope.start()
    wide = np.array([[1e4, 0], [2e4, 0], [3e4, 0]], dtype=np.float32)
    with slope.save() as start:
        slope.set_block_forces(np.array([1, 2, 4], dtype=np.int64), wide[:, 0], 5e3, np.float32(7))
        slope.do_step(0.0, 0.02)
        expected = slope.blocks().tobytes()
        slope.restore(start)
        for block, force in ((1, 1e4), (2, 2e4), (4, 3e4)):
            slope.set_block_force(np.int64(block), np.float32(force), 5e3, 7)
        slope.do_step(0.0, 0.02)
        assert slope.blocks().tobytes() == expected


# Observation.


def test_blocks_are_a_view_that_is_filled_anew(incline):
    first = incline.blocks()
    kept = incline.blocks(copy=True)
    assert first.shape == (incline.block_count,) == (2,)
    assert isinstance(first.base, np.ndarray) and not first.flags.owndata and not first.flags.writeable
    incline.do_step(0.0, 0.1)
    second = incline.blocks()
    assert np.shares_memory(first, second) and not np.shares_memory(first, kept)
    assert first["displacement_x"][1] == second["displacement_x"][1] > kept["displacement_x"][1] == 0.0
    # The buffer outlives the model as long as a view is there.
    incline.close()
    assert first["mass"].tolist() == pytest.approx([14840.0, 2650.0])


def test_blocks_tell_geometry_flags_and_motion(package, incline):
    incline.do_step(0.0, 1.0)
    fixed, block = incline.blocks()
    assert package.BlockFlag(int(fixed["flags"])) == package.BlockFlag.FIXED
    assert package.BlockFlag(int(block["flags"])) == package.BlockFlag.FAILED
    port = incline.ports["block"].state()
    for name in ("displacement_x", "displacement_y", "velocity_x", "velocity_y", "rotation", "angular_velocity"):
        assert block[name] == getattr(port, name)
    assert block["mass"] == pytest.approx(2650.0 * block["area"])
    speed = math.hypot(block["velocity_x"], block["velocity_y"])
    assert block["kinetic_energy"] == pytest.approx(0.5 * block["mass"] * speed**2, rel=1e-4)
    assert block["id"] == 1 and block["contacts"] > 0 and 0 < block["penetration_max"] < 1e-4
    older = (block["contact_count"], block["largest_penetration"])
    assert older == (block["contacts"], block["penetration_max"])


def test_contacts_carry_the_weight(package, incline):
    incline.start()
    contacts = incline.contacts()
    assert np.shares_memory(contacts, incline.contacts())
    assert set(contacts["state"]) <= set(package.ContactState)
    # Forces on the sliding block 1, from the side of the node or of the edge.
    normal = np.stack([contacts["normal_x"], contacts["normal_y"]], axis=1)
    tangent = np.stack([-contacts["normal_y"], contacts["normal_x"]], axis=1)
    stress = -contacts["normal_stress"][:, None] * normal + contacts["shear_stress"][:, None] * tangent
    side = np.where(contacts["node_block"] == 1, 1.0, -1.0)
    force = (side * contacts["length"]) @ stress
    port = incline.ports["block"].state()
    assert force == pytest.approx([port.contact_force_x, port.contact_force_y], abs=1.0)
    assert force == pytest.approx([0.0, 2650.0 * 9.81], abs=30.0)


def test_events_tell_slip_and_failure(package, incline):
    incline.start()
    assert incline.events() == []
    info = incline.do_step(0.0, 1.0)
    events = incline.events()
    assert info.event_count == len(events) and info.first_event == 0
    assert events == incline.events(info.first_event) and incline.events(len(events)) == []
    assert events[1:] == incline.events(1)
    assert events[0].kind is package.EventKind.SLIPPED and events[0].subject == 0
    assert [events[0].name, events[-1].name] == ["joint[0]", "block 1"]
    failure = events[-1]
    assert (failure.kind, failure.subject) == (package.EventKind.FAILED, 1) and 0 < failure.time < 1.0
    assert [event.time for event in events] == sorted(event.time for event in events)


def test_names_are_those_of_the_case_or_stand_ins(package, cases):
    text = (cases / "block_on_incline.toml").read_text(encoding="utf-8")
    case = tomllib.loads(text)
    with package.Model.from_string(text) as model:
        kinds = {kind: model.names(kind) for kind in package.NameKind}
        assert kinds[package.NameKind.BLOCK] == ("block 0", "block 1")
        assert kinds[package.NameKind.JOINT] == ("joint[0]",)
        assert kinds[package.NameKind.LAW] == tuple(sorted(case["joint_law"]))
        assert kinds[package.NameKind.ROCK] == tuple(sorted(case["rock"]))
        assert kinds[package.NameKind.STAGE] == tuple(stage["name"] for stage in case["stage"])
        assert kinds[package.NameKind.PORT] == tuple(model.ports)
        assert kinds[package.NameKind.MONITOR] == ("block",)
        model.do_step(0.0, 0.5)
        moved = model.monitor("block")
        assert moved == model.monitor(0)
        # It stands in the middle of the block, which slides without turning.
        assert moved.displacement_x == pytest.approx(model.blocks()["displacement_x"][1], rel=1e-6)
        with pytest.raises(package.NotFoundError, match="no monitor is named 'absent'"):
            model.monitor("absent")


def test_an_overlap_tells_both_blocks_and_the_depth(package):
    messages = []
    with package.Model.from_file(ROOT / "ffi" / "capi" / "tests" / "cases" / "soft.toml") as model:
        model.set_log(lambda level, text: messages.append((level, text)))
        model.do_step(0.0, 0.1)
        events, totals = model.events(), model.totals()
    [overlap] = [event for event in events if event.kind is package.EventKind.OVERLAPPED]
    assert (overlap.subject, overlap.other) == (0, 1) and 0.005 < overlap.depth < totals.overlap_max < 0.04
    assert all((event.other, event.depth) == (None, 0.0) for event in events if event is not overlap)
    assert totals.overlapping_pairs == 1
    [text] = [text for level, text in messages if level is package.LogLevel.WARNING]
    assert "blocks 0 and 1 overlap by" in text and "% of the mesh size" in text


def test_energies_balance(incline):
    incline.do_step(0.0, 1.0)
    e = incline.energies()
    left = e.kinetic + e.strain + e.potential + e.damping
    right = e.contact_work + e.support_work + e.external_work + e.baseline + e.residual
    assert left == pytest.approx(right, abs=1e-6) and abs(e.residual) < 1.0 and e.friction > 7000
    totals = incline.totals()
    assert totals.failed_blocks == 1 and totals.critical_dt > incline.internal_step
    assert totals.displacement_max == pytest.approx(0.9064, rel=1e-3) and totals.slipping_contacts > 0


def test_polygons_find_blocks_and_holes(package, incline):
    outline = incline.polygon(1)
    assert outline.shape[1] == 2 and outline.dtype == np.float64
    x, y = outline.T
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    assert area == pytest.approx(incline.blocks()["area"][1], rel=1e-9) == 1.0
    assert incline.holes(1) == []
    assert incline.find_block_at(0.683, 0.183) == 1 and incline.find_block_at(-0.6, -0.1) == 0
    with pytest.raises(package.NotFoundError):
        incline.find_block_at(100.0, 100.0)
    with pytest.raises(package.InvalidArgumentError):
        incline.polygon(2)


def test_ports_are_a_mapping_by_name(package, slope):
    ports = slope.ports
    assert list(ports) == ["toe", "face", "plane"] and len(ports) == 3
    kinds = [port.kind for port in ports.values()]
    assert kinds == [package.PortKind.BLOCK, package.PortKind.BOUNDARY, package.PortKind.JOINT]
    toe = ports["toe"]
    assert (toe.name, toe.index) == ("toe", 0) and 0 <= toe.block < slope.block_count
    assert "toe" in ports and "heel" not in ports and ports.get("heel") is None
    with pytest.raises(package.NotFoundError, match="heel") as caught:
        ports["heel"]
    assert isinstance(caught.value, KeyError) and caught.value.status is package.Status.NOT_FOUND
    slope.start()
    states = {name: port.state() for name, port in ports.items()}
    assert abs(states["toe"].contact_force_y) > 1e4 and states["toe"].slip == 0
    assert states["face"].stress_xx != 0 == states["face"].contact_force_y
    assert states["plane"].normal_force > 1e5 and states["plane"].displacement_x == 0


# Errors.


def test_bad_cases_tell_file_line_and_key(package, tmp_path, cases):
    toml = (cases / "block_on_incline.toml").read_text(encoding="utf-8").replace("size = 0.6", "size = -0.6")
    line = toml.splitlines().index("size = -0.6") + 1
    with pytest.raises(package.CaseError, match=f"case:{line}.*size") as caught:
        package.Model.from_string(toml)
    assert caught.value.status is package.Status.INVALID_CASE
    file = tmp_path / "bad.toml"
    file.write_text(toml, encoding="utf-8")
    with pytest.raises(package.CaseError, match=rf"bad\.toml:{line}"):
        package.Model.from_file(file)
    with pytest.raises(package.CaseFileError, match=r"absent\.toml"):
        package.Model.from_file(tmp_path / "absent.toml")
    for text in ("", "not a case", 'title = "\udcff"', toml + "\0"):
        with pytest.raises(package.EnmmError):
            package.Model.from_string(text)


def test_values_that_are_not_finite_are_refused(package, slope):
    toe = slope.ports["toe"]
    setters = {
        slope.set_gravity: 2,
        slope.set_base_acceleration: 2,
        slope.set_water_level: 1,
        slope.set_strength_factor: 1,
        toe.set_force: 3,
        slope.ports["face"].set_traction: 2,
        slope.ports["face"].set_pressure: 1,
        slope.ports["plane"].set_pressure: 1,
        slope.find_block_at: 2,
    }
    for setter, count in setters.items():
        for value in (math.nan, math.inf, -math.inf):
            for k in range(count):
                values = [0.0] * count
                values[k] = value
                with pytest.raises(package.InvalidArgumentError) as caught:
                    setter(*values)
                assert isinstance(caught.value, ValueError) and str(caught.value)
    with pytest.raises((TypeError, ValueError)):
        slope.set_gravity("down", 0)


def test_wrong_times_are_refused_and_change_nothing(package, incline):
    incline.do_step(0.0, 0.1)
    before = incline.blocks(copy=True)
    for t in (0.0, 0.2, math.nan):
        with pytest.raises((package.TimeError, package.InvalidArgumentError)):
            incline.do_step(t, 0.1)
    with pytest.raises(package.TimeError) as caught:
        incline.do_step(0.0, 0.1)
    assert caught.value.status is package.Status.WRONG_TIME
    for h in (0.0, -0.1, math.nan, math.inf):
        with pytest.raises(package.InvalidArgumentError):
            incline.do_step(0.1, h)
    assert incline.time == pytest.approx(0.1, rel=1e-14) and incline.blocks().tobytes() == before.tobytes()


def test_wrong_blocks_and_ports_are_refused(package, slope, cases):
    for block in (-1, 999, 2**32, 2**64 + 1):
        with pytest.raises(package.InvalidArgumentError):
            slope.set_block_force(block, 0.0, 0.0)
    for port in ("toe", "plane", 3, -1, 2**32 + 1):
        with pytest.raises(package.InvalidArgumentError):
            slope.set_boundary_traction(port, 0.0, 0.0)
    for act in (slope.ports["face"].set_force, slope.ports["plane"].set_traction):
        with pytest.raises(package.InvalidArgumentError):
            act(0.0, 0.0)
    for port in ("toe", "face"):
        with pytest.raises(package.InvalidArgumentError):
            slope.set_joint_pressure(port, 0.0)
    with pytest.raises(package.NotFoundError):
        slope.set_joint_pressure("absent", 0.0)
    with package.Model.from_file(cases / "coupled_slope.toml") as other:
        with pytest.raises(package.InvalidArgumentError, match="another model"):
            slope.set_boundary_pressure(other.ports["face"], 0.0)
    with pytest.raises(package.InvalidArgumentError):
        slope.interpolation = 2
    with pytest.raises(TypeError):
        slope.set_block_force(1.5, 0.0, 0.0)


def test_water_needs_a_case_with_water(package, incline):
    with pytest.raises(package.InvalidArgumentError, match="water"):
        incline.set_water_level(1.0)


def test_closed_models_and_states_are_dead(package, incline):
    port, state = incline.ports["block"], incline.save()
    with pytest.raises(package.DeadHandleError):
        state.close()
        state.close()
        incline.restore(state)
    incline.close()
    incline.close()
    for act in (incline.start, incline.blocks, incline.save, port.state, incline.energies, lambda: incline.time):
        with pytest.raises(package.DeadHandleError) as caught:
            act()
        assert caught.value.status is package.Status.DEAD_HANDLE and "dead" in str(caught.value)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (type(copy), str(copy), copy.status) == (type(caught.value), str(caught.value), caught.value.status)


def test_every_status_has_its_class(package):
    classes = {type(package._errors.error_of(int(status), "")) for status in package.Status if status}
    assert len(classes) == len(package.Status) - 1 and all(issubclass(of, package.EnmmError) for of in classes)
    assert type(package._errors.error_of(99, "")) is package.EnmmError
