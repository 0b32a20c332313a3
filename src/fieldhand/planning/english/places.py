"""Noun phrases as selectors: "the 3 yellow trees nearest to the charger in the northern half"."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

from fieldhand.planning.english.syntax import Chain, NounPhrase, Places
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.planner import Reason
from fieldhand.site.model import Site
from fieldhand.task import selectors as s

Number = Literal["one", "some", "all"]


class Unclear(Exception):
    """A phrase that means nothing here, or that means two things."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(reason.what)


class Question(Exception):
    """A phrase that leaves open what only the person can say."""

    def __init__(self, question: str, choices: tuple[str, ...] = ()) -> None:
        self.question = question
        self.choices = choices
        super().__init__(question)


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a noun phrase selects.

    Attributes:
        many: Several places rather than one.
        counted: The phrase says how many.
        each: The phrase says "each" or "every".
        region: An area ("the northern half"), not trees by themselves: "a picture in it" is at one tree of it.
        optional: "as many as you can".
        at_most: "up to 6".
        here: The places just spoken of ("there", "each of them").
        object_only: A quantity alone ("another", "two more"): of what, the verb before says.
        reward: Attribute that says what an optional visit is worth.
        assumptions: What was assumed in reading it.
    """

    selector: s.Selector
    many: bool = False
    counted: int | None = None
    each: bool = False
    region: bool = False
    optional: bool = False
    at_most: int | None = None
    here: bool = False
    object_only: bool = False
    reward: str = ""
    assumptions: tuple[str, ...] = ()


@dataclass
class _Bag:
    """The words of one noun phrase, taken out as they are understood."""

    count: int | None = None
    determined: str = ""
    each: bool = False
    any: bool = False
    another: bool = False
    as_many: bool = False
    up_to: bool = False
    more: bool = False
    plural: bool = False
    by_kind: dict[str, list[Term]] = field(default_factory=dict)
    compared: list[tuple[Term, ...]] = field(default_factory=list)
    tree_ids: list[str] = field(default_factory=list)

    def take(self, kind: str) -> Term | None:
        """The first word of a kind, taken out."""
        words = self.by_kind.get(kind)
        if not words:
            return None
        word = words.pop(0)
        if not words:
            del self.by_kind[kind]
        return word

    def has(self, *kinds: str) -> bool:
        """Whether a word of one of these kinds is left."""
        return any(k in self.by_kind for k in kinds)


REGIONS = ("PLOT", "HALF", "QUARTER", "SIDE", "EDGE", "ZONE")


def find(places: Places, site: Site) -> Found:
    """What joined chains select: one after the other, each place once.

    Raises:
        Unclear, Question: A phrase means nothing here, or several things.
    """
    found: list[Found] = []
    ids_before = False
    for chain in places.chains:
        first = chain.phrases[0]
        alone = first.quantity if not first.nominals and first.there is None else ()
        if ids_before and len(alone) == 1 and alone[0].kind == "NUM" and len(chain.phrases) == 1:
            tree = str(int(alone[0].value))
            found.append(Found(selector=s.TreeIs(tree=tree)))
            continue
        if found and _is_apposition(chain):
            continue  # "another tree, a different one": the same tree, said again
        found.append(_chain(chain, site))
        ids_before = any(len(group) == 2 and group[0].kind == "TREE" for p in chain.phrases for group in p.nominals)
    if len(found) == 1:
        return found[0]
    return _shared_head(found, places, site)


def _is_apposition(chain: Chain) -> bool:
    words = {t.kind for t in chain.terms}
    return bool(words & {"OTHER", "ANOTHER"}) and words <= {"OTHER", "ANOTHER", "DET", "PLACE", "IT", "NUM"}


def _shared_head(found: list[Found], places: Places, site: Site) -> Found:
    """ "The first and the last tree", "the north-west and south-east corner": what the last says goes for all."""
    del site
    parts: list[s.Selector] = []
    for one, chain in zip(found, places.chains, strict=False):
        parts.append(one.selector)
        del chain
    return Found(
        selector=s.Union(parts=tuple(parts)),
        many=True,
        each=any(f.each for f in found),
        assumptions=tuple(a for f in found for a in f.assumptions),
    )


def _chain(chain: Chain, site: Site) -> Found:
    """Read a chain from its end: each phrase is tied to what stands behind it."""
    behind: Found | None = None
    relation: Term | None = None
    for index in range(len(chain.phrases) - 1, -1, -1):
        behind = _phrase(chain.phrases[index], relation, behind, site)
        relation = chain.relations[index - 1] if index else None
    assert behind is not None
    return behind


def _phrase(phrase: NounPhrase, relation: Term | None, behind: Found | None, site: Site) -> Found:
    if phrase.there is not None:
        if behind is not None:
            raise _unclear(phrase, "a place was expected")
        return Found(selector=s.Here(), here=True)
    bag = _bag(phrase)
    if not phrase.nominals:
        if bag.determined and bag.count is None and not (bag.another or bag.each or bag.any):
            raise _unclear(phrase, "a place was expected")
        if behind is None or behind.here is False:
            rest = behind or Found(selector=s.Trees())
            return replace(rest, object_only=True, counted=bag.count or (1 if bag.another else None), each=bag.each)
        return replace(behind, each=bag.each)
    marker = _marker(bag)
    if marker is not None:
        _all_used(bag, phrase)
        return Found(selector=marker)
    return _trees(bag, phrase, relation, behind, site)


def _bag(phrase: NounPhrase) -> _Bag:
    bag = _Bag()
    for term in phrase.quantity:
        match term.kind:
            case "NUM":
                bag.count = int(term.value)
            case "EACH":
                bag.each = True
                if term.text.lower().startswith("both"):
                    bag.count = 2
            case "ANY":
                bag.any = True
            case "ANOTHER":
                bag.another = True
            case "ASMANY":
                bag.as_many = True
            case "UPTO":
                bag.up_to = True
            case "MORE":
                bag.more = True
            case _:
                bag.determined = term.text.lower()
    for group in phrase.nominals:
        head = group[0]
        if head.kind == "TREE" and len(group) == 2:
            bag.tree_ids.append(str(int(group[1].value)))
        elif head.kind in ("CMP", "BETWEEN"):
            bag.compared.append(group)
        elif head.kind == "IDS":
            bag.tree_ids.extend(str(i) for i in head.value)
        elif head.kind in ("WHICH", "IS", "ASCAN", "IT", "PLACE"):
            bag.plural = bag.plural or (head.kind == "PLACE" and head.plural)
            bag.as_many = bag.as_many or head.kind == "ASCAN"
        else:
            bag.by_kind.setdefault(head.kind, []).append(head)
            bag.plural = bag.plural or head.plural
    return bag


def _marker(bag: _Bag) -> s.Selector | None:
    if bag.has("START") and not bag.has("DIR", "MOST", "TREE"):
        bag.take("START")
        return s.Marker(name="start")
    if bag.has("CHARGER"):
        bag.take("CHARGER")
        return s.Marker(name="charger")
    if bag.has("FINISH") and not bag.has("DIR", "MOST", "TREE", "PLOT"):
        bag.take("FINISH")
        return s.Marker(name="end")
    return None


def _trees(bag: _Bag, phrase: NounPhrase, relation: Term | None, behind: Found | None, site: Site) -> Found:
    near: s.Selector | None = None
    of: s.Selector = s.Trees()
    if behind is not None and relation is not None:
        of, near = _related(bag, relation, behind, phrase, site)
    of = _filtered(bag, of, phrase, site)
    found = _picked(bag, of, near, phrase, site)
    _all_used(bag, phrase)
    return found


def _related(
    bag: _Bag, relation: Term, behind: Found, phrase: NounPhrase, site: Site
) -> tuple[s.Selector, s.Selector | None]:
    """What the phrase behind contributes: the trees to choose from, or the place that nearness is measured from."""
    del site
    anchored = bag.has("NEAREST", "FARTHEST", "FAR")
    match relation.kind:
        case "OF" | "AT" | "WITH" if anchored and not behind.region:
            return s.Trees(), behind.selector
        case "FROM" if anchored:
            return s.Trees(), behind.selector
        case "OF" | "AT" | "INSIDE" | "WITH":
            return behind.selector, None
        case "FROM":
            return behind.selector, None
        case "NEXTTO" | "NEAR":
            adjacent = relation.kind == "NEXTTO"
            bag.by_kind.setdefault("_BESIDE" if adjacent else "_NEAR", []).append(relation)
            return s.Trees(), behind.selector
        case "WITHIN":
            return s.Within(distance_m=relation.value, to=behind.selector), None
        case "OUTSIDE" | "EXCEPT":
            inner = behind.selector
            if isinstance(inner, s.InZone):
                return replace(inner, outside=not inner.outside), None
            return s.Excluding(places=inner), None
        case _:
            raise _unclear(phrase, f"'{relation.text}' does not fit here")


def _filtered(bag: _Bag, of: s.Selector, phrase: NounPhrase, site: Site) -> s.Selector:
    """What the words of the phrase itself leave of the trees to choose from."""
    while (zone := bag.take("ZONE")) is not None:
        of = s.InZone(zone=zone.value, of=of)
        bag.take("SIDE")
    while (value := bag.take("ATTRVAL")) is not None:
        if len(value.value) > 1:
            names = tuple(name for name, _ in value.value)
            raise Question(f"'{value.text}' stands under {' and '.join(names)}: which is meant?", names)
        attribute, wanted = value.value[0]
        of = s.Where(attribute=attribute, test="eq", value=wanted, of=of)
        if bag.has("ATTR"):
            bag.take("ATTR")
    for group in bag.compared:
        of = _compared(group, bag, of, phrase, site)
    bag.compared = []
    return of


def _compared(group: tuple[Term, ...], bag: _Bag, of: s.Selector, phrase: NounPhrase, site: Site) -> s.Selector:
    def number(term: Term) -> float:
        return float(term.value if term.kind == "NUM" else term.value.number)

    if group[0].kind == "BETWEEN":
        attribute = _attribute(bag, "", group[1], phrase, site)
        of = s.Where(attribute=attribute, test="ge", value=number(group[1]), of=of)
        return s.Where(attribute=attribute, test="le", value=number(group[3]), of=of)
    test, hint = group[0].value
    return s.Where(attribute=_attribute(bag, hint, group[1], phrase, site), test=test, value=number(group[1]), of=of)


def _attribute(bag: _Bag, hint: str, amount: Term | None, phrase: NounPhrase, site: Site) -> str:
    """Which attribute of the site a comparison is about."""
    word = bag.take("ATTR")
    if word is not None:
        if len(word.value) > 1:
            raise Question(f"'{word.text}' can be {' or '.join(word.value)}: which is meant?", tuple(word.value))
        return str(word.value[0])
    if not hint and amount is not None and amount.kind == "AMOUNT":
        hint = {"years": "age", "kg": "yield"}.get(amount.value.unit, "")
    if hint:
        fitting = [name for name in site.attributes if hint in name.lower().replace("-", "_").split("_")]
        if len(fitting) == 1:
            return fitting[0]
        if len(fitting) > 1:
            raise Question(f"which of {' and '.join(fitting)} is meant?", tuple(fitting))
        known = ", ".join(list(site.attributes)[:8]) or "none"
        raise Unclear(
            Reason(what=f"this site records no {hint} of its trees", said=_said(phrase), advice=f"it records: {known}")
        )
    raise _unclear(phrase, "which attribute is compared does not stand there")


def _picked(bag: _Bag, of: s.Selector, near: s.Selector | None, phrase: NounPhrase, site: Site) -> Found:
    count = bag.count
    one = count or 1
    # A number, an article or a singular noun says how many; "any 2 of the" takes some of what the rest selects.
    if bag.tree_ids:
        bag.take("TREE")
        trees: tuple[s.Selector, ...] = tuple(s.TreeIs(tree=t) for t in bag.tree_ids)
        return Found(selector=trees[0]) if len(trees) == 1 else Found(selector=s.Union(parts=trees), many=True)
    if bag.has("CORNER"):
        return _corners(bag, of, phrase)
    if bag.has("MIDDLE"):
        return _middle(bag, of, phrase)
    if (most := bag.take("MOST")) is not None:
        return _most(bag, most, of, phrase)
    if bag.has("EDGE", "HALF", "QUARTER", "SIDE", "FINISH") or (bag.has("DIR") and not bag.has("TREE")):
        return _region(bag, of, phrase)
    if (direction := bag.take("DIR")) is not None:  # "the northern trees"
        of = (
            s.Quarter(quarter=direction.value, of=of)
            if len(direction.value) == 2
            else s.Half(side=direction.value, of=of)
        )
    if (top := bag.take("SUPER")) is not None:
        attribute, lowest = top.value
        name = _attribute(bag, attribute, None, phrase, site)
        bag.take("TREE")
        return Found(selector=s.Top(attribute=name, count=one, lowest=lowest, of=of), many=one > 1, counted=count or 1)
    return _by_place(bag, of, near, phrase)


def _by_place(bag: _Bag, of: s.Selector, near: s.Selector | None, phrase: NounPhrase) -> Found:
    """Trees by where they stand to another place, or by being any."""
    count, one = bag.count, bag.count or 1
    plural = bag.plural and count is None
    if bag.take("OTHER") is not None or bag.another:
        of = s.Other(of=of)
    tree = bag.take("TREE")
    if bag.take("ADJACENT") is not None:
        size = count or 2
        return Found(selector=s.Adjacent(near=near or s.Here(), count=size, of=of), many=size > 1, counted=size)
    if bag.take("FARTHEST") is not None or bag.take("FAR") is not None:
        return Found(selector=s.Farthest(origin=near or s.Here(), count=one, of=of), many=one > 1, counted=one)
    if bag.take("_BESIDE") is not None:
        _some(plural, phrase)
        return Found(
            selector=s.Nearest(to=near or s.Here(), count=one, adjacent=True, of=of), many=one > 1, counted=one
        )
    if bag.take("_NEAR") is not None or bag.take("NEAREST") is not None:
        if plural and not bag.has("NEARBY"):
            _some(plural, phrase)
        return Found(selector=s.Nearest(to=near or s.Here(), count=one, of=of), many=one > 1, counted=one)
    if bag.take("NEARBY") is not None:
        return Found(
            selector=s.Nearest(to=s.Here(), count=one, fresh=True, of=of), many=plural or one > 1, counted=count
        )
    if (rank := bag.take("ORD")) is not None:
        if rank.value != 1:
            raise _unclear(
                phrase, f"'{rank.text} tree' could be counted in several ways", "name the tree by its id, or a side"
            )
        if one > 1:
            return Found(selector=s.Nearest(to=s.Marker(name="start"), count=one, of=of), many=True, counted=one)
        return Found(selector=s.First(of=of))
    if bag.take("LAST") is not None:
        if one > 1:
            return Found(selector=s.Nearest(to=s.Marker(name="end"), count=one, of=of), many=True, counted=one)
        return Found(selector=s.Last(of=of))
    plot = bag.take("PLOT")
    if bag.take("EVERYWHERE") is not None:
        return Found(selector=of, many=True, each=True)
    if bag.as_many:
        return Found(selector=of, many=True, optional=True)
    if bag.up_to and count is not None:
        return Found(selector=of, many=True, at_most=count)
    if tree is None and plot is not None:
        return Found(selector=of, region=True, many=True)
    if bag.each or (plural and not bag.any):
        return (
            Found(selector=of, many=True, each=bag.each, counted=count if count else None)
            if count is None
            else Found(selector=of, many=True, each=True)
        )
    if bag.any and plural:
        raise Question("how many of these trees?", ("2", "4", "all of them"))
    if count is None and bag.determined in ("the", "that", "this") and of == s.Trees() and tree is not None:
        return Found(selector=s.Here(), here=True)
    if s.is_single(of) and one == 1:
        return Found(selector=of)
    if isinstance(of, s.Middle | s.EdgeMiddle):
        return Found(selector=replace(of, count=one), many=one > 1, counted=one)
    return Found(selector=s.Take(count=one, of=of), many=one > 1, counted=one)


def _some(plural: bool, phrase: NounPhrase) -> None:
    if plural:
        text = " ".join(t.text for t in phrase.terms)
        raise Question(f"how many {text}?", ("2", "3", "4"))


def _corners(bag: _Bag, of: s.Selector, phrase: NounPhrase) -> Found:
    corner = bag.take("CORNER")
    bag.take("TREE")
    bag.take("PLOT")
    which: list[s.CornerName] = []
    while (direction := bag.take("DIR") or bag.take("MOST")) is not None:
        if len(direction.value) == 1 or direction.value not in ("nw", "ne", "se", "sw"):
            side = direction.value[0]
            which += [c for c in ("nw", "ne", "se", "sw") if side in c]  # "the two northern corners"
        else:
            which.append(direction.value)
    plural = bool(corner and corner.plural) or bag.each or bag.plural
    names: tuple[s.CornerName, ...] = tuple(which) or ("nw", "ne", "se", "sw")
    if bag.count is not None and bag.count > len(names):
        raise Unclear(
            Reason(
                what=f"there are {len(names)} such corners, not {bag.count}", said=_said(phrase), advice="ask for fewer"
            )
        )
    everything = s.Corners(which=names, of=of)
    if len(names) == 1:
        return Found(selector=everything)
    if bag.another or bag.take("OTHER") is not None:
        return Found(selector=s.Take(count=bag.count or 1, of=s.Other(of=everything)), many=bag.count not in (None, 1))
    if bag.count is not None and bag.count < len(names):
        return Found(selector=s.Take(count=bag.count, of=everything), many=bag.count > 1, counted=bag.count)
    if plural or bag.count == len(names):
        return Found(selector=everything, many=True, each=bag.each)
    if bag.take("NEAREST") is not None or bag.any or bag.determined in ("a", "an", "some"):
        return Found(selector=s.Take(count=1, of=everything))
    raise Question("which corner?", ("north-west", "north-east", "south-east", "south-west"))


def _middle(bag: _Bag, of: s.Selector, phrase: NounPhrase) -> Found:
    bag.take("MIDDLE")
    tree = bag.take("TREE")
    bag.take("PLOT")
    bag.take("SIDE")
    if tree is not None and tree.plural and bag.count is None:
        raise Question("how many trees in the middle?", ("2", "3", "4"))
    count = bag.count or 1
    edge = bag.take("EDGE") or bag.take("FINISH")
    direction = bag.take("DIR")
    if direction is not None and edge is not None:
        return Found(selector=s.EdgeMiddle(side=direction.value, count=count, of=of), many=count > 1)
    if direction is not None:
        raise _unclear(phrase, "the middle and a side at once", "say 'the middle of the northern edge', for example")
    if isinstance(of, s.Edge):
        return Found(selector=s.EdgeMiddle(side=of.side, count=count, of=of.of), many=count > 1, counted=bag.count)
    return Found(selector=s.Middle(count=count, of=of), many=count > 1, counted=bag.count)


def _most(bag: _Bag, most: Term, of: s.Selector, phrase: NounPhrase) -> Found:
    tree = bag.take("TREE")
    bag.take("PLOT")
    corner = len(most.value) == 2
    if bag.has("EDGE", "SIDE", "FINISH", "HALF"):
        bag.take("EDGE") or bag.take("SIDE") or bag.take("FINISH") or bag.take("HALF")
        side = s.Edge(side=most.value, of=of) if not corner else s.Quarter(quarter=most.value, of=of)
        return Found(selector=side, region=True, many=True)
    rank = bag.take("ORD")
    another = bag.another or bag.take("OTHER") is not None
    if corner:
        return Found(selector=s.Corners(which=(most.value,), of=of))
    if rank is not None and rank.value > 1:
        nearer = s.Extreme(side=most.value, count=rank.value - 1, of=of)
        return Found(selector=s.Extreme(side=most.value, of=s.Excluding(places=nearer, of=of)))
    if bag.any:
        among: s.Selector = s.AmongExtreme(side=most.value, of=of)
        among = s.Other(of=among) if another else among
        return Found(selector=s.Take(count=bag.count or 1, of=among), many=(bag.count or 1) > 1)
    if another:
        return Found(
            selector=s.Extreme(side=most.value, count=bag.count or 1, of=s.Other(of=of)), many=(bag.count or 1) > 1
        )
    if tree is not None and tree.plural and bag.count is None:
        return Found(selector=s.AmongExtreme(side=most.value, of=of), many=True, each=bag.each)
    del phrase
    count = bag.count or 1
    return Found(selector=s.Extreme(side=most.value, count=count, of=of), many=count > 1, counted=count)


def _region(bag: _Bag, of: s.Selector, phrase: NounPhrase) -> Found:
    """Halves, quarters, sides and edges: areas, or with "tree" in the phrase the trees in them."""
    direction = bag.take("DIR")
    if direction is None:
        if bag.take("EDGE") is not None and isinstance(of, s.Half):
            return Found(selector=s.Edge(side=of.side), region=True, many=True)
        if bag.take("SIDE") is not None and of != s.Trees():
            return Found(selector=of, region=True, many=True)
        raise _unclear(phrase, "which side is meant does not stand there", "say north, east, south or west")
    tree = bag.take("TREE")
    bag.take("PLOT")
    bag.take("START")
    corner = len(direction.value) == 2
    area: s.Selector
    if bag.take("EDGE") is not None or bag.take("FINISH") is not None:
        if corner:
            raise _unclear(phrase, "an edge lies on one side", "say north, east, south or west, or 'corner'")
        area = s.Edge(side=direction.value, of=of)
    elif (
        bag.take("HALF") is not None
        or bag.take("SIDE") is not None
        or bag.take("QUARTER") is not None
        or tree is not None
    ):
        area = s.Quarter(quarter=direction.value, of=of) if corner else s.Half(side=direction.value, of=of)
    elif corner:
        # "the north-east" alone is said of a corner before it, or of the quarter
        area = s.Quarter(quarter=direction.value, of=of)
    else:
        area = s.Half(side=direction.value, of=of)
    if bag.another or bag.take("OTHER") is not None:
        area = s.Other(of=area)
    if tree is not None and bag.count is None and not tree.plural and not bag.each:
        return Found(selector=s.Take(count=1, of=area))
    if bag.count is not None:
        return Found(selector=s.Take(count=bag.count, of=area), many=bag.count > 1, counted=bag.count)
    if bag.as_many:
        return Found(selector=area, many=True, optional=True)
    return Found(selector=area, region=tree is None, many=True, each=bag.each)


def _all_used(bag: _Bag, phrase: NounPhrase) -> None:
    left = [t for words in bag.by_kind.values() for t in words if t.kind not in ("PLOT", "TREE")]
    if left:
        words = ", ".join(f"'{t.text}'" for t in left)
        raise Unclear(
            Reason(
                what=f"{words} could not be placed in '{' '.join(t.text for t in phrase.terms)}'",
                said=tuple(t.span for t in left),
                advice="say it in simpler words",
            )
        )


def _said(phrase: NounPhrase) -> tuple[tuple[int, int], ...]:
    return tuple(t.span for t in phrase.terms)


def _unclear(phrase: NounPhrase, what: str, advice: str = "say it in other words") -> Unclear:
    text = " ".join(t.text for t in sorted(phrase.terms, key=lambda t: t.start))
    return Unclear(Reason(what=f"'{text}': {what}", said=_said(phrase), advice=advice))
