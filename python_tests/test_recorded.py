"""Results of a model that Python drives: those of `enmm run` to the bit, and a report of them."""

import json

import pytest

H = 0.01


@pytest.fixture
def case(package, cases):
    """A block that slides, over a short time and without pictures."""
    table = package.Case.from_file(cases / "block_on_incline.toml").to_dict()
    table["stage"][1]["duration"] = 0.1
    table["output"] = {"history_interval": 0.004, "frame_interval": 0.05, "pictures": False}
    return package.Case.from_dict(table)


def drive(model, steps):
    for _ in range(steps):
        model.do_step(model.time, H)


def rows(folder):
    return (folder / "history.csv").read_text(encoding="utf-8").splitlines()


def test_a_recorded_model_leaves_the_history_of_a_run(package, enmm, case, tmp_path):
    alone, coupled = tmp_path / "alone", tmp_path / "coupled"
    package.run(case, alone)
    with case.model() as model, model.record(coupled) as recording:
        assert recording.directory == coupled
        model.start()
        drive(model, 10)
    assert rows(coupled) == rows(alone)
    assert (coupled / "run.pvd").read_text() == (alone / "run.pvd").read_text()
    summary = json.loads((coupled / "summary.json").read_text(encoding="utf-8"))
    assert summary["coupled"] == {"communication_steps": 10, "returns": 0}
    assert summary["status"] == "finished" and [stage["name"] for stage in summary["stages"]] == ["settle", "slide"]
    # What the film of a host that drives the case shows, and the report on paper.
    assert (coupled / "report.html").stat().st_size > 50_000
    made = enmm("report", coupled)
    assert made.returncode == 0, made.stderr
    page = (coupled / "report_a4.html").read_text(encoding="utf-8")
    assert summary["verdict"] in page and "settle" in page


def test_a_run_goes_on_from_the_checkpoint_of_a_host(package, enmm, case, tmp_path):
    alone, coupled = tmp_path / "alone", tmp_path / "coupled"
    path = tmp_path / "case.toml"
    case.save(path)
    package.run(path, alone)
    with package.Model.from_file(path) as model, model.record(coupled):
        drive(model, 5)
    resumed = enmm("run", path, "--resume", coupled / "checkpoint.enmm", "-o", coupled)
    assert resumed.returncode == 0, resumed.stderr
    assert rows(coupled)[-1] == rows(alone)[-1]
    assert (coupled / "blocks.csv").read_text() == (alone / "blocks.csv").read_text()


def test_a_repeated_step_leaves_nothing_twice_and_a_frame_comes_on_request(package, case, tmp_path):
    with case.model() as model:
        model.record(tmp_path)
        model.start()
        for _ in range(5):
            before = model.save()
            drive(model, 1)
            model.restore(before)
            drive(model, 1)
        model.write_frame()
        times = [float(row.split(",")[0]) for row in rows(tmp_path)[1:]]
        assert times == sorted(set(times))
        assert f'timestep="{times[-1]!r}"' in (tmp_path / "run.pvd").read_text(encoding="utf-8")
        assert not (tmp_path / "summary.json").exists()
    # The end of the model ends the recording.
    assert json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["coupled"]["returns"] == 5


def test_recordings_that_cannot_be_are_errors(package, case, tmp_path):
    with case.model() as model:
        with pytest.raises(package.InvalidArgumentError, match="no results of this model are recorded"):
            model.write_frame()
        (tmp_path / "file").write_text("no folder", encoding="utf-8")
        with pytest.raises(package.CaseFileError, match="cannot write results"):
            model.record(tmp_path / "file")
        recording = model.record(tmp_path / "results")
        with pytest.raises(package.InvalidArgumentError, match="end that recording first"):
            model.record(tmp_path / "other")
    recording.close()
