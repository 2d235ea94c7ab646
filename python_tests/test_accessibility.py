"""The pages pass the checks of axe-core, on a telephone and on a desk, in both themes where they have them."""

import re
import subprocess
from pathlib import Path

import browser
import pytest
from conftest import from_environment

# The rules of WCAG 2.1 A and AA, and what axe calls best practices.
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]
SIZES = [(390, 844), (1440, 900)]


@pytest.fixture(scope="module")
def axe() -> str:
    """The script of axe-core; its package is there with the tests of pages alone."""
    package = pytest.importorskip("axe_core_python", reason="axe-core-python is not installed")
    return (Path(package.__file__).parent / "axe.min.js").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def pages(enmm, results, cases, short_case, tmp_path_factory):
    """The addresses of a page of a run, of one in which rock breaks, of a factor of safety, of a report on paper and of the editor."""
    place = tmp_path_factory.mktemp("pages")
    found = enmm("fos", cases / "plane_slide.toml", "-o", place / "fos")
    assert found.returncode == 0, found.stderr
    made = enmm("report", place / "fos", "--no-pdf")
    assert made.returncode == 0, made.stderr
    broken = enmm("run", cases.parent / "breaking" / "overhang.toml", "-o", place / "breaks", "--quiet")
    assert broken.returncode == 0, broken.stderr
    case = place / "edited.toml"
    case.write_text(short_case.read_text())
    command = [from_environment("ENMM_BIN"), "edit", case, "--face", "60/90"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        yield {
            "run": (results / "report.html").as_uri(),
            "fos": (place / "fos" / "report.html").as_uri(),
            "breaks": (place / "breaks" / "report.html").as_uri(),
            "paper": (place / "fos" / "report_a4.html").as_uri(),
            "edit": re.search(r"http://127\.0\.0\.1:\d+/", process.stdout.readline()).group(),
        }
        process.terminate()


def found_by(page, axe: str) -> list[str]:
    """What axe objects to: rule, and the element."""
    page.run(axe + "; null")
    tags = {"runOnly": {"type": "tag", "values": RULES}}
    answer = page.run(
        f"axe.run(document, {tags}).then(({{violations, passes}}) => ({{passed: passes.length, wrong: violations.flatMap("
        "({id, nodes}) => nodes.map(({html, any}) => `${id}: ${html.slice(0, 200)} ${any.map(a => a.message)}`))}))"
    )
    assert answer["passed"] > 10, "axe looked at the page"
    return answer["wrong"]


@pytest.mark.parametrize("size", SIZES, ids=["telephone", "desk"])
@pytest.mark.parametrize("name", ["run", "fos", "breaks", "paper", "edit"])
def test_axe_has_no_objection(program, axe, pages, tmp_path, name, size):
    page = browser.Browser(program, tmp_path / "profile", size)
    try:
        # The pages of results forbid scripts of others.
        page.call("Page.setBypassCSP", enabled=True)
        if name in ("run", "fos", "breaks"):
            page.open(pages[name])
        else:
            page.call("Page.navigate", url=pages[name])
            ready = "document.body.dataset.shown > 0 && !document.getElementById('net').hidden" if name == "edit" else "true"
            page.wait(f"document.readyState === 'complete' && document.querySelector('main, #model') && {ready}")
        page.painted()
        for theme in ["light", "dark"] if name in ("run", "fos", "breaks") else [None]:
            if theme:
                page.run(f"document.documentElement.dataset.theme !== '{theme}' && document.getElementById('theme').click()")
            assert found_by(page, axe) == [], theme
        if name == "run":
            page.press("?")
            assert found_by(page, axe) == [], "the keys"
    finally:
        page.close()


def test_axe_sees_what_is_wrong(program, axe, tmp_path):
    """A page with an unnamed button, a picture without words and faint text."""
    wrong = tmp_path / "wrong.html"
    wrong.write_text("<html><title>x</title><main><button></button><img src='x.png'><p style='color:#ccc'>faint</p>")
    page = browser.Browser(program, tmp_path / "profile", SIZES[1])
    try:
        page.call("Page.navigate", url=wrong.as_uri())
        page.wait("document.readyState === 'complete'")
        page.run(axe + "; null")
        rules = page.run("axe.run().then(({violations}) => violations.map(({id}) => id))")
        assert {"button-name", "color-contrast", "html-has-lang", "image-alt"} <= set(rules)
    finally:
        page.close()
