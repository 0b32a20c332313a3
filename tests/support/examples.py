"""Numbers of examples of a property: a few in each run, many with ``--hypothesis-profile=thorough``."""

from __future__ import annotations

from hypothesis import settings


def examples(steady: int, *, thorough: int) -> int:
    """The number for the profile that these tests run with."""
    return thorough if settings().max_examples == settings.get_profile("thorough").max_examples else steady
