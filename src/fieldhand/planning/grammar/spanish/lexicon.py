"""The tables of spanish.toml."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib


@cache
def tables() -> Mapping[str, Any]:
    """Return the tables of spanish.toml, each as its heading names it."""
    text = (files("fieldhand.planning.grammar.spanish") / "spanish.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)
