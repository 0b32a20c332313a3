"""The check of seeds that callers pass in."""

from __future__ import annotations

import operator
from typing import SupportsIndex

from fieldhand.errors import InputError
from fieldhand.language import message


def checked_seed(seed: SupportsIndex) -> int:
    """Return a seed as an ``int``, whatever integer type it has, such as that of a NumPy array.

    Args:
        seed: Seed of everything random.

    Raises:
        InputError: It is negative, or not a whole number.
    """
    try:
        checked = operator.index(seed)
    except TypeError:
        checked = -1
    if checked < 0:
        raise InputError(
            message("the seed is {seed}, not a whole number from 0", seed=repr(seed)[:40]),
            advice=message("use 0 or a greater number"),
        )
    return checked
