"""The random numbers are NumPy's Philox, and launches are made of them as documented."""

import math

import numpy as np

TWO_64 = 2**64


def philox(key: list[int], counter: list[int]) -> list[int]:
    """The block of this counter. NumPy adds one to the counter before each block."""
    number = sum(word << (64 * i) for i, word in enumerate(counter))
    before = (number - 1) % 2**256
    words = [(before >> (64 * i)) % TWO_64 for i in range(4)]
    generator = np.random.Philox(
        key=np.array(key, dtype=np.uint64), counter=np.array(words, dtype=np.uint64)
    )
    return [int(word) for word in generator.random_raw(4)]


def uniform(seed: int, point: int, toss: int, dimension: int) -> float:
    """The uniform of a dimension of a launch: (k + 1/2)/2^52, k the upper 52 bits of its word."""
    word = philox([seed, 0], [dimension // 4, toss, point, 0])[dimension % 4]
    return ((word >> 12) + 0.5) / 2**52


def test_blocks_are_numpys(random_words):
    blocks = random_words["blocks"]
    assert len(blocks) >= 500
    for case in blocks:
        assert philox(case["key"], case["counter"]) == case["words"], case


def test_uniforms_are_the_upper_bits_in_the_middle_of_their_cell(random_words):
    for case in random_words["uniforms"]:
        expected = uniform(case["seed"], case["point"], case["toss"], case["dimension"])
        assert case["uniform"] == expected, case
        assert 0.0 < expected < 1.0


def test_the_robots_launch_is_two_uniforms_scaled(random_words):
    for case in random_words["launches"]:
        at = (case["seed"], case["point"], case["toss"])
        tilt = math.pi * uniform(*at, 0)
        spin = 10.0 * math.pi * uniform(*at, 3)
        # sine and cosine of two libraries differ in the last bits
        np.testing.assert_allclose(
            case["axis"], [math.sin(tilt), 0.0, math.cos(tilt)], rtol=0, atol=1e-15
        )
        np.testing.assert_allclose(case["spin_rad_s"], [0.0, spin, 0.0], rtol=1e-15, atol=0)
