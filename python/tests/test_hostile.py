"""1000 calls with whatever can be handed to a function: a right answer, or a clean exception.

A crash ends the process and so the tests; a panic of the Rust part is no `Exception`. Right is what
the same call gives for the same values in the plainest layout.
"""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import coinmc
from coinmc import analytic, film

# What a call that makes no sense may raise. None of them is a crash or a panic.
CLEAN = (TypeError, ValueError, OverflowError, IndexError, MemoryError, coinmc.Error)

thorough = settings(
    max_examples=200, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck)
)

SCENE = {
    "coin": {"ratio": 1.2},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
    "stop": {"tosses": 100},
}

numbers = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.integers(-(2**70), 2**70),
    st.sampled_from([0, -1, 2**63 - 1, 2**64, 1e300, -1e-320, float("nan"), True]),
)
scalars = st.one_of(
    numbers,
    st.none(),
    st.text(max_size=20),
    st.binary(max_size=20),
    st.complex_numbers(),
    st.lists(numbers, max_size=3),
    st.dictionaries(st.text(max_size=5), numbers, max_size=3),
    st.sampled_from([object(), np.float32(2), np.int8(3), np.array(4), np.array([]), Ellipsis]),
)
dtypes = st.sampled_from(
    ["f8", ">f8", "f4", "f2", "g", "i8", ">i4", "u1", "?", "c16", "U3", "S3", "O", "M8[s]", "V8"]
)


@st.composite
def arrays(draw):
    """Arrays of any dtype, shape, order and layout, some of them read-only."""
    dtype = np.dtype(draw(dtypes))
    shape = draw(hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5))
    array = np.zeros(shape, dtype)
    if dtype.kind in "fiu":
        pool = draw(
            st.lists(
                st.floats(width=16) if dtype.kind == "f" else st.integers(0, 99),
                min_size=1,
                max_size=9,
            )
        )
        array[...] = np.resize(np.array(pool, dtype), shape)
    if draw(st.booleans()) and array.ndim:
        array = np.repeat(array, 2, axis=-1)[..., ::2]
    if draw(st.booleans()) and array.ndim:
        array = array[::-1]
    if draw(st.booleans()):
        array = array.T
    array.flags.writeable = draw(st.booleans())
    return array


@st.composite
def launches(draw):
    """Launches in any layout, with any numbers, or nearly launches."""
    n = draw(st.integers(0, 6))
    order = draw(st.permutations(list(coinmc.LAUNCH.names)))
    kind = draw(st.sampled_from(["f8", ">f8", "f4", "i8", "f8", "f8", "c16", "U4"]))
    width = draw(st.sampled_from([3, 3, 3, 3, 3, 3, 2, 4]))
    names = order if draw(st.integers(0, 9)) else order[:-1]
    made = np.zeros(n, [(name, kind, width) for name in names])
    if np.dtype(kind).kind in "fi":
        values = draw(st.lists(st.floats(-5, 5, width=32), min_size=12, max_size=12))
        if draw(st.integers(0, 3)) == 0:
            values[draw(st.integers(0, 11))] = draw(numbers.map(float))
        for place, name in enumerate(names):
            part = np.array(values[3 * place : 3 * place + 3])
            with np.errstate(all="ignore"):
                made[name] = np.resize(part, width)
    if draw(st.booleans()):
        made = np.repeat(made, 2)[::2]
    made.flags.writeable = draw(st.booleans())
    return made


@thorough
@given(launches(), st.sampled_from(["flat", "volumetric"]), scalars)
def test_launches(given_launches, engine, threads):
    # limits keep tosses short that would take long to fail
    limits = {"max_impacts": 300, "max_steps": 3000} if engine == "volumetric" else {}
    scene = {**SCENE, "engine": {engine: limits}}
    workers = threads if isinstance(threads, int) and not isinstance(threads, bool) else 1
    try:
        tosses = coinmc.toss(scene, launches=given_launches, threads=workers)
    except CLEAN:
        return
    plain = np.zeros(len(given_launches), coinmc.LAUNCH)
    for name in coinmc.LAUNCH.names:
        plain[name] = given_launches[name]
    again = coinmc.toss(scene, launches=plain, threads=1)
    np.testing.assert_array_equal(tosses.face, again.face)
    for name in coinmc.STATE.names:
        np.testing.assert_array_equal(tosses.final[name], again.final[name])
    assert set(tosses.face.tolist()) <= set(coinmc.Face)
    assert ((tosses.face == coinmc.Face.UNDECIDED) == (tosses.ended != coinmc.Ended.DECIDED)).all()


@thorough
@given(st.data())
def test_arguments(data):
    """Whole numbers, rates, targets, texts: anything anywhere."""
    any_ = data.draw(scalars)
    # what is too much is refused, or never ends: neither of ours to test here
    huge = isinstance(any_, (int, float, np.number)) and any_ == any_ and 1000 < any_ < 10**13
    calls = [
        lambda: coinmc.toss(SCENE, 3, first=any_),
        lambda: coinmc.toss(SCENE, 3, point=any_),
        lambda: coinmc.toss(SCENE, 3, launches=any_),
        lambda: coinmc.toss(SCENE, 3, overrides=any_),
        lambda: coinmc.launches(SCENE, 3, first=any_, point=any_),
        lambda: coinmc.trace(SCENE, any_),
        lambda: coinmc.trace(SCENE, rate_hz=any_ if not huge else 1.0),
        lambda: coinmc.trace(SCENE, launch=any_),
        lambda: coinmc.toss(any_, 3),
        lambda: coinmc.check(any_),
        lambda: coinmc.Config.from_toml(any_),
        lambda: coinmc.estimate(SCENE, tosses=any_ if not huge else 7),
        lambda: coinmc.estimate(SCENE, tosses=3).fair(any_, any_, any_),
        lambda: coinmc.toss(SCENE, 9).estimate(any_),
        lambda: coinmc.sensitivity(SCENE, any_, tosses=3),
        lambda: coinmc.sensitivity(SCENE, ["coin.ratio"], tosses=3, step=any_, confidence=any_),
        lambda: coinmc.open(any_),
        lambda: film.parse(any_),
        lambda: film.Drop(any_, any_, any_, any_),
        lambda: film.fit(any_, any_, ratio=any_),
        lambda: analytic.rule(any_, any_),
        lambda: analytic.heads_band(any_, any_, any_),
    ]
    if not huge:
        calls.append(lambda: coinmc.toss(SCENE, any_, faces_only=True))
    call = data.draw(st.sampled_from(calls))
    try:
        call()
    except (*CLEAN, OSError):
        return


@thorough
@given(arrays(), arrays())
def test_closed_forms(first, second):
    for form in (analytic.arc, lambda x: analytic.precession(x, second).side):
        try:
            result = form(first)
        except CLEAN:
            continue
        assert first.dtype.kind in "fiub"
        expected = form(np.array(first, np.float64, order="C"))
        np.testing.assert_array_equal(result, expected)
        with np.errstate(invalid="ignore"):
            assert np.all(
                np.isnan(result) | ((np.asarray(result) >= 0) & (np.asarray(result) <= 1))
            )


@thorough
@given(arrays(), arrays(), arrays())
def test_arbitrary_arrays_as_launches_and_drops(first, second, third):
    for call in (
        lambda: coinmc.toss(SCENE, launches=first),
        lambda: coinmc.trace(SCENE, launch=second),
        lambda: film.fit(film.Drop(first, second, third, first), ratio=1, radius_m=0.01),
        lambda: coinmc.check({"coin": {"ratio": first}, "engine": {"analytic": {"rule": "arc"}}}),
    ):
        try:
            call()
        except CLEAN:
            continue


@thorough
@given(st.binary(max_size=300), st.text(max_size=300))
def test_texts(blob, text):
    for call in (
        lambda: film.parse(blob),
        lambda: film.parse(text),
        lambda: coinmc.Config.from_toml(text),
        lambda: coinmc.check(SCENE, {text: text}),
        lambda: coinmc.check({text: {text: [text]}}),
    ):
        try:
            call()
        except CLEAN:
            continue
