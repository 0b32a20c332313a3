"""Noun phrases as selectors: "the 3 yellow trees nearest to the charger in the northern half".

A chain of phrases is a tree: each phrase belongs to the nearest one before it that can be described further. A tree
that is named by its id, a marker and "it" cannot, so in "the trees nearest to the charger in the northern half" it is
the trees that stand in the northern half.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english.bag import Bag, bag_of
from fieldhand.planning.english.bare import named_trees, quantity_alone
from fieldhand.planning.english.faults import Question, Unclear, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.inrow import excepted_in_rows, named_in_rows, successive_trees
from fieldhand.planning.english.joining import (
    check_comma,
    check_of_row,
    from_each_other,
    is_apposition,
    of_the_other,
    one_each,
    only_compares,
    read_as,
    without_appositions,
    without_both,
)
from fieldhand.planning.english.onebyone import swapped
from fieldhand.planning.english.pick import picked
from fieldhand.planning.english.rows import rows_meant, some_block, speaks_of_rows, unnamed_block
from fieldhand.planning.english.sets import Group
from fieldhand.planning.english.syntax import Chain, PlacePhrase, Places
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.selections import are_meant_each, as_half, as_zone, measures_from_here
from fieldhand.site.model import Site
from fieldhand.terms import AnySide

#: Words that make a phrase behind "with" or "of" a description rather than a place ("with yellow leaves").
_DESCRIBING = ("ATTR", "ATTRVAL", "SUPER")
#: What "on the east" begins with where it is said of a tree.
_OF_ANCHOR = frozenset(
    {
        "on",
        "to",
        "at",
        "towards",
        "toward",
        "over on",
        "across on",
        "located on",
        "situated on",
        "standing on",
        "growing on",
    }
)
_SPREAD_ADVICE = message("say 'at 5 points spread over the wet corner', or '5 trees spread over the block'")
_SEVERAL = frozenset({"them", "they", "both", "each", "every", "all", "these", "those"})
_ANCHORED = ("NEAREST", "FARTHEST", "FAR", "STEP", "OPPOSITE")
#: Relations that trees have, and rows do not.
_OF_TREES = ("NEAR", "NEXTTO", "WITHIN", "BEYOND", "OUTSIDE", "EXCEPT", "FROM")
#: Areas that rows are not a part of, but stand in ("the trees in the northern half in row 3").
_AREAS = ("HALF", "QUARTER", "SIDE", "EDGE", "ZONE", "DIR")


@dataclass
class _PlacePart:
    """A phrase with what describes it."""

    bag: Bag
    phrase: PlacePhrase
    described: list[tuple[Term, _PlacePart]] = field(default_factory=list)
    in_rows: bool = False  # what follows says of which row it is an end or a tree

    @property
    def closed(self) -> bool:
        """Whether nothing can describe it further."""
        named = bool(self.bag.ids) and not self.in_rows
        return bool(self.phrase.there or named or self.bag.has("CHARGER", "IT") or self.is_marker)

    @property
    def is_marker(self) -> bool:
        """Whether it is the start or the end of the site."""
        ends = self.bag.has("START", "FINISH") and not self.in_rows
        return ends and not self.bag.has("DIR", "MOST", "TREE", "MIDDLE", "COUNTEDFROM")


def find(places: Places, site: Site) -> FoundPlace:
    """What joined chains select: one after the other, each place once.

    Raises:
        Unclear, Question: A phrase means nothing here, or several things.
    """
    if any(join.value == "or" for join in places.joins):
        choices = tuple(text_of(chain.terms) for chain in places.chains)
        raise Question(
            message("'{said}': which of them?", context="question", said=text_of(places.terms)),
            choices,
            terms=places.terms,
        )
    found: list[FoundPlace] = []
    places = one_each(without_appositions(places))
    for chain, excepted in _chains(places):
        if found and is_apposition(chain):
            continue  # "another tree, a different one": the same tree, said again
        found.append(_chain(chain, excepted, site))
    if len(found) == 1:
        return found[0]
    if (whole := of_the_other(places, found)) is not None:
        with suppress(Unclear):
            return replace(_chain(whole, (), site), assumed=(read_as(places, whole),))
    check_of_row(places, found)
    check_comma(places, found)
    found = from_each_other(found)
    if any(f.object_only or f.optional or f.at_most for f in found):
        raise unclear(places.terms, message("these cannot be combined"), message("say each in a sentence of its own"))
    found = [_after(f, found[k - 1] if k else None, places) for k, f in enumerate(found)]
    if any(f.here for f in found):
        found = [replace(f, selector=s.Here()) if f.here else f for f in found]
    rows = all(f.rows for f in found)
    if rows and any(isinstance(f.selector, s.Successive) for f in found):
        raise unclear(
            places.terms, message("these rows cannot be combined"), message("say each in a sentence of its own")
        )
    return FoundPlace(
        selector=s.UnionOf(parts=tuple(f.selector for f in found)),
        many=True,
        each=any(f.each for f in found),
        region=rows,
        rows=rows,
        one_by_one=tuple(one for f in found for one in f.one_by_one) if all(f.one_by_one for f in found) else (),
        assumed=tuple(sentence for f in found for sentence in f.assumed),
    )


def _after(found: FoundPlace, before: FoundPlace | None, places: Places) -> FoundPlace:
    """Return what was found with "it" as the place named right before, which the robot need not have reached by then.

    Raises:
        Unclear: Several places were named before.
    """
    if before is None or not measures_from_here(found.selector):
        return found
    if before.many or before.here or before.selector.relative:
        raise unclear(places.terms, message("it is not clear next to what"), message("say it in a sentence of its own"))
    return replace(found, selector=swapped(found.selector, s.Here(), before.selector))


def _chains(places: Places) -> list[tuple[Chain, tuple[Chain, ...]]]:
    """Chains, each with those that go on with its exception; "in the north and the south" is said of both."""
    found: list[tuple[Chain, tuple[Chain, ...]]] = []
    for chain in without_both(places.chains):
        if found:
            if only_compares(chain):  # "older than 8 years and younger than 12"
                last, excepted = found[-1]
                head = last.phrases[0]
                head = replace(head, nominals=(*head.nominals, *chain.phrases[0].nominals))
                phrases = (head, *last.phrases[1:], *chain.phrases[1:])
                found[-1] = (replace(last, phrases=phrases, relations=(*last.relations, *chain.relations)), excepted)
                continue
            last, excepted = found[-1]
            starts_anew = any(t.kind in ("EACH", "ASMANY") for t in chain.phrases[0].quantity)
            if any(r.kind == "EXCEPT" for r in last.relations) and not starts_anew:
                found[-1] = (last, (*excepted, chain))
                continue
            if last.relations and len(chain.phrases) == 1 and _kind(chain.phrases[0]) == _kind(last.phrases[-1]) != "":
                if _kind(chain.phrases[0]) == "closed":
                    raise unclear(
                        places.terms,
                        message("this can be read in two ways"),
                        message("say each in a sentence of its own"),
                    )
                chain = replace(last, phrases=(*last.phrases[:-1], chain.phrases[0]))
        found.append((chain, ()))
    return found


def _kind(phrase: PlacePhrase) -> str:
    """Whether a phrase is an area or a closed place; neither if it speaks of trees."""
    part = _PlacePart(bag=bag_of(phrase), phrase=phrase)
    if part.closed:
        return "closed"
    return "" if part.bag.has("TREE", "CORNER", "PLACE") or not phrase.nominals else "area"


def _chain(chain: Chain, excepted: tuple[Chain, ...], site: Site) -> FoundPlace:
    parts = [_PlacePart(bag=bag_of(phrase), phrase=phrase) for phrase in chain.phrases]
    line = [parts[0]]  # the way from the first phrase to the last, by what each describes
    for relation, part in zip(chain.relations, parts[1:], strict=True):
        plot = part.is_marker is False and part.bag.only("PLOT", "PLACE") and relation.kind in ("OF", "AT")
        rows = speaks_of_rows(part.bag) and relation.kind in ("OF", "AT", "ALONG", "INSIDE")
        if rows and (line[-1].bag.ids or line[-1].bag.has("START", "FINISH")):
            line[-1].in_rows = True
        if rows and relation.kind != "OF" and len(line) > 1 and line[-1].bag.has(*_AREAS):
            line = line[:1]  # "the yellow trees in the northern half in row 3"
        if relation.kind in _OF_TREES and len(line) > 1 and speaks_of_rows(line[-1].bag):
            if relation.kind in ("NEAR", "NEXTTO") and line[-1].bag.only("ROW") and not line[-1].bag.pointing:
                raise unclear(
                    chain.terms, message("what is near, the tree or the row?"), message("name the row, or leave it out")
                )
            line = line[:1]  # "the tree in row 3 nearest to the charger"
        if len(line) > 1 and line[-1].bag.describes(*_DESCRIBING):
            line.pop()  # "trees | with yellow leaves | in the southern half"
        while len(line) > 1 and (line[-1].closed and not (plot and line[-1].is_marker)):
            line.pop()
        if relation.kind == "EXCEPT" and line[0].bag.has("TREE", "CORNER", "PLACE"):
            line = line[:1]  # an exception is taken from what the phrase speaks of
        if line[-1].closed and not (plot and line[-1].is_marker):
            raise unclear(
                chain.terms,
                message(
                    "'{said}' is a single place and cannot be restricted further", said=text_of(line[-1].phrase.terms)
                ),
            )
        line[-1].described.append((relation, part))
        line.append(part)
    others = tuple(_chain(other, (), site).selector for other in excepted)
    return _read(parts[0], others, site)


def _read(part: _PlacePart, excepted: tuple[s.Selector, ...], site: Site) -> FoundPlace:
    """A phrase with all that describes it."""
    bag, phrase = part.bag, part.phrase
    if phrase.there is not None:
        return FoundPlace(selector=s.Here(), here=True, these=are_several(phrase.there))
    if bag.has("IT") or (bag.has("PLACE") and bag.only("PLACE") and not part.described and _points_back(bag)):
        word = bag.take("IT", "PLACE")
        bag.finish()
        these = bag.each or (word is not None and are_several(word))
        return FoundPlace(selector=s.Here(), here=True, these=these)
    group = Group(side=_side_of_anchor(part))
    size: int | None = None
    successive = False
    for relation, inner in part.described:
        if _is_side_of_anchor(part, relation, inner):
            continue
        if bag.has("ROW") and relation.kind in ("OF", "WITH") and _is_size(inner):
            size = inner.bag.count
            continue
        if relation.kind == "AT" and _in_a_row(bag, inner):
            successive = True
            continue
        _describe(part, group, relation, inner, excepted, site)
    if successive or bag.has("CONSECUTIVE"):
        return successive_trees(bag, group)
    if unnamed_block(bag, site):
        return some_block(bag, group, site)
    if speaks_of_rows(bag):
        return rows_meant(bag, group, size, site)
    if bag.ids and part.in_rows:
        return named_in_rows(bag, group, site)
    if bag.ids:
        return named_trees(bag)
    marker = _marker(part)
    if marker is not None:
        bag.finish()
        return FoundPlace(selector=marker)
    if not phrase.nominals:
        return quantity_alone(bag, group, phrase, [relation for relation, _ in part.described])
    return picked(bag, group, site)


def _is_side_of_anchor(part: _PlacePart, relation: Term, inner: _PlacePart) -> bool:
    """Return True for "on the east" behind "next to it": a side of that place rather than of the site.

    Raises:
        Unclear: It can be read both ways.
    """
    at = next(k for k, (r, _) in enumerate(part.described) if r is relation)
    before = [r.kind for r, _ in part.described[:at]]
    beside = any(r.kind == "NEXTTO" for r, _ in part.described)
    bag = inner.bag
    near = any(r.kind == "NEAR" and are_named for r, are_named in _named_anchors(part))
    if relation.kind not in ("AT", "INSIDE") or not (beside or near) or inner.described or bag.count or bag.each:
        return False
    if near and relation.text.lower() not in _OF_ANCHOR:
        return False  # "the 3 trees nearest to tree 4 in the northern half"
    sides = bag.words("DIR")
    if len(sides) != 1 or not bag.only("DIR", "SIDE"):
        return False
    if relation.text.lower() not in _OF_ANCHOR or "NEXTTO" not in before:
        raise unclear(
            (relation, *inner.phrase.terms),
            message("on that side of the tree, or in that half of the site?"),
            message("say 'next to it on the east', or 'in the eastern half'"),
        )
    if len(sides[0].value) == 2:
        raise unclear(
            (relation, *inner.phrase.terms),
            message("a neighbour is on one of four sides"),
            message("say 'on the east'"),
        )
    return True


def _named_anchors(part: _PlacePart) -> tuple[tuple[Term, bool], ...]:
    """Return each relation of a phrase, and if it is to a tree that is named, or to "it"."""
    return tuple((r, bool(inner.bag.ids) or inner.bag.has("IT")) for r, inner in part.described)


def _side_of_anchor(part: _PlacePart) -> AnySide:
    """Return the side of its anchor that a phrase speaks of."""
    found = [inner for relation, inner in part.described if _is_side_of_anchor(part, relation, inner)]
    if len(found) > 1:
        raise unclear(part.phrase.terms, message("two sides cannot be combined"), message("say one of them"))
    side: AnySide = found[0].bag.words("DIR")[0].value if found else "any"
    return side


def _in_a_row(bag: Bag, inner: _PlacePart) -> bool:
    """Whether "4 trees | in a row" is said."""
    row = inner.bag
    one = row.article in ("a", "one") and row.only("ROW") and row.has("ROW") and row.count is None and not row.plural
    return one and not inner.described and bag.has("TREE") and bag.count is not None


def _is_size(part: _PlacePart) -> bool:
    """Whether a phrase behind "row" says what it is made of: "of 5 trees", "of trees"."""
    bag = part.bag
    return (
        not part.described
        and bag.only("TREE")
        and bag.has("TREE")
        and not (bag.definite or bag.each or bag.any or bag.another or bag.as_many or bag.up_to or bag.more)
    )


def are_several(term: Term) -> bool:
    """Whether a word for what was spoken of means several places ("at each of them", "both")."""
    return bool(_SEVERAL & set(term.text.lower().split()))


def _points_back(bag: Bag) -> bool:
    return bag.definite and not bag.another and bag.count is None


def _describe(
    part: _PlacePart, group: Group, relation: Term, inner: _PlacePart, excepted: tuple[s.Selector, ...], site: Site
) -> None:
    """What one phrase says of the phrase that it describes."""
    bag = part.bag
    kind = relation.kind
    if kind in ("WITH", "OF") and not inner.described and _describes(inner.bag):
        bag.join(inner.bag)
        return
    if kind == "WITH":
        raise unclear([relation, *inner.phrase.terms], message("it does not say what this refers to"))
    sided = bag.has("MIDDLE") and inner.bag.has("SIDE")
    behind = _read(inner, (), site)
    if sided and (half := as_half(behind.selector)) is not None:  # "the middle of the north side" is on the edge
        behind = replace(behind, selector=s.Edge(side=half.side, of=half.of))
    if behind.object_only or behind.optional or behind.at_most is not None:
        raise unclear([relation, *inner.phrase.terms], message("a place was expected"))
    if speaks_of_rows(bag) and not (behind.region or behind.here):
        _row_of(bag, group, relation, behind, inner)
        return
    anchored = bag.has(*_ANCHORED) and not group.anchor
    if kind == "NEAR" and behind.selector.central:
        kind = "AT"  # "somewhere near the middle" is the middle
    if kind == "FROM" and not anchored:
        raise unclear(
            [relation, *inner.phrase.terms],
            message("from there, but what?"),
            message("say 'nearest to', or 'within 20 m of'"),
        )
    spot = bag.has("ADJACENT") and behind.selector.central and not group.anchor
    match kind:
        case "FROM":
            group.anchor = _single(behind, inner)
        case "OF" | "AT" if spot:  # "two trees next to each other in the middle of the orchard"
            group.anchor = behind.selector
        case "OF" | "AT" if anchored and not behind.region and not behind.many:
            group.anchor = _single(behind, inner)
        case "OF" | "AT" | "INSIDE" | "ALONG" | "SPREAD":
            _among(bag, group, relation, behind, inner)
        case "NEXTTO" | "NEAR":
            group.anchor, group.beside = _single(behind, inner), kind == "NEXTTO"
        case "WITHIN" | "BEYOND" if zone := behind.selector.whole_zone:
            group.add(_near_zone(zone, relation), inner.phrase)
        case "WITHIN":
            group.within(relation.value, _single(behind, inner))
        case "BEYOND":
            group.without(beyond(relation.value, _single(behind, inner)))
        case "EXCEPT" if inner.bag.ids and group.rows is not None and not inner.in_rows:
            of_row = Group(area=group.area, rows=group.rows, one_by_one=group.one_by_one)
            bare = [one for one in excepted if isinstance(one, s.TreeIs)]  # "except tree 4 and tree 7"
            inner.bag.ids = [*inner.bag.ids, *(one.tree for one in bare)]
            others = [one for one in excepted if one not in bare]
            group.without(excepted_in_rows(inner.bag, of_row, site), *others)
        case "OUTSIDE" | "EXCEPT":
            group.without(behind.selector, *excepted)
        case _:
            raise unclear(part.phrase.terms, message("'{said}' does not fit here", said=relation.text))


def _row_of(bag: Bag, group: Group, relation: Term, behind: FoundPlace, inner: _PlacePart) -> None:
    """ "The row of tree 12"."""
    ranks = bag.has("ORD", "LAST", "MOST", "BACKORD", "EVERYNTH", "COUNTEDFROM")
    if relation.kind != "OF" or behind.many or bag.plural or ranks or not bag.has("ROW", "OVER"):
        terms = [relation, *inner.phrase.terms]
        raise unclear(terms, message("it is not clear of which row"), message("say 'every third tree of row 3'"))
    group.row_of = behind.selector


def _among(bag: Bag, group: Group, relation: Term, behind: FoundPlace, inner: _PlacePart) -> None:
    """ "... in the northern half", "... of row 3", "... along row 3", "... spread over the wet corner"."""
    kind, terms = relation.kind, [relation, *inner.phrase.terms]
    if kind == "SPREAD" and bag.has("PLACE") and as_zone(behind.selector) is None:
        raise unclear(terms, message("free points are spread over a zone"), _SPREAD_ADVICE)
    if kind == "SPREAD" and not bag.has("PLACE"):
        bag.spread = (relation,)
    if kind == "ALONG" and not behind.line:
        raise unclear(terms, message("along which row?"), message("name the row: 'along row 3'"))
    way = relation.text.lower().split() if kind == "ALONG" else []
    group.upwards = "up" in way and "down" not in way
    group.along = group.along or kind == "ALONG"
    group.rows_of = group.rows_of or (behind.rows and kind == "OF")
    at_each = behind.each or (are_meant_each(behind.selector) and bool(bag.article))
    if at_each and behind.many and not (behind.region or bag.as_many or bag.up_to):
        if bag.count not in (None, 1):
            raise unclear(
                bag.phrase.terms,
                message("a number of captures at each place is not supported here yet"),
                message("name each place"),
            )
        bag.each, bag.count = True, None  # "the tree at each corner"
    group.add(behind, inner.phrase)


def _describes(bag: Bag) -> bool:
    """Whether a phrase says what trees are, and names no place."""
    return bag.describes(*_DESCRIBING)


def beyond(metres: float, of: s.Selector) -> s.Selector:
    """What is left out where trees are to be at least so far from a place: those nearer to it, and itself."""
    return s.UnionOf(parts=(of, s.Within(distance_m=metres, to=of)))


def _near_zone(zone: str, relation: Term) -> FoundPlace:
    """Return the trees at most so far from a zone, or those farther away."""
    near = s.InZone(zone=zone, margin_m=relation.value, outside=relation.kind == "BEYOND")
    return FoundPlace(selector=near, many=True, region=True)


def _single(found: FoundPlace, inner: _PlacePart) -> s.Selector:
    if found.many and not found.selector.whole_zone:
        advice = message("name one tree, corner, marker or zone")
        raise unclear(inner.phrase.terms, message("distances have to be measured from a single place"), advice)
    return found.selector


def _marker(part: _PlacePart) -> s.Selector | None:
    bag = part.bag
    if bag.has("CHARGER"):
        bag.take("CHARGER")
        return s.Marker(name="charger")
    if not part.is_marker:
        return None
    if bag.take("START") is not None:
        return s.Marker(name="start")
    bag.take("FINISH")
    return s.Marker(name="end")
