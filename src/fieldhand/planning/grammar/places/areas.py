"""Constructions of areas: halves, quarters, edges, zones and blocks, and what is inside or outside them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import split
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.places.nouns import extreme
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.numbers import name_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    AREAS,
    are_meant_each,
    are_rows,
    as_edge,
    as_half,
    as_quota,
    as_where,
    as_zone,
    chooses_from_trees,
    compass_part,
    counts_in_row,
    is_block,
    is_in_block,
    is_row_of_place,
    is_whole_rows,
    measures_from_here,
    of_each,
    over,
    part_on_side,
    specifies_part,
    swapped,
)
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Maximum number of blocks to choose from.
_MOST_BLOCKS = 5


@construction(
    "region: [DET] side=DIR HALF",
    "region: [DET] side=DIR SIDE",
    "region: DET side=DIR OF site",
    cost=0.2,
)
def half(side: Lex) -> s.Selector | None:
    """Compose "the northern half" and "the north-east part"."""
    if side.value in CORNERS:
        return s.Quarter(quarter=side.value)
    return s.Half(side=side.value)


@construction("region: DET side=DIR OF whole=region", cost=0.3, given=("site",))
def side_of_ground(side: Lex, whole: s.Selector, site: Site) -> s.Selector | None:
    """Compose "the north of the paddock", of ground without plants."""
    part = half(side)
    return swapped(part, s.Trees(), whole) if part is not None and is_bare(whole, site) else None


@construction("region: [DET] side=DIR QUARTER", cost=0.2)
def quarter(side: Lex) -> s.Selector | None:
    """Compose "the north-east quarter"."""
    return s.Quarter(quarter=side.value) if side.value in CORNERS else None


@construction("region: [DET] side=DIR EDGE", cost=0.2)
def edge(side: Lex) -> s.Selector | None:
    """Compose "the northern edge"."""
    return s.Edge(side=side.value) if side.value in SIDES else None


@construction("nominal: EDGE noun=TREE", "nominal: OUTER noun=TREE", "nominal: side=DIR EDGE noun=TREE", cost=0.2)
def edge_trees(noun: Lex, side: Lex | None = None) -> Nominal | None:
    """Compose "edge trees" and "northern edge trees"."""
    where = edges() if side is None else edge(side)
    return None if where is None or not noun.plural else Nominal(where, plural=True)


@construction("nominal: inner=nominal in_ DET FAR side=DIR", cost=0.2)
def in_the_far_north(inner: Nominal, side: Lex) -> Nominal | None:
    """Compose "tree in the far north"."""
    return None if inner.plural else extreme(side, inner)


@construction("edge_word: noun=EDGE", cost=0.0, given=("site",))
@construction("water_edge: noun=WATEREDGE", cost=0.0, given=("site",))
def edge_word(noun: Lex, site: Site) -> Lex | None:
    """Compose "edge" and "bank"; "fence" is none where a zone is called so, "the stock fence"."""
    zones = (split(zone.name) for zone in site.zones if zone.kind != "boundary")
    return None if any(name[-1:] == (noun.text,) for name in zones) else noun


@construction("region: [DET] edge_word", cost=0.3)
def edges() -> s.Selector:
    """Compose "the edges"."""
    return s.UnionOf(parts=tuple(s.Edge(side=side) for side in SIDES))


@construction("region: [DET] zone=ZONE", cost=0.1)
def zone(zone: Lex) -> s.Selector:
    """Compose "the wet corner", the name of a zone."""
    return s.InZone(zone=zone.value)


@construction(
    "block: [DET] name=BLOCKNAME noun=PLOT",
    "block: [DET] noun=PLOT name=BLOCKNAME",
    "block: [DET] noun=PLOT name=NUM",
    cost=0.1,
)
def block(name: Lex, noun: Lex) -> s.Selector | None:
    """Compose "block 2"."""
    return s.InBlock(block=name_of(name)) if "block" in noun.features else None


@construction(
    "owned_block: [DET] name=BLOCKNAME PLOTPOSS",
    "owned_block: [DET] [PLOT] name=BLOCKNAMEPOSS",
    cost=0.1,
)
def owned_block(name: Lex) -> s.Selector:
    """Compose "the north block's"."""
    return s.InBlock(block=name_of(name))


@construction(
    "block_list: first=BLOCKNAME AND second=BLOCKNAME",
    "block_list: first=BLOCKNAME AND DET second=BLOCKNAME",
    cost=0.0,
)
def block_list(first: Lex, second: Lex) -> tuple[s.Selector, ...]:
    """Compose "A and B" beside "blocks"."""
    return (s.InBlock(block=name_of(first)), s.InBlock(block=name_of(second)))


@construction("block_list: first=BLOCKNAME COMMA more=block_list", cost=0.0)
def longer_block_list(first: Lex, more: tuple[s.Selector, ...]) -> tuple[s.Selector, ...]:
    """Compose "A, B and C" beside "blocks"."""
    return (s.InBlock(block=name_of(first)), *more)


@construction("blocks: [DET] noun=PLOT named=block_list", "blocks: [DET] named=block_list noun=PLOT", cost=0.1)
def named_blocks(noun: Lex, named: tuple[s.Selector, ...]) -> tuple[s.Selector, ...] | None:
    """Compose "blocks A and B"."""
    return named if noun.plural and "block" in noun.features and len(set(named)) == len(named) else None


@construction(
    "each_block: EACH noun=PLOT", "each_block: EACH OF DET noun=PLOT", "each_block: EACH DET noun=PLOT",
    cost=0.1, given=("site",),
)  # fmt: skip
def each_block(noun: Lex, site: Site) -> tuple[s.Selector, ...] | None:
    """Compose "each block" and "both blocks"."""
    if "block" not in noun.features or len(site.planting.blocks) < 2:
        return None
    return tuple(s.InBlock(block=block.name) for block in site.planting.blocks)


@construction("per_block: PER noun=PLOT", cost=0.1, given=("site",))
def per_block(noun: Lex, site: Site) -> tuple[s.Selector, ...] | None:
    """Compose "per block"."""
    return None if noun.plural else each_block(noun, site)


@construction("each_block: EACH OF blocks=blocks", "each_block: EACH blocks=blocks", cost=0.0)
def each_of_blocks(blocks: tuple[s.Selector, ...]) -> tuple[s.Selector, ...]:
    """Compose "each of the blocks A and B"."""
    return blocks


@construction("place: blocks=each_block", cost=0.4)
def at_each_block(blocks: tuple[s.Selector, ...]) -> PlaceMeaning:
    """Compose "each block" as a place."""
    return PlaceMeaning(s.Trees(), "area", each=True, per=s.UnionOf(parts=blocks))


def of_each_block(selector: s.Selector, blocks: tuple[s.Selector, ...], site: Site) -> s.Quota | None:
    """Return a number of any trees as so many of each of some blocks; None for other selectors or areas."""
    if not all(is_block(block) for block in blocks):
        return None
    every = set(blocks) == {s.InBlock(block=block.name) for block in site.planting.blocks}
    return of_each(selector, "block", s.Trees() if every else s.UnionOf(parts=blocks))


@construction(
    "place: one=place in_ blocks=each_block",
    "place: one=place FOR blocks=each_block",
    "place: one=place in_ blocks=blocks",
    "place: one=place blocks=per_block",
    cost=0.2,
    given=("site",),
)
def in_each_block(one: PlaceMeaning, blocks: tuple[s.Selector, ...], site: Site) -> PlaceMeaning | None:
    """Compose "two trees in each block" and "the corners of both blocks"."""
    if one.per is not None or one.shape not in ("one", "several") or one.optional or one.at_most:
        return None
    if not chooses_from_trees(one.selector) or is_in_block(one.selector):
        return None
    if all(counts_in_row(part) for part in one.selector.members):
        return None  # "the ends of row 2 in both blocks": of their rows
    chosen_of_each = as_quota(one.selector) is not None
    if one.shape == "several" and one.count is None and not chosen_of_each and not are_meant_each(one.selector):
        return replace(one, selector=over(one.selector, s.UnionOf(parts=blocks)))
    if (quota := of_each_block(one.selector, blocks, site)) is not None:
        return PlaceMeaning(quota, "several", each=True)
    parts = tuple(over(one.selector, block) for block in blocks)
    number = 1 if one.shape == "one" else one.count
    count = None if number is None else number * len(blocks)
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=count, each=one.each)


@construction("region: word=DET noun=PLOT", cost=0.6, given=("site",))
def some_block(word: Lex, noun: Lex, site: Site) -> list[s.Selector] | None:
    """Compose "the block" on a site of several: which of them?"""
    blocks = site.planting.blocks
    if noun.plural or "block" not in noun.features or word.features.isdisjoint({"definite", "indefinite"}):
        return None
    return [s.InBlock(block=block.name) for block in blocks] if 1 < len(blocks) <= _MOST_BLOCKS else None


@construction("bare_block: name=BLOCKNAME", cost=0.7)
def bare_block(name: Lex) -> s.Selector:
    """Compose "Home", the name of a block, without the word "block"."""
    return s.InBlock(block=name.value)


@construction("region: block=bare_block", cost=0.0)
def bare_block_as_region(block: s.Selector) -> s.Selector:
    """Compose "Home" as an area."""
    return block


@construction("region: block=block", cost=0.0)
def block_as_region(block: s.Selector) -> s.Selector:
    """Compose "block 2" as an area."""
    return block


@construction(
    "region: part=region OF whole=region",
    "region: part=region in_ whole=region",
    "region: whole=block part=rows",
    cost=0.2,
    given=("site",),
)
def part_of(part: s.Selector, whole: s.Selector, site: Site) -> s.Selector | None:
    """Compose "rows 3 to 5 of the northern half"; of a zone without plants it is a part of the ground."""
    named = compass_part(part)
    if named is not None and named[1] == s.Trees() and is_bare(whole, site):
        return swapped(part, s.Trees(), whole)
    if are_zones(whole) and _is_side(part) and all(ids_of(zone, site) for zone in whole.members):
        return s.UnionOf(parts=sides) if len(sides := side_of_zones(part, whole)) > 1 else sides[0]
    return over(part, whole) if chooses_from_trees(part) and _is_larger(whole, part) else None


def are_zones(area: s.Selector) -> bool:
    """Return True for zones by their names."""
    zones = [as_zone(one) for one in area.members]
    return all(one is not None and not one.outside and one.of == s.Trees() for one in zones)


def _is_side(part: s.Selector) -> bool:
    """Return True for a half, a quarter or an edge of the site."""
    named, edge = compass_part(part), as_edge(part)
    return (named is not None and named[1] == s.Trees()) or (edge is not None and edge.of == s.Trees())


def side_of_zones(part: s.Selector, zones: s.Selector) -> tuple[s.Selector, ...]:
    """Return a half, a quarter or an edge of each of some zones, whose middle lines are not those of the site."""
    return tuple(swapped(part, s.Trees(), zone) for zone in zones.members)


def is_bare(area: s.Selector, site: Site) -> bool:
    """Return True for a zone that can be driven on, in which no plants grow."""
    zone = as_zone(area)
    if zone is None or {one.kind for one in site.zones if one.name == zone.zone} <= {"keep_out"}:
        return False
    return zone == s.InZone(zone=zone.zone) and not (site.trees and ids_of(zone, site))


def _is_larger(whole: s.Selector, part: s.Selector) -> bool:
    """Return True unless the whole is made of rows and the part is none of them."""
    if as_edge(whole) is not None:
        return False
    return not (are_rows(whole) and not are_rows(part))


@construction("in_: word=AT", "in_: word=INSIDE", "in_: of=OF", cost=0.0)
def in_word(word: Lex | None = None, of: Lex | None = None) -> str | None:
    """Compose "in", "throughout" and "of"."""
    if of is not None:
        return "of" if "within" in of.features else None
    return "in" if word is not None and "within" in word.features else None


@construction("in_: word=FROM", cost=0.0)
def from_word(word: Lex) -> str | None:
    """Compose "from", which may name what a distance is measured from as well."""
    return "from" if "within" in word.features else None


@construction("site: [word=DET] noun=PLOT", cost=0.0, given=("site",))
def the_site(noun: Lex, site: Site, word: Lex | None = None) -> str | None:
    """Compose "the orchard", and "the block" where it is the only one."""
    if word is not None and "indefinite" in word.features:
        return None
    return None if "block" in noun.features and len(site.planting.blocks) > 1 else "site"


@construction(
    "region: first=region AND second=region",
    "region: first=region comma=COMMA second=region",
    "region: first=region COMMA AND second=region",
    "region: first=region AND in_ second=region",
    cost=0.4,
)
def both_areas(first: s.Selector, second: s.Selector, comma: Lex | None = None) -> s.Selector | None:
    """Compose "the northern half and the eastern edge"."""
    apart = part_on_side(second.members[0], first) is not None and part_on_side(first.members[-1], second) is None
    if comma is not None and apart:
        return None  # "the paddock, western half"
    if are_rows(first) != are_rows(second) or {*first.members} & {*second.members}:
        return None
    if are_rows(first) and is_whole_rows(first) and not is_whole_rows(second):
        return None  # "row 2 and row 4 in the northern half": both are meant there
    parts = tuple(part for one in (first, second) for part in one.members)
    return s.UnionOf(parts=parts)


@construction("region: part=region OF site", "region: part=region in_ site", cost=0.0)
def of_the_site(part: s.Selector) -> s.Selector:
    """Compose "the northern half of the orchard"."""
    return part


@construction("nominal: inner=nominal in_ site", cost=0.1)
def of_the_whole_site(inner: Nominal) -> Nominal:
    """Compose "trees in the orchard"."""
    return inner


@construction("nominal: inner=nominal way=in_ where=region", "nominal: inner=nominal way=along where=region", cost=0.3)
def inside(inner: Nominal, where: s.Selector, way: str) -> Nominal | None:
    """Compose "trees in the northern half" and "trees along the northern edge"."""
    if not chooses_from_trees(inner.selector) or (way == "along" and is_row_of_place(where)):
        return None  # "3 trees down the row": the tree that far along, or trees there?
    if (
        (inner.complete or inner.kind == "corner")
        and len(where.members) > 1
        and all(is_in_block(part) for part in where.members)
    ):
        return None  # "the corners of blocks A and B": of each of them
    if way == "from" and measures_from_here(inner.selector):
        return None  # "the tree farthest from the pond"
    if way == "of" and are_rows(where) and any(as_half(part) is not None for part in inner.selector.walk()):
        return None  # "the trees in the northern half of row 4": of that row, not of the orchard
    if way == "of" and are_zones(where) and any(_is_side(part) for part in inner.selector.walk()) and not inner.of_side:
        return None  # "the trees in the northern half of the wet corner": of that corner, not of the orchard
    if inner.of_side and (are_rows(where) or are_zones(where)):
        of_rows = cast(Any, inner.selector)  # "the northern trees of row 4": of that row, not of the orchard
        return replace(inner, selector=replace(of_rows, of=over(of_rows.of, where)))
    return replace(inner, selector=over(inner.selector, where))


@construction("nominal: inner=nominal way=in_ DET side=DIR", cost=0.4)
def in_the_north(inner: Nominal, way: str, side: Lex) -> Nominal | None:
    """Compose "tree in the north"."""
    where = half(side)
    return None if where is None or way == "from" else inside(inner, where, way)


@construction("along: ALONG", cost=0.0)
def along_word() -> str:
    """Compose "along"."""
    return "along"


@construction("place: where=region COMMA inner=place", "place: where=region to=AT inner=place", cost=0.6)
def places_of_area(where: s.Selector, inner: PlaceMeaning, to: Lex | None = None) -> PlaceMeaning | None:
    """Compose "row 7, every third tree" and "row 7 at every third tree"."""
    if to is not None and "motion" in to.features:
        return None
    if inner.per is not None or inner.shape not in ("one", "several") or not chooses_from_trees(inner.selector):
        return None
    if any(isinstance(part, AREAS) and part != s.Rows() for part in inner.selector.walk()):
        return None  # two areas, one after the other; "the first plant of each row" has none of its own
    return replace(inner, selector=over(inner.selector, where))


@construction("place: rows=each_row to=AT inner=place", "place: rows=each_row COMMA [to=AT] inner=place", cost=0.3)
def places_of_each_row(rows: s.Selector, inner: PlaceMeaning, to: Lex | None = None) -> PlaceMeaning | None:
    """Compose "each bed at the third plant from the north"."""
    if (to is not None and "motion" in to.features) or inner.per is not None or inner.shape not in ("one", "several"):
        return None
    if not all(counts_in_row(part) for part in inner.selector.members):
        return None
    if any(isinstance(part, AREAS) for part in inner.selector.walk()):
        return None
    return replace(inner, selector=over(inner.selector, rows), shape="several", each=True, count=None)


@construction("place: WHOLEOF where=region", cost=0.2)
def whole_area(where: s.Selector) -> PlaceMeaning:
    """Compose "the whole of row 4"."""
    return PlaceMeaning(where, "several", each=True)


@construction("place: whole=place way=in_ where=region", cost=0.4)
def restricted(whole: PlaceMeaning, where: s.Selector, way: str) -> PlaceMeaning | None:
    """Compose "as many trees as possible in row 3" and "one tree per row in the northern half"."""
    if way == "of":
        return None  # "as many trees as possible in the northern half of row 4": of that row
    if whole.per is not None:
        if whole.per != s.Rows() or not chooses_from_trees(where):
            return None
        if are_rows(where):
            return replace(whole, per=where)
        return replace(whole, per=s.Rows(of=where)) if len(where.members) == 1 else None
    if not whole.optional or whole.there or not chooses_from_trees(whole.selector):
        return None
    return replace(whole, selector=over(whole.selector, where))


@construction("place: whole=place COMMA where=region", cost=0.3)
def in_area_behind(whole: PlaceMeaning, where: s.Selector) -> PlaceMeaning | None:
    """Compose "the ten weakest vines, south block" and "every third tree, rows 2 to 5"."""
    if as_where(where) is not None and as_where(whole.selector) is not None:
        return None  # "the onions, the Sturon first"
    if whole.shape not in ("one", "several") or whole.per is not None or not specifies_part(whole.selector):
        return None
    return replace(whole, selector=over(whole.selector, where))


@construction("place: where=region", cost=0.4)
def area(where: s.Selector) -> PlaceMeaning:
    """Compose "the northern half" as a place."""
    return PlaceMeaning(where, "area")


@construction("place: word=DET in_ where=region", cost=0.4)
def those_in(word: Lex, where: s.Selector) -> PlaceMeaning | None:
    """Compose "those in row 4"."""
    like = Likewise("those")
    return PlaceMeaning(where, "several", like=like) if "stands_for_noun" in word.features else None


@construction(
    "nominal: where=block inner=nominal",
    "nominal: where=bare_block inner=nominal",
    "nominal: where=owned_block inner=nominal",
    cost=0.3,
)
def of_block(where: s.Selector, inner: Nominal) -> Nominal | None:
    """Compose "north block vines"."""
    if not chooses_from_trees(inner.selector):
        return None
    return replace(inner, selector=over(inner.selector, where))


@construction("region: [DET] PLOTPOSS where=region", cost=0.1)
def of_the_farm(where: s.Selector) -> s.Selector:
    """Compose "the orchard's east side"."""
    return where


@construction("place: [DET] zone=ZONEPOSS inner=nominal", cost=0.2)
def of_the_zone(zone: Lex, inner: Nominal) -> PlaceMeaning | None:
    """Compose "the wet corner's northernmost tree"."""
    if not (inner.single or inner.plural) or inner.complete or not chooses_from_trees(inner.selector):
        return None
    return PlaceMeaning(over(inner.selector, s.InZone(zone=zone.value)), "one" if inner.single else "several")


@construction("nominal: zone=ZONE inner=nominal", cost=0.4)
def plants_of_zone(zone: Lex, inner: Nominal) -> Nominal | None:
    """Compose "warm section tomatoes"."""
    if inner.single or inner.complete or inner.pronoun or inner.tested or not chooses_from_trees(inner.selector):
        return None
    return replace(inner, selector=over(inner.selector, s.InZone(zone=zone.value)))
