"""Conversion of config dicts to TOML text, which error messages can quote."""

from collections.abc import Mapping
from typing import Any

from coinmc._errors import ConfigError

__all__ = ["document", "overrides_of", "value"]

#: Deepest nesting accepted; a deeper dict contains itself.
_MAX_DEPTH = 16
_BARE = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def document(tables: Mapping[str, Any]) -> str:
    """Write a dict of tables as TOML: one key per line, nested tables inline."""
    if not isinstance(tables, Mapping):
        raise TypeError(
            f"a config must be a path, a dict or a coinmc.Config, not {type(tables).__name__}"
        )
    plain = [f"{_key(key)} = {value(item)}" for key, item in _items(tables) if not _table(item)]
    headed = [
        f"\n[{_key(key)}]\n" + "".join(f"{_key(k)} = {value(v)}\n" for k, v in _items(item))
        for key, item in _items(tables)
        if _table(item)
    ]
    return "".join(f"{line}\n" for line in plain) + "".join(headed)


def overrides_of(overrides: Mapping[str, Any] | None) -> list[str]:
    """Write overrides in the form of the command line's ``--set key.path=value``."""
    if overrides is None:
        return []
    if not isinstance(overrides, Mapping):
        raise TypeError('overrides must be a dict such as {"coin.ratio": 1.2}')
    lines = []
    for key, item in _items(overrides):
        if "=" in key:
            raise ConfigError(f"`{key}` is not a dotted key such as `surface.friction`")
        lines.append(f"{key}={value(item)}")
    return lines


def value(item: Any, depth: int = 0) -> str:
    """Write a value as a TOML expression on one line."""
    if depth > _MAX_DEPTH:
        raise ConfigError("the config is nested too deeply")
    # NumPy scalars and arrays convert themselves to Python values
    if not isinstance(item, (str, bytes)) and hasattr(item, "tolist"):
        item = item.tolist()
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, (int, float)):
        return _number(item)
    if isinstance(item, str):
        return _text(item)
    if isinstance(item, Mapping):
        pairs = (f"{_key(key)} = {value(inner, depth + 1)}" for key, inner in _items(item))
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(item, (list, tuple, range)):
        return "[" + ", ".join(value(inner, depth + 1) for inner in item) + "]"
    raise TypeError(
        f"a config holds numbers, booleans, strings, lists and dicts, not {type(item).__name__}"
    )


def _number(number: float) -> str:
    if isinstance(number, int):
        # Python refuses to print very long integers
        if abs(number) >= 1 << 64:
            raise ConfigError("whole numbers in a config must fit in 64 bits")
        return str(int(number))
    return repr(float(number))


def _table(item: Any) -> bool:
    return isinstance(item, Mapping)


def _items(table: Mapping[str, Any]) -> list[tuple[str, Any]]:
    items = list(table.items())
    for key, _ in items:
        if not isinstance(key, str):
            raise TypeError(f"config keys must be strings, not {type(key).__name__}")
    return items


def _key(key: str) -> str:
    return key if key and all(c in _BARE for c in key) else _text(key)


def _text(text: str) -> str:
    escaped = (
        _ESCAPES.get(c) or (f"\\u{ord(c):04X}" if ord(c) < 0x20 or ord(c) == 0x7F else c)
        for c in text
    )
    return '"' + "".join(escaped) + '"'
