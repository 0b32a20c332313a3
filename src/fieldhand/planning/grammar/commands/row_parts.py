"""Constructions of work along parts of rows: "spray the San Marzano tomatoes", "film row 4 from G4-03 to G4-13"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.counted import row_itself
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.site.planting import Row

GRAMMAR = Grammar()
construction = GRAMMAR.construction


def _positions(trees: set[str], site: Site) -> list[tuple[Row, list[int]]] | None:
    """Return the rows of some trees with the positions of these in each, from 0.

    None if one of them stands in no row, or alone in its row: along a single tree there is no way.
    """
    found: list[tuple[Row, list[int]]] = []
    for row in site.planting.rows:
        at = [k for k, tree in enumerate(row.trees) if site.trees[tree].place.id in trees]
        found += [(row, at)] if at else []
    if any(len(at) == 1 for _, at in found) or sum(len(at) for _, at in found) != len(trees):
        return None
    return found


def _tract(trees: s.Selector, site: Site) -> Tract | None:
    """Return the parts of rows along some trees; None for whole rows, and for trees along which there is no way."""
    known = None if are_rows(trees) else ids_of(trees, site)
    there = _positions(known, site) if known else None
    if not there:
        return None
    row, at = there[0]
    if len(there) == 1 and len(trees.members) == at[-1] - at[0] + 1:  # "trees 3 to 13 of row 4", not a list of them
        part = s.InRow(first=at[0] + 1, last=at[-1] + 1, of=row_itself(row, site))
        if ids_of(part, site) == known:
            return Tract(part, "rows")
    return Tract(trees, "rows")


@construction(
    "tract: trees=place",
    "tract: way=ALONG trees=place",
    "tract: in_ trees=place",
    cost=1.0,
    given=("site", "robot"),
)
def trees_in_rows(trees: PlaceMeaning, site: Site, robot: RobotProfile, way: Lex | None = None) -> Tract | None:
    """Compose "the San Marzano tomatoes" of "spray the San Marzano tomatoes"."""
    del way
    works = any(action.implement is not None for action in robot.action.values())
    plain = (
        works
        and trees.shape in ("area", "several")
        and trees.per is None
        and not trees.optional
        and trees.at_most is None
        and not trees.refers_back
    )
    return _tract(trees.selector, site) if plain else None


@construction(
    "tract: [ALONG] rows=rows FROM first=TREEID range_to last=TREEID",
    "tract: [ALONG] rows=rows BETWEEN first=TREEID AND last=TREEID",
    "tract: FROM first=TREEID range_to last=TREEID",
    "tract: BETWEEN first=TREEID AND last=TREEID",
    cost=0.1,
    given=("site",),
)
def from_tree_to_tree(first: Lex, last: Lex, site: Site, rows: s.Selector | None = None) -> Tract | None:
    """Compose "row 4 from G4-03 to G4-13", of two trees of one row."""
    ends = {str(first.value), str(last.value)}
    for row in site.planting.rows:
        at = [k for k, tree in enumerate(row.trees) if site.trees[tree].place.id in ends]
        if len(at) == 2:
            part = s.InRow(first=at[0] + 1, last=at[1] + 1, of=row_itself(row, site))
            inside = rows is None or ends <= (ids_of(rows, site) or set())
            return Tract(part, "rows") if inside and len(ids_of(part, site) or ()) == at[1] - at[0] + 1 else None
    return None


def _plants_of(row: Row, site: Site) -> set[str]:
    return {site.trees[tree].place.id for tree in row.trees}


@construction(
    "tract: DET MIDDLE [n=count] noun=ROW", "tract: ALONG DET MIDDLE [n=count] noun=ROW",
    "tract: DET n=count MIDDLE noun=ROW", "tract: DET MIDDLE [n=count] noun=ROW in_ where=region",
    "tract: DET MIDDLE [n=count] noun=ROW OF where=region", "tract: DET n=count MIDDLE noun=ROW OF where=region",
    "tract: DET n=count MIDDLE noun=ROW in_ where=region", cost=0.1, given=("site",),
)  # fmt: skip
def middle_rows_of_sections(
    noun: Lex, site: Site, n: int | None = None, where: s.Selector | None = None
) -> list[Tract] | None:
    """Compose "the middle row" of sections whose rows are numbered on, and of one that is a zone as well."""
    every = [row.name for row in site.planting.rows]
    own = len(site.planting.blocks) > 1 or where is not None
    if not own or noun.plural != (n is not None) or n not in (None, 2) or len({*every}) < len(every):
        return None
    plants = None if where is None else ids_of(where, site) or set()
    there = (row for row in site.planting.rows if plants is None or _plants_of(row, site) <= plants)
    names = [row.name for row in there]
    if len(names) < 2 or not all(name.isdecimal() for name in names):
        return None
    names.sort(key=int)
    half, odd = divmod(len(names), 2)
    middle = [s.Rows(first=one, last=one) for one in names[half - 1 + odd : half + 1]]
    if n == 2:
        return [Tract(s.UnionOf(parts=tuple(middle)), "rows")] if len(middle) == 2 else None
    return [Tract(one, "rows") for one in middle]
