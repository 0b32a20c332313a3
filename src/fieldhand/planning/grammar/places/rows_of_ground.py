"""Constructions of rows that are counted within an area: "the second row of the cool section"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.places.counted import row_itself
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.numbers import whole
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone, over
from fieldhand.site.model import Site
from fieldhand.site.planting import Row

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "rows: [DET] rank=ORD ROW in_ where=region", "rows: [DET] rank=ORD ROW OF where=region",
    "rows: [DET] LAST ROW in_ where=region", "rows: [DET] LAST ROW OF where=region",
    cost=0.0, given=("site",),
)  # fmt: skip
def row_of_ground(where: s.Selector, site: Site, rank: Lex | None = None) -> list[s.Selector] | None:
    """Compose "the second row of the cool section", if the second row of the site is elsewhere."""
    return _counted(-1 if rank is None else int(rank.value) - 1, where, site) or None


@construction(
    "rows: [DET] ROW number=NUM in_ where=region", "rows: [DET] ROW number=NUM OF where=region",
    cost=0.0, given=("site",),
)  # fmt: skip
def numbered_row_of_ground(number: Lex, where: s.Selector, site: Site) -> list[s.Selector] | None:
    """Compose "row 2 of the cool section", if row 2 is elsewhere: the second row there, or row 2?"""
    n = whole(number.value)
    found = [] if n is None else _counted(n - 1, where, site)
    named = [row_itself(row, site) for row in site.planting.rows if row.name == str(n)]
    return [*found, *named] if found else None


def _counted(at: int, where: s.Selector, site: Site) -> list[s.Selector]:
    """Return the row at an index among the rows of an area, by their numbers and by where they lie.

    None if the area has not as many, or holds the row that is counted so on the whole site.
    """
    zone = as_zone(where)
    if zone is None or zone.outside or zone.margin_m:
        return []
    there = ids_of(zone, site) or set()
    rows = [row for row in site.planting.rows if {site.trees[tree].place.id for tree in row.trees} <= there]
    if not rows or len(rows) == len(site.planting.rows) or not -len(rows) <= at < len(rows):
        return []
    if at >= 0 and any(row.name == str(at + 1) for row in rows):
        return []
    by_number = sorted(rows, key=_number) if all(row.name.isdecimal() for row in rows) else rows
    return list(dict.fromkeys(over(row_itself(ordered[at], site), zone) for ordered in (by_number, rows)))


def _number(row: Row) -> int:
    return int(row.name)
