"""The files that a run leaves, read as a user's script would read them."""

import csv
import json

PNG = b"\x89PNG\r\n\x1a\n"


def test_every_promised_file_is_there(results):
    names = ["summary.json", "history.csv", "blocks.csv", "run.pvd", "checkpoint.enmm", "report.html", "film.bin"]
    for name in names:
        assert (results / name).stat().st_size > 0, name
    assert sorted(results.glob("frames/*.vtu"))
    pictures = sorted(results.glob("*.png"))
    assert pictures
    for picture in pictures:
        assert picture.read_bytes().startswith(PNG), picture


def test_summary_is_json_without_non_numbers(results):
    def refuse(word):
        raise ValueError(word)

    summary = json.loads((results / "summary.json").read_text(), parse_constant=refuse)
    assert isinstance(summary, dict) and summary


def test_history_has_a_header_and_rising_times(results):
    with (results / "history.csv").open(newline="") as file:
        header, *rows = list(csv.reader(file))
    assert len(rows) > 2
    assert all(len(row) == len(header) for row in rows)
    times = [float(row[0]) for row in rows]
    assert all(a < b for a, b in zip(times, times[1:]))


def test_check_counts_the_blocks_of_the_short_case(enmm, short_case):
    answer = enmm("check", short_case, "--json")
    assert answer.returncode == 0, answer.stderr
    model = json.loads(answer.stdout)
    # A base of 6 m × 1 m and a block of 1 m × 1 m on it, parted by one joint.
    assert model["blocks"] == 2
    assert abs(model["total_area"] - 7.0) < 1e-9
    assert [round(area, 9) for area in model["block_areas"]] == [1.0, 6.0]


def test_bad_input_exits_with_2_and_one_line(enmm, tmp_path):
    missing = enmm("check", tmp_path / "absent.toml")
    assert missing.returncode == 2
    assert missing.stderr.startswith("error: ")
    assert len(missing.stderr.strip().splitlines()) == 1
