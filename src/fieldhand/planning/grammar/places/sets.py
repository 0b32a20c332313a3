"""Constructions of parts of a group: "the two oldest of these", "of the yellow trees, one", "only those in row 3"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.chosen import Chosen, chosen_among
from fieldhand.planning.grammar.places.clauses import Clause, Trait, with_attribute
from fieldhand.planning.grammar.places.counted import Positions, rows_within, trees_counted
from fieldhand.planning.grammar.places.numbered import all_of, ids_of
from fieldhand.planning.grammar.places.numbers import VAGUE_NUMBERS
from fieldhand.planning.grammar.places.quantities import Determiner, quantified
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    AREAS,
    are_rows,
    as_in_row,
    as_rows,
    blocks_of,
    chooses_from_trees,
    counts_in_row,
    is_description,
    is_in_block,
    is_one_row,
    over,
    part_on_side,
    picked_from,
    some_of,
    swapped,
)
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Choices without a noun that are named together.
Choices = tuple[Chosen, ...]


def _is_group(place: PlaceMeaning) -> bool:
    """Return True for several places of which some can be meant."""
    plain = place.per is None and not place.optional and place.at_most is None and not place.refers_back
    return plain and place.shape == "several"


@construction("chosen: [one=ONE] OF group=place", cost=0.1)
def of_group(group: PlaceMeaning, one: Lex | None = None) -> Chosen | None:
    """Compose "of the yellow trees" behind "the two oldest"."""
    if not _is_group(group) or group.each:
        return None
    return Chosen(Nominal(group.selector, plural=True), group=group.count or -1, preceded=one is not None)


@construction("chosen: SOMEOF group=place", cost=0.1)
def vague_part_of_group(group: PlaceMeaning) -> list[Chosen] | None:
    """Compose "some of the yellow trees": a question between numbers."""
    whole = of_group(replace(group, shape="several") if group.shape == "area" else group)
    return None if whole is None else [replace(whole, count=n) for n in VAGUE_NUMBERS]


@construction(
    "place: EACH BUT n=count OF group=place", "place: EACH except n=count OF group=place", cost=0.1, given=("site",)
)
def all_but_so_many(n: int, group: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "all but two of the yellow trees", whichever these are."""
    there = ids_of(group.selector, site) or set()
    if not _is_group(group) or group.each or n >= len(there):
        return None
    left_out = s.Excluding(places=some_of(group.selector, n), of=group.selector)
    return PlaceMeaning(left_out, "several")


@construction("place: chosen=chosen", "place: ANY chosen=chosen", "place: ATLEAST chosen=chosen", cost=0.1)
def some_of_group(chosen: Chosen) -> PlaceMeaning | None:
    """Compose "two of the yellow trees" and "any two of trees 4, 5 and 6"."""
    n = chosen.count
    if not chosen.group or n is None or chosen.choice is not None or chosen.unvisited or 0 < chosen.group <= n:
        return None
    return PlaceMeaning(some_of(chosen.inner.selector, n), "one" if n == 1 else "several", count=n)


@construction("place: n=count FROM group=place", cost=0.3)
def some_from_group(n: int, group: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "two from the yellow trees"."""
    chosen = of_group(group)
    return None if chosen is None else some_of_group(replace(chosen, count=n))


@construction("place: UPTO chosen=chosen", "place: check=CMP chosen=chosen", cost=0.2)
def at_most_of_group(chosen: Chosen, check: Lex | None = None) -> PlaceMeaning | None:
    """Compose "up to two of trees 4, 5 and 6"."""
    if not chosen.group or chosen.count is None or chosen.choice is not None:
        return None
    if check is not None and check.value != ("le", ""):
        return None
    return PlaceMeaning(chosen.inner.selector, "several", at_most=chosen.count)


@construction("place: word=ANY OF group=place choice=clause_choice", cost=0.2, given=("site",))
def whichever_of(word: Lex, group: PlaceMeaning, choice: Chosen, site: Site) -> list[PlaceMeaning] | None:
    """Compose "whichever of the yellow trees is nearest to the charger"."""
    return chosen_among(group.selector, choice, site) if "free_choice" in word.features and _is_group(group) else None


@construction("place: marks=marks OF group=place", "place: DET marks=marks OF group=place", cost=0.2, given=("site",))
def ranks_of_group(marks: Positions, group: PlaceMeaning, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the first two of trees 4, 5 and 6"."""
    if not _is_group(group):
        return None
    listed = group.selector.members
    if len(listed) < 2 or counts_in_row(listed[0]):
        return trees_counted(Nominal(group.selector, plural=True), marks, site)
    numbers = [number for first, last in marks.spans for number in range(first, last + 1)]
    if marks.either or not all(0 < abs(number) <= len(listed) for number in numbers):
        return None
    chosen = all_of([s.Nth(nth=number, of=group.selector) for number in numbers])
    return [PlaceMeaning(chosen, "one" if len(numbers) == 1 else "several", count=len(numbers))]


# Choices without a noun, before, behind or beside their group.


@construction("bares: first=bare", cost=0.0)
def one_choice(first: Chosen) -> Choices:
    """Compose "oldest", the beginning of "oldest and the youngest"."""
    return (first,)


@construction("bares: first=bares [COMMA] AND [DET] then=bare", cost=0.1)
def more_choices(first: Choices, then: Chosen) -> Choices | None:
    """Compose "three oldest and the three youngest"."""
    return (*first, then) if then not in first else None


def all_among(of: s.Selector, choices: Choices, site: Site) -> list[PlaceMeaning] | None:
    """Return what choices without a noun mean among some places."""
    ways = [chosen_among(of, one, site) for one in choices]
    if any(len(way) != 1 for way in ways):
        return ways[0] if len(ways) == 1 and ways[0] else None
    if len(ways) == 1:
        return ways[0]
    counts = [1 if way[0].shape == "one" else way[0].count for way in ways]
    count = None if None in counts else sum(one for one in counts if one is not None)
    return [PlaceMeaning(all_of([way[0].selector for way in ways]), "several", count=count)]


@construction(
    "place: [DET] choices=bares OF group=place",
    "place: OF group=place [COMMA] DET choices=bares",
    "place: group=place comma=COMMA DET choices=bares",
    cost=0.2,
    given=("site",),
)
def choices_of_group(
    group: PlaceMeaning, choices: Choices, site: Site, comma: Lex | None = None
) -> list[PlaceMeaning] | None:
    """Compose "the oldest and the youngest of the yellow trees" and "of the yellow trees the five oldest"."""
    if group.shape == "area" and comma is None and is_description(group.selector):
        group = replace(group, shape="several")  # "of the Merlot, the three oldest"
    if not _is_group(group) or (group.count is not None and any((one.count or 1) >= group.count for one in choices)):
        return None
    if comma is not None and any(one.count is None for one in choices):
        return None  # "the yellow trees, the oldest first"
    return all_among(group.selector, choices, site)


@construction("place: [DET] choices=bares inner=nominal", cost=0.1, given=("site",))
def choices_before_noun(choices: Choices, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the three oldest and the three youngest trees in row 3"."""
    if len(choices) < 2 or inner.single or inner.complete or inner.kind != "tree":
        return None
    if not inner.plural and any(one.count not in (None, 1) for one in choices):
        return None
    return all_among(inner.selector, choices, site)


@construction("place: [DET] first=bare OR [DET] second=bare inner=nominal", cost=0.1, given=("site",))
def either_choice(first: Chosen, second: Chosen, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the oldest or the youngest tree in row 3": which of the two?"""
    if choices_before_noun((first, second), inner, site) is None:
        return None
    return [place for one in (first, second) for place in chosen_among(inner.selector, one, site)]


@construction("place: first=place [COMMA] AND DET choices=bares", cost=0.2, given=("site",))
def and_another_choice(first: PlaceMeaning, choices: Choices, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the oldest tree in row 3 and the youngest", of the same trees."""
    of = picked_from(first.selector)
    if of is None or first.per is not None or first.like is not None or of == s.Trees():
        return None
    others = all_among(of, choices, site) or ()
    counts = [1 if one.shape == "one" else one.count for one in (first, *others)]
    return [
        PlaceMeaning(
            s.UnionOf(parts=(first.selector, *one.selector.members)), "several", count=sum(filter(None, counts))
        )
        for one in others
        if len(others) == 1
    ]


@construction(
    "place: first=place [COMMA] AND [DET] marks=marks [ONE]",
    "place: first=place [COMMA] other=OR [DET] marks=marks [ONE]",
    cost=0.2,
    given=("site",),
)
def and_another_rank(
    first: PlaceMeaning, marks: Positions, site: Site, other: Lex | None = None
) -> list[PlaceMeaning] | None:
    """Compose "the first tree of row 2 and the last", and "... or the last", which is a question."""
    row = as_in_row(first.selector)
    if row is None or row.of == s.Trees() or first.per is not None:
        return None
    others = trees_counted(Nominal(row.of, plural=True), replace(marks, counted_from=row.counted_from), site) or ()
    if other is not None:
        return [first, *others]
    return [
        replace(first, selector=s.UnionOf(parts=(first.selector, *one.selector.members)), shape="several", count=None)
        for one in others
    ]


@construction("place: [DET] HALF OF rows=rows", "place: PART rows=rows", cost=0.1, given=("site",))
def some_half(rows: s.Selector, site: Site) -> list[PlaceMeaning] | None:
    """Compose "half of row 2": which half?"""
    from fieldhand.planning.grammar.places.positions import part_of_row

    halves = [part_of_row((number, 2, "usual"), rows, site) for number in (1, 2)] if is_one_row(rows) else []
    return [PlaceMeaning(half, "several") for half in halves if half is not None] or None


# Restrictions behind a place.


@construction(
    "only: ONLY [DET] value=ATTRVAL ONE",
    "only: ONLY [DET] value=ATTRVAL TREE",
    "only: [DET] value=ATTRVAL ONE ONLY",
    cost=0.1,
)
def only_a_kind(value: Lex) -> list[Clause]:
    """Compose "only the yellow ones"."""
    return [(Trait((name, "eq", text)),) for name, text in value.value]


@construction(
    "only: ONLY [DET] ONE clause=relative",
    "only: ONLY word=DET clause=relative",
    "only: ONLY [DET] ONE in_ area=region",
    "only: ONLY word=DET in_ area=region",
    "only: ONLY in_ area=region",
    cost=0.1,
)
def only_those(clause: Clause = (), area: s.Selector | None = None, word: Lex | None = None) -> Clause | None:
    """Compose "only those in row 3" and "only the ones that are yellow"."""
    if word is not None and "those" not in word.features:
        return None
    return clause if area is None else (Trait(area=area),)


@construction(
    "place: OF whole=place [COMMA] DET ONE clause=relative",
    "place: OF whole=place [COMMA] DET ONE in_ area=region",
    "place: OF whole=place [COMMA] word=DET clause=relative",
    cost=0.2,
)
def of_these_those(
    whole: PlaceMeaning, clause: Clause = (), area: s.Selector | None = None, word: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "of the Merlot, the ones in row 3" and "of the yellow trees, those older than 8 years"."""
    those = only_those(clause, area, word)
    return None if those is None else restricted_to(whole, those)


@construction(
    "place: first=place [COMMA] AND [AT] quantity=quantity inner=nominal OUTSIDE [OF] IT", cost=0.1, given=("site",)
)
def and_outside_it(first: PlaceMeaning, quantity: Determiner, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the trees in the wet corner and any three trees outside it"."""
    areas = [part for part in first.selector.walk() if isinstance(part, AREAS)]
    beyond = with_attribute(inner, (Trait(area=areas[0], outside=True),)) if len(areas) == 1 else None
    if beyond is None or first.per is not None or first.shape not in ("several", "area"):
        return None
    others = quantified(quantity, replace(beyond, tested=False), site) or ()
    return [replace(first, selector=s.UnionOf(parts=(first.selector, one.selector)), shape="several") for one in others]


@construction("place: first=place [COMMA] [AND] then in_ rows=rows", cost=0.2)
def then_in_rows(first: PlaceMeaning, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the first tree of row 10, then of row 11"."""
    last = first.selector.members[-1]
    before = rows_within(last)
    if before is None or before == rows or not is_one_row(rows) or first.per is not None or are_rows(last):
        return None
    blocks = blocks_of(before)
    there = over(rows, blocks[0]) if len(blocks) == 1 and not is_in_block(rows) else rows
    parts = (*first.selector.members, swapped(last, before, there))
    one = first.shape == "one" or first.in_order
    return replace(first, selector=s.UnionOf(parts=parts), shape="several", count=None, in_order=True) if one else None


@construction("place: whole=place [COMMA] [and_or_but] clause=only", cost=0.1)
def restricted_to(whole: PlaceMeaning, clause: Clause) -> PlaceMeaning | None:
    """Compose "row 3, but only the yellow ones"."""
    if whole.shape not in ("several", "area") or whole.count is not None or whole.per is not None or whole.like:
        return None
    inner = with_attribute(Nominal(whole.selector, plural=True), clause)
    return None if inner is None else replace(whole, selector=inner.selector, shape="several")


@construction(
    "place: whole=place [COMMA] BUT ONLY part=place", "place: whole=place COMMA ONLY part=place",
    "place: whole=place [COMMA] BUT part=place ONLY", cost=-1.0, given=("site",),
)  # fmt: skip
def only_a_part(whole: PlaceMeaning, part: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "bed 8, but only the Roma" and "row 3, just the northern half", of what is in it."""
    known = {whole.shape, part.shape} <= {"one", "several", "area"} and part.like is None and whole.like is None
    if not known or whole.shape == "one" or any(one.per is not None or one.optional for one in (whole, part)):
        return None
    if whole.selector == s.Trees() or whole.selector.relative or part.selector.relative:
        return None
    selector = part_on_side(part.selector, whole.selector) or over(part.selector, whole.selector)
    own, among = ids_of(selector, site), ids_of(whole.selector, site)
    if own is None or among is None or not own or not own <= among or own == among:
        return None
    several = part.shape == "area" or (part.shape == "one" and len(own) > 1)  # "all rows, but only the first tree"
    return replace(part, selector=selector, shape="several" if several else part.shape)


@construction("place: whole=place [COMMA] [and_or_but] ONLY [DET] one=chosen", cost=0.1, given=("site",))
@construction("place: whole=place [COMMA] [and_or_but] ONLY [DET] one=bare", cost=0.1, given=("site",))
def only_chosen(whole: PlaceMeaning, one: Chosen, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the peppers, but only every other one" and "row 3, but only the two oldest"."""
    bare_noun = one.inner.pronoun or one.inner == Nominal(s.Trees(), plural=one.inner.plural)
    if whole.shape not in ("several", "area") or whole.count is not None or whole.per is not None or whole.like:
        return None
    if one.choice is None or not bare_noun or whole.optional or whole.selector == s.Trees():
        return None
    inner = replace(one.inner, pronoun=False)
    return chosen_among(whole.selector, replace(one, inner=inner), site) or None


@construction(
    "place: whole=place [COMMA] STICKING where=region", "place: whole=place COMMA where=region ONLY", cost=0.3
)
def sticking_to(whole: PlaceMeaning, where: s.Selector) -> PlaceMeaning | None:
    """Compose "the yellow trees, sticking to the northern half"."""
    if whole.shape != "several" or whole.per is not None or not chooses_from_trees(whole.selector):
        return None
    return replace(whole, selector=over(whole.selector, where))


@construction(
    "parity: [COMMA] [and_or_but] [ONLY] [DET] odd=ODD [ONE] [ONLY]",
    "parity: [COMMA] [and_or_but] [ONLY] [DET] EVEN [ONE] [ONLY]",
    cost=0.1,
)
def parity(odd: Lex | None = None) -> str:
    """Compose "but the odd-numbered ones only"."""
    return "even" if odd is None else "odd"


@construction("place: whole=place which=parity", cost=0.2)
def those_of_parity(whole: PlaceMeaning, which: str) -> PlaceMeaning | None:
    """Compose "rows 1 to 10, the odd ones" and "vines 1 to 21 of row 3, only the even ones"."""
    remainder = 1 if which == "odd" else 0
    selector, row = whole.selector, as_in_row(whole.selector)
    if whole.per is not None or whole.optional or whole.at_most is not None:
        return None
    if row is not None and 0 < row.first < row.last:
        numbers = [n for n in range(row.first, row.last + 1) if n % 2 == remainder]
        parts: tuple[s.Selector, ...] = tuple(replace(row, first=n, last=n) for n in numbers)
    elif (labelled := as_rows(selector)) is not None and labelled.every == 1 and labelled.counted_from == "usual":
        low, high = labelled.first, labelled.last
        if not (low.isdigit() and high.isdigit() and int(low) < int(high)):
            return None
        return replace(whole, selector=replace(labelled, first=str(int(low) + (int(low) % 2 != remainder)), every=2))
    else:
        return None
    return replace(whole, selector=s.UnionOf(parts=parts), count=len(parts)) if len(parts) > 1 else None
