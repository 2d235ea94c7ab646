"""The twin of a slope: strength from noisy monitors by an ensemble smoother, and a forecast from saved states."""

import importlib.util
import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest


@pytest.fixture(scope="module")
def twin(package):
    path = Path(__file__).parents[1] / "examples" / "coupling" / "twin.py"
    spec = importlib.util.spec_from_file_location("twin", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def result(twin):
    return twin.run()


def test_strength_is_found_within_a_deviation(twin, result):
    first, last = result["ensemble"][0], result["ensemble"][-1]
    mean, deviation = last.mean(axis=0), last.std(axis=0, ddof=1)
    assert last.shape == (50, 2) and len(result["ensemble"]) == 5
    assert np.all(np.abs(mean - result["true"]) < deviation)
    # The truth was no part of what the ensemble began with, and the monitors made it surer by far.
    assert np.all(np.abs(first.mean(axis=0) - result["true"]) > 0.1 * first.std(axis=0))
    assert np.all(deviation < 0.4 * first.std(axis=0, ddof=1))


def test_the_forecast_holds_the_true_slope(twin, result, tmp_path):
    ahead = round(10 * twin.MEASURED)
    truth, forecast = result["truth"], result["forecast"]
    assert forecast.shape == (50, *truth.shape)
    slipped = truth[-1, 2] - truth[ahead - 1, 2]
    assert slipped > 0.02, "the slope slips in the shaking that was not measured"
    low, high = np.quantile(forecast[:, -1, 2], [0.025, 0.975])
    assert low < truth[-1, 2] < high and high - low < 0.5 * slipped
    twin.draw(result, tmp_path / "twin.png")
    assert (tmp_path / "twin.png").read_bytes().startswith(b"\x89PNG")


def test_a_slope_goes_on_from_its_saved_state_with_the_same_bits(twin):
    values = {"friction_deg": 34.5, "cohesion": 45e3}
    whole, _ = twin.slip(values, twin.END)
    first, state = twin.slip(values)
    more, _ = twin.slip(values, twin.END, state)
    assert np.vstack([first, more]).tobytes() == whole.tobytes()


def test_the_ensemble_is_the_same_for_any_number_of_threads(twin):
    measured, _ = twin.slip(twin.TRUTH)
    with ThreadPoolExecutor(1) as executor:
        wanted = twin.smooth(measured, 6, executor, (2.0, 2.0))
    with ThreadPoolExecutor(4) as executor:
        assert np.array_equal(twin.smooth(measured, 6, executor, (2.0, 2.0)), wanted)


def test_the_smoother_is_exact_for_a_linear_slope(twin, monkeypatch):
    """Prior N(0, 5²), one datum with a deviation of 2: the posterior variance is 1/(1/25 + 1/4) = 3.448276."""

    class Linear:
        @staticmethod
        def map(_, values):
            return [(np.array([[of]]), None) for of in values]

    monkeypatch.setattr(twin, "parameters", lambda normals: normals[0])
    monkeypatch.setattr(twin, "PRIOR_MEAN", np.zeros(2))
    monkeypatch.setattr(twin, "PRIOR_SD", np.full(2, 5.0))
    monkeypatch.setattr(twin, "NOISE", 2.0)
    members = 20_000
    last = twin.smooth(np.array([[3.0]]), members, Linear)[-1][:, 0]
    variance = 1 / (1 / 25 + 1 / 4)
    assert variance == pytest.approx(3.448276, abs=1e-6)
    # Four standard errors of a variance and a mean of so many members, doubled for the gains, which are sampled too.
    assert last.var() == pytest.approx(variance, rel=8 * math.sqrt(2 / members))
    assert last.mean() == pytest.approx(variance * 3.0 / 4, abs=8 * math.sqrt(variance / members))
