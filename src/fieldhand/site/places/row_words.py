"""Rows, and counting along them, as growers say them: "rows 2 to 5", "every third tree", "trees 4 to 9"."""

from __future__ import annotations

import re

from fieldhand.site.kinds import phrase
from fieldhand.site.places.attribute_words import say_attribute
from fieldhand.task.selectors import InRow, Order, Ordered, Rows, Towards

_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")
_ORDERS: dict[Order, str] = {
    "west_to_east": "from west to east",
    "east_to_west": "from east to west",
    "north_to_south": "from north to south",
    "south_to_north": "from south to north",
    "nearest_first": "the nearest first",
    "farthest_first": "the farthest first",
    "rows": "row by row",
}
_BACKWARDS: dict[Order, str] = {
    "west_to_east": "from east to west",
    "east_to_west": "from west to east",
    "north_to_south": "from south to north",
    "south_to_north": "from north to south",
    "nearest_first": "the farthest first",
    "farthest_first": "the nearest first",
    "rows": "row by row from the last",
}


def say_ordinal(number: int) -> str:
    """Which in a count: "third", "12th", and from the other end "last", "second last"."""
    if number < 0:
        return "last" if number == -1 else f"{say_ordinal(-number)} last"
    if 0 < number <= len(_ORDINALS):
        return _ORDINALS[number - 1]
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def say_every(nth: int) -> str:
    """Every so many: "every", "every other", "every third"."""
    return {1: "every", 2: "every other"}.get(nth, f"every {say_ordinal(nth)}")


def say_block(block: str) -> str:
    """A block: "block B"."""
    return block if phrase(block).startswith("block ") else f"block {block}"


def say_rows(rows: Rows) -> tuple[str, bool]:
    """The rows that are meant, without the trees in them, and whether it is one: "row 3", "every other row"."""
    first, last = rows.first, rows.last
    side = "" if rows.counted_from == "usual" else f" from the {rows.counted_from}"
    if first and first == last:
        return f"{_say_row(first, side)}", True
    if not first and not last:
        every = "all rows" if rows.every == 1 else f"{say_every(rows.every)} row"
        return f"{every}{side}", False
    if _rises(first) and _rises(last):
        span = f"rows {_bare(first)} to {_bare(last)}{side}"
    else:
        span = f"the rows from {_say_end(first, 'first', side)} to {_say_end(last, 'last', side)}"
    return (span if rows.every == 1 else f"{say_every(rows.every)} one of {span}"), False


def say_row_of(over: int, origin: str) -> str:
    """The row of a place, or a row near it; of the place in hand where no origin is said."""
    if over == 0:
        return f"the row of {origin}" if origin else "the same row"
    after = "after" if over > 0 else "before"
    if abs(over) == 1:
        return f"the row {after} that of {origin}" if origin else f"the row {after} this one"
    return f"the row {abs(over)} rows {after} {f'that of {origin}' if origin else 'this one'}"


def say_numbers(selector: InRow) -> str:
    """Which trees in a row: "trees 4 to 9", "tree 4", "the last 3 trees"."""
    first, last = selector.first, selector.last
    if first == last:
        return f"tree {first}" if first >= 0 else f"the {say_ordinal(first)} tree"
    if last == -1 and first < 0:
        return f"the last {-first} trees"
    if first == 1 and last > 0:
        return f"the first {last} trees"
    if first > 0 and last > 0:
        return f"trees {first} to {last}"
    return f"the {say_ordinal(first)} to the {say_ordinal(last)} tree"


def say_way(towards: Towards) -> str:
    """Which way along a row: "down the row", "along the row to the north"."""
    return f"{towards} the row" if towards in ("down", "up") else f"along the row to the {towards}"


def say_order(selector: Ordered) -> str:
    """An order: "from west to east", "by yield, the highest first"."""
    if selector.by == "attribute":
        end = "highest" if selector.descending else "lowest"
        return f"by {say_attribute(selector.attribute)[0]}, the {end} first"
    return (_BACKWARDS if selector.descending else _ORDERS)[selector.by]


def _say_row(said: str, side: str) -> str:
    return f"row {_bare(said)}" if _is_name(said, side) else f"the {say_ordinal(int(said))} row{side}"


def _say_end(said: str, otherwise: str, side: str) -> str:
    """One end of a range of rows."""
    return _say_row(said, side) if said else f"the {otherwise} row{side}"


def _is_name(said: str, side: str) -> bool:
    """Whether a row is called so, rather than counted from a side or from the last."""
    return _rises(said) and not (side and said.strip().isdecimal())


def _rises(said: str) -> bool:
    """Whether it is a name, or a number that does not count from the last row."""
    return bool(said) and re.fullmatch(r"-\d{1,9}", said.strip()) is None


def _bare(said: str) -> str:
    return said[4:] if said.lower().startswith("row ") else said
