"""Derivatives by paired tosses, against those of a closed form."""

import numpy as np
import pytest

import coinmc

# P(side) of the flat adhesive coin is the arc rule's where the landing angle is uniform
ADHESIVE = {
    "seed": 3,
    "coin": {"ratio": 1.0},
    "surface": {"restitution": 0.0, "friction": 0.3, "landing": "adhesive"},
    "launch": {"preset": "clean-flat"},
    "engine": {"flat": {}},
    "stop": {"tosses": 400_000},
}


def test_the_derivative_equals_that_of_the_closed_form():
    """dP/d ln x of the arc rule is (2/π)·2x/(4 + x²); five intervals of 99.9 % miss 1 in 200."""
    for ratio in (0.3, 0.7, 1.0, 1.5, 2.0):
        table = coinmc.sensitivity(
            ADHESIVE, ["coin.ratio"], step=0.02, confidence=0.999, overrides={"coin.ratio": ratio}
        )
        exact = (2 / np.pi) * 2 * ratio / (4 + ratio**2)
        # the arc rule holds up to the step's square and the launch's own angle distribution
        slack = 0.01
        assert table["d_p_side_lo"][0] - slack < exact < table["d_p_side_hi"][0] + slack, ratio


def test_pairs_are_far_more_precise_than_independent_tosses():
    table = coinmc.sensitivity(ADHESIVE, ["coin.ratio"], step=0.02)
    half_width = (table["d_p_side_hi"][0] - table["d_p_side_lo"][0]) / 2
    p = coinmc.analytic.arc(1.0)
    independent = 1.96 * np.sqrt(2 * p * (1 - p) / 400_000) / np.log(1.02)
    assert half_width < independent / 4


def test_derivatives_of_all_faces_sum_to_zero(scene):
    table = coinmc.sensitivity(scene, tosses=20_000)
    total = sum(table[f"d_p_{face}"] for face in ("heads", "tails", "side"))
    # but for undecided tosses, of which there are none
    np.testing.assert_allclose(total, 0.0, atol=1e-12)
    assert set(table["parameter"]) >= {"coin.ratio", "surface.restitution", "surface.friction"}
    assert "coin.mass_kg" not in table["parameter"]
    assert (table["tosses"] == 20_000).all()
    assert len(repr(table).splitlines()) == 1 + len(table)


def test_sensitivity_of_a_result_at_a_point(scene):
    result = coinmc.estimate({**scene, "coin": {"ratio": [0.8, 1.6]}})
    at = [result.sensitivity(["coin.ratio"], point=point, tosses=5000) for point in (0, 1)]
    assert [float(table["value"][0]) for table in at] == [0.8, 1.6]
    alone = coinmc.sensitivity(scene, ["coin.ratio"], tosses=5000, overrides={"coin.ratio": 1.6})
    assert at[1]["d_p_side"].tolist() == alone["d_p_side"].tolist()


def test_parameters_that_cannot_be_varied_are_reported(scene):
    with pytest.raises(ValueError, match=r"coin\.ratoi is not a number of this config"):
        coinmc.sensitivity(scene, ["coin.ratoi"])
    for arguments in ({"step": 0.0}, {"step": 2.0}, {"confidence": 1.0}, {"tosses": 0}):
        with pytest.raises(ValueError, match=r"step|confidence|at least one"):
            coinmc.sensitivity(scene, ["coin.ratio"], **arguments)


def test_a_parameter_at_the_end_of_its_range_is_changed_to_one_side():
    """Half a step above restitution 1 there is no restitution."""
    at_end = {"surface.restitution": 1.0}
    table = coinmc.sensitivity(ADHESIVE, list(at_end), step=0.05, tosses=500, overrides=at_end)
    assert (table["from"].tolist(), table["to"].tolist()) == ([1.0 / 1.05], [1.0])
    chosen = coinmc.sensitivity(ADHESIVE, list(at_end), tosses=500, overrides=at_end)
    assert chosen["to"].tolist() == [1.0]
