"""What all questions share: where their scene comes from, and tables for notebooks."""

import html
from collections.abc import Mapping, Sequence
from typing import Any

from coinmc import _lib, _toml
from coinmc._config import Config, ConfigLike, _source

__all__ = ["html_table", "source_of"]


def source_of(
    config: ConfigLike | None, scene: str | None, overrides: Mapping[str, Any] | None
) -> tuple[tuple[str, str], list[str]]:
    """Return kind and text of the source of a scene, and what replaces values of it."""
    if config is not None and scene is not None:
        raise ValueError("give a config or the name of a scene, not both")
    sets = _toml.overrides_of(overrides)
    if isinstance(config, Config):
        return config._source, config._overrides + sets
    if config is not None:
        return _source(config), sets
    return ("scene", scene or _lib.scenes()[0][0]), sets


def html_table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return an HTML table of cells of text."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table><thead>{line(heads, 'th')}</thead><tbody>{body}</tbody></table>"
