"""The page of a run in which water flows in joints: a layer that follows the stages, and nothing of it elsewhere."""

import csv
import json

import browser
import meshio
import pytest

LITRES = 6e4  # Litres per minute in a m³/s.
# A plate with a level joint at a height of 4 m under a head of 7 m on its left; a drain halfway in the second stage.
CASE = """
title = "Plate with a joint"
[domain]
outline = [[0, 0], [10, 0], [10, 8], [0, 8]]
[mesh]
size = 1.0
origin = [0.131, 0.077]
[[joint]]
points = [[0, 4], [10, 4]]
[[joint]]
points = [[3, 4], [3, 8]]
[rock.rock]
density = 2600
young = 1e10
poisson = 0.25
[joint_law.joint]
friction_deg = 40
[flow]
aperture = 2e-4
[[head]]
name = "left"
edge = [[0, 0], [0, 8]]
level = 7.0
[[drain]]
name = "row"
points = [[5, 3], [5, 5]]
active = false
[[fix]]
edge = [[0, 0], [10, 0]]
[[stage]]
name = "wet"
kind = "static"
duration = 0.05
[[stage]]
name = "drained"
kind = "static"
duration = 0.05
drain = ["row"]
"""
# Transmissivity (m²/s) of 0.2 mm: γe³/12μ.
T = 9810 * 8e-12 / 12e-3
ROWS = "[...document.querySelectorAll('#inlets tbody tr')].map(row => [...row.children].map(cell => cell.textContent))"


@pytest.fixture
def page(program, tmp_path):
    opened = browser.Browser(program, tmp_path / "profile")
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def flowing(enmm, tmp_path_factory):
    """Folder of a run of the plate."""
    folder = tmp_path_factory.mktemp("flow")
    (folder / "plate.toml").write_text(CASE)
    answer = enmm("run", folder / "plate.toml", "-o", folder / "out", "--quiet")
    assert answer.returncode in (0, 4), answer.stderr
    return folder / "out"


def rows(page) -> dict[str, list[float]]:
    """Flows (m²/s) in, out and off by place, as the page shows them."""
    return {name: [float(flow.replace("−", "-")) / LITRES for flow in flows] for name, *flows in page.run(ROWS)}


def test_the_layer_follows_the_stages(flowing, page):
    page.open((flowing / "report.html").as_uri())
    page.painted()
    notes = page.run("enmm.film.of('water').map(({stage, pieces, nodes, seeps}) => [stage, pieces, nodes, seeps])")
    assert [stage for stage, *_ in notes] == ["wet", "drained"]
    # The head falls from 3 m at the left to none at the right, or at the drain halfway; the joint above it fills to it.
    for (_, pieces, nodes, seeps), far in zip(notes, [10, 5]):
        for x, y, head in nodes:
            if y == 4:
                assert head == pytest.approx(max(3 * (1 - x / far), 0), abs=2e-3)
        assert max(flow for *_, flow in pieces) == pytest.approx(T * 3 / far, rel=1e-3)
        assert len(seeps) == (1 if far == 10 else 0)
    page.run("enmm.player.seek(enmm.film.start)")
    page.painted()
    assert rows(page)["air"][1] == pytest.approx(T * 0.3, rel=1e-3)
    page.run("enmm.player.seek(enmm.film.end)")
    page.painted()
    drained = rows(page)
    assert drained["row"][1] == pytest.approx(T * 0.6, rel=6e-4) and "air" not in drained
    with (flowing / "flow.csv").open(newline="") as file:
        told = [row for row in csv.DictReader(file) if row["stage"] == "drained" and row["name"] == "row"]
    assert float(told[0]["out [m2/s]"]) == pytest.approx(drained["row"][1], rel=6e-4)
    assert page.errors == [] and page.requests == []


# The pixel at a quarter of the joint is that of the layer, and that of the rock or its outline without it.
def test_the_layer_can_be_switched_off(flowing, page):
    page.open((flowing / "report.html").as_uri())
    page.painted()
    place = """(() => { const {slope, film: {shape}} = enmm, at = slope.toScreen(2 - shape.originX, 4 - shape.originY);
        return [...slope.pen.getImageData(Math.round(at[0]), Math.round(at[1]), 1, 1).data]; })()"""
    wet = page.run(place)
    page.run("document.getElementById('water').click()")
    page.painted()
    assert page.run(place) != wet
    page.run("document.getElementById('water').click()")
    page.painted()
    assert page.run(place) == wet


def test_each_stage_has_a_picture_of_its_flow(flowing):
    for stage in (1, 2):
        assert (flowing / f"stage{stage}_flow.png").stat().st_size > 1000
    text = (flowing / "stage2_flow.svg").read_text()
    assert "row 0.235 L/min per m" in text and "pressure head [m]" in text


# The level joint carries the same flow all along, in the direction of its lines.
def test_frames_have_heads_and_flows(flowing):
    frames = sorted((flowing / "frames").glob("flow_*.vtu"))
    first = meshio.read(frames[0])
    head, pressure, flow = (first.cell_data[name][0] for name in ("head", "pressure", "flow"))
    assert head[pressure > 0].max() < 7 and abs(flow).max() == pytest.approx(T * 0.3, rel=1e-9)
    assert first.point_data["pressure_head"].max() == pytest.approx(3, rel=1e-9)
    last = meshio.read(frames[-1])
    assert abs(last.cell_data["flow"][0]).max() == pytest.approx(T * 0.6, rel=1e-3)


# Without water that flows the page has no line of the layer, and there is no picture of it.
def test_results_without_flow_know_none(results):
    assert "drawFlow" not in (results / "report.html").read_text()
    assert not list((results / "frames").glob("flow_*")) and not list(results.glob("*_flow.*"))
    assert not (results / "flow.csv").exists()
    assert json.loads((results / "summary.json").read_text()).get("flow") is None
