"""Surfaces from measurements."""

import json

import arviz_base
import dynesty
import emcee
import nautilus
import numpy as np
import pyarrow.parquet
import pytest
import scipy.optimize

import coinmc
from coinmc._toml import document

CONFIG = {
    "coin": {"ratio": 1.5},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
    "counts": [{"heads": 190, "tails": 185, "side": 125}],
    "tilt": {"angle_deg": [16, 17, 18]},
    "bounces": [{"time_s": [0.0, 0.20, 0.302, 0.35]}],
}
SMALL = {"points": 128, "tosses": 64, "predicted": 2048}


@pytest.fixture(scope="module")
def found():
    return coinmc.calibrate(CONFIG, **SMALL)


@pytest.fixture(scope="module")
def summary(found):
    """Mean and standard deviation of each parameter by our own draws."""
    draws = np.column_stack([found.draws[name] for name in found.model.parameters])
    return draws.mean(axis=0), draws.std(axis=0)


def agree(samples, weights, summary, effective):
    """A sampler's mean and spread are ours: 5 standard errors of `effective` draws."""
    mean, sd = summary
    theirs = np.average(samples, axis=0, weights=weights)
    spread = np.sqrt(np.average((samples - theirs) ** 2, axis=0, weights=weights))
    assert np.all(np.abs(theirs - mean) < 5 * sd / np.sqrt(effective))
    assert np.all(np.abs(spread / sd - 1) < 5 / np.sqrt(2 * effective))


def test_the_answer_says_what_was_measured(found):
    assert found.model.measured.tolist()[:3] == [190, 185, 125]
    assert sorted(found.model.measured_names[3:]) == ["bounces 1", "tilt 1"]
    friction = found.parameters["friction"]
    assert friction["lo"] < np.tan(np.radians(17)) < friction["hi"]
    side = found.faces["side"]
    assert side["lo"] < side["p"] < side["hi"]
    assert found.next[0]["p_side_sd_after"] < side["parameter_error"]
    assert "P(side)" in repr(found)
    assert "friction" in found._repr_html_()


def test_the_command_gives_the_same_draws(found, command, tmp_path):
    config = tmp_path / "coin.toml"
    config.write_text(document(CONFIG))
    sizes = [f"--{name}={value}" for name, value in SMALL.items()]
    draws = tmp_path / "draws.parquet"
    command("calibrate", config, *sizes, "--posterior", draws)
    table = pyarrow.parquet.read_table(draws)
    assert table.column_names == list(found.draws)
    for name, values in found.draws.items():
        assert np.array_equal(table[name].to_numpy(), values)
    assert table.schema.field("friction").metadata[b"unit"] == b"1"
    told = json.loads(pyarrow.parquet.read_metadata(draws).metadata[b"coinmc.calibration"])
    assert told == found.document


def test_many_rows_are_the_same_as_one_at_a_time(found):
    model = found.model
    rows = np.random.default_rng(3).uniform([0.1, 0.1], [0.9, 0.6], (50, 2))
    together = model.log_prob(rows)
    assert together.tolist() == [model.log_prob(row) for row in rows]
    assert np.allclose(together, model.log_prior(rows) + model.log_likelihood(rows))
    assert model.log_prob([1.2, 0.3]) == -np.inf
    assert model.log_prob([0.5, -1]) == -np.inf
    with pytest.raises(ValueError, match="2 columns"):
        model.log_prob([0.5, 0.3, 0.1])
    # smooth: a small step changes it by little
    assert abs(model.log_prob([0.5, 0.3]) - model.log_prob([0.5, 0.3 + 1e-9])) < 1e-5


def test_simulations_scatter_as_measurements_do(found):
    model = found.model
    theta = np.tile([0.5, 0.3], (200, 1))
    simulated = model.simulate(theta, seed=5)
    assert simulated.shape == (200, 5)
    assert np.all(simulated[:, :3].sum(axis=1) == 500)
    assert np.array_equal(simulated, model.simulate(theta, seed=5))
    assert not np.array_equal(simulated, model.simulate(theta, seed=6))
    # three readings of 1°: 5 standard errors of 200 draws
    angle = simulated[:, model.measured_names.index("tilt 1")]
    expected = np.degrees(np.arctan(0.3))
    assert abs(angle.mean() - expected) < 5 / np.sqrt(3 * 200)
    assert abs(angle.std() * np.sqrt(3) - 1) < 5 / np.sqrt(2 * 200)


def test_scipy_finds_the_mode(found, summary):
    mean, sd = summary
    best = scipy.optimize.minimize(
        lambda theta: -found.model.log_prob(theta), mean, method="Nelder-Mead"
    )
    assert best.success
    assert np.all(np.abs(best.x - mean) < sd)


def test_emcee_agrees(found, summary):
    mean, sd = summary
    sampler = emcee.EnsembleSampler(32, 2, found.model.log_prob, vectorize=True)
    sampler._random.seed(1)
    start = mean + sd * np.random.default_rng(1).normal(size=(32, 2))
    sampler.run_mcmc(start, 400)
    # autocorrelation of some 30 steps
    agree(sampler.get_chain(discard=100, flat=True), None, summary, 32 * 300 / 30)


def test_dynesty_agrees(found, summary):
    sampler = dynesty.NestedSampler(
        found.model.log_likelihood,
        found.model.prior_transform,
        2,
        nlive=200,
        rstate=np.random.default_rng(1),
    )
    sampler.run_nested(print_progress=False)
    result = sampler.results
    agree(result.samples, result.importance_weights(), summary, 300)


def test_nautilus_agrees(found, summary):
    sampler = nautilus.Sampler(
        found.model.prior_transform,
        found.model.log_likelihood,
        n_dim=2,
        n_live=300,
        n_networks=1,
        vectorized=True,
        seed=1,
    )
    sampler.run(n_eff=2000)
    samples, log_weights, _ = sampler.posterior()
    agree(samples, np.exp(log_weights - log_weights.max()), summary, 2000)


def test_sbi_agrees(found, summary, tmp_path, monkeypatch):
    """It learns the posterior from simulated measurements alone, without our likelihood."""
    torch = pytest.importorskip("torch", reason="sbi is not installed: scripts/test --full does")
    inference = pytest.importorskip("sbi.inference")
    monkeypatch.chdir(tmp_path)  # it writes logs beside whoever calls it
    torch.manual_seed(1)
    model, (mean, sd) = found.model, summary
    theta = model.prior_transform(np.random.default_rng(1).uniform(size=(5000, 2)))
    measured = model.simulate(theta, seed=1)
    learner = inference.NPE(show_progress_bars=False)
    learner.append_simulations(*(torch.tensor(rows).float() for rows in (theta, measured)))
    posterior = learner.train()
    samples = posterior.sample((4000,), condition=torch.tensor(model.measured[None]).float())
    samples = samples.detach().numpy().reshape(-1, 2)
    # A network that has seen few simulations is not exact: here its spread is a sixth too narrow.
    assert np.all(np.abs(samples.mean(axis=0) - mean) < 0.5 * sd)
    assert np.all(np.abs(np.log(samples.std(axis=0) / sd)) < np.log(1.4))


def test_arviz_takes_the_draws(found):
    tree = arviz_base.from_dict(found.to_arviz_dict())
    posterior = tree["posterior"]
    assert dict(posterior.sizes) == {"chain": 1, "draw": 4000}
    assert float(posterior["friction"].mean()) == pytest.approx(
        found.parameters["friction"]["mean"]
    )
    assert set(tree["log_likelihood"].data_vars) == {"counts_1", "tilt_1", "bounces_1"}


def test_bad_input_says_where():
    config = {**CONFIG, "tilt": {"angle_deg": 60}}
    with pytest.raises(coinmc.ConfigError, match="tilt 1 contradicts the prior"):
        coinmc.calibrate(config, points=64, tosses=32)
    config = {**CONFIG, "counts": {"heads": 1, "tails": 1, "side": 1, "tosses": 4}}
    with pytest.raises(coinmc.ConfigError, match="do not add up"):
        coinmc.CalibrationModel(config)
    with pytest.raises(coinmc.ConfigError, match="unknown key `angle`"):
        coinmc.CalibrationModel({**CONFIG, "tilt": {"angle": 17}})
    with pytest.raises(ValueError, match="from 32 to 65536"):
        coinmc.CalibrationModel(CONFIG, points=2)


def test_measurements_sharper_than_the_draws_are_refused():
    config = {**CONFIG, "tilt": {"angle_deg": 17, "angle_error_deg": 1e-7}}
    with pytest.raises(ValueError, match="independent draws, and 20 are needed"):
        coinmc.calibrate(config, points=64, tosses=32, predicted=1024)


def test_readings_that_scatter_and_tosses_that_were_lost_are_remarked_on():
    config = {
        **CONFIG,
        "tilt": {"angle_deg": [12, 22, 12, 22]},
        "counts": {"heads": 19, "tails": 18, "side": 13, "lost": 10},
    }
    found = coinmc.calibrate(config, points=64, tosses=32, predicted=1024)
    remarks = found.document["remarks"]
    # 100/3 = 5.77 squared, for errors of 1 degree
    assert any(text.startswith("the readings of tilt 1 scatter 5.8 times") for text in remarks)
    assert any(
        text.startswith("10 of the 60 tosses of counts 1 showed no face") for text in remarks
    )
