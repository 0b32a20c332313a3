"""Noun phrases as selectors: "the 3 yellow trees nearest to the charger in the northern half".

A chain of phrases is a tree: each phrase belongs to the nearest one before it that can be described further. A tree
that is named by its id, a marker and "it" cannot, so in "the trees nearest to the charger in the northern half" it is
the trees that stand in the northern half.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from fieldhand.planning.english.bag import Bag, bag_of
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.found import Found
from fieldhand.planning.english.pick import picked
from fieldhand.planning.english.sets import Group, nested
from fieldhand.planning.english.syntax import Chain, NounPhrase, Places
from fieldhand.planning.english.tokens import Term
from fieldhand.site.model import Site
from fieldhand.task import selectors as s

#: Words that make a phrase behind "with" or "of" a description rather than a place ("with yellow leaves").
_DESCRIBING = ("ATTR", "ATTRVAL", "SUPER")
_SEVERAL = frozenset({"them", "they", "both", "each", "every", "all", "these", "those"})
_ANCHORED = ("NEAREST", "FARTHEST", "FAR")


@dataclass
class _Part:
    """A phrase with what describes it."""

    bag: Bag
    phrase: NounPhrase
    described: list[tuple[Term, _Part]] = field(default_factory=list)

    @property
    def closed(self) -> bool:
        """Whether nothing can describe it further."""
        return bool(self.phrase.there or self.bag.ids or self.bag.has("CHARGER", "IT") or self.is_marker)

    @property
    def is_marker(self) -> bool:
        """Whether it is the start or the end of the site."""
        return self.bag.has("START", "FINISH") and not self.bag.has("DIR", "MOST", "TREE", "MIDDLE")


def find(places: Places, site: Site) -> Found:
    """What joined chains select: one after the other, each place once.

    Raises:
        Unclear, Question: A phrase means nothing here, or several things.
    """
    if any(join.value == "or" for join in places.joins):
        choices = tuple(text_of(chain.terms) for chain in places.chains)
        raise Question(f"'{text_of(places.terms)}': which of them?", choices)
    found: list[Found] = []
    for chain, excepted in _chains(_one_each(places)):
        if found and _is_apposition(chain):
            continue  # "another tree, a different one": the same tree, said again
        found.append(_chain(chain, excepted, site))
    if len(found) == 1:
        return found[0]
    if any(f.object_only or f.optional or f.at_most for f in found):
        raise unclear(places.terms, "these cannot be said together", "say each in a sentence of its own")
    if any(f.here for f in found):
        found = [replace(f, selector=s.Here()) if f.here else f for f in found]
    return Found(selector=s.Union(parts=tuple(f.selector for f in found)), many=True, each=any(f.each for f in found))


def _chains(places: Places) -> list[tuple[Chain, tuple[Chain, ...]]]:
    """Chains, each with those that go on with its exception; "in the north and the south" is said of both."""
    found: list[tuple[Chain, tuple[Chain, ...]]] = []
    for chain in _without_both(places.chains):
        if found:
            if _only_compares(chain):  # "older than 8 years and younger than 12"
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
                    raise unclear(places.terms, "this can be read in two ways", "say each in a sentence of its own")
                chain = replace(last, phrases=(*last.phrases[:-1], chain.phrases[0]))
        found.append((chain, ()))
    return found


def _one_each(places: Places) -> Places:
    """ "The northernmost and southernmost trees": one of each, the plural is that of their sum."""
    last = places.chains[-1]
    head = last.phrases[0]
    alone = all(not bag_of(c.phrases[0]).has("TREE", "PLACE") for c in places.chains[:-1])
    ranks = any(g[0].kind in ("MOST", "SUPER", "ORD", "LAST") for g in head.nominals)
    if len(places.chains) < 2 or not alone or not ranks or any(t.kind == "NUM" for t in head.quantity):
        return places
    nominals = tuple(tuple(replace(t, plural=False) for t in group) for group in head.nominals)
    single = replace(last, phrases=(replace(head, nominals=nominals), *last.phrases[1:]))
    return replace(places, chains=(*places.chains[:-1], single))


def _without_both(chains: tuple[Chain, ...]) -> tuple[Chain, ...]:
    """ "Both the first and the last tree": "both" announces the "and", and counts nothing."""
    first = chains[0].phrases[0]
    quantity = tuple(t for t in first.quantity if not t.text.lower().startswith("both"))
    if len(chains) != 2 or quantity == first.quantity:
        return chains
    return (replace(chains[0], phrases=(replace(first, quantity=quantity), *chains[0].phrases[1:])), chains[1])


def _only_compares(chain: Chain) -> bool:
    bag = bag_of(chain.phrases[0])
    return bool(bag.compared) and not chain.phrases[0].quantity and not bag.has("TREE", "PLACE", "CORNER")


def _kind(phrase: NounPhrase) -> str:
    """Whether a phrase is an area or a closed place; neither if it speaks of trees."""
    part = _Part(bag=bag_of(phrase), phrase=phrase)
    if part.closed:
        return "closed"
    return "" if part.bag.has("TREE", "CORNER", "PLACE") or not phrase.nominals else "area"


def _is_apposition(chain: Chain) -> bool:
    words = {t.kind for t in chain.terms}
    return bool(words & {"OTHER", "ANOTHER"}) and words <= {"OTHER", "ANOTHER", "DET", "PLACE", "IT", "NUM"}


def _chain(chain: Chain, excepted: tuple[Chain, ...], site: Site) -> Found:
    parts = [_Part(bag=bag_of(phrase), phrase=phrase) for phrase in chain.phrases]
    line = [parts[0]]  # the way from the first phrase to the last, by what each describes
    for relation, part in zip(chain.relations, parts[1:], strict=True):
        plot = part.is_marker is False and part.bag.only("PLOT", "PLACE") and relation.kind in ("OF", "AT")
        while len(line) > 1 and (line[-1].closed and not (plot and line[-1].is_marker)):
            line.pop()
        if relation.kind == "EXCEPT" and line[0].bag.has("TREE", "CORNER", "PLACE"):
            line = line[:1]  # an exception is taken from what the phrase speaks of
        if line[-1].closed and not (plot and line[-1].is_marker):
            raise unclear(
                chain.terms, f"'{text_of(line[-1].phrase.terms)}' is one place: nothing more can be said of it"
            )
        line[-1].described.append((relation, part))
        line.append(part)
    others = tuple(_chain(other, (), site).selector for other in excepted)
    return _read(parts[0], others, site)


def _read(part: _Part, excepted: tuple[s.Selector, ...], site: Site) -> Found:
    """A phrase with all that describes it."""
    bag, phrase = part.bag, part.phrase
    if phrase.there is not None:
        return Found(selector=s.Here(), here=True, these=are_several(phrase.there))
    if bag.has("IT") or (bag.has("PLACE") and bag.only("PLACE") and not part.described and _points_back(bag)):
        word = bag.take("IT", "PLACE")
        bag.finish()
        these = bag.each or (word is not None and are_several(word))
        return Found(selector=s.Here(), here=True, these=these)
    group = Group()
    for relation, inner in part.described:
        _describe(part, group, relation, inner, excepted, site)
    if bag.ids:
        return _named(bag)
    marker = _marker(part)
    if marker is not None:
        bag.finish()
        return Found(selector=marker)
    if not phrase.nominals:
        return _quantity_alone(bag, group, phrase, [relation for relation, _ in part.described])
    return picked(bag, group, site)


def are_several(term: Term) -> bool:
    """Whether a word for what was spoken of means several places ("at each of them", "both")."""
    return bool(_SEVERAL & set(term.text.lower().split()))


def _points_back(bag: Bag) -> bool:
    return bag.definite and not bag.another and bag.count is None


def _describe(
    part: _Part, group: Group, relation: Term, inner: _Part, excepted: tuple[s.Selector, ...], site: Site
) -> None:
    """What one phrase says of the phrase that it describes."""
    bag = part.bag
    kind = relation.kind
    if kind in ("WITH", "OF") and not inner.described and _describes(inner.bag):
        bag.join(inner.bag)
        return
    if kind == "WITH":
        raise unclear([relation, *inner.phrase.terms], "what is meant by this does not stand there")
    sided = bag.has("MIDDLE") and inner.bag.has("SIDE")
    behind = _read(inner, (), site)
    if sided and isinstance(behind.selector, s.Half):  # "the middle of the north side" is on the edge
        behind = replace(behind, selector=s.Edge(side=behind.selector.side, of=behind.selector.of))
    if behind.object_only or behind.optional or behind.at_most is not None:
        raise unclear([relation, *inner.phrase.terms], "a place was expected")
    anchored = bag.has(*_ANCHORED) and not group.anchor
    if kind == "NEAR" and isinstance(behind.selector, s.Middle | s.EdgeMiddle):
        kind = "AT"  # "somewhere near the middle" is the middle
    if kind == "FROM" and not anchored:
        raise unclear([relation, *inner.phrase.terms], "from there, but what?", "say 'nearest to', or 'within 20 m of'")
    match kind:
        case "FROM":
            group.anchor = _single(behind, inner)
        case "OF" | "AT" if anchored and not behind.region and not behind.many:
            group.anchor = _single(behind, inner)
        case "OF" | "AT" | "INSIDE":
            if behind.each and behind.many and not behind.region and not bag.as_many and not bag.up_to:
                if bag.count not in (None, 1):
                    raise unclear(part.phrase.terms, "so many at each place cannot be said yet", "name each place")
                bag.each, bag.count = True, None  # "the tree at each corner"
            group.add(behind, inner.phrase)
        case "NEXTTO" | "NEAR":
            group.anchor, group.beside = _single(behind, inner), kind == "NEXTTO"
        case "WITHIN":
            group.within(relation.value, _single(behind, inner))
        case "OUTSIDE" | "EXCEPT":
            group.without(behind.selector, *excepted)
        case _:
            raise unclear(part.phrase.terms, f"'{relation.text}' does not fit here")


def _describes(bag: Bag) -> bool:
    """Whether a phrase says what trees are, and names no place."""
    return bag.describes(*_DESCRIBING)


def _single(found: Found, inner: _Part) -> s.Selector:
    if found.many:
        advice = "name one tree, corner or marker"
        raise unclear(inner.phrase.terms, "one place is needed to measure from", advice)
    return found.selector


def _named(bag: Bag) -> Found:
    """Trees by their ids."""
    if bag.count is not None and bag.count != len(bag.ids):
        raise bag.fault(f"{bag.count} or {len(bag.ids)} trees?", "let the number and the names agree")
    if bag.any:
        raise Question(f"'{text_of(bag.phrase.terms)}': how many of them?", ("1", f"all {len(bag.ids)}"))
    bag.finish()
    trees = tuple(s.TreeIs(tree=tree) for tree in bag.ids)
    if len(trees) == 1:
        return Found(selector=trees[0])
    return Found(selector=s.Union(parts=trees), many=True, each=bag.each)


def _marker(part: _Part) -> s.Selector | None:
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


def _quantity_alone(bag: Bag, group: Group, phrase: NounPhrase, relations: list[Term]) -> Found:
    """ "Another", "two more", "each": of what, the verb before says; of whom, what describes it."""
    if bag.up_to or bag.as_many:
        raise bag.fault("of what does not stand there", "say 'as many trees as you can', for example")
    if bag.article and bag.count is None and not (bag.another or bag.each or bag.any):
        raise unclear(phrase.terms, "a place was expected")
    if bag.each and not bag.another and group.empty:
        return Found(selector=s.Here(), here=True, these=True)  # "photograph both"
    bag.more = False
    number = bag.count or (1 if bag.another else None)
    if group.empty:
        return Found(selector=s.Trees(), object_only=True, counted=number, each=bag.each)
    selector = nested(group, s.Trees())
    partitive = all(relation.kind in ("OF", "EXCEPT") for relation in relations)
    if partitive and bag.each and not bag.count:
        return Found(selector=selector, many=True, each=True)  # "all but the yellow trees"
    if partitive and bag.count and not group.single:
        return Found(selector=s.Take(count=bag.count, of=selector), many=bag.count > 1, counted=bag.count)
    return Found(selector=selector, object_only=True, counted=number, each=bag.each, many=True, region=group.region)
