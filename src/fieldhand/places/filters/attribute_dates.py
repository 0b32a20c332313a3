"""Dates among the attributes of plants: "2026-04-01"."""

from __future__ import annotations

import math
import re

from fieldhand.compatibility import date_from_iso
from fieldhand.terms import Value

_DATE = re.compile(r"\d{4}-\d{2}-\d{2}")


def day_number(value: Value) -> float:
    """Return the number of the day that a text like "2026-04-01" names; NaN for anything else."""
    if not isinstance(value, str) or _DATE.fullmatch(value.strip()) is None:
        return math.nan
    try:
        return float(date_from_iso(value.strip()).toordinal())
    except ValueError:
        return math.nan


def is_date(value: Value) -> bool:
    """Return True for a text that names a day."""
    return not math.isnan(day_number(value))
