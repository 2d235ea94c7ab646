"""Frames of a finished run open in VTK, which is what ParaView reads them with; meshio finds the same numbers."""

import xml.etree.ElementTree

import meshio
import numpy
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

POLYGON, VERTEX, POLY_VERTEX, LINE = 7, 1, 2, 3
POINT_FIELDS = {"displacement": 3, "velocity": 3}
CELL_FIELDS = ["stress", "stress_xx", "stress_yy", "stress_xy", "principal_max", "principal_min", "mean_stress"]
CELL_FIELDS += ["max_shear", "block", "rock"]
JOINT_FIELDS = {"block_1": 1, "block_2": 1, "opening": 1, "slip": 1, "force": 3, "normal_stress": 1, "shear_stress": 1}
JOINT_FIELDS |= {"normal": 3, "state": 1, "bond": 1, "law": 1, "is_joint": 1}
PARTS = {"0": "elements", "1": "joints", "2": "bolts", "3": "supports", "4": "water"}


@pytest.fixture(scope="module")
def entries(results) -> list[dict]:
    """Entries of the collection: timestep, part, file."""
    root = xml.etree.ElementTree.parse(results / "run.pvd").getroot()
    assert root.get("type") == "Collection"
    return [entry.attrib for entry in root.iter("DataSet")]


def files_of_part(results, entries, part):
    files = [(float(entry["timestep"]), results / entry["file"]) for entry in entries if entry["part"] == part]
    assert files
    return files


def read_with_vtk(path):
    """The grid of a file; an error that VTK reports is an error here."""
    errors = []
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: errors.append("warning"))
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors, path
    return reader.GetOutput()


def array(fields, name):
    return vtk_to_numpy(fields.GetArray(name))


def component_names(grid, name):
    field = grid.GetFieldData().GetArray(name)
    return [field.GetComponentName(k) for k in range(field.GetNumberOfComponents())]


def test_the_collection_lists_all_parts_of_every_time(results, entries):
    elements, joints = (files_of_part(results, entries, part) for part in "01")
    times = [time for time, _ in elements]
    assert times == sorted(times)
    assert times == [time for time, _ in joints]
    assert all(entry["name"] == PARTS[entry["part"]] for entry in entries)
    assert {results / entry["file"] for entry in entries} == set((results / "frames").glob("*.vtu"))


def test_vtk_reads_the_elements(results, entries):
    for time, path in files_of_part(results, entries, "0"):
        grid = read_with_vtk(path)
        assert grid.GetNumberOfCells() > 0
        assert {grid.GetCellType(k) for k in range(grid.GetNumberOfCells())} == {POLYGON}
        assert array(grid.GetFieldData(), "TimeValue").tolist() == [time]
        for name, components in POINT_FIELDS.items():
            assert grid.GetPointData().GetArray(name).GetNumberOfComponents() == components
            assert numpy.isfinite(array(grid.GetPointData(), name)).all()
        for name in CELL_FIELDS:
            assert len(array(grid.GetCellData(), name)) == grid.GetNumberOfCells()


def test_polygons_are_counter_clockwise_and_share_no_points(results, entries):
    _, path = files_of_part(results, entries, "0")[0]
    grid = read_with_vtk(path)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    ends = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    assert ends[-1] == len(points)
    for start, end in zip(ends[:-1], ends[1:]):
        x, y, _ = points[start:end].T
        assert 0.5 * (x @ numpy.roll(y, -1) - y @ numpy.roll(x, -1)) > 0.0


def test_stress_is_a_tensor_whose_principal_values_are_beside_it(results, entries):
    _, path = files_of_part(results, entries, "0")[-1]
    data = read_with_vtk(path).GetCellData()
    assert [data.GetArray("stress").GetComponentName(k) for k in range(6)] == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
    xx, yy, zz, xy, yz, xz = array(data, "stress").T
    assert (xx == array(data, "stress_xx")).all() and (yy == array(data, "stress_yy")).all()
    assert (xy == array(data, "stress_xy")).all() and not yz.any() and not xz.any()
    # Elastic rock in plane strain, with the Poisson's ratio of short.toml.
    assert numpy.allclose(zz, 0.25 * (xx + yy), rtol=1e-12, atol=0.0)
    values = numpy.linalg.eigvalsh(numpy.array([[xx, xy], [xy, yy]]).T)
    size = numpy.abs(values).max()
    assert size > 0.0
    assert numpy.allclose(values[:, 0], array(data, "principal_min"), atol=1e-9 * size)
    assert numpy.allclose(values[:, 1], array(data, "principal_max"), atol=1e-9 * size)


def test_vtk_reads_the_joints(results, entries):
    for time, path in files_of_part(results, entries, "1"):
        grid = read_with_vtk(path)
        assert array(grid.GetFieldData(), "TimeValue").tolist() == [time]
        assert component_names(grid, "law_names") == ["plane"]
        assert component_names(grid, "state_names") == ["open", "slip", "lock"]
        assert component_names(grid, "bond_names") == ["none", "broken", "holds"]
        count = grid.GetNumberOfCells()
        assert {grid.GetCellType(k) for k in range(count)} == {LINE}
        assert grid.GetNumberOfPoints() == 2 * count
        for name, components in JOINT_FIELDS.items():
            field = grid.GetCellData().GetArray(name)
            assert (field.GetNumberOfTuples(), field.GetNumberOfComponents()) == (count, components)
        assert set(array(grid.GetCellData(), "state")) <= {0, 1, 2}
        lengths = numpy.linalg.norm(array(grid.GetCellData(), "normal"), axis=1)
        assert numpy.allclose(lengths, 1.0, atol=1e-9)


def test_joints_are_whole_lines_with_force_over_length_as_stress(results, entries):
    """A block of 1 m on a base: one joint of 1 m that bears its weight and slips under it."""
    _, first = files_of_part(results, entries, "1")[0]
    _, last = files_of_part(results, entries, "1")[-1]
    start, end = read_with_vtk(first), read_with_vtk(last)
    ends = vtk_to_numpy(start.GetPoints().GetData()).reshape(-1, 2, 3)
    assert numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(1.0, abs=1e-9)
    data = {name: array(end.GetCellData(), name) for name in JOINT_FIELDS}
    is_joint = data["is_joint"] == 1
    pairs = {(min(a, b), max(a, b)) for a, b in zip(data["block_1"], data["block_2"])}
    assert pairs == {(0, 1)}
    # It slides at 0.5 m/s less what friction takes, for 0.05 s, and stays on the base.
    friction = 9.81 * numpy.tan(numpy.radians(20.0))
    way = 0.5 * 0.05 - 0.5 * friction * 0.05**2
    # Friction begins late by its delay, for the block has just been put down.
    assert data["slip"][is_joint] == pytest.approx(way, rel=0.03)
    assert numpy.abs(data["opening"][is_joint]).max() < 1e-3
    weight = 2600.0 * 9.81
    upward = numpy.abs(data["force"][:, 1].sum())
    assert 0.3 * weight < upward < 3.0 * weight, "the weight, about, for the block has just been put down"
    closed = data["normal_stress"][is_joint]
    assert closed.max() <= 0.0 and numpy.abs(closed).max() < 5.0 * weight, "Pa over a face of 1 m"


def test_vtk_reads_the_supports_bolts_and_water_of_a_slope(enmm, cases, tmp_path):
    text = (cases / "plane_slide.toml").read_text(encoding="utf-8")
    case = tmp_path / "bolted.toml"
    case.write_text(text + '\n[output]\nframe_interval = 60.0\npictures = false\n', encoding="utf-8")
    answer = enmm("run", case, "-o", tmp_path / "out", "--quiet")
    assert answer.returncode == 0, answer.stderr
    assert not list((tmp_path / "out").glob("*.png"))
    frames = {name: read_with_vtk(max((tmp_path / "out" / "frames").glob(f"{name}_*.vtu"))) for name in PARTS.values()}
    forces = array(frames["bolts"].GetCellData(), "force")
    assert len(forces) == 4 and (forces > 100e3).all() and (forces <= 210e3).all(), "420 kN every 2 m at most"
    assert component_names(frames["bolts"], "bolt_names") == [f"row_{k}" for k in (1, 2, 3, 4)]
    assert set(array(frames["bolts"].GetCellData(), "state")) <= {1, 2}
    # At rest the supports bear rock and water, and nothing sideways is left over.
    reaction = array(frames["supports"].GetPointData(), "reaction").sum(axis=0)
    points = vtk_to_numpy(frames["elements"].GetPoints().GetData())
    offsets = vtk_to_numpy(frames["elements"].GetCells().GetOffsetsArray())
    corners = numpy.split(points, offsets[:-1])
    area = sum(0.5 * (x @ numpy.roll(y, -1) - y @ numpy.roll(x, -1)) for x, y, _ in (c.T for c in corners))
    weight = 2650.0 * 9.81 * area
    assert reaction[1] == pytest.approx(weight, rel=0.02) and abs(reaction[0]) < 0.02 * weight
    # 5 m of water stand in the tension crack.
    pressure = array(frames["water"].GetPointData(), "water_pressure")
    assert pressure.max() == pytest.approx(1000.0 * 9.81 * 5.0, rel=0.01)
    # The wedge, the block of the bolts' heads, rests: joints, bolts and water together bear its weight.
    element_blocks = array(frames["elements"].GetCellData(), "block")
    areas = {block: 0.0 for block in set(element_blocks)}
    for block, (x, y, _) in zip(element_blocks, (c.T for c in corners)):
        areas[block] += 0.5 * (x @ numpy.roll(y, -1) - y @ numpy.roll(x, -1))
    wedge = min(areas, key=areas.get)
    joints = frames["joints"].GetCellData()
    sign = numpy.where(array(joints, "block_1") == wedge, 1.0, -1.0)
    total = (array(joints, "force") * sign[:, None]).sum(axis=0)[:2]
    bars = vtk_to_numpy(frames["bolts"].GetPoints().GetData()).reshape(-1, 2, 3)[:, :, :2]
    along = (bars[:, 1] - bars[:, 0]) / numpy.linalg.norm(bars[:, 1] - bars[:, 0], axis=1)[:, None]
    total += (along * forces[:, None]).sum(axis=0)
    edges = vtk_to_numpy(frames["water"].GetPoints().GetData()).reshape(-1, 2, 3)[:, :, :2]
    inward = numpy.column_stack([-(edges[:, 1] - edges[:, 0])[:, 1], (edges[:, 1] - edges[:, 0])[:, 0]])
    mean = pressure.reshape(-1, 2).mean(axis=1)
    own = array(frames["water"].GetCellData(), "block") == wedge
    total += (inward[own] * mean[own, None]).sum(axis=0)
    weight = 2650.0 * 9.81 * areas[wedge]
    # Convergence 1e-5; edges that the water table crosses are wet on a part only, which their ends do not tell.
    assert numpy.abs(total - [0.0, weight]).max() < 0.01 * weight


def test_meshio_reads_the_same_numbers_as_vtk(results, entries):
    for entry in entries:
        grid = read_with_vtk(results / entry["file"])
        mesh = meshio.read(results / entry["file"])
        assert len(mesh.points) == grid.GetNumberOfPoints()
        if len(mesh.points) == 0:
            continue
        assert (mesh.points == vtk_to_numpy(grid.GetPoints().GetData())).all()
        assert sum(len(block) for block in mesh.cells) == grid.GetNumberOfCells()
        for name, values in mesh.point_data.items():
            expected = array(grid.GetPointData(), name)
            assert numpy.array_equal(values.reshape(expected.shape), expected), name
        for name, blocks in mesh.cell_data.items():
            assert numpy.array_equal(numpy.concatenate(blocks), array(grid.GetCellData(), name)), name
