"""`report.html` in a real browser: it loads without an error, plays, and answers clicks with the numbers of the run."""

import base64
import csv
import io
import json
import re
import shutil
import subprocess
import time
import urllib.error
import urllib.request

import browser
import meshio
import pytest
from conftest import from_environment
from PIL import Image

# Weights of the units that the page shows.
UNITS = {"m": 1, "mm": 1e-3, "m/s": 1, "mm/s": 1e-3, "Pa": 1, "kPa": 1e3, "MPa": 1e6, "m²": 1, "kg/m": 1, "t/m": 1e3}
UNITS |= {"°": 3.141592653589793 / 180, "°/s": 3.141592653589793 / 180, "": 1}
# Numbers of a block: name in the page, column of blocks.csv.
OF_BLOCK = [
    ("Area", "area [m2]"),
    ("Mass", "mass [kg/m]"),
    ("Centroid x", "centroid_x [m]"),
    ("Centroid y", "centroid_y [m]"),
    ("Rotation", "rotation [rad]"),
    ("Angular velocity", "angular_velocity [rad/s]"),
    ("σxx", "mean_stress_xx [Pa]"),
    ("σyy", "mean_stress_yy [Pa]"),
    ("σxy", "mean_stress_xy [Pa]"),
    ("Largest penetration", "penetration_max [m]"),
]
# The same of components: number of their row under a name.
PARTS = [
    ("Displacement", "displacement_x [m]", "displacement_y [m]"),
    ("Speed", "velocity_x [m/s]", "velocity_y [m/s]"),
]


@pytest.fixture
def page(program, tmp_path):
    opened = browser.Browser(program, tmp_path / "profile")
    yield opened
    opened.close()


@pytest.fixture
def report(page, results):
    """The page of the short run, at its end."""
    page.open((results / "report.html").as_uri())
    page.painted()
    return page


def quiet(page) -> None:
    """The page has no error and made no request."""
    assert page.errors == []
    assert page.requests == []


def number(shown: str) -> float:
    """A number as the page shows it, in SI units."""
    value, unit = re.fullmatch(r"([−+\de.]+)\s*(\S*)", shown.replace("e−", "e-").replace("e+", "e")).groups()
    return float(value.replace("−", "-")) * UNITS[unit]


def shown(page) -> list[tuple[str, str]]:
    """Names and values of the table of what is chosen."""
    rows = "[...document.querySelectorAll('#choice tr')].map(row => [...row.children].map(cell => cell.textContent))"
    return [(name, value) for name, value in page.run(rows)]


def table(path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def place(page, x: float, y: float) -> tuple[float, float]:
    """The pixel of a place in the model (m), by the camera of the page."""
    script = f"""(() => {{
        const shape = enmm.film.shape, box = document.getElementById("slope").getBoundingClientRect();
        const [px, py] = enmm.slope.toScreen({x!r} - shape.originX, {y!r} - shape.originY);
        return [px + box.x, py + box.y];
    }})()"""
    return tuple(page.run(script))


def close(found: float, wanted: float) -> bool:
    """Equal to the four digits that the page shows."""
    return abs(found - wanted) <= 6e-4 * abs(wanted) + 1e-12


def test_the_panel_begins_with_the_verdict(report, results):
    summary = json.loads((results / "summary.json").read_text())
    panel = report.run("[...document.getElementById('panel').children].map((part) => [part.id, part.textContent])")
    assert panel[0][0] == "verdict" and summary["verdict"] in panel[0][1]
    assert summary["verdict"].startswith("the slope has not failed")


@pytest.mark.parametrize("number_of_block", [0, 1])
def test_a_click_on_a_block_shows_the_numbers_of_blocks_csv(report, results, number_of_block):
    block = table(results / "blocks.csv")[number_of_block]
    report.click(*place(report, float(block["centroid_x [m]"]), float(block["centroid_y [m]"])))
    assert report.run("document.querySelector('#choice h2').textContent") == f"Block {block['id']}"
    rows = shown(report)
    found = dict(rows)
    for name, column in OF_BLOCK:
        assert close(number(found[name]), float(block[column])), (name, found[name], block[column])
    names = [name for name, _ in rows]
    for name, *columns in PARTS:
        at = names.index(name)
        for (_, value), column in zip(rows[at + 1 : at + 3], columns):
            assert close(number(value), float(block[column])), (name, value, block[column])
    quiet(report)


def test_a_click_on_a_monitor_shows_its_numbers(report, results):
    last = table(results / "history.csv")[-1]
    x, y = 1.5 + float(last["top_ux [m]"]), 1.9 + float(last["top_uy [m]"])
    report.click(*place(report, x, y))
    assert report.run("document.querySelector('#choice h2').textContent") == "Monitor top"
    rows = [number(value) for _, value in shown(report)]
    assert close(rows[0], 1.5) and close(rows[1], 1.9)
    assert close(rows[3], float(last["top_ux [m]"]))
    assert close(rows[4], float(last["top_uy [m]"]))
    quiet(report)


def test_a_click_in_the_air_lets_go(report):
    report.click(*place(report, 1.5, 1.5))
    assert len(shown(report)) > 5
    report.click(*place(report, 4.0, 1.8))
    assert shown(report) == []


def test_it_plays_to_the_end_and_moves_the_rock(report, results):
    end = float(table(results / "history.csv")[-1]["time [s]"])
    assert abs(report.run("enmm.film.end") - end) < 1e-9
    report.run("enmm.player.seek(0)")
    report.painted()
    before = report.run("Array.from(enmm.slope.x)")
    report.run("document.getElementById('play').focus()")
    report.click(*middle(report, "#play"))
    report.wait("!enmm.player.playing")
    report.painted()
    after = report.run("Array.from(enmm.slope.x)")
    # The block slides 0.5 m/s × 0.05 s, less what friction takes; the base is held.
    assert 0.015 < max(b - a for a, b in zip(before, after)) < 0.025
    assert min(abs(b - a) for a, b in zip(before, after)) < 1e-3
    assert report.run("document.getElementById('clock').textContent").startswith("time 0.050 s, stage slide")
    quiet(report)


def middle(page, selector: str) -> tuple[float, float]:
    box = page.run(f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])"
                   f"(document.querySelector({selector!r}).getBoundingClientRect())")
    return tuple(box)


def test_keys_play_step_zoom_and_colour(report):
    frames = report.run("enmm.film.frames.length")
    at = "enmm.player.moment().from"
    report.press("Home")
    assert report.run(at) == 0
    report.press("ArrowRight")
    assert report.run(at) == 1
    report.press("ArrowLeft")
    assert report.run(at) == 0
    report.press("End")
    assert report.run(at) == frames - 1
    report.press("Home")
    report.press(" ", "Space")
    report.wait("enmm.player.time > enmm.film.start")
    colours = ["displacement", "velocity", "stress", "shear", "block", "joint", "slip", "opening"]
    for key, name in zip("12345678", colours):
        report.press(key)
        assert report.run("document.querySelector('[data-colour][aria-checked=true]').dataset.colour") == name
    scale = report.run("enmm.slope.camera.scale")
    report.press("+")
    assert report.run("enmm.slope.camera.scale") == pytest.approx(1.5 * scale)
    report.press("0")
    assert report.run("enmm.slope.camera.scale") == pytest.approx(scale)
    quiet(report)


def test_the_tabulator_reaches_every_control_and_shows_where_it_is(report):
    wanted = report.run("document.querySelectorAll('button, select, input, summary, canvas[tabindex]').length")
    script = """(() => {
        const at = document.activeElement, style = getComputedStyle(at);
        if (at === document.body) return null;
        at.dataset.seen = "1";
        return style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2;
    })()"""
    for _ in range(2 * wanted):
        report.press("Tab")
        assert report.run(script) in (None, True)
    missed = report.run("""[...document.querySelectorAll('button, select, input, summary, canvas[tabindex]')]
        .filter(control => !control.dataset.seen && control.offsetParent !== null)
        .map(control => control.id || control.textContent)""")
    assert missed == []


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_picture_shows_rock_and_sky(report, results, theme, tmp_path):
    report.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
    report.open((results / "report.html").as_uri())
    report.press("5")
    picture = Image.open(io.BytesIO(report.screenshot())).convert("RGB")

    def pixel(x: float, y: float) -> tuple[int, int, int]:
        return picture.getpixel(tuple(round(part) for part in place(report, x, y)))

    air, base = pixel(4.0, 1.7), pixel(4.5, 0.5)
    assert (sum(air) > 3 * 220) == (theme == "light")
    # The free block has the first colour of Okabe and Ito, whitened by 0.4, the held base a neutral one.
    assert pixel(1.5, 1.3) == (240, 197, 102)
    assert base != air and max(base) - min(base) < 30
    quiet(report)


def test_bolts_supports_and_water_are_drawn(enmm, page, cases, tmp_path):
    answer = enmm("run", cases / "plane_slide.toml", "-o", tmp_path / "out", "--quiet", "--set", "output.pictures=false")
    assert answer.returncode == 0, answer.stderr
    page.open((tmp_path / "out" / "report.html").as_uri())
    page.painted()
    last = {part: meshio.read(max((tmp_path / "out" / "frames").glob(f"{part}_*.vtu"))) for part in ("bolts", "water")}
    (forces,) = last["bolts"].cell_data["force"]
    at_end = "enmm.film.frames.at(-1)"
    found = page.run(f"Array.from({at_end}.bolts.force)")
    assert len(found) == 4 and all(close(a, b) for a, b in zip(found, forces))
    assert page.run("enmm.film.head.bolts.map(({name}) => name)") == [f"row_{k}" for k in (1, 2, 3, 4)]
    # Held sides and base: triangles and rollers, nothing that absorbs waves.
    assert set(page.run(f"Array.from({at_end}.supports.sign)")) <= {1, 2, 3}
    assert page.run(f"{at_end}.supports.sign.length") > 20
    # The greatest pressure is that of the frame for ParaView.
    pressure = page.run(f"drawPressure(enmm.slope, {at_end}, enmm.theme)")
    assert pressure == pytest.approx(last["water"].point_data["water_pressure"].max(), rel=1e-3)
    places = [(0.7 * head + 0.3 * end)[:2].tolist() for head, end in last["bolts"].points.reshape(-1, 2, 3)]

    def drawn() -> list[bool]:
        """Whether each bolt has its colour, #be125a, but for smoothing."""
        picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
        # The pixel that holds the place: its neighbour may be smoothed.
        pixels = [picture.getpixel(tuple(int(part) for part in place(page, x, y))) for x, y in places]
        return [max(abs(a - b) for a, b in zip(pixel, (190, 18, 90))) < 60 for pixel in pixels]

    assert all(drawn())
    page.run("document.getElementById('structures').click()")
    page.painted()
    assert not any(drawn())
    quiet(page)


def test_a_page_follows_a_block_that_breaks_and_lists_the_break(enmm, page, cases, tmp_path):
    case = cases.parent / "breaking" / "overhang.toml"
    answer = enmm("run", case, "-o", tmp_path / "out", "--quiet", "--set", "output.pictures=false")
    assert answer.returncode == 0, answer.stderr
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    (broken,) = summary["breaks"]
    page.open((tmp_path / "out" / "report.html").as_uri())
    page.painted()
    # The parts after the break: two blocks before, one more behind it, which falls in one frame after the other.
    counts = page.run("enmm.film.frames.map(({time, shape}) => [time, shape.count])")
    assert all(count == (2 if time < broken["time"] else 3) for time, count in counts)
    assert {count for _, count in counts} == {2, 3}
    page.run("enmm.player.seek(enmm.film.end)")
    page.painted()
    falls = f"enmm.film.shape.places.get({broken['block']})"
    assert page.run(f"enmm.film.frames.at(-1).displacement_y[{falls}]") < -2.5
    assert "3 blocks" in page.run("document.getElementById('subtitle').textContent")
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    sky, rock = (picture.getpixel(tuple(round(part) for part in place(page, 15.5, y))) for y in (13.0, 9.5))
    assert sky != rock, "where the overhang was there is air, and it lies below"
    # The list: when, what and how, then where and the forces.
    lines = page.run("[...document.querySelectorAll('#breaks tbody tr')].map(row => row.innerText)")
    assert len(lines) == 2 and "by bending" in lines[0] and f"{broken['share']:.3f}" in lines[0]
    assert f"\t{broken['block']}\t" in lines[0] and f"Block {broken['part']} parts off." in lines[1]
    assert lines[1].startswith("(13.00, 10.00) to (13.00, 14.00) m: N ")
    forces = dict(re.findall(r"([NVM]) (−?[\d.]+) M?k?N", lines[1]))
    for name, key in (("N", "normal"), ("V", "shear"), ("M", "moment")):
        weights = [float(forces[name].replace("−", "-")) * unit for unit in (1.0, 1e3, 1e6)]
        assert any(close(weight, broken[key]) for weight in weights), (name, lines[1])
    page.run("document.querySelector('#breaks button').click()")
    page.painted()
    shown_at = page.run("enmm.player.time")
    assert shown_at >= broken["time"] and page.run("enmm.film.shape.count") == 3
    # The colour: shares from 0 to 1, by the name of blocks.csv, whose last column it is.
    page.run("document.querySelector('[data-colour=strength_share]').click()")
    page.painted()
    assert page.run("enmm.limits") == [0, 1]
    legend = page.run("document.getElementById('legend').innerText").split("\n")
    assert legend[0] == "Share of strength, worst section" and legend[-1] == "1.000"
    rows = table(tmp_path / "out" / "blocks.csv")
    last = page.run("Array.from(enmm.film.frames.at(-1).strength_share)")
    places = dict(page.run("[...enmm.film.shape.places]"))
    assert len(last) == len(rows) == 3
    assert all(close(last[places[int(row["id"])]], float(row["strength_share"])) for row in rows)
    frame = meshio.read(max((tmp_path / "out" / "frames").glob("elements_*.vtu")))
    assert set(frame.cell_data["strength_share"][0]) <= {float(row["strength_share"]) for row in rows}
    quiet(page)


# Dug slowly, the overhang of the examples has 3ρgL²/t of its weight at its root: 0.56 of its strength.
def test_a_page_names_the_block_nearest_to_breaking(enmm, page, cases, tmp_path):
    case = (cases.parent / "breaking" / "overhang.toml").read_text()
    slow = tmp_path / "slow.toml"
    slow.write_text(case.replace('kind = "dynamic"\nduration = 0.8\ndamping = 0.02', 'kind = "static"\nduration_max = 5.0'))
    answer = enmm("run", slow, "-o", tmp_path / "out", "--quiet", "--set", 'output.pictures=["strength"]')
    assert answer.returncode == 0, answer.stderr
    assert (tmp_path / "out" / "stage2_strength.png").exists()
    worst = json.loads((tmp_path / "out" / "summary.json").read_text())["worst_sections"][0]
    assert worst["failure"] == "bends" and worst["share"] == pytest.approx(0.4782 / 0.85, rel=2e-3)
    page.open((tmp_path / "out" / "report.html").as_uri())
    page.painted()
    assert page.run("document.getElementById('breaks')") is None
    facts = page.run(
        "[...document.querySelectorAll('#panel section')].find(({innerText}) => innerText.startsWith('Nearest to breaking'))"
        ".innerText"
    )
    for text in (f"Block\t{worst['block']}\n", "How\tby bending", "From\t(13.00, 10.00) m", "0.56"):
        assert text in facts, facts
    colours = page.run("Array.from(enmm.film.frames.at(-1).strength_share)")
    assert max(colours) == pytest.approx(worst["share"], rel=1e-4)
    quiet(page)


# Pages, tables and frames of rock that does not break are as they were.
def test_results_of_rock_that_does_not_break_know_no_strength(report, results):
    assert "strength_share" not in (results / "blocks.csv").read_text()
    assert "function breaksSection" not in (results / "report.html").read_text()
    assert report.run("document.querySelector('[data-colour=strength_share]')") is None
    assert report.run("document.getElementById('breaks')") is None


@pytest.mark.parametrize("size", [(390, 800), (1440, 900)])
def test_nothing_hides_the_slope_and_play_is_in_reach(program, results, tmp_path, size):
    page = browser.Browser(program, tmp_path / "profile", size)
    try:
        page.open((results / "report.html").as_uri())
        page.painted()
        # Colours, their scale and zoom end above the slope; every control is whole within the width.
        assert page.run("document.getElementById('bar').getBoundingClientRect().bottom"
                        " <= document.getElementById('slope').getBoundingClientRect().top + 1")
        assert page.run("document.documentElement.scrollWidth <= innerWidth")
        cut = "[...document.querySelectorAll('button, select')].filter(e => e.offsetParent && !e.closest('dialog')"
        cut += " && (e.getBoundingClientRect().right > innerWidth || e.scrollWidth > e.clientWidth + 1)).map(e => e.id)"
        assert page.run(cut) == []
        assert page.run("document.getElementById('play').getBoundingClientRect().bottom <= innerHeight")
        quiet(page)
    finally:
        page.close()


def test_a_question_mark_shows_the_keys(report):
    report.press("?")
    assert report.run("document.getElementById('keys').open")
    assert "play or pause" in report.run("document.getElementById('keys').textContent")
    report.press("Escape")
    assert not report.run("document.getElementById('keys').open")
    quiet(report)


def test_a_link_leads_to_its_moment_and_colour(report, results):
    middle = report.run("0.5 * (enmm.film.start + enmm.film.end)")
    report.run(f"enmm.player.seek({middle})")
    report.press("3")
    report.run("enmm.copyLink()")
    address = report.run("location.href")
    report.call("Page.navigate", url="about:blank")
    report.open(address)
    assert report.run("enmm.player.time") == pytest.approx(middle, rel=1e-8)
    assert report.run("enmm.colour.key") == "stress"
    # A link that names no moment, or a wrong one, leaves the page at its end.
    report.call("Page.navigate", url="about:blank")
    report.open((results / "report.html").as_uri() + "#t=soon&colour=nonsense")
    assert report.run("enmm.player.time === enmm.film.end")
    assert report.errors == []


def test_picture_and_table_hold_what_is_shown(report, results):
    picture = report.run("enmm.picture().toDataURL('image/png').split(',')[1]")
    picture = Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB")
    width, height = report.run("[document.getElementById('slope').width, document.getElementById('slope').height]")
    assert picture.size == (width, height + 44)
    assert len(picture.getcolors(1 << 20)) > 20
    table = list(csv.reader(io.StringIO(report.run("csvOf(enmm.film)"))))
    rows = list(csv.reader((results / "history.csv").open()))
    assert len(table) == len(rows) and len(table[0]) == len(rows[0])
    for mine, theirs in zip(table[1:], rows[1:]):
        assert all(close(float(a), float(b)) for a, b in zip(mine, theirs))
    quiet(report)


def test_the_film_button_saves_what_plays(report, tmp_path):
    report.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path / "saved"))
    assert not report.run("document.getElementById('save-film').hidden"), "Chromium can record"
    report.run("document.getElementById('save-film').click()")
    assert report.run("document.getElementById('save-film').disabled && enmm.player.playing")
    report.wait("!document.getElementById('save-film').disabled")
    assert report.run("enmm.player.time === enmm.film.end")
    until = time.monotonic() + 20
    while not (saved := list((tmp_path / "saved").glob("*.webm"))) and time.monotonic() < until:
        time.sleep(0.05)
    assert [path.name for path in saved] == ["short.webm"]
    film = saved[0].read_bytes()
    assert film.startswith(b"\x1aE\xdf\xa3") and re.search(rb"V_(VP8|VP9|AV1|MPEG4)", film), "a film of pictures"
    # The pictures differ: a browser plays the film, and the slope is elsewhere at its end.
    shown = """(async () => {
        const video = document.createElement('video');
        video.src = URL.createObjectURL(new Blob([Uint8Array.from(atob('%s'), (c) => c.charCodeAt(0))]));
        video.muted = true;
        await new Promise((good, bad) => { video.onloadeddata = good; video.onerror = bad; });
        const pen = Object.assign(document.createElement('canvas'), { width: 64, height: 64 }).getContext('2d');
        const grab = () => { pen.drawImage(video, 0, 0, 64, 64); return pen.getImageData(0, 0, 64, 64).data.join(); };
        const first = grab();
        video.play();
        await new Promise((done) => { video.onended = done; });
        return [video.videoWidth, video.videoHeight, first !== grab()];
    })()""" % base64.b64encode(film).decode()
    size = report.run("[document.getElementById('slope').width, document.getElementById('slope').height]")
    report.call("Page.navigate", url="about:blank")
    width, height, differ = report.run(shown)
    # Encoders take even sizes.
    assert abs(width - size[0]) <= 1 and abs(height - size[1]) <= 1 and differ


def numbers_of_elements(page, key: str) -> list[float]:
    return page.run(f"Array.from(numbersOfElements(enmm.film.frames.at(-1), {key!r}))")


def test_elements_have_the_numbers_of_the_frames(report, results):
    last = meshio.read(max((results / "frames").glob("elements_*.vtu")))
    quantum = report.run("enmm.film.frames.at(-1).elements.stress.quantum")
    for key, name in (("stress", "mean_stress"), ("shear", "max_shear")):
        # meshio sorts elements by their number of corners; the largest error of sorted numbers is no larger.
        wanted = sorted(value for values in last.cell_data[name] for value in values)
        found = sorted(numbers_of_elements(report, key))
        assert len(found) == len(wanted) > 20
        assert max(abs(a - b) for a, b in zip(found, wanted)) <= 1.5 * quantum
        assert quantum <= 0.05 * max(map(abs, wanted))
    # The free block moves by the numbers of its points, the held one not at all.
    moved = max((last.point_data["displacement"] ** 2).sum(axis=1)) ** 0.5
    assert max(numbers_of_elements(report, "displacement")) == pytest.approx(moved, rel=0.01)
    speed = max((last.point_data["velocity"] ** 2).sum(axis=1)) ** 0.5
    assert max(numbers_of_elements(report, "velocity")) == pytest.approx(speed, rel=0.03)
    quiet(report)


def test_joints_have_the_slip_of_the_frames(report, results):
    joints = meshio.read(max((results / "frames").glob("joints_*.vtu")))
    wanted = max(max(values) for values in joints.cell_data["slip"])
    found = report.run("Array.from(numbersOfJoints(enmm.film.frames.at(-1), 'slip'))")
    assert wanted > 0.01 and max(found) == pytest.approx(wanted, rel=0.05)
    quiet(report)


def test_each_element_has_its_colour(report):
    report.run("document.querySelector('[data-colour=stress]').click()")
    report.painted()
    # Away from outlines and marks: pixels of middles of elements of the held block.
    wrong = report.run("""(() => {
        const { film, slope, limits } = enmm, frame = film.frames.at(-1), numbers = numbersOfElements(frame, "stress");
        const ratio = slope.canvas.width / slope.canvas.clientWidth, wrong = [], seen = new Set();
        eachElement(frame, (e) => {
            const at = middleOfElement(slope, e).map((part) => Math.floor(part * ratio)),
                step = stepOf(numbers[e], limits, false), wanted = RAMPS.cividis[step].match(/\\d+/g).map(Number);
            const found = [...slope.pen.getImageData(...at, 1, 1).data].slice(0, 3);
            seen.add(step);
            if (found.join() !== wanted.join()) wrong.push([e, found, wanted]);
        });
        return [wrong.length, film.shape.elements, seen.size];
    })()""")
    # Marks of monitors and outlines may lie on a few.
    assert wrong[0] <= 0.2 * wrong[1] and wrong[2] > 3, wrong
    report.errors[:] = [error for error in report.errors if "willReadFrequently" not in error]
    quiet(report)


def heads(page) -> list[str]:
    return page.run("[...document.querySelectorAll('#probe h2, #choice h2')].map((head) => head.textContent)")


def test_a_click_reads_the_element_and_the_joint(report):
    # The joint lies at y = 1 between x = 1 and 2; the block has slid to the right and lies on the base.
    report.click(*place(report, 1.6, 1.0))
    assert "Joint" in heads(report)
    rows = "[...document.querySelectorAll('#probe tr')].map((row) => [...row.children].map((cell) => cell.textContent))"
    names = [name for name, _ in report.run(rows)]
    assert names[-3:] == ["State", "Opening", "Slip"]
    charts = "[...document.querySelectorAll('#chart-quantity option')].map(({textContent}) => textContent)"
    assert "Joint: opening and slip (m)" in report.run(charts)
    report.click(*place(report, 1.5, 1.5))
    assert heads(report) == ["Element", "Block 0"] or heads(report) == ["Element", "Block 1"]
    found = dict(report.run(rows))
    e, k = report.run("[enmm.choice.element, enmm.choice.block]")
    stress = report.run(f"stressOfElement(enmm.film.frames.at(-1), {e}, {k})")
    assert close(number(found["σxx"]), stress[0]) and close(number(found["σyy"]), stress[1])
    assert {"Element: stress (Pa)", "Element: speed (m/s)"} <= set(report.run(charts))
    series = report.run("enmm.charts.find(({name}) => name.startsWith('Element: stress')).series[2]")
    assert close(series["values"][-1] if isinstance(series["values"], list) else 0.5 * sum(stress[:2]), 0.5 * sum(stress[:2]))
    assert len(series["time"]) > 1
    quiet(report)


def test_keys_choose_a_place(report):
    report.run("document.getElementById('slope').focus()")

    def shift(key: str) -> None:
        for kind in ("keyDown", "keyUp"):
            report.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, modifiers=8)
        report.painted()

    shift("ArrowDown")
    begun = report.run("enmm.cursor")
    for _ in range(12):
        shift("ArrowDown")
    assert report.run("enmm.cursor") == [begun[0], begun[1] + 8 * 12]
    assert heads(report)[-1].startswith("Block") and "Element" in heads(report)
    assert report.run("document.getElementById('found').textContent") == ", ".join(heads(report))
    report.press("Escape")
    assert report.run("enmm.cursor") is None and heads(report) == ["Numbers"]
    quiet(report)


# Crosses have two lines for each element: thin ones of compression alone, or thick ones of tension.
def test_crosses_can_be_switched_on(report):
    picture = "enmm.picture().toDataURL()"
    before = report.run(picture)
    report.run("document.getElementById('crosses').click()")
    report.painted()
    assert report.run(picture) != before
    report.run("document.getElementById('crosses').click()")
    report.painted()
    assert report.run(picture) == before
    quiet(report)


def test_the_page_of_fos_shows_the_trial_that_fails(enmm, page, cases, tmp_path):
    answer = enmm("fos", cases / "plane_slide.toml", "-o", tmp_path, "--json")
    assert answer.returncode == 0, answer.stderr
    page.open((tmp_path / "report.html").as_uri())
    page.painted()
    times = page.run("enmm.film.frames.map(({time}) => time)")
    assert len(times) == 20 and times[0] == 0 and times == sorted(set(times))
    assert page.run("enmm.film.frames.every(({elements, time}) => elements && elements.time === time)")
    record = json.loads((tmp_path / "fos.json").read_text())
    fails = next(block for block in record["failing_blocks"])
    moved = page.run(f"""enmm.film.frames.map(({{displacement_x: x, displacement_y: y, shape}}) => {{
        const k = shape.places.get({fails["block"]});
        return Math.hypot(x[k], y[k]);
    }})""")
    # It begins at rest and goes on and on.
    assert moved[-1] - moved[0] == pytest.approx(fails["displacement"], rel=0.05)
    assert moved[10] - moved[0] < 0.7 * (moved[-1] - moved[0])
    quiet(page)


@pytest.fixture
def edited(short_case, tmp_path):
    """`enmm edit` on a copy of the short case: the file and the address of its page."""
    case = tmp_path / "edited.toml"
    case.write_text(short_case.read_text())
    command = [from_environment("ENMM_BIN"), "edit", case]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        yield case, re.search(r"http://127\.0\.0\.1:\d+/", process.stdout.readline()).group()
        process.terminate()


def test_the_editor_keeps_the_part_in_sight_at_each_save(edited, page):
    case, address = edited
    page.call("Page.navigate", url=address)
    page.wait("document.body?.dataset.shown === '1'")
    model = "document.querySelector('#model iframe').contentWindow.enmm"
    whole = page.run(f"{model}.sight()")
    assert whole["part"] is None
    page.run(f"{model}.slope.zoom(3, 40, 60); {model}.slope.pan(25, -10); {model}.refresh()")
    page.run(f"{model}.switchTheme()")
    before, origin = page.run(f"{model}.sight()"), page.run(f"{model}.film.shape.originX")
    assert before["part"]["scale"] > 0 and before["theme"] != whole["theme"]
    text = case.read_text()
    # More rock moves the origin of the film.
    case.write_text(text.replace("[6, 0], [6, 1]", "[9, 0], [9, 1]"))
    page.wait("document.body.dataset.shown === '2'")
    page.painted()
    after = page.run(f"{model}.sight()")
    assert page.run(f"{model}.film.shape.originX") != origin
    for name, value in before["part"].items():
        assert after["part"][name] == pytest.approx(value, rel=1e-12, abs=1e-9)
    assert (after["colour"], after["theme"]) == (before["colour"], before["theme"])
    page.run(f"{model}.slope.fit()")
    case.write_text(text)
    page.wait("document.body.dataset.shown === '3'")
    assert page.run(f"{model}.sight()")["part"] is None, "the whole slope stays the whole slope"
    assert page.errors == []


def test_a_hostile_title_stays_text(enmm, page, tmp_path, short_case):
    hostile = "</script><script>window.stolen = 1</script>"
    text = short_case.read_text().replace("Short run for the Python tests", hostile)
    case = tmp_path / "case.toml"
    case.write_text(text)
    answer = enmm("run", case, "-o", tmp_path / "out", "--quiet")
    assert answer.returncode == 0, answer.stderr
    page.open((tmp_path / "out" / "report.html").as_uri())
    assert page.run("window.stolen") is None
    assert page.run("document.getElementById('title').textContent").startswith("</script>")
    quiet(page)


def test_bound_marks_the_mechanism(enmm, page, tmp_path, cases):
    answer = enmm("bound", cases / "plane_slide.toml", "-o", tmp_path, "--json")
    assert answer.returncode == 0, answer.stderr
    level = json.loads(answer.stdout)["level_tops"]
    page.open((tmp_path / "report.html").as_uri())
    marked = page.run("enmm.film.of('marked').map(({blocks}) => blocks)")
    assert marked == [[moving["block"] for moving in level["mechanism"]]]
    assert f"{level['factor']:.4f}" in page.run("document.getElementById('panel').textContent")
    quiet(page)


@pytest.fixture
def served(results, tmp_path):
    """A folder with the first half of a film, `enmm view` on it, its address, and all bytes of the film."""
    film = (results / "film.bin").read_bytes()
    (tmp_path / "film.bin").write_bytes(film[: len(film) // 2])
    command = [from_environment("ENMM_BIN"), "view", tmp_path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        address = re.search(r"http://127\.0\.0\.1:\d+/", process.stdout.readline()).group()
        yield tmp_path, address, film
        process.terminate()


def test_view_follows_a_run_that_goes_on(served, page):
    folder, address, film = served
    page.open(address)
    early = page.run("enmm.film.frames.length")
    assert page.run("document.getElementById('status').textContent") == "still running"
    with (folder / "film.bin").open("ab") as file:
        file.write(film[len(film) // 2 :])
    page.wait("enmm.film.of('end').length > 0")
    page.painted()
    assert page.run("enmm.film.frames.length") > early > 0
    assert page.run("enmm.player.time === enmm.film.end")
    assert page.run("document.getElementById('status').textContent") == ""
    assert page.errors == []
    assert all(request.startswith(address) for request in page.requests)


def test_view_serves_the_film_and_nothing_else(served):
    _, address, film = served
    with urllib.request.urlopen(f"{address}film?from=8") as answer:
        assert answer.read() == film[8 : len(film) // 2]
    refusals = [("../short.toml", {}, 404), (f"film?from={10 * len(film)}", {}, 416), ("film?from=x", {}, 400)]
    refusals.append(("", {"Host": "rocks.example"}, 403))
    for path, headers, status in refusals:
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(urllib.request.Request(address + path, headers=headers))
        assert refused.value.code == status


def test_view_makes_the_page_of_a_killed_run(enmm, results, tmp_path, page):
    shutil.copy(results / "film.bin", tmp_path)
    whole = (tmp_path / "film.bin").read_bytes()
    (tmp_path / "film.bin").write_bytes(whole[: 2 * len(whole) // 3])
    answer = enmm("view", tmp_path, "--page")
    assert answer.returncode == 0, answer.stderr
    page.open((tmp_path / "report.html").as_uri())
    assert page.run("document.getElementById('status').textContent") == "not finished"
    assert page.run("enmm.film.frames.length") > 0
    quiet(page)
