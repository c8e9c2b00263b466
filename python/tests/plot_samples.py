"""Tables and traces of known numbers: what the pictures of the tests show.

Made from formulas, not from engines, so that pictures change only when plots do.
"""

from types import SimpleNamespace

import numpy as np

STATE = [
    ("time_s", "f8"),
    ("position_m", "f8", 3),
    ("velocity_m_s", "f8", 3),
    ("axis", "f8", 3),
    ("spin_rad_s", "f8", 3),
    ("energy_j_kg", "f8"),
]
GRAVITY = 9.81
RADIUS, HEIGHT = 0.02, 0.024


def faces(side: np.ndarray, lean: float = 0.02, half_width: float = 0.03) -> dict:
    """Probabilities of the three faces with intervals, of which P(side) is given."""
    p = {"heads": (1 - side) / 2 + lean, "tails": (1 - side) / 2 - lean, "side": side}
    return {
        f"p_{face}{end}": value + by
        for face, value in p.items()
        for end, by in (("", 0), ("_lo", -half_width), ("_hi", half_width))
    }


def sweep() -> dict:
    """A result: five ratios at two restitutions."""
    ratio, restitution = (a.ravel() for a in np.meshgrid([0.5, 1, 1.5, 2, 2.5], [0.3, 0.6]))
    count = len(ratio)
    return {
        "point": np.arange(count),
        "ratio": ratio,
        "radius_m": np.full(count, 0.01),
        "restitution": restitution,
        "engine": np.full(count, "flat"),
        "law": np.full(count, "moreau"),
        **faces(0.06 + 0.095 * ratio**1.8 * (1.2 - restitution)),
        "confidence": np.full(count, 0.95),
    }


def line() -> dict:
    """The rows of `sweep` at one restitution."""
    table = sweep()
    return {name: column[:5] for name, column in table.items()}


def work() -> dict:
    """Run times and errors of two ways of computing."""
    time = np.geomspace(0.01, 10, 6)
    errors = np.concatenate([0.01 / np.sqrt(time), 0.02 / np.sqrt(time) + 0.01])
    return {
        "time_s": np.concatenate([time, 5 * time]),
        "total_error": errors,
        "total_error_lo": 0.8 * errors,
        "total_error_hi": 1.3 * errors,
        "engine": np.repeat(["flat", "rapier"], 6),
    }


def dependence() -> dict:
    """Sensitivities of three parameters."""
    value = np.array([-0.1, 0.6, 0.2])
    return {
        "parameter": np.array(["surface.friction", "coin.ratio", "surface.restitution"]),
        **{
            f"d_p_{face}{end}": scale * value + by
            for face, scale in (("side", 1), ("heads", -0.5))
            for end, by in (("", 0), ("_lo", -0.04), ("_hi", 0.05))
        },
    }


def film() -> SimpleNamespace:
    """A fit: residuals of two coordinates, one of them drifting, and two impacts."""
    time = np.arange(40) / 240
    table = {
        "drop": np.zeros(80, int),
        "time_s": np.concatenate([time, time]) + 3.0,
        "coordinate": np.repeat(["x_m", "theta_rad"], 40),
        "standardised": np.concatenate([1.5 * np.sin(40 * time), 6 * np.cos(900 * time) ** 5]),
    }
    return SimpleNamespace(residuals=table, drops=[SimpleNamespace(impacts_s=[0.05, 0.12])])


def trace(*, turn: float = 0.0) -> SimpleNamespace:
    """A coin that falls turning, bounces once as high as a quarter, and slides to its end.

    `turn` leads its path out of the plane, rad.
    """
    drop, bounce, slide = 0.3, 0.3, 0.1
    times = np.arange(0, 168) / 240
    samples = np.array([_at(time, drop, bounce, slide, turn) for time in times], STATE)
    marks = [("launched", 0.0), ("touching", drop), ("impact", drop), ("touching", drop + bounce)]
    marks += [
        ("impact", drop + bounce),
        ("sliding", drop + bounce),
        ("ended", drop + bounce + slide),
    ]
    events = np.zeros(len(marks), [("kind", "U9"), *STATE])
    for row, (kind, time) in zip(events, marks, strict=True):
        before = kind == "touching"
        state = _at(time - 1e-9 if before else time, drop, bounce, slide, turn)
        row["kind"] = kind
        for (name, *_), value in zip(STATE, state, strict=True):
            row[name] = value
    return SimpleNamespace(
        samples=samples,
        events=events,
        outcome="heads",
        scene={"radius_m": RADIUS, "height_m": HEIGHT, "gravity_m_s2": GRAVITY},
        rims_m=2 * ((RADIUS, HEIGHT / 2),),
        axial_gyration_m2=RADIUS**2 / 2,
        weight_m_s2=(0.0, 0.0, -GRAVITY),
    )


def _at(time: float, drop: float, bounce: float, slide: float, turn: float) -> tuple:
    """The state at a time: centre along x, tilt about y."""
    floor, across = HEIGHT / 2, 0.4
    if time < drop:
        z, vz, spin = floor + GRAVITY * (drop**2 - time**2) / 2, -GRAVITY * time, 15.0
        tilt = spin * (time - drop)
    elif time < drop + bounce:
        since = time - drop
        vz = GRAVITY * (bounce / 2 - since)
        z, spin = floor + GRAVITY * since * (bounce - since) / 2, 2 * np.pi / bounce
        tilt = spin * since
    else:
        z, vz, spin, tilt = floor, 0.0, 0.0, 0.0
    # slows down evenly while it slides
    slid = np.clip(time - drop - bounce, 0, slide)
    x = across * (min(time, drop + bounce) + slid - slid**2 / (2 * slide))
    across *= 1 - slid / slide
    out = np.array([np.cos(turn), np.sin(turn), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    axis = np.sin(tilt) * out + np.cos(tilt) * up
    energy = 0.5 * (across**2 + vz**2) + RADIUS**2 / 8 * spin**2 + GRAVITY * z
    return (time, x * out + z * up, across * out + vz * up, axis, spin * np.cross(up, out), energy)
