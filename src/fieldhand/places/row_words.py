"""Rows, and counting along them, as growers say them: "rows 2 to 5", "every third tree", "trees 4 to 9"."""

from __future__ import annotations

import re
from typing import Literal

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.attribute_words import say_attribute
from fieldhand.places.selectors import InRow, Order, Ordered, Rows
from fieldhand.terms import Towards

#: What an ordinal stands before or for, which other languages say differently.
Ranked = Literal["tree", "row", "one"]

_ORDERS: dict[Order, str] = {
    "west_to_east": message("from west to east"),
    "east_to_west": message("from east to west"),
    "north_to_south": message("from north to south"),
    "south_to_north": message("from south to north"),
    "nearest_first": message("the nearest first"),
    "farthest_first": message("the farthest first"),
    "rows": message("row by row"),
}
_BACKWARDS: dict[Order, str] = {
    "west_to_east": message("from east to west"),
    "east_to_west": message("from west to east"),
    "north_to_south": message("from south to north"),
    "south_to_north": message("from north to south"),
    "nearest_first": message("the farthest first"),
    "farthest_first": message("the nearest first"),
    "rows": message("row by row from the last"),
}


def say_ordinal(number: int, of: Ranked = "tree") -> str:
    """Which in a count: "third", "12th", and from the other end "last", "second last"."""
    if number == -1:
        return message("last", context=of)
    if number < 0:
        return message("{ordinal} last", context=of, ordinal=say_ordinal(-number, of))
    match number:
        case 1:
            return message("first", context=of)
        case 2:
            return message("second", context=of)
        case 3:
            return message("third", context=of)
        case 4:
            return message("fourth", context=of)
        case 5:
            return message("fifth", context=of)
        case 6:
            return message("sixth", context=of)
        case 7:
            return message("seventh", context=of)
        case 8:
            return message("eighth", context=of)
        case 9:
            return message("ninth", context=of)
        case 10:
            return message("tenth", context=of)
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    match ending:
        case "st":
            return message("{number}st", context=of, number=number)
        case "nd":
            return message("{number}nd", context=of, number=number)
        case "rd":
            return message("{number}rd", context=of, number=number)
    return message("{number}th", context=of, number=number)


def say_ranked_tree(number: int) -> str:
    """The tree that has a number in a count: "the third tree", "the second last tree"."""
    if number < -1:
        return message("the {ordinal} last tree", ordinal=say_ordinal(-number))
    return message("the {ordinal} tree", ordinal=say_ordinal(number))


def say_rows(rows: Rows) -> tuple[str, bool]:
    """The rows that are meant, without the trees in them, and whether it is one: "row 3", "every other row"."""
    first, last = rows.first, rows.last
    side = "" if rows.counted_from == "usual" else message("from the {side}", side=COMPASS[rows.counted_from])
    if first and first == last:
        return _say_row(first, side), True
    if not first and not last:
        match rows.every:
            case 1:
                return message("all rows {from_side}", from_side=side), False
            case 2:
                return message("every other row {from_side}", from_side=side), False
        nth = say_ordinal(rows.every, "row")
        return message("every {ordinal} row {from_side}", ordinal=nth, from_side=side), False
    if _rises(first) and _rises(last):
        span = message("rows {first} to {last} {from_side}", first=_bare(first), last=_bare(last), from_side=side)
    else:
        begins = _say_row(first, side) if first else message("the first row {from_side}", from_side=side)
        ends = _say_row(last, side) if last else message("the last row {from_side}", from_side=side)
        span = message("the rows from {first} to {last}", first=begins, last=ends)
    match rows.every:
        case 1:
            return span, False
        case 2:
            return message("every other one of {rows}", rows=span), False
    return message("every {ordinal} one of {rows}", ordinal=say_ordinal(rows.every, "row"), rows=span), False


def say_row_of(over: int, origin: str) -> str:
    """The row of a place, or a row near it; of the place in hand where no origin is said."""
    if over == 0:
        return message("the row of {place}", place=origin) if origin else message("the same row")
    if over == 1:
        return message("the row after that of {place}", place=origin) if origin else message("the row after this one")
    if over == -1:
        return message("the row before that of {place}", place=origin) if origin else message("the row before this one")
    if over > 0:
        if origin:
            return message("the row {count} rows after that of {place}", count=over, place=origin)
        return message("the row {count} rows after this one", count=over)
    if origin:
        return message("the row {count} rows before that of {place}", count=-over, place=origin)
    return message("the row {count} rows before this one", count=-over)


def say_numbers(selector: InRow) -> str:
    """Which trees in a row: "trees 4 to 9", "tree 4", "the last 3 trees"."""
    first, last = selector.first, selector.last
    if first == last:
        if first >= 0:
            return message("tree {number}", context="in a row", number=first)
        return say_ranked_tree(first)
    if last == -1 and first < 0:
        return message("the last {count} trees", count=-first)
    if first == 1 and last > 0:
        return message("the first {count} trees", count=last)
    if first > 0 and last > 0:
        return message("trees {first} to {last}", first=first, last=last)
    return message("the {first} to the {last} tree", first=say_ordinal(first, "one"), last=say_ordinal(last, "one"))


def say_way(towards: Towards) -> str:
    """Which way along a row: "down the row", "along the row to the north"."""
    match towards:
        case "down":
            return message("down the row")
        case "up":
            return message("up the row")
    return message("along the row to the {side}", side=COMPASS[towards])


def say_order(selector: Ordered) -> str:
    """An order: "from west to east", "by yield, the highest first"."""
    if selector.by == "attribute":
        name = say_attribute(selector.attribute)[0]
        if selector.descending:
            return message("by {name}, the highest first", name=name)
        return message("by {name}, the lowest first", name=name)
    return (_BACKWARDS if selector.descending else _ORDERS)[selector.by]


def _say_row(said: str, side: str) -> str:
    if _is_name(said, side):
        return message("row {name}", name=_bare(said))
    if int(said) < -1:
        ordinal = say_ordinal(-int(said), "row")
        return message("the {ordinal} last row {from_side}", ordinal=ordinal, from_side=side)
    return message("the {ordinal} row {from_side}", ordinal=say_ordinal(int(said), "row"), from_side=side)


def _is_name(said: str, side: str) -> bool:
    """Whether a row is called so, rather than counted from a side or from the last."""
    return _rises(said) and not (side and said.strip().isdecimal())


def _rises(said: str) -> bool:
    """Whether it is a name, or a number that does not count from the last row."""
    return bool(said) and re.fullmatch(r"-\d{1,9}", said.strip()) is None


def _bare(said: str) -> str:
    return said[4:] if said.lower().startswith("row ") else said
