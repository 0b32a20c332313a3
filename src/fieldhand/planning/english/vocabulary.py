"""The words that every robot and every orchard share, read from vocabulary.toml."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from itertools import product
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


@cache
def questions() -> Mapping[str, str]:
    """Return the names of readings by the questions for them: "how warm is the air", "how wet the soil is"."""
    found: dict[str, str] = {}
    for reading, asked in vocabulary()["asked_by_adjective"].items():
        for adjective, thing in product(asked["adjectives"], asked["of"]):
            verb = "are" if thing.endswith("s") else "is"
            found[f"how {adjective} {verb} {thing}"] = found[f"how {adjective} {thing} {verb}"] = reading
    return found
