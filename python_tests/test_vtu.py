"""Frames of a finished run open in VTK, which is what ParaView reads them with; meshio finds the same numbers."""

import xml.etree.ElementTree

import meshio
import numpy
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

POLYGON, VERTEX, POLY_VERTEX = 7, 1, 2
POINT_FIELDS = {"displacement": 3, "velocity": 3}
CELL_FIELDS = ["stress_xx", "stress_yy", "stress_xy", "mean_stress", "max_shear", "block", "rock"]
JOINT_FIELDS = {"normal_stress": 1, "shear_stress": 1, "length": 1, "normal": 3, "state": 1, "law": 1}


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


def test_the_collection_lists_both_parts_of_every_time(results, entries):
    elements, joints = (files_of_part(results, entries, part) for part in "01")
    times = [time for time, _ in elements]
    assert times == sorted(times)
    assert times == [time for time, _ in joints]
    listed = {path for _, path in elements + joints}
    assert listed == set((results / "frames").glob("*.vtu"))


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


def test_vtk_reads_the_joints(results, entries):
    found = 0
    for time, path in files_of_part(results, entries, "1"):
        grid = read_with_vtk(path)
        assert array(grid.GetFieldData(), "TimeValue").tolist() == [time]
        count = grid.GetNumberOfPoints()
        found += count
        assert {grid.GetCellType(k) for k in range(grid.GetNumberOfCells())} == {VERTEX if count else POLY_VERTEX}
        for name, components in JOINT_FIELDS.items():
            field = grid.GetPointData().GetArray(name)
            assert (field.GetNumberOfTuples(), field.GetNumberOfComponents()) == (count, components)
        if count:
            assert set(array(grid.GetPointData(), "state")) <= {0, 1, 2}
            lengths = numpy.linalg.norm(array(grid.GetPointData(), "normal"), axis=1)
            assert numpy.allclose(lengths, 1.0, atol=1e-9)
    assert found, "no frame has a joint point"


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
