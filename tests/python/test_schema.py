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
    ("launch.preset", "robt"),
    ("launch.orientation", {"tilt_deg": 0.0, "axis": [0, 0, 1]}),
    ("engine.flat.law", "newton"),
    ("engine.flat.zeno", 0.0),
    ("engine.rapier", {}),
    ("stop.tosses", 0),
    ("stop.half_width", 0.01),
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
    validator.validate(tomllib.loads(VALID))


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
