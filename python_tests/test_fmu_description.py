"""What the FMUs say of themselves: valid, consistent, and true to what their libraries do."""

import ctypes
import re
import subprocess
import xml.etree.ElementTree
import zipfile
from pathlib import Path

import pytest
from fmpy.validation import validate_fmu
from fmu_support import ERROR, OK, TYPES, Instance, functions_of, size

EXPECTED_SYMBOLS = {2: 44, 3: 75}


def tree(fmu):
    return xml.etree.ElementTree.parse(fmu.folder / "modelDescription.xml").getroot()


def test_fmpy_finds_no_problem(fmu):
    assert validate_fmu(str(fmu.path)) == []


def test_archive_is_portable_and_complete(fmu):
    with zipfile.ZipFile(fmu.path) as archive:
        infos = archive.infolist()
        assert archive.testzip() is None
    names = [info.filename for info in infos]
    assert len(names) == len(set(names))
    for info in infos:
        assert info.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
        assert info.extract_version <= 20 and not info.flag_bits & 1
        assert not info.filename.startswith("/") and ".." not in info.filename and "\\" not in info.filename
        assert (info.external_attr >> 16) & 0o170000 in (0, 0o100000, 0o040000), "no links"
    assert {"modelDescription.xml", "documentation/index.html", "resources/case.json"} <= set(names)
    assert any(name.startswith("documentation/licenses/") for name in names)
    assert ("model.png" if fmu.version == 2 else "terminalsAndIcons/icon.png") in names
    identifier = fmu.description.coSimulation.modelIdentifier
    assert re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", identifier)
    assert fmu.library.stem == identifier


def test_page_needs_nothing_outside(fmu):
    text = (fmu.folder / "documentation" / "index.html").read_text(encoding="utf-8")
    for target in re.findall(r"""(?:src|href)=["']([^"'#]+)""", text):
        assert target.startswith("data:") or (fmu.folder / "documentation" / target).exists(), target
    for v in fmu.description.modelVariables:
        assert v.name in text


def test_pictures_are_png(fmu):
    picture = fmu.folder / ("model.png" if fmu.version == 2 else "terminalsAndIcons/icon.png")
    assert picture.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")


def test_capabilities(fmu):
    root = tree(fmu)
    assert root.find("ModelExchange") is None and root.find("ScheduledExecution") is None
    co = root.find("CoSimulation").attrib
    state = "FMUstate" if fmu.version == 2 else "FMUState"
    for name in (f"canGetAndSet{state}", f"canSerialize{state}", "canHandleVariableCommunicationStepSize"):
        assert co[name] == "true"
    for name in ("needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess"):
        assert co[name] == "false"
    if fmu.version == 3:
        for name in (
            "providesIntermediateUpdate",
            "mightReturnEarlyFromDoStep",
            "canReturnEarlyAfterIntermediateUpdate",
        ):
            assert co[name] == "true"
        assert co["hasEventMode"] == "true"
    else:
        assert co["canInterpolateInputs"] == "true"


def test_head_says_whose_the_model_is_and_how_names_are_made(fmu):
    head = tree(fmu).attrib
    for name in ("author", "version", "copyright", "license", "generationTool"):
        assert len(head[name]) > 3, name
    assert "MIT" in head["license"] and "Apache-2.0" in head["license"]
    assert head["generationDateAndTime"] == "1980-01-01T00:00:00Z", "no clock: the same case gives the same bytes"
    assert head["variableNamingConvention"] == "structured"


def test_default_experiment(fmu):
    experiment = tree(fmu).find("DefaultExperiment").attrib
    end = {"block_on_incline": 1.0, "coupled_slope": 2.0}[fmu.case]
    assert (float(experiment["startTime"]), float(experiment["stopTime"])) == (0.0, end)
    assert float(experiment["stepSize"]) == 0.01


def test_names_and_references_are_unique(fmu):
    variables = fmu.description.modelVariables
    assert len({v.name for v in variables}) == len(variables)
    kinds = {(v.type if fmu.version == 2 else "", v.valueReference) for v in variables}
    assert len(kinds) == len(variables)


def test_every_variable_is_described_with_a_unit_that_is_defined(fmu):
    units = {unit.name: unit for unit in fmu.description.unitDefinitions}
    bare = set()
    for v in fmu.description.modelVariables:
        assert v.description and len(v.description) > 3, v.name
        assert v.causality in {"independent", "parameter", "input", "output", "local"}
        if v.unit is None:
            bare.add(v.name)
        else:
            assert v.unit in units and units[v.unit].baseUnit is not None, v.name
        if v.type in ("Integer", "Int32", "Boolean", "String", "Binary"):
            assert v.unit is None
    for v in fmu.description.modelVariables:
        if re.search(r"force|stress|displacement|velocity|energy|pressure|traction|_deg|density|young", v.name):
            assert v.unit not in (None, ""), v.name


@pytest.mark.parametrize(
    ("unit", "exponents"),
    [
        ("m", (0, 1, 0)),
        ("m/s", (0, 1, -1)),
        ("N/m", (1, 0, -2)),
        ("Pa", (1, -1, -2)),
        ("J/m", (1, 1, -2)),
        ("s", (0, 0, 1)),
    ],
)
def test_units_have_their_dimensions(fmu, unit, exponents):
    (found,) = [u for u in fmu.description.unitDefinitions if u.name == unit]
    base = found.baseUnit
    assert (base.kg, base.m, base.s) == exponents and base.factor in (None, 1.0, "1")


def test_variability_initial_and_start_go_together(fmu):
    for v in fmu.description.modelVariables:
        discrete = v.type in ("Integer", "Int32", "Boolean", "String", "Binary")
        match v.causality:
            case "parameter":
                tunable = v.name.endswith((".friction", ".cohesion", ".tension", "damping", "water.density"))
                kind = "tunable" if tunable else "fixed"
                assert (v.initial, v.variability) == ("exact", kind) and v.start is not None
            case "input":
                assert v.start is not None
                assert v.variability == ("discrete" if discrete else "continuous")
            case "output" | "local":
                assert v.initial == "calculated" and v.start is None, v.name
                assert not (discrete and v.variability == "continuous")
            case "independent":
                assert v.start is None and v.initial is None and v.variability == "continuous" and v.unit == "s"
    assert len(fmu.named("independent")) == (1 if fmu.version == 3 else 0)


def test_structure_lists_all_outputs_in_order(fmu):
    root = tree(fmu)
    outputs = fmu.named("output")
    if fmu.version == 2:
        order = [v.name for v in fmu.description.modelVariables]
        listed = lambda name: [order[int(e.get("index")) - 1] for e in root.find(f"ModelStructure/{name}")]
        found, initial = listed("Outputs"), listed("InitialUnknowns")
    else:
        by_reference = {v.valueReference: v.name for v in fmu.description.modelVariables}
        listed = lambda name: [
            by_reference[int(e.get("valueReference"))] for e in root.findall(f"ModelStructure/{name}")
        ]
        found, initial = listed("Output"), listed("InitialUnknown")
    assert found == [v.name for v in outputs]
    assert initial == [v.name for v in outputs if v.initial in ("calculated", "approx")]


def test_dependencies_say_which_outputs_follow_inputs_at_once(fmu, opened):
    """An output with empty dependencies does not change when inputs are set; checked by setting all of them."""
    instance = opened(fmu).initialize().run(3, 0.01)
    root = tree(fmu)
    if fmu.version == 2:
        order = [v.name for v in fmu.description.modelVariables]
        unknowns = {order[int(e.get("index")) - 1]: e for e in root.find("ModelStructure/Outputs")}
    else:
        order = {v.valueReference: v.name for v in fmu.description.modelVariables}
        unknowns = {order[int(e.get("valueReference"))]: e for e in root.findall("ModelStructure/Output")}
    free = [name for name, e in unknowns.items() if e.get("dependencies") == ""]
    assert set(fmu.block_outputs()) <= set(free)
    before = instance.get(*free)
    for v in fmu.named("input"):
        value = 1e5 if v.unit in ("N/m", "Pa") else 0.5
        instance.check(instance.set({v.name: value if size(v) == 1 else [value] * size(v)}))
    assert instance.get(*free) == before


def test_limits_hold_start_values(fmu):
    for v in fmu.description.modelVariables:
        if v.start is None or size(v) > 1 or v.type in ("Boolean", "String"):
            continue
        low, high = float(v.min or "-inf"), float(v.max or "inf")
        assert low <= float(v.start) <= high, v.name


def test_log_categories_are_those_of_the_standard(fmu):
    assert [c.get("name") for c in tree(fmu).find("LogCategories")] == [
        "logEvents",
        "logStatusWarning",
        "logStatusDiscard",
        "logStatusError",
        "logStatusFatal",
        "logAll",
    ]


def test_getters_give_the_start_values(fmu, opened):
    """In initialization mode and in step mode, inputs and parameters are what the description says, to the bit."""
    instance = opened(fmu)
    instance.check(instance.set_up())
    for mode in ("initialization", "step"):
        for v in fmu.named("parameter") + fmu.named("input"):
            values = instance.get(v.name)
            if v.type == "Boolean":
                assert values == [v.start == "true"]
            else:
                starts = [float(text) for text in str(v.start).split()]
                assert values in (starts, starts * size(v)), (mode, v.name)
        if mode == "initialization":
            instance.check(instance.exit_initialization())


def test_every_variable_can_be_read_in_every_mode_in_which_it_has_a_value(fmu, opened):
    instance = opened(fmu)
    names = [v.name for v in fmu.description.modelVariables if v.type not in ("String", "Binary")]

    def all_finite():
        assert all(abs(value) < float("inf") for value in instance.get(*names))

    if fmu.version == 3:
        settable = [v.name for v in fmu.named("parameter") + fmu.named("input")]
        assert all(abs(value) < float("inf") for value in instance.get(*settable))
    instance.check(instance.set_up())
    all_finite()
    instance.check(instance.exit_initialization())
    all_finite()
    instance.run(1, 0.01)
    all_finite()
    instance.check(instance.terminate())
    all_finite()


def test_outputs_and_time_cannot_be_set(fmu, opened):
    instance = opened(fmu)
    instance.check(instance.set_up())
    state = instance.save()
    for v in fmu.named("output") + fmu.named("independent"):
        if v.type == "Binary":
            continue
        values = instance.get(v.name)
        with instance.complaint():
            assert instance.set_raw(v.type, [v.valueReference], values) == ERROR
        instance.check(instance.restore(state))


def test_inputs_read_back_as_set(fmu, opened):
    instance = opened(fmu).initialize()
    for v in fmu.named("input"):
        values = [0.001 * (k + 1) for k in range(size(v))]
        instance.check(instance.set({v.name: values if size(v) > 1 else values[0]}))
        assert instance.get(v.name) == values


def test_a_parameter_at_its_limits_is_taken_and_behind_them_refused(fmu, opened):
    instance = opened(fmu)
    instance.check(instance.set_up())
    state = instance.save()
    for v in fmu.named("parameter") + fmu.named("input"):
        if size(v) > 1 or v.type == "Boolean":
            continue
        integer = v.type in ("Integer", "Int32")
        for limit, outward in ((v.min, -1), (v.max, 1)):
            if limit is None:
                continue
            limit = int(limit) if integer else float(limit)
            instance.check(instance.set({v.name: limit}))
            beyond = limit + outward * (1 if integer else max(1.0, abs(limit)))
            with instance.complaint(v.name):
                assert instance.set({v.name: beyond}) == ERROR
            instance.check(instance.restore(state))


def test_wrong_type_is_refused(fmu, opened):
    instance = opened(fmu).initialize()
    state = instance.save()
    samples = {}
    for v in fmu.description.modelVariables:
        if v.type in TYPES[fmu.version] and size(v) == 1:
            samples.setdefault(v.type, v.valueReference)
    for kind in TYPES[fmu.version]:
        for other, reference in samples.items():
            if other != kind:
                with instance.complaint():
                    assert instance.get_raw(kind, [reference])[0] == ERROR
                instance.check(instance.restore(state))
                assert instance.set_raw(kind, [reference], [0]) == ERROR
                instance.check(instance.restore(state))


def test_arrays_cover_all_blocks(fmus):
    for fmu in fmus.values():
        arrays = [v for v in fmu.description.modelVariables if size(v) > 1]
        if fmu.version == 2:
            assert not arrays
            continue
        blocks = {"block_on_incline": 2, "coupled_slope": 13}[fmu.case]
        assert {size(v) for v in arrays} == {blocks}
        assert {"block_force_x", "block_moment", "block_displacement_x", "block_contact_count"} <= {
            v.name for v in arrays
        }


def test_terminals_hold_all_variables_of_their_port(fmu):
    place = fmu.folder / "terminalsAndIcons" / "terminalsAndIcons.xml"
    if fmu.version == 2:
        assert not place.exists()
        return
    root = xml.etree.ElementTree.parse(place).getroot()
    assert root.get("fmiVersion", "").startswith("3.0")
    found = {
        terminal.get("name"): [e.get("variableName") for e in terminal.iter("TerminalMemberVariable")]
        for terminal in root.iter("Terminal")
    }
    ports = {"block_on_incline": ["block"], "coupled_slope": ["toe", "face", "plane"]}[fmu.case]
    assert list(found) == ports
    for port, members in found.items():
        assert members == [name for name in fmu.variables if name.startswith(f"{port}.")]


def test_both_versions_describe_the_same_interface(fmus):
    for case in ("block_on_incline", "coupled_slope"):
        two, three = (fmus[f"{case}_fmi{version}.fmu"] for version in (2, 3))
        scalars = {
            name: (v.causality, v.variability, v.unit, v.description, v.start)
            for name, v in three.variables.items()
            if size(v) == 1 and name not in ("time", "snapshot")
        }
        scalars = {name: row for name, row in scalars.items() if not name.startswith("block_")}
        own = {name: (v.causality, v.variability, v.unit, v.description, v.start) for name, v in two.variables.items()}
        assert own == scalars
        assert two.token != three.token


def test_token_is_a_uuid_of_its_own(fmus):
    tokens = {fmu.token for fmu in fmus.values()}
    assert len(tokens) == 4
    for token in tokens:
        assert re.fullmatch(r"[0-9a-f]{8}-[0-9a-f]{4}-5[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}", token)


def test_packing_is_reproducible(enmm, fmu, tmp_path):
    case = Path(__file__).parents[1] / "examples" / "cases" / f"{fmu.case}.toml"
    done = enmm("fmu", case, "-o", tmp_path / fmu.path.name, "--fmi", fmu.version)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / fmu.path.name).read_bytes() == fmu.path.read_bytes()


def test_all_functions_of_the_standard_are_exported(fmu):
    assert len(set(functions_of(fmu))) == EXPECTED_SYMBOLS[fmu.version]


def test_library_needs_only_the_system(fmu):
    output = subprocess.run(["readelf", "-d", str(fmu.library)], capture_output=True, text=True, check=True).stdout
    needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", output))
    allowed = {
        "libc.so.6",
        "libm.so.6",
        "libgcc_s.so.1",
        "libdl.so.2",
        "libpthread.so.0",
        "librt.so.1",
        "ld-linux-x86-64.so.2",
    }
    assert needed <= allowed
    assert "RUNPATH" not in output and "RPATH" not in output


def test_version_and_platform(fmu):
    library = fmu.load()
    version = getattr(library, f"fmi{fmu.version}GetVersion")
    version.restype = ctypes.c_char_p
    assert version().decode() == f"{fmu.version}.0"
    if fmu.version == 2:
        library.fmi2GetTypesPlatform.restype = ctypes.c_char_p
        assert library.fmi2GetTypesPlatform() == b"default"


def test_instance_of_each_is_made_and_ended(fmu):
    with Instance(fmu) as instance:
        assert instance.pointer
        assert instance.set_up() == OK
