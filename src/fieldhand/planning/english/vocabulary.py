"""The words that every robot and every orchard share, read from vocabulary.toml."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib


@cache
def vocabulary() -> Mapping[str, Any]:
    """The tables of vocabulary.toml, each as its heading names it."""
    text = (files("fieldhand.planning.english") / "vocabulary.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@cache
def glue() -> frozenset[str]:
    """Words that change nothing about a mission, wherever they stand."""
    return frozenset(vocabulary()["silent"]["glue"])
