"""Constructions of chosen trees: how many of a description, and how they are chosen, whatever the order of the words.

The words before and behind the noun each add one thing: a number, a choice ("nearest to the pond", "at random"), an
area, a distance. :func:`places_of` puts them together, so no construction lists their orders.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.areas import inside
from fieldhand.planning.grammar.places.compass import AWAY_FROM, CORNERS, SIDES
from fieldhand.planning.grammar.places.counted import Positions, TreeNumbers, fills_rows, row_of_all, rows_within
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.numbers import VAGUE_NUMBERS
from fieldhand.planning.grammar.places.rows import in_each_row
from fieldhand.planning.grammar.places.steps import Distance
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    are_rows,
    as_along_row,
    as_nearest,
    as_zone,
    chooses_from_trees,
    is_description,
    is_one_row,
    is_spot,
    over,
    swapped,
)
from fieldhand.site.model import Site
from fieldhand.terms import AnySide, CountedFrom, Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Ways to choose among trees.
By = Literal[
    "extreme", "best", "nearest", "beside", "around", "farthest", "nearby", "random", "spread", "evenly", "in a run",
    "adjacent", "apart", "of every", "nth", "at", "numbered", "path",
]  # fmt: skip
#: Choices of which the k-th is one: "the second oldest".
_RANKED = ("extreme", "best", "nearest", "farthest")


@dataclass(frozen=True, slots=True)
class Choice:
    """A way to choose trees among those of a description.

    Attributes:
        by: Way to choose.
        value: What the way needs beside places: a side, an attribute, a distance.
        to: Place that they are near to or far from; None for the place where the robot is.
    """

    by: By
    value: Any = None
    to: PlaceMeaning | None = None


@dataclass(frozen=True)
class NthTree:
    """Every n-th tree.

    Attributes:
        n: Number.
        start: Number of the first one.
        counted_from: Side from which they are counted.
        visited_from: Side from which they are visited, if the phrase says it.
    """

    n: int
    start: int = 1
    counted_from: CountedFrom = "usual"
    visited_from: Side | None = None


@dataclass(frozen=True, slots=True)
class Chosen:
    """Trees of a description with what is said of their number and choice.

    Attributes:
        inner: Description.
        count: Number, if it is given.
        rank: Which one in the order of the choice ("second oldest").
        choice: How they are chosen, if it is said.
        unvisited: True for trees that the robot has not visited ("three other trees").
        near: Distance from a place, within which or beyond which they are.
        neighbours: True for "neighbours", whose place may be the one in hand.
        preceded: True if words before the noun were added; those behind it come first.
        per: Rows in each of which they are chosen.
        group: Number of the places of a group of which these are some, -1 if it is not known; 0 for others.
    """

    inner: Nominal
    count: int | None = None
    rank: int | None = None
    choice: Choice | None = None
    unvisited: bool = False
    near: Distance | None = None
    neighbours: bool = False
    preceded: bool = False
    per: s.Selector | None = None
    group: int = 0


@construction("chosen: inner=nominal", cost=0.1)
def described(inner: Nominal) -> Chosen | None:
    """Compose "yellow trees"."""
    return None if inner.single else Chosen(inner)


@construction("chosen: noun=NEIGHBOUR", cost=0.1)
def neighbours(noun: Lex) -> Chosen:
    """Compose "neighbours"."""
    inner = Nominal(s.Trees(), plural="plural" in noun.features)
    return Chosen(inner, choice=Choice("beside"), neighbours=True)


@construction("chosen: POINT", cost=0.1)
def points() -> Chosen:
    """Compose "points" along a row, which are trees."""
    return Chosen(Nominal(s.Trees(), plural=True, kind="point"))


@construction("chosen: word=DET noun=ROW OF chosen=chosen", cost=0.1)
def row_of_trees(word: Lex, noun: Lex, chosen: Chosen) -> Chosen | None:
    """Compose "a row of four trees"."""
    choice = in_a_row(word, noun)
    return None if choice is None or chosen.count is None else _with_choice(chosen, choice)


# Words before the noun.


@construction("chosen: n=count chosen=chosen", cost=0.1)
def so_many(n: int, chosen: Chosen) -> Chosen | None:
    """Compose "three yellow trees"."""
    return None if chosen.count is not None else replace(chosen, count=n, preceded=True)


@construction("chosen: OTHER chosen=chosen", "chosen: MORE chosen=chosen", cost=0.1)
def others(chosen: Chosen) -> Chosen | None:
    """Compose "other trees"."""
    return None if chosen.unvisited else replace(chosen, unvisited=True, preceded=True)


@construction("chosen: rank=ORD chosen=chosen", cost=0.1)
def ranked(rank: Lex, chosen: Chosen) -> Chosen | None:
    """Compose "second oldest tree"."""
    if chosen.rank is not None or chosen.choice is None or chosen.choice.by not in _RANKED:
        return None
    return replace(chosen, rank=rank.value, preceded=True)


@construction("chosen: choice=chosen_by chosen=chosen", cost=0.1)
def chosen_before(choice: Choice, chosen: Chosen) -> Chosen | None:
    """Compose "nearest tree"."""
    if chosen.neighbours and choice.by == "nearest":
        return replace(chosen, choice=replace(chosen.choice or choice, by="nearest"), preceded=True)
    made = _with_choice(chosen, choice)
    return None if made is None else replace(made, preceded=True)


@construction("chosen_by: side=MOST", cost=0.1)
def by_side(side: Lex) -> Choice | None:
    """Compose "northernmost"."""
    return None if side.value in CORNERS else Choice("extreme", side.value)


@construction("chosen: n=count side=DIR chosen=chosen", cost=0.1)
def so_many_to_a_side(n: int, side: Lex, chosen: Chosen) -> Chosen | None:
    """Compose "3 northern trees": those farthest to the north."""
    if chosen.count is not None or "adjective" not in side.features or side.value in CORNERS or n < 2:
        return None
    if chosen.inner.complete:
        return None
    made = _with_choice(chosen, Choice("extreme", side.value))
    return None if made is None else replace(made, count=n, preceded=True)


@construction("chosen_by: rank=ranking", cost=0.1)
def by_attribute(rank: tuple[str, bool]) -> Choice:
    """Compose "oldest"; "highest" waits for its attribute."""
    return Choice("best", rank)


@construction("chosen_by: RANDOM", "chosen_by: [DET] SAMPLE OF", cost=0.1)
def by_chance() -> Choice:
    """Compose "random"."""
    return Choice("random")


@construction("chosen_by: EVENLYSPACED", cost=0.1)
def by_even_spacing() -> Choice:
    """Compose "evenly spaced"."""
    return Choice("evenly")


@construction("chosen_by: FARAPART", cost=0.1)
def by_spread() -> Choice:
    """Compose "far apart"."""
    return Choice("spread")


@construction("chosen_by: CONSECUTIVE", cost=0.1)
def by_run() -> Choice:
    """Compose "consecutive"."""
    return Choice("in a run")


@construction("chosen_by: ADJACENT", "chosen_by: NEAREACH", cost=0.1)
def by_adjacency() -> Choice:
    """Compose "adjacent"."""
    return Choice("adjacent")


@construction("chosen_by: NEAREST", cost=0.2)
def by_nearness() -> Choice:
    """Compose "nearest"."""
    return Choice("nearest")


@construction("chosen_by: FARTHEST", cost=0.2)
def by_distance() -> Choice:
    """Compose "farthest"."""
    return Choice("farthest")


@construction("chosen_by: NEARBY", cost=0.1)
def by_vicinity() -> Choice:
    """Compose "nearby"."""
    return Choice("nearby")


@construction(
    "chosen: n=count OUTOF EACH m=count chosen=chosen",
    "chosen: n=count OUTOF m=count chosen=chosen",
    "chosen: n=count OF EACH m=count chosen=chosen",
    "chosen: n=count AT EACH m=count chosen=chosen",
    "chosen: n=count word=AT m=count chosen=chosen",
    cost=0.1,
)
def so_many_of_every(n: int, m: int, chosen: Chosen, word: Lex | None = None) -> Chosen | None:
    """Compose "3 of every 5 trees"."""
    if word is not None and "in_time" not in word.features:
        return None
    if chosen.count is not None or not chosen.inner.plural:
        return None
    made = _with_choice(chosen, Choice("of every", m))
    return None if made is None else replace(made, count=n, inner=replace(made.inner, plural=n > 1), preceded=True)


@construction("chosen: rank=ranking [n=count] YIELDER", "chosen: n=count rank=ranking YIELDER", cost=0.1)
def yielders(rank: tuple[str, bool], n: int | None = None) -> Chosen | None:
    """Compose "top 10 yielders"."""
    inner = Nominal(s.Trees(), plural=True)
    return None if rank[0] else Chosen(inner, count=n, choice=Choice("best", ("yield", rank[1])), preceded=True)


@construction("chosen: EACH n=ORD chosen=chosen", "chosen: EACH OTHER chosen=chosen", cost=0.1)
def every_nth(chosen: Chosen, n: Lex | None = None) -> Chosen | None:
    """Compose "every third tree" and "every other tree"."""
    one = chosen.group or not chosen.inner.plural or chosen.inner.unmarked
    return _every(chosen, 2 if n is None else n.value) if one else None


@construction("chosen: word=EACH n=count chosen=chosen", cost=0.2)
def every_so_many(word: Lex, n: int, chosen: Chosen) -> Chosen | None:
    """Compose "every 5 trees"."""
    return _every(chosen, n) if "every" in word.features and chosen.inner.plural else None


def _every(chosen: Chosen, n: int) -> Chosen | None:
    """Return every n-th tree of a description."""
    inner = chosen.inner
    if n < 2 or inner.tested or inner.kind != "tree" or chosen.count is not None or chosen.choice is not None:
        return None
    return replace(chosen, choice=Choice("nth", NthTree(n)), count=1, inner=replace(inner, plural=False), preceded=True)


# Words behind the noun.


@construction("in_their_row: in_ DET ROW", "in_their_row: OF DET ROW", "in_their_row: in_ EACH ROW", cost=0.0)
@construction("in_their_row: OF EACH ROW", "in_their_row: INEACH", cost=0.0)
def in_their_row() -> str:
    """Compose "in the row" behind the tree from which others are counted."""
    return "row"


@construction("begins_at: STARTING", "begins_at: STARTWITH", "begins_at: COUNTED", cost=0.0)
def begins_at() -> str:
    """Compose "starting with"."""
    return "begin"


@construction(
    "begin_with: begins_at [DET] rank=ORD [TREE] [in_their_row]",
    "begin_with: begins_at [DET] rank=ORD ONE [in_their_row]",
    cost=0.0,
)
def begin_with(rank: Lex) -> int:
    """Compose "starting with the second one"."""
    return int(rank.value)


@construction("chosen: chosen=chosen [COMMA] start=begin_with", cost=0.1)
def starting_with(chosen: Chosen, start: int) -> Chosen | None:
    """Compose "every third tree, starting with the second one"."""
    return _with_nth(chosen, start=start)


@construction("chosen: chosen=chosen [COMMA] begins_at trees=tree_ids", cost=0.1, given=("site",))
def starting_with_tree(chosen: Chosen, trees: tuple[str, ...], site: Site) -> Chosen | None:
    """Compose "every third tree of row 4, starting with tree 2", by its number in the row or by its id."""
    of = chosen.inner.selector
    there = ids_of(of, site) if are_rows(of) and is_one_row(of) else None
    if len(trees) != 1 or not there:
        return None
    (name,) = trees
    if name in there:
        before = (
            number
            for number in range(1, len(there) + 1)
            if ids_of(s.InRow(first=number, last=number, of=of), site) == {name}
        )
        number = next(before, 0)
    else:
        number = int(name) if name.isdigit() and 0 < int(name) <= len(there) else 0
    return _with_nth(chosen, start=number) if number else None


@construction("chosen: chosen=chosen [COMMA] side=start", cost=0.1)
def starting_from(chosen: Chosen, side: Side) -> Chosen | None:
    """Compose "every third tree starting from the north"."""
    return _with_nth(chosen, counted_from=side, visited_from=side)


@construction("chosen: chosen=chosen COMMA FROM [DET] side=DIR", cost=0.1)
def from_a_side(chosen: Chosen, side: Lex) -> Chosen | None:
    """Compose "every third tree, from the south", which they are counted and visited from."""
    visited = starting_from(chosen, side.value) if side.value in SIDES else None
    return visited or (None if _as_nth(chosen) is not None else counted_from(chosen, side))


@construction("chosen: chosen=chosen FROM [DET] side=DIR [FINISH]", cost=0.1)
def counted_from(chosen: Chosen, side: Lex) -> Chosen | None:
    """Compose "every third tree from the north" and "first two trees from the north"."""
    choice = chosen.choice
    if choice is None or side.value not in SIDES:
        return None
    if isinstance(choice.value, Positions | TreeNumbers):
        if choice.value.counted_from != "usual" or rows_within(chosen.inner.selector) is not None:
            return None  # "the first six trees of row 9 from the south": counted or visited from there?
        return replace(chosen, choice=replace(choice, value=replace(choice.value, counted_from=side.value)))
    return _with_nth(chosen, counted_from=side.value)


@construction("chosen: chosen=chosen COMMA way=in_ where=region", cost=0.2)
def in_area_behind(chosen: Chosen, where: s.Selector, way: str) -> Chosen | None:
    """Compose "every third tree, starting with the second, in row 4"."""
    nth = _as_nth(chosen)
    starts = nth is not None and (nth.start > 1 or nth.visited_from is not None)
    counted = chosen.choice is not None and getattr(chosen.choice.value, "counted_from", "usual") != "usual"
    return in_area(chosen, where, way) if starts or counted else None


def _as_nth(chosen: Chosen) -> NthTree | None:
    """Return how every n-th tree is counted; None for other trees."""
    value = None if chosen.choice is None else chosen.choice.value
    return value if isinstance(value, NthTree) else None


def _with_nth(chosen: Chosen, **changed: Any) -> Chosen | None:
    """Return every n-th tree with the tree or the side from which they are counted."""
    choice = chosen.choice
    if choice is None or not isinstance(choice.value, NthTree):
        return None
    if any(getattr(choice.value, name) != NthTree.__dataclass_fields__[name].default for name in changed):
        return None
    return replace(chosen, choice=replace(choice, value=replace(choice.value, **changed)))


@construction("chosen: chosen=chosen COMMA n=count OFTHEM", cost=0.2)
def so_many_of_them(chosen: Chosen, n: int) -> Chosen | None:
    """Compose "yellow trees, eight of them"."""
    return replace(chosen, count=n) if chosen.count is None and chosen.inner.plural and chosen.rank is None else None


@construction("chosen: chosen=chosen COMMA choice=chosen_as", cost=0.1)
def chosen_behind_a_comma(chosen: Chosen, choice: Choice) -> Chosen | None:
    """Compose "trees, nearest to the charger"; ", chosen at random" is said of all before it."""
    return None if choice.by == "random" else _with_choice(chosen, choice)


@construction("chosen: chosen=chosen COMMA choice=chosen_as", cost=0.8)
def drawn_behind_a_comma(chosen: Chosen, choice: Choice) -> Chosen | None:
    """Compose "trees, chosen at random", of one description."""
    return _with_choice(chosen, choice) if choice.by == "random" else None


@construction(
    "chosen: chosen=chosen choice=chosen_as",
    "chosen: chosen=chosen STANDS choice=chosen_as",
    "chosen: chosen=chosen COMMA DET ONE [STANDS] choice=chosen_as",
    cost=0.1,
)
def chosen_behind(chosen: Chosen, choice: Choice) -> Chosen | None:
    """Compose "trees nearest to the charger"."""
    return _with_choice(chosen, choice)


@construction("chosen: chosen=chosen [COMMA] BY [DET] attribute=ATTR", cost=0.2)
def best_by(chosen: Chosen, attribute: Lex) -> list[Chosen] | None:
    """Compose "weakest vines, going by vigor"."""
    choice = chosen.choice
    if choice is None or choice.by != "best" or not isinstance(choice.value, tuple):
        return None
    name, lowest = choice.value
    return [
        replace(chosen, choice=replace(choice, value=(other, lowest)))
        for other in attribute.value
        if name in ("", other)
    ]


@construction("chosen: chosen=chosen WITH [DET] attribute=ATTR DET best=ranking", cost=0.1)
def with_attribute_most(chosen: Chosen, attribute: Lex, best: tuple[str, bool]) -> list[Chosen] | None:
    """Compose "tree with the yield the most big"."""
    made = [] if best[0] else [_with_choice(chosen, Choice("best", (name, best[1]))) for name in attribute.value]
    return [one for one in made if one is not None] or None


@construction("chosen: chosen=chosen WITH DET rank=ORD best=ranking", cost=0.1)
def with_the_second_most(chosen: Chosen, rank: Lex, best: tuple[str, bool]) -> Chosen | None:
    """Compose "tree with the second highest yield"."""
    made = _with_choice(chosen, Choice("best", best)) if best[0] else None
    return None if made is None else replace(made, rank=rank.value)


@construction("chosen: chosen=chosen in_ to=place", "chosen: chosen=chosen NEAR to=place", cost=0.2)
def adjacent_near(chosen: Chosen, to: PlaceMeaning) -> Chosen | None:
    """Compose "adjacent trees near the charger"."""
    choice = chosen.choice
    if choice is None or choice.by != "adjacent" or choice.to is not None or to.shape != "one":
        return None
    return replace(chosen, choice=replace(choice, to=to))


@construction("chosen: chosen=chosen AT to=place", "chosen: chosen=chosen OF to=place", cost=0.2)
def near_what(chosen: Chosen, to: PlaceMeaning) -> Chosen | None:
    """Compose "nearest tree to the charger" and "neighbours of tree 12"."""
    choice = chosen.choice
    if choice is None or choice.by not in ("nearest", "beside") or choice.to is not None or to.selector == s.Middle():
        return None
    return replace(chosen, choice=replace(choice, to=to))


@construction("chosen: chosen=chosen FROM to=place", cost=0.2)
def far_from_what(chosen: Chosen, to: PlaceMeaning) -> Chosen | None:
    """Compose "farthest tree from the charger"."""
    choice = chosen.choice
    if choice is None or choice.by != "farthest" or choice.to is not None:
        return None
    return replace(chosen, choice=replace(choice, to=to))


@construction("chosen: chosen=chosen side=on_side", "chosen: side=DIR chosen=chosen", cost=0.2)
def to_one_side(chosen: Chosen, side: Side | Lex) -> Chosen | None:
    """Compose "neighbour to the east" and "southern neighbour"."""
    choice = chosen.choice
    where = side.value if isinstance(side, Lex) else side
    if choice is None or choice.by != "beside" or choice.value is not None or where not in SIDES:
        return None
    return replace(chosen, choice=replace(choice, value=where))


@construction("chosen_as: choice=chosen_by", cost=0.1)
def chosen_so(choice: Choice) -> Choice | None:
    """Compose "chosen at random" behind its noun; "oldest" stands before it."""
    return None if choice.by in ("extreme", "best", "farthest") else choice


@construction(
    "chosen_as: [which_is] NEAREST [AT] to=place",
    "chosen_as: [which_is] DET NEAREST [AT] to=place",
    "chosen_as: [which_is] [DET] NEAREST OF to=place",
    cost=0.1,
)
def nearest_to(to: PlaceMeaning) -> Choice:
    """Compose "nearest to the charger"."""
    return Choice("nearest", to=to)


@construction("chosen_as: [which_is] near=NEAR to=place", cost=0.2)
def near_to(near: Lex, to: PlaceMeaning) -> Choice | None:
    """Compose "closest to the charger" and "around tree 12"; "near" does not say how near."""
    if "nearest" in near.features:
        return Choice("nearest", to=to)
    return Choice("around", to=to) if "surrounds" in near.features else Choice("nearest", "near", to)


@construction("chosen_as: [which_is] [DET] FARTHEST FROM to=place", cost=0.1)
def farthest_from(to: PlaceMeaning) -> Choice:
    """Compose "farthest from the charger"."""
    return Choice("farthest", to=to)


@construction(
    "chosen_as: [which_is] NEXTTO to=place [side=on_side]",
    "chosen_as: [which_is] BESIDE to=place [side=on_side]",
    cost=0.1,
)
def beside(to: PlaceMeaning, side: Side | None = None) -> Choice:
    """Compose "next to tree 12 on the east"."""
    return Choice("beside", side, to)


@construction("chosen_as: [which_is] FARFROM to=place as_can", cost=0.1)
def as_far_as_possible_from(to: PlaceMeaning) -> Choice:
    """Compose "as far away from it as possible"."""
    return Choice("farthest", to=to)


@construction("chosen_as: [which_is] side=on_side OF to=place", cost=0.2)
def to_a_side_of(side: Side, to: PlaceMeaning) -> Choice:
    """Compose "to the north of it"."""
    return Choice("beside", side, to)


@construction("chosen_as: [EACH] dist=apart", "chosen_as: WHICH dist=apart", "chosen_as: ABOUT dist=apart", cost=0.1)
def so_far_apart(dist: float) -> Choice:
    """Compose "15 m apart"."""
    return Choice("apart", (dist, False))


@construction("chosen_as: [EACH] least=apart_least", "chosen_as: WHICH least=apart_least", cost=0.1)
def at_least_so_far_apart(least: float) -> Choice:
    """Compose "at least 15 m apart"."""
    return Choice("apart", (least, True))


@construction("chosen_as: SPREAD where=region", "chosen_as: SPREAD site", cost=0.1)
def spread_over(where: s.Selector | None = None) -> Choice:
    """Compose "spread over the northern half"; along a row they are evenly spaced."""
    if where is not None and are_rows(where) and is_one_row(where):
        return Choice("evenly", where)
    return Choice("spread", where)


@construction("chosen: chosen=chosen SPREAD site", "chosen: chosen=chosen over_site", cost=0.1)
def anywhere(chosen: Chosen) -> Chosen | None:
    """Compose "trees at random across the orchard"."""
    return chosen if chosen.choice is not None and chosen.choice.by == "random" else None


@construction("over_site: word=OPPOSITE site", "over_site: in_ site", cost=0.1)
def over_site(word: Lex | None = None) -> str | None:
    """Compose "across the orchard"."""
    return "site" if word is None or "across" in word.features else None


@construction("chosen_as: EVENLYALONG rows=rows", cost=0.1)
def evenly_along(rows: s.Selector) -> Choice:
    """Compose "spread evenly along row 4"."""
    return Choice("evenly", rows)


@construction("chosen_as: EVENLYALONG word=DET noun=ROW", "chosen_as: SPREAD word=DET noun=ROW", cost=0.0)
def evenly_along_theirs(word: Lex, noun: Lex) -> Choice | None:
    """Compose "spread evenly along the bed", of plants that all stand in one row."""
    return Choice("evenly", s.RowOf()) if not noun.plural and "definite" in word.features else None


@construction("chosen_as: [WHICH] WITH [DET] rank=ranking", "chosen_as: OF [DET] rank=ranking", cost=0.1)
def with_the_most(rank: tuple[str, bool]) -> Choice | None:
    """Compose "with the highest yield"."""
    return Choice("best", rank) if rank[0] else None


@construction("chosen_as: [WHICH] ATTRVERB [DET] rank=ranking", cost=0.1)
def that_yielded(rank: tuple[str, bool]) -> Choice | None:
    """Compose "that yielded the least"."""
    return None if rank[0] else Choice("best", ("yield", rank[1]))


@construction("chosen_as: AT word=DET noun=ROW", cost=0.1)
def in_a_row(word: Lex, noun: Lex) -> Choice | None:
    """Compose "in a row"."""
    return None if noun.plural or "one" not in word.features else Choice("in a run")


@construction(
    "chosen_as: OUTOF EACH m=count [TREE]", "chosen_as: OUTOF m=count [TREE]", "chosen_as: word=AT m=count", cost=0.1
)
def of_every(m: int, word: Lex | None = None) -> Choice | None:
    """Compose "out of every five" and "in three" of "one tree in three"."""
    return Choice("of every", m) if word is None or "in_time" in word.features else None


@construction("chosen: chosen=chosen way=in_ where=region", cost=0.2)
def in_area(chosen: Chosen, where: s.Selector, way: str) -> Chosen | None:
    """Compose "trees nearest to the charger in the northern half"."""
    choice, inner = chosen.choice, chosen.inner
    if choice is None or not chooses_from_trees(inner.selector):
        return None
    if choice.to is not None and not choice.to.selector.named_marker and where != s.RowOf():
        return None  # "nearest to the tree in the northern half": the tree there?
    if where == s.RowOf() and choice.by in ("nearest", "beside", "farthest"):
        where = s.RowOf(origin=_origin(choice))
    there = inside(inner, where, way)
    return None if there is None else replace(chosen, inner=there)


@construction("chosen: chosen=chosen in_ rows=each_row", cost=0.0)
def chosen_in_each_row(chosen: Chosen, rows: s.Selector) -> Chosen | None:
    """Compose "three oldest trees in each row"."""
    if chosen.choice is None or chosen.choice.by in ("at", "numbered", "nth") or chosen.per is not None:
        return None
    return replace(chosen, per=rows)


def _origin(choice: Choice) -> s.Selector:
    return s.Here() if choice.to is None else choice.to.selector


def _with_choice(chosen: Chosen, choice: Choice) -> Chosen | None:
    """Return a description with a choice; only one says how the trees are chosen."""
    return replace(chosen, choice=choice) if chosen.choice is None else None


# Choices without a noun.


@construction("far_side: [which_is] side=farthest_side", cost=0.0)
def far_side(side: Lex) -> Choice | None:
    """Compose "farthest to the south"."""
    return by_side(side)


@construction("clause_choice: choice=chosen_as", "clause_choice: [which_is] [DET] choice=chosen_by", cost=0.0)
def clause_choice(choice: Choice) -> Chosen | None:
    """Compose "is nearest to the charger" behind "whichever of them"."""
    return bare(choice)


@construction("bare: [n=count] [noun=ONE] choice=chosen_as", "bare: [n=count] [noun=ONE] choice=far_side", cost=0.1)
def bare_behind(choice: Choice, n: int | None = None, noun: Lex | None = None) -> list[Chosen] | None:
    """Compose "one nearest to the charger", of places that something else names."""
    return None if choice.by == "best" and n is None else bare_of(choice, n, noun)


@construction("bare: [n=count] choice=chosen_by [noun=ONE]", "bare: choice=chosen_by n=count [noun=ONE]", cost=0.1)
def bare_of(choice: Choice, n: int | None = None, noun: Lex | None = None) -> list[Chosen] | None:
    """Compose "three oldest", of places that something else names; "the nearest ones": how many?"""
    several = n is None and noun is not None and "plural" in noun.features
    made = (bare(choice, number) for number in (VAGUE_NUMBERS if several else (n,)))
    return [one for one in made if one is not None] or None


def bare(choice: Choice, n: int | None = None) -> Chosen | None:
    """Return so many chosen ones, of places that something else names."""
    if (choice.by in ("nearest", "farthest", "beside") and choice.to is None) or choice.by == "of every":
        return None
    return Chosen(Nominal(s.Trees(), plural=n is not None and n > 1), count=n, choice=choice)


def chosen_among(of: s.Selector, chosen: Chosen, site: Site) -> list[PlaceMeaning]:
    """Return what a choice without a noun can mean among some places."""
    return places_of(replace(chosen, inner=replace(chosen.inner, selector=of)), site) or []


# Places.


@construction("place: [word=DET] chosen=chosen", cost=0.2, given=("site",))
def places_of(chosen: Chosen, site: Site, word: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "the five oldest yellow trees in row 3"."""
    if chosen.choice is None:
        return _unvisited(chosen)
    if chosen.choice.by in ("at", "numbered"):
        return None
    indefinite = word is not None and "indefinite" in word.features
    if indefinite and (chosen.inner.plural or chosen.count is not None) and chosen.choice.by != "nearby":
        return None
    numbers = _numbers(chosen, definite=word is not None)
    how = chosen.choice
    in_rows = any(are_rows(part) for part in chosen.inner.selector.walk())
    open_row = how.by == "evenly" and (how.value == s.RowOf() or (how.value is None and not in_rows))
    if open_row and (own := row_of_all(chosen.inner, site)) is not None:
        how = replace(how, value=own)  # "six basil plants spread evenly along the bed", which is theirs
    if how.by == "evenly" and how.value is None and not any(are_rows(part) for part in chosen.inner.selector.walk()):
        how = _evenly_among(chosen.inner, site) or how
    made = [_place(chosen, choice, n) for choice in _named(how, site) for n in numbers]
    if chosen.per is not None:
        made = [None if one is None else in_each_row(one, chosen.per) for one in made]
    return [one for one in made if one is not None] or None


def _evenly_among(inner: Nominal, site: Site) -> Choice | None:
    """Return how "four evenly spaced leeks" are chosen: along their row, or spread over their rows; None for others."""
    if (own := row_of_all(inner, site)) is not None:
        return Choice("evenly", own)
    return Choice("spread") if fills_rows(inner, site) else None


def _unvisited(chosen: Chosen) -> list[PlaceMeaning] | None:
    """Return any so many trees that were not visited ("three other trees")."""
    if not chosen.unvisited or chosen.count is None or chosen.rank is not None:
        return None
    some = s.Take(count=chosen.count, of=s.NotVisited(of=chosen.inner.selector))
    return [PlaceMeaning(some, "several" if chosen.count > 1 else "one", count=chosen.count)]


@construction("place: owner=owned_by chosen=chosen", cost=0.2, given=("site",))
def owned(owner: PlaceMeaning, chosen: Chosen, site: Site) -> list[PlaceMeaning] | None:
    """Compose "tree 12's two nearest neighbours" and "its neighbour to the east"."""
    choice = chosen.choice
    if choice is None or choice.to is not None or choice.by not in ("nearest", "beside"):
        return None
    if owner.shape not in ("one", "here"):
        return None
    inner = replace(chosen.inner, selector=swapped(chosen.inner.selector, s.RowOf(), s.RowOf(origin=owner.selector)))
    return places_of(replace(chosen, inner=inner, choice=replace(choice, to=owner)), site, None)


@construction(
    "place: near=place [COMMA] AND [AT] DET n=count [TREE] FARTHEST",
    "place: near=place [COMMA] AND [AT] DET n=count [TREE] FARTHEST FROM IT",
    cost=0.2,
)
def and_the_farthest(near: PlaceMeaning, n: int) -> PlaceMeaning | None:
    """Compose "the three trees nearest to the pond and the three farthest from it"."""
    nearest = as_nearest(near.selector)
    if nearest is None or nearest.adjacent or near.shape not in ("one", "several"):
        return None
    far = s.Farthest(origin=nearest.to, count=n, of=nearest.of)
    return PlaceMeaning(s.UnionOf(parts=(nearest, far)), "several", count=nearest.count + n)


@construction("place: near=place in_ rows=rows", cost=0.2)
def along_its_row(near: PlaceMeaning, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the two trees north of it in the row"."""
    along = all(as_along_row(step) is not None for step in near.selector.members)
    return near if rows == s.RowOf() and along else None


def _named(choice: Choice, site: Site) -> Sequence[Choice]:
    """Return a choice with the attribute of the site that a word hints at."""
    from fieldhand.planning.grammar.words import hinted_attributes

    if choice.by != "best":
        return (choice,)
    name, lowest = choice.value
    if name == "yield":
        return tuple(replace(choice, value=(one, lowest)) for one in hinted_attributes("yield", site))
    return (choice,) if name else ()


def _numbers(chosen: Chosen, *, definite: bool) -> Sequence[int | None]:
    """Return the numbers of trees that may be meant."""
    choice, inner = chosen.choice, chosen.inner
    if chosen.group:
        return (chosen.count or 1,) if chosen.preceded and choice is not None and choice.by != "of every" else ()
    if chosen.count is not None:
        return (chosen.count,) if inner.counts(chosen.count) else ()
    if not inner.plural or inner.unmarked:
        return (1,)
    if choice is None:
        return ()
    if choice.by == "best" and definite:
        return VAGUE_NUMBERS
    if choice.by in ("beside", "around") and choice.value is None:
        if choice.to is not None and choice.to.shape == "area":
            return ()
        in_row = any(part.row_of is not None for part in inner.selector.walk())
        return (2,) if in_row else (4, 8) if choice.by == "around" else (2, 4)
    return (None,)


def _place(chosen: Chosen, choice: Choice, n: int | None) -> PlaceMeaning | None:
    """Return so many trees of a description, chosen in a way; None if the two do not fit."""
    inner = chosen.inner
    of = s.NotVisited(of=inner.selector) if chosen.unvisited else inner.selector
    if n is None:
        if choice.by != "nearby":
            return None
        return PlaceMeaning(s.Nearest(to=s.Here(), count=2, fresh=True, of=of), "nearby")
    if inner.kind == "point" and choice.by != "evenly":
        return None
    if inner.kind == "corner" and (n >= (inner.complete or n + 1) or choice.by not in ("nearest", "farthest")):
        return None
    if choice.to is not None and not _measurable(choice):
        return None
    if chosen.rank is not None:
        if n != 1 or chosen.rank < 2:
            return None
        better = _selector(choice, chosen.rank - 1, of)
        if better is None:
            return None
        of = s.Excluding(places=better, of=of)
    selector = _selector(choice, n, of)
    if selector is None:
        return None
    those = Likewise("those", holds=True) if inner.pronoun and inner.selector == s.Trees() else None
    if choice.by == "nth":
        return PlaceMeaning(selector, "several", each=True, in_order=choice.value.visited_from is not None, like=those)
    if choice.by == "of every" and n == 1:
        return PlaceMeaning(selector, "several", each=True, like=those)
    beside = chosen.neighbours if choice.to is None else choice.to.shape == "here"
    ranked = inner.pronoun and choice.by == "best" and n == 1 and of == s.Trees()  # "one of the youngest"
    like = Likewise("ranked") if ranked else those
    vague = choice.value[0] if choice.by == "best" and n > 1 and chosen.count is None else ""
    shape: Literal["one", "several"] = "one" if n == 1 else "several"
    return PlaceMeaning(selector, shape, count=n if n > 1 else None, beside=beside, like=like, vague=vague)


def _measurable(choice: Choice) -> bool:
    """Return True if trees can be near to or far from the place of a choice."""
    if choice.to is None or choice.to.shape in ("one", "here"):
        return True
    return choice.to.shape == "area" and as_zone(choice.to.selector) is not None


def _selector(choice: Choice, n: int, of: s.Selector) -> s.Selector | None:
    """Return the selector of so many trees that are chosen in a way."""
    to, value = _origin(choice), choice.value
    zone = as_zone(to) is not None
    match choice.by:
        case "extreme":
            return s.Extreme(side=value, count=n, of=of) if value in SIDES else None
        case "best":
            return s.Top(attribute=value[0], count=n, lowest=value[1], of=of)
        case "nearest":
            if to == s.Middle() and n == 1 and of == s.Trees():
                return None  # that is the middle itself
            return s.Adjacent(near=to, count=n, of=of) if is_spot(to) else s.Nearest(to=to, count=n, of=of)
        case "around":
            return s.Nearest(to=to, count=n, adjacent=not zone, of=of)
        case "beside":
            side: AnySide = value or "any"
            if side != "any" and (n > 1 or of != s.Trees()):
                return None
            return s.Nearest(to=to, count=n, adjacent=not zone, side=side, of=of)
        case "farthest":
            return s.Farthest(origin=to, count=n, of=of)
        case "nearby":
            return s.Nearest(to=s.Here(), count=n, fresh=True, of=of)
        case "random":
            return s.RandomSample(count=n, of=of)
        case "of every":
            return _of_every(value, n, of)
        case "nth":
            every = s.EveryNth(nth=value.n, start=value.start, counted_from=value.counted_from, of=of)
            return every if value.visited_from is None else s.Ordered(by=AWAY_FROM[value.visited_from], of=every)
        case "path":
            return value[0].among(of if value[1] is None else over(of, value[1]), n) if chooses_from_trees(of) else None
        case "at" | "numbered":
            return None
        case _ if n < 2:
            return None
        case "spread":
            return s.Spread(count=n, of=of if value is None else over(of, value)) if chooses_from_trees(of) else None
        case "evenly":
            return _evenly(n, of if value is None else over(of, value))
        case "in a run":
            return s.Successive(count=n, of=of)
        case "adjacent":
            return s.Adjacent(near=to, count=n, of=of)
        case "apart":
            return s.Apart(apart_m=value[0], count=n, least=value[1], of=of)


def _of_every(m: int, n: int, of: s.Selector) -> s.Selector | None:
    """Return n of every m trees along their rows."""
    if n >= m:
        return None
    return s.EveryNth(nth=m, of=of) if n == 1 else s.Evenly(count=n, out_of=m, of=of)


def _evenly(n: int, of: s.Selector) -> s.Selector | None:
    """Return trees that are evenly spaced along one row, or spread over those of a description."""
    rows = {part for part in of.walk() if are_rows(part)}
    if not rows and is_description(of):
        return s.Spread(count=n, of=of)  # "five evenly spread leeks"
    return s.Evenly(count=n, of=of) if len(rows) == 1 and all(is_one_row(part) for part in rows) else None
