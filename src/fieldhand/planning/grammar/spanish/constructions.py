"""Constructions of Spanish: those of all languages, with the patterns whose word order is Spanish.

Most patterns here name a function that English has with another order of its parts. The constructions of English that
would read Spanish words wrongly are left out.
"""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar import commands, places
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands import conditions, driving, limits, spacing, things
from fieldhand.planning.grammar.meaning import Amount, CaptureCommand, Nominal, PlaceMeaning, Thing
from fieldhand.planning.grammar.places import (
    chosen,
    clauses,
    earlier,
    groups,
    nouns,
    numbers,
    positions,
    quantities,
    rows,
    spots,
    steps,
)
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import over
from fieldhand.terms import Side

#: Constructions whose patterns would read Spanish words wrongly: an adjective behind its noun as a clause, each of so
#: many in "cada tres árboles", two numbers in "1 200", a time limit in "dentro de 5 minutos", which says when to begin,
#: and work that the battery allows in "si la batería está", which a test may follow.
_ENGLISH = (
    nouns.described,
    nouns.attribute_is,
    clauses.which_clause,
    groups.each_of_group,
    numbers.longer_tree_list,
    numbers.unmarked_tree_list,
    rows.longer_row_list,
    limits.limited_to,
    conditions.if_it_fits,
)

GRAMMAR = Grammar()
GRAMMAR.include(places.GRAMMAR, without=_ENGLISH)
GRAMMAR.include(commands.GRAMMAR, without=_ENGLISH)
construction = GRAMMAR.construction

# What describes a noun stands behind it: "árboles amarillos", "la mitad norte", "los 3 árboles más al norte".
construction("nominal: inner=nominal value=ATTRVAL", "nominal: inner=nominal OF value=ATTRVAL", cost=0.2)(
    nouns.described
)
construction("quality: value=ATTRVAL", cost=0.4)(nouns.attribute_is)
construction("relative: WHICH [IS] traits=traits", cost=0.2)(clauses.which_clause)
construction("relative: WHICH [IS] test=quality", cost=0.5)(clauses.with_clause)
construction("quality_trait: test=quality", cost=0.2)(clauses.tested)
construction("traits: is_not trait=quality_trait", cost=0.0)(clauses.denied)
construction("nominal: inner=nominal side=MOST", cost=0.2)(nouns.extreme)
construction("chosen_as: side=MOST", cost=0.1)(chosen.by_side)
construction("rows: [DET] [n=count] noun=ROW side=MOST", cost=0.1)(rows.outermost_rows)
construction("ranking: attribute=ATTR rank=ranking", cost=0.0)(nouns.ranking_of)
construction("chosen_as: [WITH] rank=ranking", "chosen_as: OF [DET] rank=ranking", cost=0.1)(chosen.by_attribute)
construction("region: [DET] HALF side=DIR", "region: [DET] SIDE side=DIR", cost=0.2)(places.areas.half)
construction("region: [DET] QUARTER side=DIR", cost=0.2)(places.areas.quarter)
construction("region: [DET] EDGE side=DIR", cost=0.2)(places.areas.edge)
construction("nominal: noun=CORNER side=DIR", "nominal: noun=CORNER OF DET side=DIR", cost=0.1)(spots.corner)
construction("nominal: TREE OF DET [n=count] noun=CORNER", cost=0.2)(spots.corners)
construction("edge_side: EDGE side=DIR", "edge_side: SIDE side=DIR", "edge_side: FINISH side=DIR", cost=0.1)(
    spots.edge_side
)
construction("corner_at: noun=CORNER side=DIR", cost=0.0)(spots.corner_at)
construction("row_end: FINISH side=DIR", cost=0.0, given=("site",))(positions.row_end)
construction("nominal: inner=nominal OTHER", cost=0.2)(quantities.another)
construction("nominal: ANOTHER inner=nominal OTHER", cost=0.1)(quantities.another)
construction("chosen: chosen=chosen OTHER", cost=0.1)(chosen.others)
construction("rows: [DET] noun=ROW number=row_parity", "rows: each=EACH noun=ROW number=row_parity", cost=0.1)(
    rows.rows_of_parity
)
construction("rows: DET rows=row_list", cost=0.1)(rows.listed_rows)
construction(
    "rows: [DET] ROW FROM [DET] first=NUM range_to [DET] last=NUM",
    "rows: [DET] ROW first=NUM range_to DET last=NUM",
    cost=0.2,
)(rows.rows_from_to)
construction("number_item: first=number_item range_to DET last=number_item", cost=0.1)(numbers.number_range)
construction("tree_ids: TREE start=FROM DET item=number_item", cost=0.2)(numbers.trees_by_number)
construction(
    "tree_ids: first=tree_ids COMMA [AND] [DET] [TREE] item=number_item",
    "tree_ids: first=tree_ids AND [DET] [TREE] item=number_item",
    "tree_ids: first=tree_ids COMMA [AND] [DET] [TREE] item=code_item",
    "tree_ids: first=tree_ids AND [DET] [TREE] item=code_item",
    cost=0.3,
)(numbers.longer_tree_list)
construction(
    "row_list: rows=row_list COMMA [AND] [DET] [ROW] item=row_item",
    "row_list: rows=row_list AND [DET] [ROW] item=row_item",
    cost=0.1,
)(rows.longer_row_list)
construction("place: word=EACHOF place=place", cost=0.4, given=("site",))(groups.each_of_group)
construction("numbers: first=numbers [COMMA] AND DET item=number_item", cost=0.1)(numbers.more_numbers)
construction("ordered: DET rank=ranking FIRSTONE", cost=0.1)(driving.best_first)
construction("place: EACH [DET] inner=nominal ALLYOUCAN", "place: ASMANYOF inner=nominal", cost=0.1)(quantities.as_many)
construction("place: n=count inner=nominal UPTO", "place: n=count inner=nominal ATMOST", cost=0.2)(quantities.up_to)
construction(
    "place: ANOTHER POINT [RANDOM] [COMMA] step=stride",
    "place: ANOTHER TREE [RANDOM] [COMMA] step=stride",
    "place: DET POINT step=stride",
    cost=0.3,
)(steps.tree_along_row)


# Earlier missions: "los 10 árboles más calientes de la semana pasada".
construction(
    "place: [DET] n=count several=read_noun most=hottest when=PERIOD",
    "place: [DET] several=read_noun most=hottest when=PERIOD",
    cost=0.3,
)(earlier.most_read_earlier)
construction(
    "with_most: WITH [DET] noun=NOUN most=STATISTIC", "with_most: WITH [DET] most=STATISTIC noun=NOUN", cost=0.0
)(earlier.with_most)
construction(
    "earlier_test: WAS subject=measured test=predicate when=PERIOD", "earlier_test: WAS test=predicate when=PERIOD",
    cost=0.1, given=("robot",),
)(earlier.was_read)  # fmt: skip


# Commands and clauses.
@construction(
    "capture: TAKE place=to_it things=things",
    "capture: verb place=place TAKE things=things",
    "capture: MEASURE place=place COMMA verb things=things",
    "capture: TAKE ATHIM things=things word=relation place=place",
    cost=0.3,
)
def capture_at(things: tuple[Thing, ...], place: PlaceMeaning, used: int, word: str = "at") -> CaptureCommand:
    """Compose "hazle una foto al árbol 4"."""
    return CaptureCommand(things, place, used, relation=word)


construction("thing: n=count READING OF [DET] noun=NOUN", cost=0.1)(things.readings_of)
construction("apart: AT far=amount APART", "apart: SPACEDBY far=amount APART", cost=0.1)(spacing.apart)
construction("apart: SPACEDBY [APART] far=amount", "apart: WITH far=amount APART", cost=0.1)(spacing.apart)
construction("apart: SPACEDBY APART FOR far=amount", cost=0.1)(spacing.apart)
construction("test: IS value=ATTRVAL", "test: denied=ISNOT value=ATTRVAL", cost=0.3)(conditions.tree_is)
construction("test: IS check=CMP value=amount", cost=0.3)(conditions.tree_compared)
construction("allow: FITS", cost=0.2)(conditions.if_it_fits)
construction("limit: WITHOUT GO [UPTO] check=CMP most=amount", cost=0.3)(limits.not_more_than)
construction("limit: BEFORE BATTERY [IS] [at] least=amount", cost=0.3)(limits.keep)
construction("limit: RETURN BEFORE WHICH BATTERY [IS] [at] least=amount", cost=0.2)(limits.home_with)
construction("drive: GO OF place=place", cost=0.6)(driving.drive_to)


@construction("amount: DET inner=amount", cost=0.1)
def with_article(inner: Amount) -> Amount:
    """Compose "el 30 %"."""
    return inner


@construction("to_it: word=ATHIM", cost=0.1)
def to_it(word: Lex) -> PlaceMeaning:
    """Compose "-le" of "tómale": where the robot is."""
    return PlaceMeaning(s.Here(), "those" if "of_several" in word.features else "here")


@construction("place: ONEOFEACH n=count inner=nominal", cost=0.2)
def one_of_so_many(n: int, inner: Nominal) -> PlaceMeaning | None:
    """Compose "uno de cada tres árboles"."""
    if inner.single or inner.complete or n < 2 or not inner.plural or inner.tested or inner.kind != "tree":
        return None
    return PlaceMeaning(s.EveryNth(nth=n, of=inner.selector), "several", each=True)


@construction("rows: EACH n=count noun=ROW", "rows: ONEOFEACH n=count noun=ROW", cost=0.2)
def every_so_many_rows(n: int, noun: Lex) -> s.Selector | None:
    """Compose "cada tres filas"."""
    return s.Rows(every=n) if noun.plural and n > 1 else None


@construction("place: DET inner=nominal BYTURNS", "place: DET inner=nominal BYTURNS in_ where=region", cost=0.2)
def every_other(inner: Nominal, where: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "un árbol sí y otro no de la fila 6"."""
    if inner.single or inner.complete or inner.plural or inner.tested or inner.kind != "tree":
        return None
    of = inner.selector if where is None else over(inner.selector, where)
    return PlaceMeaning(s.EveryNth(nth=2, of=of), "several", each=True)


@construction("place: DET side=DIR", "place: DET side=DIR OF site", cost=0.6)
def that_corner(side: Lex) -> PlaceMeaning | None:
    """Compose "la noreste" behind "la esquina noroeste"."""
    return PlaceMeaning(s.Corners(which=(side.value,)), "one") if side.value in CORNERS else None


@construction("way: AT DET side=DIR OF DET ROW", cost=0.1)
def way_along_row(side: Lex) -> Side | None:
    """Compose "hacia el norte de la fila"."""
    return side.value if side.value in SIDES else None


construction("limit: word=AT most=amount [of_what]", cost=0.4)(limits.in_time)
construction(
    "limit: UPTO most=amount [of_what]",
    "limit: most=amount ATMOST [of_what]",
    "limit: WITH UPTO most=amount [of_what]",
    "limit: USE [UPTO] most=amount [of_what]",
    "limit: USE ATMOST most=amount [of_what]",
    "limit: GO UPTO most=amount [of_what]",
    "limit: GO ATMOST most=amount [of_what]",
    cost=0.4,
)(limits.at_most_so_much)


@construction("thing: [DET] word=READING OF [DET] noun=NOUN", cost=0.2)
def readings_of(word: Lex, noun: Lex) -> Thing | None:
    """Compose "las lecturas de CO2"."""
    made = things.reading_of(noun)
    return None if made is None else replace(made, plural=word.plural)
