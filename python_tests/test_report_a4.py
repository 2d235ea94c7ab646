"""`enmm report` on paper: a browser prints it on A4 without cut text, and it shows no word of the method."""

import re
import shutil

import browser
import pytest

# Width of the text on A4 (CSS pixels): 210 mm less two margins of 14 mm.
WIDTH = round(182 / 25.4 * 96)
# Elements whose text is wider than they are, or that reach beyond the paper.
CUT = """[...document.querySelectorAll('h1, h2, h3, p, li, th, td, pre, figure, img, table')]
    .filter(e => e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== 'inline'
        || e.getBoundingClientRect().right > document.body.getBoundingClientRect().right + 1)
    .map(e => e.tagName + ' ' + e.textContent.slice(0, 60))"""
LONG = """
[report]
project = "Quarry North with a name that goes on and on, bench 3 of the eastern wall above the haul road"
author = "AnAuthorWhoseNameHasNoSpaceInItAndIsLongerThanTheLineOnThePaperThatItIsPrintedOnAsSomeNamesAre"

[section]
azimuth_deg = 75
"""


@pytest.fixture(scope="module")
def folder(enmm, short_case, tmp_path_factory):
    """Results of a run of the short case, with names that hardly fit."""
    place = tmp_path_factory.mktemp("paper")
    case = place / "case.toml"
    case.write_text(short_case.read_text() + LONG)
    ran = enmm("run", case, "-o", place / "out")
    assert ran.returncode == 0, ran.stderr
    return place / "out"


def test_the_pdf_has_pages_of_a4(program, enmm, folder):
    made = enmm("report", folder)
    assert made.returncode == 0, made.stderr
    pdf = (folder / "report_a4.pdf").read_bytes()
    assert pdf.startswith(b"%PDF-")
    boxes = {tuple(float(side) for side in box.split()) for box in re.findall(rb"/MediaBox ?\[([^]]*)\]", pdf)}
    # A4 in points, to the rounding of browsers.
    assert boxes and all(abs(w - 595.3) < 1 and abs(h - 841.9) < 1 for _, _, w, h in boxes), boxes
    assert len(re.findall(rb"/Type ?/Page\b", pdf)) >= 4
    assert made.stdout.count("report_a4") == 2
    left = {path.name for path in folder.iterdir() if path.name.endswith(".tmp")}
    assert not left, "no half-written file stays"


@pytest.mark.parametrize("width", [WIDTH, 390, 1440])
def test_no_text_is_cut(program, enmm, folder, tmp_path, width):
    assert enmm("report", folder, "--no-pdf").returncode == 0
    page = browser.Browser(program, tmp_path / "profile", (width, 1000))
    try:
        if width == WIDTH:
            page.call("Emulation.setEmulatedMedia", media="print")
        page.call("Page.navigate", url=(folder / "report_a4.html").as_uri())
        page.wait("document.readyState === 'complete' && document.querySelector('main') !== null")
        if width != 390:
            # On a telephone a wide table is moved under its finger.
            assert page.run(CUT) == []
        assert page.run("document.documentElement.scrollWidth <= innerWidth")
        assert page.run("[...document.images].every(i => i.complete && i.naturalWidth > 0 && i.alt.length > 0)")
        assert page.run("[...document.querySelectorAll('table')].every(t => t.querySelector('th[scope]'))")
        assert page.errors == [] and page.requests == []
    finally:
        page.close()


def test_an_old_pdf_does_not_stay_beside_a_new_report(enmm, folder):
    (folder / "report_a4.pdf").write_bytes(b"%PDF-old")
    assert enmm("report", folder, "--no-pdf").returncode == 0
    assert not (folder / "report_a4.pdf").exists()


def test_without_a_browser_the_page_says_how_to_print(enmm, folder, tmp_path, monkeypatch):
    shutil.copytree(folder, tmp_path / "out")
    monkeypatch.setenv("PATH", str(tmp_path))
    made = enmm("report", tmp_path / "out")
    assert made.returncode == 0, made.stderr
    assert "no PDF" in made.stdout and "--converter" in made.stdout
