"""Closed forms: known values, broadcasting, NaN in NaN out."""

import inspect
import math
import typing

import numpy as np
import pytest

from coinmc import analytic

# every function of numbers, with arguments within its domain
FORMS = {
    "arc": (1.2,),
    "zone": (1.2,),
    "surface_area": (1.2,),
    "cross_section": (1.2,),
    "well_depth_flat": (1.2,),
    "well_depth_solid": (1.2,),
    "side_depth": (1.2,),
    "face_depth": (1.2,),
    "precession": (1.2, 1.1),
    "precession_fair_ratio": (1.1, 0.4),
    "same_side": (1.1,),
    "other_side": (1.1,),
    "psi": (0.6,),
    "zone_area": (0.01, 0.02),
    "half_turns": (2.4, 238.6, 9.81),
    "is_heads": (38.1,),
    "heads_band": (3, 2.4, 9.81),
    "heads_in_window": (3.1, 4.4),
    "bias_bound": (3.0,),
}


def parts(value):
    return value if isinstance(value, tuple) else (value,)


def test_every_function_is_tested():
    functions = {name for name in analytic.__all__ if inspect.isfunction(getattr(analytic, name))}
    assert functions == {*FORMS, "rule", "fair_ratio"}


def test_known_values():
    assert analytic.arc(2.0) == 0.5
    assert analytic.zone(1.5) == 0.6
    assert analytic.surface_area(1.0) == 0.5
    assert analytic.cross_section(2.0) == 0.5
    for name, fair in zip(analytic.RULES, (1.1547, 0.7071, 0.5, 1.0, 1.657, 1.3545), strict=True):
        assert analytic.fair_ratio(name) == pytest.approx(fair, abs=5e-5)
        assert analytic.rule(name, analytic.fair_ratio(name)).side == pytest.approx(
            1 / 3, abs=1e-15
        )
    # Diaconis, Holmes & Montgomery (2007), Keller (1986)
    assert analytic.same_side(math.radians(80.99)) == pytest.approx(0.508, abs=5e-6)
    assert analytic.half_turns(2.4, 238.6) == pytest.approx(37.16, abs=0.005)
    assert analytic.zone_area(0.01, 0.01) == pytest.approx(2 * math.pi * 0.01 * math.sqrt(1.25e-4))
    slowest, fastest = analytic.heads_band(2, 2.4)
    assert analytic.half_turns(2.4, [slowest, fastest]) == pytest.approx([3.5, 4.5])


@pytest.mark.parametrize(("name", "arguments"), FORMS.items())
def test_arrays_equal_scalars(name, arguments):
    form = getattr(analytic, name)
    scale = np.linspace(0.9, 1.1, 12)
    if name == "heads_band":
        scale = np.arange(1.0, 13.0)
    first = arguments[0] * scale
    whole = parts(form(first.reshape(3, 4), *arguments[1:]))
    for part, result in enumerate(whole):
        assert result.shape == (3, 4)
        single = [parts(form(float(x), *arguments[1:]))[part] for x in first]
        np.testing.assert_array_equal(result.ravel(), single)
        assert isinstance(single[0], bool if name == "is_heads" else float)


@pytest.mark.parametrize(("name", "arguments"), FORMS.items())
def test_nan_in_any_argument_gives_nan(name, arguments):
    form = getattr(analytic, name)
    for place in range(len(arguments)):
        given = list(arguments)
        given[place] = np.array([arguments[place], np.nan])
        with np.errstate(all="raise"):
            for result in parts(form(*given)):
                if name == "is_heads":
                    assert result.tolist() == [True, False]
                else:
                    assert np.isnan(result).tolist() == [False, True]


def test_arguments_broadcast():
    faces = analytic.precession(np.linspace(0.1, 2, 5)[:, None], np.linspace(0.1, 3, 7))
    assert faces.side.shape == (5, 7)
    np.testing.assert_allclose(faces.heads + faces.tails + faces.side, 1.0, atol=1e-14)
    assert analytic.zone(np.zeros((0, 3))).shape == (0, 3)
    with pytest.raises(ValueError, match="broadcast"):
        analytic.precession(np.ones(2), np.ones(3))


def test_other_dtypes_and_layouts():
    x = np.linspace(0.5, 1.5, 10)
    expected = analytic.arc(x)
    np.testing.assert_array_equal(analytic.arc(x.astype(">f8")), expected)
    np.testing.assert_array_equal(analytic.arc(np.repeat(x, 3)[::3]), expected)
    np.testing.assert_array_equal(analytic.arc(x[::-1]), expected[::-1])
    np.testing.assert_array_equal(analytic.arc(list(x)), expected)
    np.testing.assert_array_equal(analytic.arc([1, 2]), analytic.arc([1.0, 2.0]))
    for bad in ("1", [1j], [None], np.array(["a"]), [[1], [2, 3]]):
        with pytest.raises((TypeError, ValueError)):
            analytic.arc(bad)
    with pytest.raises(ValueError, match="no rule is called 'arcs'"):
        analytic.rule("arcs", 1)


def test_probabilities_stay_within_bounds():
    hostile = np.array([-1.0, 0.0, 1e-300, 1e300, np.inf, -np.inf, np.nan])
    for name in analytic.RULES:
        faces = analytic.rule(name, hostile)
        for p in typing.cast("tuple", faces):
            assert np.all(np.isnan(p) | ((p >= 0) & (p <= 1)))
            assert np.isnan(p[[0, 5, 6]]).all()


def test_a_column_of_pandas_is_an_array():
    import pandas as pd

    column = pd.Series([0.0, 1.0, 2.0])
    np.testing.assert_array_equal(analytic.arc(column), analytic.arc([0.0, 1.0, 2.0]))
    with pytest.raises(ValueError, match="masked"):
        analytic.arc(np.ma.masked_array([1.0, 2.0], mask=[False, True]))
