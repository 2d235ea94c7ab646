"""The notebooks run from their first cell to their last; their own assertions compare with closed forms."""

from pathlib import Path

import nbclient
import nbformat
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[1] / "examples" / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs_and_draws(path, package):
    notebook = nbformat.read(path, as_version=4)
    kept = [printed(cell) for cell in notebook.cells]
    pictures = sum("image/png" in out.get("data", {}) for cell in notebook.cells for out in cell.get("outputs", []))
    assert pictures >= 2, "the notebook is kept with its pictures"
    execute(notebook, path.parent)
    assert [printed(cell) for cell in notebook.cells] == kept, "what it is kept with is what it prints"
    shown = [kind for cell in notebook.cells for out in cell.get("outputs", []) for kind in out.get("data", {})]
    assert shown.count("image/png") >= 2, "pictures are drawn"


def printed(cell) -> str:
    """What a cell prints."""
    return "".join(out["text"] for out in cell.get("outputs", []) if out.output_type == "stream")


def execute(notebook, folder):
    client = nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}})
    client.execute()


def test_a_notebook_has_bars_pages_and_tables_without_being_asked(package, short_case, tmp_path):
    case = str(short_case)
    lines = [
        "import enmm",
        # What is shown on the way stays here, since the bar goes at its end.
        "from IPython import display as shown",
        "seen = []",
        "class Heard(shown.HTML):",
        "    def __init__(self, data=None, **rest):",
        "        super().__init__(data, **rest)",
        "        seen.append(data)",
        "shown.HTML = Heard",
    ]
    cells = [
        "\n".join(lines),
        f"result = enmm.run({case!r}); result",
        "result.show(300)",
        "found = enmm.fos('../cases/block_on_incline.toml', tolerance=0.05); found",
        "print(sum('<progress' in page for page in seen), seen[-1] == '', any('trial 2 of' in page for page in seen))",
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    execute(notebook, NOTEBOOKS[0].parent)
    pages = ["".join(out.get("data", {}).get("text/html", "") for out in cell.outputs) for cell in notebook.cells]
    assert "stage slide" in pages[1] and "data:image/png" in pages[1]
    assert "<iframe" in pages[2] and "height:300px" in pages[2]
    assert "factor of safety" in pages[3] and "limit analysis" in pages[3]
    assert not any("<progress" in page for page in pages), "bars go away"
    count, ended, trials = printed(notebook.cells[4]).split()
    assert int(count) > 3 and (ended, trials) == ("True", "True")


def test_a_folder_of_a_stranger_reaches_neither_the_notebook_nor_other_files(package, tmp_path):
    from enmm import _html

    page = tmp_path / "report.html"
    page.write_text("<script>parent.document.title = 'taken'</script>")
    frame = _html.frame(page, 300)
    assert 'sandbox="allow-scripts allow-downloads"' in frame and "taken" in frame
    picture, secret = tmp_path / "deformed.png", tmp_path / "secret"
    secret.write_bytes(b"\x89PNG\r\n")
    assert "base64" in _html.picture(secret, "a picture")
    picture.symlink_to(secret)
    assert _html.picture(picture, "a picture") == ""
    secret.write_bytes(b"no picture")
    assert _html.picture(secret, "a picture") == ""
    page.unlink()
    page.symlink_to(secret)
    with pytest.raises(package.InvalidArgumentError, match="no regular file"):
        _html.frame(page, 300)
