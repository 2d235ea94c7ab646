"""Prints how long the page of a run takes to draw once more, in each of its colours.

    python python_tests/redraw.py report.html

In milliseconds of processor time of the thread of the page, pixels included: other programs on the machine do not
count. Each redraw shows another frame, as playing does.
"""

import sys
import tempfile
from pathlib import Path

import browser

REDRAWS = 40
# Reading a pixel ends the drawing.
REDRAW = """(() => {
    const { film, player, slope } = enmm, frames = film.frames;
    for (let k = 0; k < %d; k++) {
        player.time = frames[frames.length - 1 - (k %% Math.min(20, frames.length))].time;
        enmm.draw();
        slope.pen.getImageData(0, 0, 1, 1);
    }
})()"""


def measure(page: browser.Browser) -> dict[str, float]:
    """Milliseconds of a redraw by colour."""
    def spent() -> float:
        metrics = page.call("Performance.getMetrics")["metrics"]
        return next(metric["value"] for metric in metrics if metric["name"] == "TaskDuration")

    found = {}
    for colour in page.run("[...document.querySelectorAll('[data-colour]')].map((button) => button.dataset.colour)"):
        page.run(f"document.querySelector('[data-colour={colour}]').click()")
        page.painted()
        page.run(REDRAW % 10)
        before = spent()
        page.run(REDRAW % REDRAWS)
        found[colour] = 1000 * (spent() - before) / REDRAWS
    return found


def main() -> None:
    report = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        page = browser.Browser(browser.find(), Path(folder) / "profile")
        try:
            page.call("Performance.enable", timeDomain="threadTicks")
            page.open(report.as_uri())
            page.painted()
            print(page.run("document.getElementById('subtitle').textContent"))
            for colour, time in measure(page).items():
                print(f"{colour:24} {time:6.1f} ms")
        finally:
            page.close()


if __name__ == "__main__":
    main()
