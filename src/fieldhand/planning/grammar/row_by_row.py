"""Rows one by one, where something is said of each of them that no selector says of all."""

from __future__ import annotations

from fieldhand.errors import PlaceError, TaskError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.selections import as_rows, is_in_block, rows_kept
from fieldhand.site.model import Site

#: Maximum number of rows that are planned one by one.
MOST_ONE_BY_ONE = 60


def one_by_one(selector: s.Selector, site: Site) -> tuple[s.Selector, ...]:
    """Return the rows of a selection, each as a selector of its own."""
    try:
        places = resolve(selector, site, Context(here=site.start))
    except (PlaceError, TaskError):
        return ()
    planting = site.planting
    index = [site.by_id[place.id].index for place in places if place.id in site.by_id]
    numbers = sorted({int(k) for k in planting.row_of[index] if k >= 0})
    parts = (rows_kept(selector) or selector).members
    named_rows = [named_by for part in parts if (named_by := as_rows(part)) is not None]
    inner_most = {part.of for part in named_rows}
    plain = len(inner_most) == 1 and len(named_rows) == len(parts)
    of = next(iter(inner_most)) if plain else selector
    made: list[s.Selector] = []
    for k in numbers:
        row = planting.rows[k]
        block = planting.blocks[row.block]
        named = len(planting.blocks) > 1 and not is_in_block(of)
        inner = s.InBlock(block=block.name, of=of) if named else of
        made.append(s.Rows(first=row.name, last=row.name, of=inner))
    return tuple(made)
