"""Constructions of rows by the plants in them: "the Merlot rows", "the pumpkin bed", "each covered bed"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.places.counted import row_itself
from fieldhand.planning.grammar.places.flags import is_not_so, is_so
from fieldhand.planning.grammar.places.nouns import AttributeTest, that_pass
from fieldhand.planning.grammar.places.numbered import all_of, ids_of
from fieldhand.planning.grammar.places.rows import OPPOSITE_SIDE
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows
from fieldhand.site.counting import rows_from
from fieldhand.site.model import Site
from fieldhand.site.planting import Row

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Attributes that say where a plant stands, not what it is.
_OF_THE_GROUND = frozenset({"row", "block"})


# What grows in a row.


@construction("planted: value=ATTRVAL", cost=0.0)
def planted_with(value: Lex) -> list[s.Selector]:
    """Compose "pumpkin" before "bed"."""
    return [s.Where(attribute=name, test="eq", value=text) for name, text in value.value if name not in _OF_THE_GROUND]


@construction("planted: values=value_list", cost=0.0)
def planted_with_several(values: tuple[tuple[str, str], ...]) -> s.Selector | None:
    """Compose "leek and onion" before "beds"."""
    if values[0][0] in _OF_THE_GROUND:
        return None
    return that_pass((values[0][0], "any", tuple(text for _, text in values)), s.Trees())


@construction("planted: flag=FLAG", "planted: NON [DASH] no=FLAG", "planted: NOT no=FLAG", cost=0.0)
def planted_so(flag: Lex | None = None, no: Lex | None = None) -> list[s.Selector]:
    """Compose "covered" before "beds"."""
    tests = is_so(flag) if flag is not None else [] if no is None else is_not_so(no)
    return [that_pass(test, s.Trees()) for test in tests]


@construction("planted: flag=FLAG inner=planted", cost=0.1)
def planted_so_with(flag: Lex, inner: s.Selector) -> list[s.Selector]:
    """Compose "covered lettuce" before "beds"."""
    return [that_pass(test, inner) for test in is_so(flag)]


@construction(
    "planted_rows: noun=ROW OF [DET] inner=planted [TREE]",
    "planted_rows: noun=ROW WITH [DET] inner=planted [TREE]",
    "planted_rows: noun=ROW FOR [DET] inner=planted [TREE]",
    "planted_rows: noun=ROW WHERE [DET] inner=planted [IS]",
    "planted_rows: noun=ROW [in_] WHICH [DET] inner=planted [IS]",
    "planted_rows: noun=ROW STANDS inner=planted",
    "planted_rows: inner=planted noun=ROW",
    cost=0.1,
)
def rows_planted(noun: Lex, inner: s.Selector) -> tuple[s.Selector, bool]:
    """Compose "pumpkin bed" and "beds with courgettes": the plants, and whether the noun stands in the plural."""
    return inner, noun.plural


@construction("planted_rows: noun=ROW [which_is] test=attribute_test", cost=0.3)
def rows_that_pass(noun: Lex, test: AttributeTest) -> tuple[s.Selector, bool]:
    """Compose "beds that are covered"."""
    return that_pass(test, s.Trees()), noun.plural


@construction("planted_rows: noun=ROW is_not test=attribute_test", cost=0.3)
def rows_that_do_not_pass(noun: Lex, test: AttributeTest) -> tuple[s.Selector, bool] | None:
    """Compose "beds that aren't covered"."""
    name, check, value = test
    if check != "eq" or not isinstance(value, bool):
        return None
    return that_pass((name, check, not value), s.Trees()), noun.plural


# Rows.


@construction("rows: [DET] planted=planted_rows", cost=0.1, given=("site",))
def rows_of_kind(planted: tuple[s.Selector, bool], site: Site) -> list[s.Selector] | None:
    """Compose "the Merlot rows" and "the pumpkin bed", where no row has plants of two kinds."""
    kind, plural = planted
    rows = filled_rows(kind, site)
    if plural:
        return [s.Rows(of=kind)] if rows else None
    return [row_itself(row, site) for row in rows] or None


@construction("rows: [DET] n=count planted=planted_rows", cost=0.1, given=("site",))
def so_many_rows_of_kind(n: int, planted: tuple[s.Selector, bool], site: Site) -> s.Selector | None:
    """Compose "the two cabbage beds", where there are as many."""
    kind, plural = planted
    return s.Rows(of=kind) if plural and len(filled_rows(kind, site)) == n else None


@construction(
    "each_row: EACH planted=planted_rows", "each_row: EACH OF DET planted=planted_rows", cost=0.1, given=("site",)
)
def each_row_of_kind(planted: tuple[s.Selector, bool], site: Site) -> s.Selector | None:
    """Compose "each Merlot row" and "each of the cabbage beds"."""
    kind, _ = planted
    return s.Rows(of=kind) if filled_rows(kind, site) else None


def filled_rows(kind: s.Selector, site: Site) -> list[Row]:
    """Return the rows that have plants of a kind, if all of these have no others; else none."""
    plants = ids_of(kind, site) or set()
    found = []
    for row in site.planting.rows:
        there = {site.trees[tree].place.id for tree in row.trees}
        if not there & plants:
            continue
        if not there <= plants:
            return []
        found.append(row)
    return found


def rows_out_of(kind: s.Selector, site: Site) -> s.Selector | None:
    """Return the rows of some plants, if these are all plants of the rows; None if they are not, or are rows anyway."""
    if are_rows(kind):
        return None
    rows = filled_rows(kind, site)
    return all_of([row_itself(row, site) for row in rows]) if rows else None


@construction(
    "rows: DET noun=ROW [DIRECTLY] NEXTTO kind=crop_area", "rows: DET noun=ROW [DIRECTLY] BESIDE kind=crop_area",
    "rows: BOTH noun=ROW [DIRECTLY] NEXTTO kind=crop_area", "rows: DET noun=ROW EACHSIDE [OF] kind=crop_area",
    "rows: DET noun=ROW side=on_side OF kind=crop_area",
    cost=0.2, given=("site",),
)  # fmt: skip
def rows_next_to_crop(noun: Lex, kind: s.Selector, site: Site, side: str = "") -> s.Selector | list[s.Selector] | None:
    """Compose "the bed next to the onions", which may lie to either side of theirs, and "the beds next to them"."""
    there = filled_rows(kind, site)
    found: dict[str, s.Selector] = {}
    for block in {row.block for row in there}:
        rows, first_side = rows_from(site, site.planting.blocks[block], "usual")
        if side and side not in (first_side, OPPOSITE_SIDE.get(first_side)):
            return None
        steps = (-1, 1) if not side else (-1,) if side == first_side else (1,)
        at = {k + step for k, row in enumerate(rows) if row in there for step in steps}
        beside = [rows[k] for k in sorted(at) if 0 <= k < len(rows) and rows[k] not in there]
        found |= {row.name: row_itself(row, site) for row in beside}
    if not noun.plural:
        return list(found.values()) or None
    return all_of(list(found.values())) if len(found) > 1 else None
