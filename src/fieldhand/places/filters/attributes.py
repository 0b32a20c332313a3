"""Filter and rank trees by attributes of the site file; a tree without the attribute passes no test and has no rank."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import counted
from fieldhand.places.filters.attribute_dates import day_number
from fieldhand.places.place_errors import (
    no_such_attribute,
    no_such_value,
    no_such_value_here,
    not_a_number,
    not_comparable,
)
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Site
from fieldhand.terms import Test, Value

if TYPE_CHECKING:
    from fieldhand.places.filters.where import Where


COMPARISONS: Mapping[Test, Callable[[Any, Any], Any]] = {
    "lt": operator.lt,
    "le": operator.le,
    "gt": operator.gt,
    "ge": operator.ge,
    "eq": operator.eq,
    "ne": operator.ne,
}


@dataclass(frozen=True, eq=False)
class Column:
    """The values of one attribute for all trees of a site.

    Attributes:
        numbers: Numeric value of each tree; NaN if the value is not a number.
        codes: Index of each tree's value in ``texts``; -1 if the tree lacks the attribute.
        texts: Distinct values as text in lower case; a single placeholder if all values are numbers.
        days: Number of the day that each tree's value names as a date; NaN if it is no date.
    """

    numbers: NDArray[np.float64]
    codes: NDArray[np.intp]
    texts: tuple[str, ...]
    days: NDArray[np.float64]


def where(spots: PlaceGroup, selector: Where, notes: ResolutionNotes) -> PlaceGroup:
    """Return the places whose attribute passes the test, as numbers or dates if both are, else as text."""
    column = column_of(spots.site, selector.attribute)
    mine = column_rows(column, spots)
    wanted = _number(selector.value)
    numeric = ~np.isnan(mine.numbers)
    passed = np.zeros(len(spots), dtype=bool)
    if not math.isnan(wanted):
        passed |= numeric & COMPARISONS[selector.test](mine.numbers, wanted)
    if selector.test in ("eq", "ne"):
        text = _text(selector.value)
        same = [k for k, known in enumerate(column.texts) if known == text]
        equal = np.isin(mine.codes, same)
        as_text = (mine.codes >= 0) & (~numeric | math.isnan(wanted))
        passed |= as_text & (equal if selector.test == "eq" else ~equal)
        if selector.test == "eq" and not same and not (column.numbers == wanted).any():
            raise no_such_value(spots.site, selector)
    elif not math.isnan(wanted_day := day_number(selector.value)) and not np.isnan(column.days).all():
        passed |= COMPARISONS[selector.test](mine.days, wanted_day)
    elif math.isnan(wanted):
        raise not_comparable(selector)
    elif np.isnan(column.numbers).all():
        raise not_a_number(selector.attribute)
    if not passed.any() and selector.test == "eq":
        raise no_such_value_here(spots.site, selector, _values(spots, selector.attribute))
    note_lacking(int((mine.codes < 0).sum()), selector.attribute, notes)
    return spots.keep(passed)


def _values(spots: PlaceGroup, attribute: str) -> tuple[Value, ...]:
    """Return the distinct values of an attribute among these places."""
    trees = [spots.site.trees[k] for k in spots.index[spots.is_tree].tolist()]
    kept = (tree.properties[name] for tree in trees for name in tree.properties if phrase(name) == phrase(attribute))
    return tuple(dict.fromkeys(kept))


def note_lacking(count: int, attribute: str, notes: ResolutionNotes) -> None:
    """Add a note on the number of trees without the attribute."""
    if count:
        notes.remark(
            counted(
                "{count} has no {attribute} and is left out",
                "{count} have no {attribute} and are left out",
                count,
                attribute=attribute,
            )
        )


def with_number(spots: PlaceGroup, attribute: str) -> tuple[PlaceGroup, NDArray[np.float64]]:
    """Return the places with a value of the attribute that is a number, or a date if none is, and the values."""
    column = column_of(spots.site, attribute)
    of_days = bool(np.isnan(column.numbers).all())
    if of_days and np.isnan(column.days).all():
        raise not_a_number(attribute)
    mine = column_rows(column, spots)
    numbers = mine.days if of_days else mine.numbers
    known = ~np.isnan(numbers)
    return spots.keep(known), numbers[known]


def column_rows(column: Column, spots: PlaceGroup) -> Column:
    """Return the column restricted to these places; places other than trees lack every attribute."""
    tree = spots.is_tree
    return Column(
        numbers=np.where(tree, column.numbers[spots.index * tree], np.nan),
        codes=np.where(tree, column.codes[spots.index * tree], -1),
        texts=column.texts,
        days=np.where(tree, column.days[spots.index * tree], np.nan),
    )


def column_of(site: Site, attribute: str) -> Column:
    """Return the column of an attribute, or of the only one whose name differs just in case, hyphens or underscores.

    The column is computed on first use and cached with the site.
    """
    name = attribute
    if not any(name in tree.properties for tree in site.trees):
        alike = [known for known in site.attributes if phrase(known) == phrase(attribute)]
        if len(alike) != 1:
            raise no_such_attribute(site, attribute)
        name = alike[0]
    key = ("attribute", name)
    if key not in site.cache:
        site.cache[key] = _column(site, name)
    return cast(Column, site.cache[key])


def _column(site: Site, name: str) -> Column:
    values = [tree.properties.get(name) for tree in site.trees]
    if all(type(value) is float for value in values):  # fast path
        numbers = np.array(values, dtype=np.float64)
        no_days = np.full(len(values), np.nan)
        codes = np.zeros(len(values), dtype=np.intp)
        return Column(np.where(np.isfinite(numbers), numbers, np.nan), codes, ("\0",), no_days)
    kinds = [(type(value), value) for value in values]  # 1.0 and True are equal keys but different values
    distinct = list(dict.fromkeys(kinds))
    texts: dict[str, int] = {}
    code = {kind: -1 if kind[1] is None else texts.setdefault(_text(kind[1]), len(texts)) for kind in distinct}
    number = {kind: math.nan if kind[1] is None else _number(kind[1]) for kind in distinct}
    day = {kind: math.nan if kind[1] is None else day_number(kind[1]) for kind in distinct}
    return Column(
        np.fromiter(map(number.__getitem__, kinds), dtype=np.float64, count=len(kinds)),
        np.fromiter(map(code.__getitem__, kinds), dtype=np.intp, count=len(kinds)),
        tuple(texts),
        np.fromiter(map(day.__getitem__, kinds), dtype=np.float64, count=len(kinds)),
    )


def _number(value: Value) -> float:
    """Return a value as a number, parsing text; NaN for anything else."""
    if isinstance(value, bool):
        return math.nan
    try:
        number = float(value)
    except ValueError:
        return math.nan
    return number if math.isfinite(number) else math.nan


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    text = str(value).strip().casefold()
    return {"true": "yes", "false": "no"}.get(text, text)
