"""pyvista, thus ParaView's library, draws frames of a run: rock where it is, joints by the names of their states."""

import subprocess
import sys

import numpy
import pytest
import pyvista

WIDTH, HEIGHT = 640, 480
# In a process of its own: VTK ends the program where it finds nothing to draw with.
PROBE = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Plane(), color="black", lighting=False)
assert plotter.screenshot(None, return_img=True).std() > 10
"""


@pytest.fixture(scope="module", autouse=True)
def off_screen():
    probe = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True)
    if probe.returncode != 0:
        reason = (probe.stderr.strip().splitlines() or [f"status {probe.returncode}"])[-1]
        pytest.skip(f"VTK cannot draw here (Debian: apt-get install libegl1 libgl1-mesa-dri): {reason}")


@pytest.fixture
def last(results):
    """Elements and joints at the end of the short run."""
    reader = pyvista.get_reader(results / "run.pvd")
    reader.set_active_time_value(reader.time_values[-1])
    elements, joints = reader.read()[:2]
    return elements, joints


def names(grid, of):
    """What the numbers of an array stand for: the component names of its array in the field data."""
    field = grid.GetFieldData().GetArray(f"{of}_names")
    return [field.GetComponentName(k) for k in range(field.GetNumberOfComponents())]


def drawn(add, tmp_path):
    """Pixels of a picture from above, and the pixel of a place (m)."""
    plotter = pyvista.Plotter(off_screen=True, window_size=(WIDTH, HEIGHT))
    plotter.set_background("white")
    add(plotter)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    pixels = plotter.screenshot(tmp_path / "picture.png", return_img=True)
    (x, y, _), scale = plotter.camera.focal_point, plotter.camera.parallel_scale

    def at(place_x, place_y):
        per_metre = 0.5 * HEIGHT / scale
        row, column = 0.5 * HEIGHT - (place_y - y) * per_metre, 0.5 * WIDTH + (place_x - x) * per_metre
        return tuple(int(part) for part in pixels[round(row), round(column)][:3])

    plotter.close()
    return pixels, at


def test_the_rock_is_drawn_where_it_is(last, tmp_path):
    elements, _ = last
    pixels, at = drawn(lambda plotter: plotter.add_mesh(elements, color="black", lighting=False), tmp_path)
    centres = elements.cell_centers().points
    assert len(centres) > 10
    assert all(at(x, y) == (0, 0, 0) for x, y, _ in centres)
    # Beside the block of 1 m, over the base, there is air.
    assert at(4.0, 1.5) == (255, 255, 255)
    assert set(numpy.unique(pixels.reshape(-1, 3).min(axis=1))) >= {0, 255}


def test_stress_is_coloured_by_its_values(last, tmp_path):
    elements, _ = last
    stress = elements.cell_data["mean_stress"]
    clim = [stress.min(), stress.max()]
    look = dict(scalars="mean_stress", cmap="gray", clim=clim, lighting=False, show_scalar_bar=False)
    _, at = drawn(lambda plotter: plotter.add_mesh(elements, **look), tmp_path)
    # Centres of slivers lie on pixels that they share with their neighbours.
    area = elements.compute_cell_sizes().cell_data["Area"]
    large = area > 0.5 * area.max()
    assert large.sum() > 10
    shades = [at(x, y)[0] for x, y, _ in elements.cell_centers().points[large]]
    wanted = 255.0 * (stress[large] - clim[0]) / (clim[1] - clim[0])
    assert numpy.abs(numpy.array(shades) - wanted).max() < 4.0


def test_joints_are_drawn_by_the_names_of_law_and_state(last, tmp_path):
    _, joints = last
    assert names(joints, "law") == ["plane"]
    states = names(joints, "state")
    assert states == ["open", "slip", "lock"]
    slipping = joints.extract_cells(joints.cell_data["state"] == states.index("slip"))
    assert slipping.n_cells > 0, "the block slides on its base"

    def add(plotter):
        plotter.add_mesh(joints, color="white", line_width=5, lighting=False)
        plotter.add_mesh(slipping, color="red", line_width=5, lighting=False)

    _, at = drawn(add, tmp_path)
    for x, y, _ in slipping.cell_centers().points:
        assert at(x, y) == (255, 0, 0)
