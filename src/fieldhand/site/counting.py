"""Count rows and trees as growers do: the rows of a block from one side, the trees of a row from one end."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Site
from fieldhand.site.names import say_block
from fieldhand.site.planting import Block, Planting, Row
from fieldhand.terms import CountedFrom, Side

OUTWARD: Mapping[Side, tuple[float, float]] = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}
_OPPOSITE: Mapping[str, Side] = {"north": "south", "south": "north", "east": "west", "west": "east"}
_WINDS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")

#: A row leads towards a side of the compass within this angle of it (60 degrees): one to the north-east leads to both.
_TOWARDS_COS = 0.5 - 1e-9

#: An id of a tree such as "B07-12": the row's part, and the number in the row.
_ENDS_IN_NUMBER = re.compile(r"(.*\D)0*(\d{1,6})")
_NUMBERED = re.compile(r"(\D*?) ?0*(\d{1,9})")


def require_rows(site: Site) -> Planting:
    """Return the planting of a site.

    Raises:
        PlaceError: The site has no rows.
    """
    if not site.planting.blocks:
        raise PlaceError(
            message("this site has no rows"),
            where=site.name,
            advice=message(
                "{why}; select trees by id, by compass direction or by zone",
                why=site.planting.why or message("the trees do not stand in rows"),
            ),
        )
    return site.planting


def along(block: Block) -> NDArray[np.float64]:
    """Return the unit vector along a block's rows, away from their usual end."""
    turn = np.radians(block.bearing_deg)
    axis = np.array([np.sin(turn), np.cos(turn)])
    away = axis[0] > 0 if block.runs_east_west else axis[1] < 0
    return axis if away else -axis


def across(block: Block) -> NDArray[np.float64]:
    """Return the unit vector across a block's rows, towards higher numbers."""
    x, y = along(block)
    return np.array([y, -x]) if block.runs_east_west else np.array([-y, x])


def wind(vector: NDArray[np.float64]) -> str:
    """Return the direction of a vector by the eight-point compass: "south-east"."""
    return _WINDS[round(float(np.degrees(np.arctan2(vector[0], vector[1]))) / 45.0) % 8]


def leads(vector: NDArray[np.float64], side: Side) -> int:
    """Return 1 if the vector leads towards a side, -1 if away from it, 0 if neither."""
    cosine = float(vector @ np.array(OUTWARD[side]))
    return 0 if abs(cosine) < _TOWARDS_COS else int(np.sign(cosine))


def way_of(block: Block) -> str:
    """Return the direction of a block's rows: "north to south"."""
    axis = along(block)
    return message("{one} to {other}", one=COMPASS[wind(-axis)], other=COMPASS[wind(axis)])


def rows_from(site: Site, block: Block, side: CountedFrom) -> tuple[tuple[Row, ...], str]:
    """Return the rows of a block in counting order, and the side that they are counted from.

    By default rows are counted from the side where the site's own numbers or letters begin, else from the usual side.

    Raises:
        PlaceError: The rows cannot be counted from that side, because they run towards it.
    """
    if side == "usual":
        falling = _falls([row.name for row in block.rows if row.known == "file"])
        axis = across(block)
        return (block.rows[::-1], wind(axis)) if falling else (block.rows, wind(-axis))
    way = leads(across(block), side)
    if way == 0:
        axis = across(block)
        raise PlaceError(
            _not_counted(message("rows cannot be counted from the {side}", side=COMPASS[side]), site, block),
            where=site.name,
            advice=message(
                "count from the {one} or from the {other}", one=COMPASS[wind(-axis)], other=COMPASS[wind(axis)]
            ),
        )
    return (block.rows[::-1] if way > 0 else block.rows), side


def trees_from(site: Site, block: Block, side: CountedFrom) -> tuple[int, str]:
    """Return 1 if the trees of a block's rows count in list order, -1 if backwards, and the side that they are counted
    from.

    By default they are counted from where the numbers in their ids begin ("B07-01"), else from the usual end.

    Raises:
        PlaceError: The rows have no end on that side.
    """
    axis = along(block)
    if side == "usual":
        return (-1, wind(axis)) if _ids_fall(site, block) else (1, wind(-axis))
    way = leads(axis, side)
    if way == 0:
        raise PlaceError(
            _not_counted(message("trees in a row cannot be counted from the {side}", side=COMPASS[side]), site, block),
            where=site.name,
            advice=message(
                "count from the {one} or from the {other}", one=COMPASS[wind(-axis)], other=COMPASS[wind(axis)]
            ),
        )
    return -way, side


def find_block(site: Site, name: str) -> Block | None:
    """Return the block of a name, else of a number from 1; None if there is none."""
    blocks = site.planting.blocks
    exact = [b for b in blocks if b.name == name]
    alike = exact or [b for b in blocks if bare_name(b.name) == bare_name(name)]
    if alike:
        return alike[0]
    number = bare_name(name)
    return blocks[int(number) - 1] if number.isdecimal() and 0 < int(number[:9]) <= len(blocks) else None


def find_row(rows: Sequence[Row], name: str, *, by_number: bool = False) -> int | None:
    """Return the index of the row with a name or number; None if there is none.

    The full name is tried first, then the number in the name ("3" is "R03" if all rows have such names), then the
    position in counting order; negative numbers count from the last row.

    Args:
        rows: Rows in counting order.
        name: A name or a number.
        by_number: Treat numbers as positions in counting order, regardless of the names.
    """
    number = int(name) if re.fullmatch(r"-?\d{1,9}", name.strip()) else None
    if not by_number or number is None:
        exact = [k for k, row in enumerate(rows) if row.name == name]
        counts_back = number is not None and number < 0
        alike = exact or [k for k, r in enumerate(rows) if not counts_back and bare_name(r.name) == bare_name(name)]
        if alike:
            return alike[0]
        own = _own_numbers(tuple(row.name for row in rows))
        if own and (number is None or number >= 0):
            return own.index(number) if number in own else None
    if number is None or number == 0 or abs(number) > len(rows):
        return None
    return number - 1 if number > 0 else len(rows) + number


@lru_cache(maxsize=4096)
def bare_name(name: str) -> str:
    """Return a row's or block's name for comparison: lower case, without a leading "row" or "block"."""
    words = phrase(name)
    for lead in ("row ", "block "):
        words = words.removeprefix(lead)
    return words or name.strip().lower()


def row_words(site: Site, row: Row) -> str:
    """Return a row in words: "row 3", with its block if there are several."""
    name = bare_name(row.name) if phrase(row.name).startswith("row ") else row.name
    blocks = site.planting.blocks
    words = message("row {name}", name=name)
    return message("{rows} of {block}", rows=words, block=block_words(blocks[row.block])) if len(blocks) > 1 else words


def block_words(block: Block) -> str:
    """Return a block in words: "block B"."""
    return say_block(block.name)


def _not_counted(what: str, site: Site, block: Block) -> str:
    """Return the refusal with the direction in which the rows run."""
    if len(site.planting.blocks) == 1:
        return message("{what}: the rows run {way}", what=what, way=way_of(block))
    return message("{what}: the rows of {block} run {way}", what=what, block=block_words(block), way=way_of(block))


@lru_cache(maxsize=1024)
def _own_numbers(names: tuple[str, ...]) -> tuple[int, ...]:
    """Return the numbers in names that share the same letters and differ in the number; else nothing."""
    found = [_NUMBERED.fullmatch(bare_name(name)) for name in names]
    if not found or len({m.group(1) if m else None for m in found}) > 1 or found[0] is None:
        return ()
    numbers = tuple(int(m.group(2)) for m in found if m)
    return numbers if len(set(numbers)) == len(names) else ()


def _falls(names: Sequence[str]) -> bool:
    """Return True if numbers or single letters decrease from name to name."""
    numbers = _own_numbers(tuple(names))
    letters = [name.lower() for name in names if len(name) == 1 and name.isalpha()]
    order: Sequence[int | str] = numbers if numbers else letters if len(letters) == len(names) else ()
    return len(order) > 1 and all(a > b for a, b in pairwise(order))  # type: ignore[operator]


def _ids_fall(site: Site, block: Block) -> bool:
    """Return True if the ids of the trees end in numbers that decrease along each row, and begin anew in each row."""
    beginnings: set[str] = set()
    for row in block.rows:
        found = [_ENDS_IN_NUMBER.fullmatch(site.trees[k].place.id) for k in row.trees.tolist()]
        names, numbers = {m[1] if m else "" for m in found}, [int(m[2]) for m in found if m]
        if len(names) != 1 or len(numbers) != len(found) or not all(a > b for a, b in pairwise(numbers)):
            return False
        beginnings |= names
    return len(beginnings) == len(block.rows) and any(len(row.trees) > 1 for row in block.rows)


def numbered_by_file(site: Site, row: Row) -> bool:
    """Return True if the row's planting positions are numbers from the file."""
    first, last = (site.trees[k].properties for k in (row.trees[0], row.trees[-1]))
    names = [n for n, value in first.items() if _same(value, row.slots[0]) and _same(last.get(n), row.slots[-1])]
    return any(
        all(_same(site.trees[k].properties.get(name), slot) for k, slot in zip(row.trees, row.slots, strict=True))
        for name in names
    )


def _same(value: object, slot: int) -> bool:
    try:
        return not isinstance(value, bool) and float(value) == slot  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return False
