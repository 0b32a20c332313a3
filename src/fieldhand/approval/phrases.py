"""Selectors as English that a grower would sign.

A selector is said from the inside out. What only keeps trees (an attribute, a zone, a half of the site) gathers around
one noun: "the yellow trees in the northern half". What picks (the northernmost, the 3 nearest) closes the phrase:
"the 3 northernmost of the yellow trees"; whatever keeps among those then starts a new one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import assert_never

from fieldhand.approval.clauses import say_attribute, say_test
from fieldhand.site.places.resolve import bare_ground
from fieldhand.task import selectors as s
from fieldhand.task.words import (
    CORNERS,
    SIDES,
    listed,
    say_count,
    say_number,
)

Names = Mapping[str, str]

#: Attributes whose values people use as adjectives: "yellow trees", "Kerman trees".
_ADJECTIVAL = re.compile(r"(^|_)(colou?r|variety|cultivar|species|health|status|condition|kind)$")


@dataclass(frozen=True, kw_only=True)
class _Phrase:
    """A noun phrase about trees.

    Attributes:
        closed: The whole phrase where something was picked; then the other parts are empty.
        single: It means one place.
        before, after: Adjectives and what follows the noun, in the order in which they are said.
        among: The closed phrase of which the trees are kept.
    """

    closed: str = ""
    single: bool = False
    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    among: str = ""

    @property
    def plain(self) -> bool:
        """Every tree of the site."""
        return self == _Phrase()

    def keeping(self, *, before: str = "", after: str = "") -> _Phrase:
        """The phrase narrowed by one more adjective or clause."""
        base = _Phrase(among=self.closed) if self.closed else self
        return replace(
            base,
            before=(*base.before, before) if before else base.before,
            after=(*base.after, after) if after else base.after,
        )

    def say(self, count: int | None = None) -> str:
        """The phrase with its article, and how many there are where that is known."""
        if self.closed:
            return self.closed
        if self.plain:
            return "every tree" if count is None else f"all {say_count(count, 'tree')}"
        number = () if count is None else (str(count),)
        noun = "tree" if count == 1 else "trees"
        return " ".join(("the", *number, *self.before, noun, *_clauses(self)))

    def group(self) -> str:
        """The phrase as something to pick from: "the yellow trees"."""
        return "the trees" if self.plain else self.say()


def _clauses(phrase: _Phrase) -> tuple[str, ...]:
    """What follows the noun; a comma keeps a second clause from being read as part of the first."""
    among = (f"among {phrase.among}",) if phrase.among else ()
    clauses = (*sorted(phrase.after, key=lambda a: not a.startswith("whose ")), *among)
    return (*(f"{clause}," for clause in clauses[:-1]), *clauses[-1:])


def say_selector(selector: s.Selector, names: Names | None = None, count: int | None = None) -> str:
    """A selector in words.

    Args:
        selector: What to say.
        names: What a label is called ("the tree of step 3"); else it is quoted.
        count: How many places it gives, said where the phrase does not say it itself.
    """
    return _phrase(selector, names or {}).say(count)


def _phrase(selector: s.Selector, names: Names) -> _Phrase:
    match selector:
        case s.Trees():
            return _Phrase()
        case s.TreeIs(tree=tree):
            return _one(f"tree {tree}")
        case s.Marker(name=name):
            return _one("the charger" if name == "charger" else f"the {name} marker")
        case s.Here():
            return _one("the place reached before")
        case s.Bound(label=label):
            return _one(names.get(label, f"the place called “{label}”"))
        case s.First() | s.Last():
            return _ranked("first" if isinstance(selector, s.First) else "last", 1, selector.of, names)
        case s.Extreme():
            return _ranked(f"{selector.side}ernmost", selector.count, selector.of, names)
        case s.AmongExtreme(side=side, of=of):
            group = _phrase(of, names)
            return _many(f"the {side}ernmost {'trees' if group.plain else f'of {group.group()}'}")
        case s.Corners():
            return _corners(selector, names)
        case s.Half() | s.Quarter() | s.Edge():
            return _area(selector, names)
        case s.Where() | s.InZone() | s.Within() | s.Other() | s.Excluding():
            return _filtered(selector, names)
        case s.Middle() | s.EdgeMiddle() | s.Nearest() | s.Farthest() | s.Top():
            return _picked(selector, names)
        case s.Adjacent():
            return _adjacent(selector, names)
        case s.Take():
            return _taken(selector, names)
        case s.Union(parts=parts):
            return _together(parts, names)
        case _:
            assert_never(selector)


def _one(text: str) -> _Phrase:
    return _Phrase(closed=text, single=True)


def _many(text: str) -> _Phrase:
    return _Phrase(closed=text)


def _spot(selector: s.Selector, names: Names) -> str:
    """A place that something is measured from."""
    return "there" if isinstance(selector, s.Here) else say_selector(selector, names)


def _it(selector: s.Selector, names: Names) -> str:
    """A place where "there" would be no English ("next to there")."""
    return "that place" if isinstance(selector, s.Here) else say_selector(selector, names)


def _ranked(rank: str, count: int, of: s.Selector, names: Names) -> _Phrase:
    """The first, the northernmost: an adjective that picks."""
    group = _phrase(of, names)
    if count == 1:
        return _one(f"the {rank} tree" if group.plain else f"the {rank} of {group.group()}")
    return _many(f"the {count} {rank} trees" if group.plain else f"the {count} {rank} of {group.group()}")


def _corners(selector: s.Corners, names: Names) -> _Phrase:
    group = _phrase(selector.of, names)
    of = "" if group.plain else f" of {group.group()}"
    which = selector.which
    if len(which) == 1:
        return _one(f"the {CORNERS[which[0]]} corner tree{of}")
    if not which or set(which) == set(CORNERS):
        return _many(f"the 4 corner trees{of}")
    return _many(f"the {listed([CORNERS[w] for w in which])} corner trees{of}")


def _area(selector: s.Half | s.Quarter | s.Edge, names: Names) -> _Phrase:
    """A region of the site, whichever way it is nested with what else keeps trees."""
    match selector:
        case s.Half(side=side):
            area = f"in the {SIDES[side]} half"
        case s.Quarter(quarter=quarter):
            area = f"in the {CORNERS[quarter]} quarter"
        case s.Edge(side=side):
            area = f"along the {SIDES[side]} edge"
    if bare_ground(selector.of) == selector.of:
        return _Phrase(after=(f"{area}{_of_ground(selector.of, names)}",))
    return _phrase(selector.of, names).keeping(after=f"{area}{_of_ground(selector.of, names)}")


def _of_ground(of: s.Selector, names: Names) -> str:
    """Of what a half or an edge is one, where it is not the whole site (the rule stands in ``site.places``)."""
    ground = bare_ground(of)
    return "" if ground == s.Trees() else f" of {_phrase(ground, names).group()}"


def _filtered(selector: s.Where | s.InZone | s.Within | s.Other | s.Excluding, names: Names) -> _Phrase:
    base = _phrase(selector.of, names)
    match selector:
        case s.Where():
            if isinstance(selector.value, str) and selector.test == "eq" and _ADJECTIVAL.search(selector.attribute):
                return base.keeping(before=selector.value)
            return base.keeping(after=f"whose {say_test(selector.attribute, selector.test, selector.value)}")
        case s.InZone(zone=zone, outside=outside):
            return base.keeping(after=f"{'outside' if outside else 'inside'} the zone “{zone}”")
        case s.Within(distance_m=distance, to=to):
            return base.keeping(after=f"within {say_number(distance)} m of {_it(to, names)}")
        case s.Other():
            return base.keeping(after="not visited yet")
        case s.Excluding(places=places):
            return base.keeping(after=f"other than {_it(places, names)}")


def _picked(selector: s.Middle | s.EdgeMiddle | s.Nearest | s.Farthest | s.Top, names: Names) -> _Phrase:
    verb = "is" if selector.count == 1 else "are"
    match selector:
        case s.Middle():
            own = "the site" if isinstance(selector.of, s.Trees) else "their area"
            tail = f"nearest to the middle of {own}"
        case s.EdgeMiddle(side=side):
            tail = f"nearest to the middle of the {SIDES[side]} edge{_of_ground(selector.of, names)}"
        case s.Nearest(to=to, adjacent=adjacent, fresh=fresh):
            tail = f"{'next' if adjacent else 'nearest'} to {_it(to, names)}{' and not visited yet' if fresh else ''}"
        case s.Farthest(origin=origin):
            tail = f"farthest from {_spot(origin, names)}"
        case s.Top(attribute=attribute, lowest=lowest):
            tail, verb = f"with the {'lowest' if lowest else 'highest'} {say_attribute(attribute)[0]}", ""
    group = _phrase(selector.of, names)
    build = _one if selector.count == 1 else _many
    number = () if selector.count == 1 else (str(selector.count),)
    noun = "tree" if selector.count == 1 else "trees"
    clause = f"that {verb} {tail}" if verb and (group.after or group.among) else tail
    if not group.closed:
        return build(" ".join(("the", *number, *group.before, noun, *_clauses(group), clause)))
    ones = "the one" if selector.count == 1 else f"the {selector.count}"
    return build(f"{ones} of {group.group()} {clause}")


def _adjacent(selector: s.Adjacent, names: Names) -> _Phrase:
    near = _it(selector.near, names)
    if selector.count == 1:
        return _picked(s.Nearest(to=selector.near, of=selector.of), names)
    group = _phrase(selector.of, names)
    trees = say_count(selector.count, "tree") if group.plain else f"{selector.count} of {group.group()}"
    return _many(f"{trees} next to each other, beginning with the one nearest to {near}")


def _taken(selector: s.Take, names: Names) -> _Phrase:
    inner = _phrase(selector.of, names)
    if selector.count == 1:
        if selector.of == s.Other():
            return _one("another tree, the nearest one not visited yet")
        return inner if inner.single else _one(f"the nearest of {inner.group()}")
    return _many(f"the {selector.count} nearest of {inner.group()}")


def _together(parts: tuple[s.Selector, ...], names: Names) -> _Phrase:
    trees = [part.tree for part in parts if isinstance(part, s.TreeIs)]
    if len(parts) == 1:
        return _phrase(parts[0], names)
    if trees and len(trees) == len(parts):
        return _many(f"trees {listed(trees)}")
    return _many(listed([say_selector(part, names) for part in parts]) or "no place at all")


def say_places(ids: tuple[str, ...], few: int = 8) -> str:
    """Places by id: all of them when few, else the first ones and how many more."""
    if len(ids) <= few:
        return listed(ids)
    return f"{', '.join(ids[:few])} and {len(ids) - few} more"
