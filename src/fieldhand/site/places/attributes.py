"""Trees by what the file says of them. A tree that lacks an attribute passes no test of it and has no rank in it."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.kinds import phrase
from fieldhand.site.model import Site
from fieldhand.site.places.faults import no_such_attribute, no_such_value, not_a_number
from fieldhand.site.places.spots import Spots
from fieldhand.task.selectors import Test, Top, Value, Where

_COMPARE: Mapping[Test, Callable[[Any, Any], Any]] = {
    "lt": operator.lt,
    "le": operator.le,
    "gt": operator.gt,
    "ge": operator.ge,
    "eq": operator.eq,
    "ne": operator.ne,
}


@dataclass(frozen=True, eq=False)
class Column:
    """One attribute of every tree.

    Attributes:
        numbers: Its value where it is a number (or text that is one), else NaN.
        codes: Position of its value's text in ``texts``, -1 where the tree lacks the attribute.
        texts: The distinct values as text, lower case.
    """

    numbers: NDArray[np.float64]
    codes: NDArray[np.intp]
    texts: tuple[str, ...]


def where(spots: Spots, selector: Where) -> Spots:
    """Those whose attribute passes the test: as numbers if both sides are numbers, else as text without case."""
    column = column_of(spots.site, selector.attribute)
    mine = column_rows(column, spots)
    wanted = _number(selector.value)
    numeric = ~np.isnan(mine.numbers)
    passed = np.zeros(len(spots), dtype=bool)
    if not math.isnan(wanted):
        passed |= numeric & _COMPARE[selector.test](mine.numbers, wanted)
    if selector.test in ("eq", "ne"):
        text = _text(selector.value)
        same = [k for k, known in enumerate(column.texts) if known == text]
        equal = np.isin(mine.codes, same)
        as_text = (mine.codes >= 0) & (~numeric | math.isnan(wanted))
        passed |= as_text & (equal if selector.test == "eq" else ~equal)
        if selector.test == "eq" and not same and not (column.numbers == wanted).any():
            raise no_such_value(spots.site, selector)
    elif math.isnan(wanted) or np.isnan(column.numbers).all():
        raise not_a_number(selector, "value" if math.isnan(wanted) else "attribute")
    return spots.keep(passed)


def ranked(spots: Spots, selector: Top) -> Spots:
    """All that have a number there, the highest (or lowest) first; ties by file order."""
    column = column_of(spots.site, selector.attribute)
    if np.isnan(column.numbers).all():
        raise not_a_number(selector, "attribute")
    numbers = column_rows(column, spots).numbers
    have = spots.keep(~np.isnan(numbers))
    numbers = numbers[~np.isnan(numbers)]
    return have.keep(np.lexsort((have.file_order, numbers if selector.lowest else -numbers)))


def column_rows(column: Column, spots: Spots) -> Column:
    """The column for these places; what is no tree lacks every attribute."""
    tree = spots.is_tree
    return Column(
        numbers=np.where(tree, column.numbers[spots.index * tree], np.nan),
        codes=np.where(tree, column.codes[spots.index * tree], -1),
        texts=column.texts,
    )


def column_of(site: Site, attribute: str) -> Column:
    """The attribute of this name, else the only one whose name differs in case, hyphens and underscores alone."""
    name = attribute
    if name not in site.attributes:
        alike = [known for known in site.attributes if phrase(known) == phrase(attribute)]
        if len(alike) != 1:
            raise no_such_attribute(site, attribute)
        name = alike[0]
    columns: dict[str, Column] = vars(site).setdefault("_columns", {})
    if name not in columns:
        columns[name] = _column(site, name)
    return columns[name]


def _column(site: Site, name: str) -> Column:
    numbers = np.full(len(site.trees), np.nan)
    codes = np.full(len(site.trees), -1, dtype=np.intp)
    texts: dict[str, int] = {}
    for k, tree in enumerate(site.trees):
        value = tree.properties.get(name)
        if value is not None:
            numbers[k] = _number(value)
            codes[k] = texts.setdefault(_text(value), len(texts))
    return Column(numbers, codes, tuple(texts))


def _number(value: Value) -> float:
    """The number that a value is or that its text spells; NaN for anything else."""
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
