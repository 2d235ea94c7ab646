"""FMUs of every example case, held against the standards: the schemas of the FMI project (which FMPy carries), FMPy's
own rules, and rules of the text that neither knows."""

import zipfile
from pathlib import Path, PurePosixPath

import fmpy
import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from lxml import etree

CASES = sorted((Path(__file__).parents[1] / "examples" / "cases").glob("*.toml"))
SCHEMAS = Path(fmpy.__file__).with_name("schema")
TOP = {
    2: {"modelDescription.xml", "model.png", "binaries", "resources", "documentation"},
    3: {"modelDescription.xml", "terminalsAndIcons", "binaries", "resources", "documentation"},
}


@pytest.fixture(scope="module", params=[(case, version) for case in CASES for version in (2, 3)],
                ids=lambda pair: f"{pair[0].stem}_fmi{pair[1]}")
def packed(request, enmm, tmp_path_factory):
    """An FMU with its version and its files."""
    case, version = request.param
    path = tmp_path_factory.mktemp("standard") / f"{case.stem}.fmu"
    done = enmm("fmu", case, "-o", path, "--fmi", version)
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(path) as archive:
        return path, version, {name: archive.read(name) for name in archive.namelist()}


def test_there_are_cases():
    assert len(CASES) >= 8


def test_fmpy_finds_no_problem(packed):
    path, _, _ = packed
    assert validate_fmu(str(path)) == []


def test_every_document_fits_its_schema(packed):
    _, version, files = packed
    documents = {"modelDescription.xml": f"fmi{version}ModelDescription.xsd"}
    if version == 3:
        documents["terminalsAndIcons/terminalsAndIcons.xml"] = "fmi3TerminalsAndIcons.xsd"
    assert {name for name in files if name.endswith(".xml")} == set(documents)
    for name, schema in documents.items():
        rules = etree.XMLSchema(file=str(SCHEMAS / f"fmi{version}" / schema))
        rules.validate(etree.fromstring(files[name]))
        assert not rules.error_log, f"{name}: {rules.error_log}"


def test_files_lie_where_the_standard_has_them(packed):
    path, version, files = packed
    paths = [PurePosixPath(name) for name in files]
    assert {parts.parts[0] for parts in paths} <= TOP[version]
    library = "binaries/linux64" if version == 2 else "binaries/x86_64-linux"
    (binary,) = [parts for parts in paths if parts.parts[0] == "binaries"]
    assert str(binary.parent) == library or not Path("/proc").exists(), "elsewhere another platform"
    assert binary.stem == read_model_description(str(path), validate=False).coSimulation.modelIdentifier


def test_structure_refers_to_variables_that_there_are(packed):
    path, _, _ = packed
    description = read_model_description(str(path), validate=False)
    variables = {v.name for v in description.modelVariables}
    for unknown in description.outputs + description.initialUnknowns:
        assert unknown.variable.name in variables
        for known in unknown.dependencies or []:
            assert known.causality in {"input", "parameter", "independent"}, f"{unknown.variable.name}: {known.name}"
    assert description.derivatives == [] and description.eventIndicators in ([], None)


def test_start_values_fill_their_arrays_and_lie_within_limits(packed):
    path, _, _ = packed
    for v in read_model_description(str(path), validate=False).modelVariables:
        starts = [] if v.start is None else str(v.start).split()
        size = 1
        for dimension in v.dimensions or []:
            size *= int(dimension.start)
        assert len(starts) in (0, 1, size), v.name
        if v.type not in ("Boolean", "Binary"):
            low, high = float(v.min or "-inf"), float(v.max or "inf")
            assert all(low <= float(start) <= high for start in starts), v.name


def test_default_experiment_makes_sense(packed):
    path, _, _ = packed
    experiment = read_model_description(str(path), validate=False).defaultExperiment
    start, stop, step = (float(text) for text in (experiment.startTime, experiment.stopTime, experiment.stepSize))
    assert start == 0.0 < step <= stop


def test_terminals_have_names_of_their_own_and_members_that_there_are(packed):
    path, version, files = packed
    if version == 2:
        assert not any(name.startswith("terminalsAndIcons") for name in files)
        return
    variables = {v.name for v in read_model_description(str(path), validate=False).modelVariables}
    root = etree.fromstring(files["terminalsAndIcons/terminalsAndIcons.xml"])
    names = [terminal.get("name") for terminal in root.iter("Terminal")]
    assert len(set(names)) == len(names)
    assert {member.get("variableName") for member in root.iter("TerminalMemberVariable")} <= variables
