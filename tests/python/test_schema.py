"""The JSON Schema of configs: valid, accepts what the program accepts, refuses what it refuses."""

import copy
import json
import tomllib

import jsonschema
import pytest

VALID = """
seed = 1
[coin]
ratio = { from = 0.2, to = 2.0, steps = 19 }
[surface]
restitution = [0.3, 0.5]
friction = 0.3
[launch]
preset = "robot"
[engine.flat]
[stop]
tosses = 1_000_000
"""

IN_SPACE = """
[coin]
ratio = [0.25, 0.85]
[surface]
restitution = 0.5
friction = 0.3
rolling_friction_m = [1e-5, 1e-4]
pivoting_friction_m = 1e-4
restitution_threshold_m_s = 0.1
[environment]
linear_drag_per_s = 0.1
angular_drag_per_s = 0.1
gyroscopic_torque = false
[launch]
preset = "drop"
[engine.volumetric]
law = "stronge"
decision = "energy"
zeno = { from = 0.001, to = 0.1, steps = 3, scale = "log" }
stick_speed = 1e-3
smoothing_time = 1e-3
time_limit = 1e4
[stop]
tosses = 1000
"""

# A path of keys and the value put there.
BAD = [
    ("sede", 1),
    ("seed", -1),
    ("seed", "one"),
    ("seed", 1.5),
    ("coin.ratio", 0),
    ("coin.ratio", -1.0),
    ("coin.ratio", "1.2"),
    ("coin.ratio", []),
    ("coin.ratio", {"from": 1.0, "steps": 3}),
    ("coin.ratio", {"from": 1.0, "to": 2.0, "steps": 1}),
    ("coin.ratio", {"from": 1.0, "to": 2.0, "steps": 10**12}),
    ("coin.radius_m", 0),
    ("coin.radios_m", 0.01),
    ("surface.restitution", 1.5),
    ("surface.restitution", [0.5, -0.1]),
    ("surface.friction", -0.1),
    ("surface.landing", "soft"),
    ("surface.rolling_friction_m", -1e-4),
    ("surface.pivoting_friction_m", [1e-4, -1e-4]),
    ("surface.restitution_threshold_m_s", "2"),
    ("environment.linear_drag_per_s", -1.0),
    ("environment.angular_drag_per_s", {"from": -1.0, "to": 1.0, "steps": 3}),
    ("environment.gyroscopic_torque", 1),
    ("launch.preset", "robt"),
    ("launch.orientation", {"tilt_deg": 0.0, "axis": [0, 0, 1]}),
    ("engine.flat.law", "newton"),
    ("engine.flat.zeno", 0.0),
    ("engine", {"volumetric": {"law": "newton"}}),
    ("engine", {"volumetric": {"decision": "certain"}}),
    ("engine", {"volumetric": {"stick_speed": 0.2}}),
    ("engine", {"volumetric": {"smoothing_time": 0.0}}),
    ("engine", {"volumetric": {"time_limit": 0.0}}),
    ("engine", {"volumetric": {"energy_fraction": 0.01}}),
    ("engine.rapier", {}),
    ("stop.tosses", 0),
    ("stop", {"tosses": 1000, "half_width": 0.01}),
    ("estimate.confidence", 1.0),
]


@pytest.fixture(scope="module")
def schema(coinmc) -> dict:
    return json.loads(coinmc("schema").stdout)


@pytest.fixture(scope="module")
def validator(schema):
    return jsonschema.Draft202012Validator(schema)


def test_it_is_a_schema_of_2020_12(schema):
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    jsonschema.Draft202012Validator.check_schema(schema)


def test_the_copy_in_the_repository_is_current(root, schema):
    copies = list((root / "schema").glob("*.json"))
    if not copies:
        pytest.skip("no copy is checked in")
    assert json.loads(copies[0].read_text()) == schema


def test_examples_are_accepted(root, validator):
    examples = sorted((root / "examples").glob("*.toml"))
    assert examples
    for path in examples:
        errors = list(validator.iter_errors(tomllib.loads(path.read_text())))
        assert not errors, f"{path.name}: {errors[0].message}"


def test_what_is_valid_is_accepted(validator):
    for text in (VALID, IN_SPACE):
        validator.validate(tomllib.loads(text))


@pytest.mark.parametrize(("path", "value"), BAD, ids=lambda x: x if isinstance(x, str) else None)
def test_what_is_bad_is_refused_by_schema_and_program(path, value, validator, coinmc, tmp_path):
    config = copy.deepcopy(tomllib.loads(VALID))
    *tables, key = path.split(".")
    table = config
    for name in tables:
        table = table.setdefault(name, {})
    table[key] = value
    assert not validator.is_valid(config)
    (tmp_path / "valid.toml").write_text(VALID)
    setting = f"{path}={as_toml(value)}"
    done = coinmc("check", "valid.toml", "--set", setting, cwd=tmp_path, check=False)
    assert done.returncode == 2, done.stdout


def as_toml(value) -> str:
    """A value as a TOML expression."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {as_toml(item)}" for key, item in value.items()) + "}"
    return json.dumps(value)
