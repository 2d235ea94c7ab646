"""Parameters by name through the Python package: one law, one state, many values."""

import math
import pickle

import numpy as np
import pytest


def run(model, steps, h=0.01):
    toe = model.ports["toe"]
    rows = []
    for _ in range(steps):
        model.do_step(model.time, h)
        state = toe.state()
        rows.append((state.displacement_x, state.displacement_y))
    return np.array(rows)


def test_parameters_have_names_units_and_ranges(package, slope):
    assert "joint_law.weak.friction" in slope.parameters
    friction = slope.parameters.info("joint_law.weak.friction")
    assert (friction.unit, friction.low, friction.tunable) == ("rad", 0.0, True)
    assert slope.parameters["joint_law.weak.friction"] == math.radians(26)
    assert not slope.parameters.info("rock.schist.young").tunable
    with pytest.raises(package.NotFoundError, match="joint_law.weak.friction"):
        slope.parameters["joint_law.strong.friction"]
    for bad in (math.nan, -0.1, 2.0):
        with pytest.raises(package.InvalidArgumentError, match="joint_law.weak.friction"):
            slope.parameters["joint_law.weak.friction"] = bad
    assert slope.parameters["joint_law.weak.friction"] == math.radians(26)
    with pytest.raises(TypeError):
        del slope.parameters["damping"]


def test_several_are_set_at_once_or_none(package, slope):
    slope.start()
    with pytest.raises(package.InvalidArgumentError, match="rock.schist.young"):
        slope.parameters.update({"damping": 0.3, "rock.schist.young": 1e9})
    assert slope.parameters["damping"] != 0.3
    slope.parameters.update({"damping": 0.3, "joint_law.weak.friction": 0.4})
    assert (slope.parameters["damping"], slope.parameters["joint_law.weak.friction"]) == (0.3, 0.4)


def test_the_friction_of_one_law_is_found_from_observations(slope):
    """A twin: of fifty states of one slope, each with its own friction of the weak plane, the best fits and goes on."""
    toe = slope.ports["toe"]
    slope.start()
    toe.set_force(0.45e6, 0.28e6)
    start = slope.save()
    slope.parameters["joint_law.weak.friction"] = math.radians(24.3)
    seen = run(slope, 10)

    def miss(friction):
        slope.restore(start)
        slope.parameters["joint_law.weak.friction"] = friction
        return float(np.sqrt(np.mean((run(slope, 10) - seen) ** 2)))

    frictions = np.radians(np.linspace(22, 27, 26))
    best = min(frictions, key=miss)
    assert math.degrees(best) == pytest.approx(24.3, abs=0.11)
    slope.restore(start)
    assert slope.parameters["joint_law.weak.friction"] == math.radians(26), "a state brings its parameters along"


def test_a_state_goes_into_a_model_with_another_friction(package, slope, cases):
    slope.start()
    run(slope, 2)
    state = slope.save()
    text = (cases / "coupled_slope.toml").read_text(encoding="utf-8").replace("friction_deg = 26", "friction_deg = 23")
    with package.Model.from_string(text) as other:
        with pytest.raises(package.StateError):
            other.restore(state)
        with pytest.raises(package.StateError):
            other.deserialize(slope.serialize(state))
        other.restore(state, keep_parameters=True)
        assert (other.time, other.parameters["joint_law.weak.friction"]) == (slope.time, math.radians(23))
        moved = run(other, 5)
        other.restore(other.deserialize(slope.serialize(state), keep_parameters=True))
        assert np.array_equal(run(other, 5), moved)
    slope.parameters["joint_law.weak.friction"] = math.radians(23)
    assert np.array_equal(run(slope, 5), moved)


def test_models_go_through_pickle_with_their_parameters(slope):
    slope.parameters["rock.schist.young"] = 4e9
    slope.start()
    slope.parameters["joint_law.weak.friction"] = math.radians(24)
    state = slope.save()
    with pickle.loads(pickle.dumps(slope)) as copy, pickle.loads(pickle.dumps(state)):
        assert dict(copy.parameters) == dict(slope.parameters)
        assert np.array_equal(run(copy, 5), run(slope, 5))


def test_a_tunable_parameter_of_an_fmu_acts_as_in_the_library(slope_fmu, opened, slope):
    name, toe = "joint_law.weak.friction", ("toe.displacement_x", "toe.displacement_y")
    instance = opened(slope_fmu).initialize()
    instance.run(3, 0.01)
    state = instance.save()
    instance.check(instance.set({name: math.radians(23)}))
    instance.run(5, 0.01, first=3)
    slope.start()
    run(slope, 3)
    slope.parameters[name] = math.radians(23)
    assert tuple(run(slope, 5)[-1]) == tuple(instance.get(*toe))
    assert instance.get(name) == [math.radians(23)]
    instance.check(instance.restore(state))
    assert instance.get(name) == [math.radians(26)]
    moved = instance.run(5, 0.01, first=3).get(*toe)
    assert moved != list(run(slope, 1)[-1])
    instance.check(instance.set({name: math.radians(23)}))
    assert instance.set({"rock.schist.young": 1e9}) == 3, "fixed parameters are refused"


def test_a_rollout_is_the_same_calls_one_by_one(package, slope):
    """Three frictions from one state, on one thread and on two."""
    name, frictions = "joint_law.weak.friction", np.radians([22.0, 24.0, 26.0])
    slope.start()
    run(slope, 2)
    state, stands = slope.save(), slope.time
    outputs = [("toe", "displacement_x"), ("toe", "displacement_y"), ("face", "stress_yy")]
    one = package.rollout(slope, state, {name: frictions}, steps=5, h=0.01, outputs=outputs)
    two = package.rollout(slope, [state] * 3, {name: frictions}, steps=5, h=0.01, outputs=outputs, threads=2)
    assert one.values.shape == (3, 5, 3) and np.array_equal(one.values, two.values)
    assert not one.statuses.any() and slope.time == stands
    for friction, rows in zip(frictions, one.values, strict=True):
        slope.restore(state)
        slope.parameters[name] = friction
        assert np.array_equal(run(slope, 5), rows[:, :2])
        assert slope.ports["face"].state().stress_yy == rows[-1, 2]
    with pytest.raises(package.InvalidArgumentError, match="slip_x"):
        package.rollout(slope, state, steps=1, outputs=[("toe", "slip_x")])
    with pytest.raises(package.InvalidArgumentError, match="samples"):
        package.rollout(slope, [state] * 2, {name: frictions}, steps=1, outputs=outputs)


def test_a_sample_that_fails_leaves_the_others(package, slope):
    slope.start()
    good = slope.save()
    slope.set_block_force(slope.ports["toe"].block, 1e15, 1e15)
    bad = slope.save()
    made = package.rollout(slope, [good, bad], steps=3, h=0.01, outputs=[("toe", "displacement_x")], threads=2)
    assert made.statuses.tolist() == [0, package.Status.NUMERICAL_FAILURE]
    assert np.isfinite(made.values[0]).all() and np.isnan(made.values[1]).any()


def test_models_step_together_with_the_same_bits(package, slope, cases):
    models = [package.Model.from_file(cases / "coupled_slope.toml") for _ in range(3)]
    for model, friction in zip(models, (22, 24, 26), strict=True):
        model.parameters["joint_law.weak.friction"] = math.radians(friction)
        model.start()
    alone = [model.save() for model in models]
    assert package.batch_step(models, 0.02, threads=2).tolist() == [0, 0, 0]
    moved = [model.serialize() for model in models]
    for model, state in zip(models, alone, strict=True):
        model.restore(state)
        model.do_step(model.time, 0.02)
    assert [model.serialize() for model in models] == moved
    with pytest.raises(package.InvalidArgumentError, match="threads"):
        package.batch_step(models, 0.02, threads=0)
    models[1].close()
    assert package.batch_step(models, 0.02, threads=2).tolist() == [0, package.Status.DEAD_HANDLE, 0]
