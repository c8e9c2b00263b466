"""Reads the lists of this folder: promises, modules, and survivors with their reasons."""

import collections
import re
import tomllib
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PLACE = re.compile(r":\d+:\d+: ")


def listed(name):
    """The entries of a list, by its name."""
    return tomllib.loads((FOLDER / f"{name}.toml").read_text()).get(name.removesuffix("s"), [])


def survivors(reason=""):
    """How often each mutation may survive, for a reason that begins so."""
    known = [one for one in listed("survivors") if one["reason"].startswith(reason)]
    return collections.Counter({(s["file"], s["mutation"]): s.get("times", 1) for s in known})


def named(line):
    """File and mutation of a line like `src/a.rs:12:3: replace f with 0`: places change."""
    file, mutation = PLACE.split(line, maxsplit=1)
    return file, mutation
