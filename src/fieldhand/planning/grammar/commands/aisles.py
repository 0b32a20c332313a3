"""Constructions of aisles: "every second aisle", "the paths between beds 6 and 9", "in the middle of each aisle"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import PlaceMeaning, WorkCommand
from fieldhand.planning.grammar.places.counted import Positions, row_itself
from fieldhand.planning.grammar.places.numbered import all_of, ids_of
from fieldhand.planning.grammar.places.numbers import name_of
from fieldhand.planning.grammar.places.planted_rows import filled_rows, rows_out_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, are_several_rows, over
from fieldhand.site.counting import rows_from
from fieldhand.site.model import Site
from fieldhand.site.planting import Row
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: The rows on the two sides of an aisle, in counting order.
Aisle = tuple[Row, Row]


# --- the rows between which aisles lie --------------------------------------------------------------------------------


@construction("gaps: gaps=between_gaps", cost=0.0)
def gaps(gaps: s.Selector) -> s.Selector:
    """Compose "between rows 10 and 14" as the rows of aisles."""
    return gaps


@construction("between_gaps: BETWEEN [ROW] first=row_name AND [ROW] last=row_name", cost=0.0)
@construction("gaps: FROM ROW first=row_name range_to [ROW] last=row_name", cost=0.0)
def between_two_rows(first: Lex, last: Lex) -> s.Selector:
    """Compose "between rows 10 and 14"."""
    return s.Rows(first=name_of(first), last=name_of(last))


@construction("between_gaps: BETWEEN rows=any_rows", cost=0.1)
def between_rows(rows: s.Selector) -> s.Selector | None:
    """Compose "between the beds" and "between beds 6, 7 and 8"."""
    return (s.Trees() if rows == s.Rows() else rows) if are_several_rows(rows) else None


@construction(
    "between_gaps: BETWEEN first=crop_area AND last=crop_area", "between_gaps: BETWEEN first=rows AND last=rows",
    "between_gaps: BETWEEN first=crop_area AND last=rows", "between_gaps: BETWEEN first=rows AND last=crop_area",
    cost=0.1, given=("site",),
)  # fmt: skip
def between_planted(first: s.Selector, last: s.Selector, site: Site) -> s.Selector | None:
    """Compose "between the leeks and the pumpkins": all aisles from the ones to the others."""
    ends = [filled_rows(one, site) for one in (first, last)]
    for block in site.planting.blocks:
        rows, _ = rows_from(site, block, "usual")
        one, other = sorted([rows.index(row) for row in end if row in rows] for end in ends)
        if one and other and len(one) + len(other) == sum(map(len, ends)) and max(one) < min(other):
            return _span(rows[max(one) : min(other) + 1], site)
    return None


@construction(
    "beside: EACHSIDE OF row=rows", "beside: NEXTTO row=rows", "beside: NEXTTO row=crop_area",
    "beside: BESIDE row=rows", "beside: BESIDE row=crop_area", "beside: [AT] side=own_side OF row=rows",
    "beside: [AT] [DET] towards=DIR OF row=rows", cost=0.1, given=("site",),
)  # fmt: skip
def beside_a_row(row: s.Selector, site: Site, side: str = "", towards: Lex | None = None) -> tuple[Aisle, ...] | None:
    """Compose "on both sides of bed 4" and "west of bed 4"."""
    rows = filled_rows(row, site)
    if len(rows) != 1:
        return None
    side = side if towards is None else towards.value
    pairs = [(one, other) for one, other in aisles_in(s.Trees(), site) if rows[0] in (one, other)]
    others = (other if one is rows[0] else one for one, other in pairs)
    there = [pair for pair, other in zip(pairs, others, strict=True) if side in ("", _side_of(other, rows[0], site))]
    return tuple(there) or None


def aisles_in(where: s.Selector, site: Site) -> list[Aisle]:
    """Return the aisles between neighbouring rows of which all plants are in an area, in counting order."""
    plants = ids_of(where, site) or set()

    def inside(row: Row) -> bool:
        return plants.issuperset(site.trees[tree].place.id for tree in row.trees)

    counted = (rows_from(site, block, "usual")[0] for block in site.planting.blocks)
    return [pair for rows in counted for pair in pairwise(rows) if all(map(inside, pair))]


def _side_of(other: Row, row: Row, site: Site) -> Side:
    """Return the side of a row on which a neighbouring row stands."""
    east, north = site.xy[list(other.trees)].mean(axis=0) - site.xy[list(row.trees)].mean(axis=0)
    if site.planting.blocks[row.block].runs_east_west:
        return "north" if north > 0 else "south"
    return "east" if east > 0 else "west"


def _span(rows: Sequence[Row], site: Site) -> s.Selector:
    """Return neighbouring rows by the names of the first and the last one."""
    first = row_itself(rows[0], site)
    span = replace(first, last=rows[-1].name)
    together = all_of([row_itself(row, site) for row in rows])
    return span if ids_of(span, site) == ids_of(together, site) else together


def _between(pairs: Sequence[Aisle], site: Site) -> Tract:
    """Return neighbouring aisles."""
    return Tract(_span([pairs[0][0], *(last for _, last in pairs)], site), "aisles")


# --- aisles -----------------------------------------------------------------------------------------------------------


@construction("tract: [ALONG] [in_] gaps=gaps", cost=0.1)
def ground_between(gaps: s.Selector) -> Tract:
    """Compose "between rows 10 and 14"."""
    return Tract(gaps, "aisles")


@construction("aisle_noun: noun=AISLE", "aisle_noun: noun=AISLEPATH", "aisle_noun: noun=AISLEGROUND", cost=0.0)
def aisle_noun(noun: Lex) -> Lex:
    """Compose "aisle", "path" and "grass" before the rows between which they lie."""
    return noun


@construction(
    "tract: [ALONG] [in_] [DET] noun=AISLE [WHICH] [IS] pairs=beside",
    "tract: [ALONG] [in_] [DET] noun=AISLEPATH [WHICH] [IS] pairs=beside",
    "tract: [ALONG] [in_] EACH [DET] aisle_noun [WHICH] [IS] pairs=beside",
    "tract: [ALONG] [in_] [DET] AISLEGROUND [WHICH] [IS] pairs=beside", cost=0.0, given=("site",),
)  # fmt: skip
def aisles_beside(pairs: tuple[Aisle, ...], site: Site, noun: Lex | None = None) -> list[Tract]:
    """Compose "the paths on both sides of bed 4"; "the path next to it" may be either of them."""
    either = noun is not None and not noun.plural
    return [_between([pair], site) for pair in pairs] if either else [_between(pairs, site)]


@construction(
    "tract: [ALONG] [in_] [DET] noun=aisle_noun [WHICH] [IS] gaps=gaps",
    "tract: [ALONG] [in_] EACH [DET] noun=aisle_noun [WHICH] [IS] gaps=gaps",
    "tract: [ALONG] [in_] [DET] n=count noun=aisle_noun gaps=gaps",
    "tract: [ALONG] [in_] EACH [DET] n=count noun=aisle_noun gaps=gaps",
    "tract: [ALONG] [in_] EACH rank=ORD noun=aisle_noun gaps=gaps",
    "tract: [ALONG] [in_] EACH other=OTHER noun=aisle_noun gaps=gaps",
    cost=0.0, given=("site",),
)  # fmt: skip
def aisles_between(
    noun: Lex, gaps: s.Selector, site: Site, n: int | None = None, rank: Lex | None = None, other: Lex | None = None
) -> Tract | None:
    """Compose "the three paths between beds 6 and 9" and "every second aisle between rows 3 and 6"."""
    if n is not None and (n != len(aisles_in(gaps, site)) or noun.plural == (n == 1)):
        return None
    every = 2 if other is not None else 1 if rank is None else int(rank.value)
    return Tract(gaps, "aisles", every=every) if every >= 1 else None


@construction(
    "tract: [ALONG] [in_] EACH [DET] AISLE", "tract: [ALONG] [in_] [DET] noun=AISLE",
    "tract: [ALONG] [in_] EACH other=OTHER AISLE", "tract: [ALONG] [in_] EACH rank=ORD AISLE",
    cost=0.1,
)  # fmt: skip
def aisles(noun: Lex | None = None, other: Lex | None = None, rank: Lex | None = None) -> Tract | None:
    """Compose "every second aisle" and "the aisles"."""
    if noun is not None and not noun.plural:
        return None
    every = 2 if other is not None else 1 if rank is None else int(rank.value)
    return Tract(s.Trees(), "aisles", every=every) if every >= 1 else None


@construction(
    "tract: [ALONG] [in_] DET rank=ORD [n=count] noun=AISLE", "tract: [ALONG] [in_] DET LAST [n=count] noun=AISLE",
    "tract: [ALONG] [in_] DET rank=ORD [n=count] noun=AISLE FROM [DET] side=DIR",
    "tract: [ALONG] [in_] DET side=MOST [n=count] noun=AISLE",
    cost=0.1, given=("site",),
)  # fmt: skip
def counted_aisles(noun: Lex, site: Site, rank: Lex | None = None, n: int = 1, side: Lex | None = None) -> Tract | None:
    """Compose "the second aisle", "the last three aisles" and "the westernmost aisle", of a site with one block."""
    pairs = aisles_in(s.Trees(), site)
    if len(site.planting.blocks) != 1 or noun.plural != (n > 1) or (rank is not None and n > 1 and rank.value != 1):
        return None
    at = -1 if rank is None and side is None else 0 if rank is None else int(rank.value) - 1
    if side is not None and pairs:
        if side.value not in (_side_of(pairs[0][k], pairs[0][1 - k], site) for k in (0, 1)):
            return None
        if _side_of(*pairs[0], site) != side.value:
            pairs = [(last, first) for first, last in reversed(pairs)]
    chosen = pairs[at : at + n] if at >= 0 else pairs[-n:]
    return _between(chosen, site) if len(chosen) == n else None


@construction("tract: [ALONG] [in_] DET noun=AISLE OF where=region", cost=0.1, given=("site",))
@construction("tract: [ALONG] [in_] DET noun=AISLE in_ where=region", cost=0.1, given=("site",))
def only_aisle_of_area(noun: Lex, where: s.Selector, site: Site) -> Tract | None:
    """Compose "the aisle of the warm section", which has no other."""
    return None if noun.plural or len(aisles_in(where, site)) != 1 else Tract(where, "aisles")


@construction("tract: part=tract OF where=region", "tract: part=tract in_ where=region", cost=0.1)
def aisles_of_area(part: Tract, where: s.Selector) -> Tract | None:
    """Compose "every second aisle of the north block" and "the headlands of the north block"."""
    if part.mode not in ("aisles", "headlands") or where == part.selector:
        return None
    if part.selector == s.Trees():
        return Tract(where, part.mode, every=part.every)
    return Tract(over(part.selector, where), part.mode, every=part.every) if are_rows(part.selector) else None


@construction(
    "from_aisle: FROM [DET] aisle_noun [WHICH] [IS] gaps=gaps", "from_aisle: FROM gaps=gaps",
    "from_aisle: FROM [DET] aisle_noun [WHICH] [IS] pairs=beside",
    "from_aisle: GO [FROM] ALONG [DET] aisle_noun [WHICH] [IS] gaps=gaps",
    cost=0.0, given=("site",),
)  # fmt: skip
def from_aisle(site: Site, gaps: s.Selector | None = None, pairs: tuple[Aisle, ...] = ()) -> Aisle | None:
    """Compose "from the aisle between rows 3 and 4"."""
    there = pairs if gaps is None else aisles_in(gaps, site)
    return there[0] if len(there) == 1 else None


@construction(
    "work: one=work [COMMA] aisle=from_aisle", "work: aisle=from_aisle [COMMA] one=work", cost=0.1, given=("site",)
)
def worked_from_an_aisle(one: WorkCommand, aisle: Aisle, used: int, site: Site) -> WorkCommand | None:
    """Compose "film row 4 from the aisle between rows 3 and 4": on the side of it on which the other row is."""
    if one.along is None or one.mode != "rows" or one.sides != "one":
        return None
    rows = filled_rows(rows_out_of(one.along, site) or one.along, site)
    if len(rows) != 1 or rows[0] not in aisle:
        return None
    other = next(row for row in aisle if row is not rows[0])
    return replace(one, sides=_side_of(other, rows[0], site), used=used)


# --- places in aisles -------------------------------------------------------------------------------------------------


@construction("in_aisle: part=tract", "in_aisle: gaps=between_gaps", cost=0.0)
def in_aisle(part: Tract | None = None, gaps: s.Selector | None = None) -> s.Selector | None:
    """Compose "the aisle between rows 3 and 4" and "between rows 3 and 4"."""
    if part is not None:
        return part.selector if part.mode == "aisles" and part.every == 1 else None
    return gaps


def _beside(aisles: s.Selector, site: Site, at: s.Selector) -> PlaceMeaning | None:
    """Return the place in each of some aisles beside a plant of the row before it."""
    of = s.Trees() if are_rows(aisles) else aisles
    places = [
        s.Beside(side=_side_of(other, row, site), of=over(at, over(row_itself(row, site), of)))
        for row, other in aisles_in(aisles, site)
    ]
    n = len(places)
    return PlaceMeaning(all_of(places), "one" if n == 1 else "several", count=n, each=n > 1) if places else None


@construction(
    "halfway: HALFWAY aisles=in_aisle", "place: [DET] MIDDLE OF aisles=in_aisle",
    "place: [DET] MIDDLE in_ aisles=in_aisle",
    "place: [DET] MIDDLE aisles=in_aisle", "adverbial_place: aisles=between_gaps COMMA AT DET MIDDLE",
    cost=0.1, given=("site",),
)  # fmt: skip
def middles_of_aisles(aisles: s.Selector, site: Site) -> PlaceMeaning | None:
    """Compose "the middle of every aisle": beside the middle plant of the row before it."""
    return _beside(aisles, site, s.Middle())


@construction(
    "place: [DET] at=row_end OF aisles=in_aisle", "place: [DET] at=row_end aisles=in_aisle",
    "place: aisles=in_aisle COMMA AT DET at=row_end", "place: aisles=in_aisle AT DET at=row_end",
    "adverbial_place: aisles=between_gaps COMMA AT DET at=row_end",
    "adverbial_place: aisles=between_gaps AT DET at=row_end",
    cost=0.1, given=("site",),
)  # fmt: skip
def end_of_aisles(at: Positions, aisles: s.Selector, site: Site) -> PlaceMeaning | None:
    """Compose "the north end of the aisle between rows 3 and 4"."""
    if at.near is not None:
        return None
    return _beside(aisles, site, s.InRow(first=1, last=1, counted_from=at.counted_from))


@construction(
    "place: EACH [OF] [DET] FINISH OF aisles=in_aisle", "place: EACH [OF] [DET] FINISH aisles=in_aisle",
    cost=0.1, given=("site",),
)  # fmt: skip
def both_ends_of_aisles(aisles: s.Selector, site: Site) -> PlaceMeaning | None:
    """Compose "both ends of the aisle between rows 3 and 4"."""
    ends = [_beside(aisles, site, s.InRow(first=at, last=at)) for at in (1, -1)]
    parts = [part for one in ends if one is not None for part in one.selector.members]
    return PlaceMeaning(all_of(parts), "several", count=len(parts), each=True) if parts else None


@construction("adverbial_place: gaps=between_gaps", cost=0.3, given=("site",))
def somewhere_in_an_aisle(gaps: s.Selector, site: Site) -> list[PlaceMeaning] | None:
    """Compose "between rows 3 and 4", of one aisle: in its middle, or at one of its ends?"""
    if len(aisles_in(gaps, site)) != 1:
        return None
    spots = (s.Middle(), s.InRow(first=1, last=1), s.InRow(first=-1, last=-1))
    return [found for at in spots if (found := _beside(gaps, site, at)) is not None]


@construction("place: at=adverbial_place", cost=0.0)
def between_rows_as_place(at: PlaceMeaning) -> PlaceMeaning:
    """Compose "between rows 3 and 4" as a place."""
    return at
