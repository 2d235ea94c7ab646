"""The couplings of docs/coupling.md run, and mean what the document says of them."""

import importlib.util
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parents[1] / "examples" / "coupling"
SHARED = Path(__file__).parents[2] / "shared" / "data" / "accel" / "elcentro_1940_ns.csv"


def example(name):
    """The module of an example."""
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def is_picture(path):
    return path.read_bytes().startswith(b"\x89PNG") and path.stat().st_size > 20_000


def test_a_block_in_an_earthquake_slips_as_newmark_says(package, tmp_path):
    earthquake = example("earthquake")
    result = earthquake.run()
    slip, newmark = result["block"], result["newmark"]
    assert newmark[-1] > 0.1
    assert abs(slip[-1] - newmark[-1]) < 0.01 * newmark[-1]
    assert np.max(np.abs(slip - newmark)) < 0.01 * newmark[-1]
    page = " ".join((FOLDER.parents[1] / "docs" / "coupling.md").read_text(encoding="utf-8").split())
    assert f"it slips {slip[-1]:.4f} m, Newmark's {newmark[-1]:.4f} m" in page
    toe = result["slope"][:, 0]
    assert 0.05 < toe[-1] < 1.0, "the slope slips in the strong part"
    assert abs(toe[-1] - toe[-150]) < 1e-3 * toe[-1], "and has come to rest"
    assert {event.kind.name for event in result["events"]} >= {"SLIPPED"}
    earthquake.draw(result, tmp_path / "earthquake.png")
    assert is_picture(tmp_path / "earthquake.png")


def test_a_real_record_slips_as_newmark_says(package):
    if not SHARED.exists():
        print(f"left out: {SHARED} is absent")
        return
    result = example("earthquake").run(SHARED)
    assert abs(result["block"][-1] - result["newmark"][-1]) < 0.02 * result["newmark"][-1]


def test_a_fast_drawdown_moves_the_slope_until_its_joints_have_drained(package, tmp_path):
    reservoir = example("reservoir")
    result = reservoir.run()
    t, level, hill, moved, _, uplift = result["rows"].T
    at = {time: np.argmin(np.abs(t - time)) for time in (0.5, 4.0, 5.4, 7.0, 9.0, 9.9)}
    assert level[at[4.0]] > 18.0 > 8.0 > level[at[7.0]]
    assert hill[at[7.0]] > 3.0 + level[at[7.0]], "the water in the hill is left behind"
    assert uplift[0] == 0 < 0.05 * uplift.max() < uplift[at[7.0]], "and flows out through the plane"
    assert uplift[at[9.9]] < 0.01 * uplift.max(), "until it has drained"
    assert moved[: at[5.4]].max() < 5e-4, "the rising water does not set the slope going"
    assert moved[at[7.0]] > 5e-3, "the drawdown sets it going"
    assert abs(moved[at[9.9]] - moved[at[9.0]]) < 1e-4, "drained joints stop it"
    reservoir.draw(result, tmp_path / "reservoir.png")
    assert is_picture(tmp_path / "reservoir.png")
