"""Conditions on several readings at once: "if both are low", "if neither is", "if at least two of the three are"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.selections import as_some, named_places
from fieldhand.site.model import Site
from fieldhand.task import conditions as c

#: More readings than this are not told one by one.
MOST_READINGS = 12
#: What may stand between the number of readings and what is asked of them ("all of the three readings | are").
_OF_THEM = frozenset({"OF", "DET", "NUM", "IT", "THERE", "TREE", "PLACE", "NOUN", "READING", "CORNER", "MORE", "EACH"})
_NONE = frozenset({"neither", "neither of", "none", "none of", "not one", "not one of", "no", "not any", "not any of"})
_ALL = frozenset({"both", "both of", "all", "all of", "all the", "every one of", "each one of", "each of"})
_ANY = frozenset({"either", "either of", "any", "any of", "any one", "any one of", "one of"})


@dataclass(frozen=True, kw_only=True)
class Share:
    """How many of several readings have to be as asked.

    Attributes:
        least: At least so many; None means every one of them.
        none: None of them may be.
        size: How many readings there are, if the request says it.
        loose: It may as well be said of each by itself ("if any of them is hot, measure CO2 there").
        terms: What is asked of each reading.
    """

    terms: tuple[Term, ...]
    least: int | None = None
    none: bool = False
    size: int | None = None
    loose: bool = False

    def of(self, each: Sequence[c.Condition]) -> c.Condition:
        """The condition on all of the readings, from that on each."""
        if self.none:
            return c.Not(condition=c.AnyOf(conditions=tuple(each)))
        if self.least is None or self.least == len(each):
            return c.AllOf(conditions=tuple(each))
        if self.least == 1:
            return c.AnyOf(conditions=tuple(each))
        groups = combinations(each, self.least)
        return c.AnyOf(conditions=tuple(c.AllOf(conditions=group) for group in groups))


def share_of(terms: Sequence[Term]) -> Share | None:
    """How many readings a condition is about; None if it is about one."""
    if not terms:
        return None
    head = terms[0]
    said = head.text.lower()
    rest = terms[1:]
    least: int | None = None
    none = loose = False
    size = 2 if said.split()[0] in ("both", "either", "neither") else None
    if head.kind in ("NEITHER", "NOT") and said in _NONE:
        none = True
    elif head.kind == "EACH" and said in _ALL:
        loose = size is None and said not in ("all", "all of", "all the")
    elif head.kind == "ANY" and said in _ANY:
        least, loose = 1, True
    elif head.kind == "CMP" and head.value[0] == "ge" and rest and _is_count(rest[0]) and not _is_amount(rest[1:]):
        least, rest = int(rest[0].value), rest[1:]
    elif _is_count(head) and rest and (rest[0].kind in ("OF", "THERE") or rest[0].text.lower() == "or more"):
        least, rest = int(head.value), rest[1:]
    else:
        return None
    at = 0
    while at < len(rest) and rest[at].kind in _OF_THEM:
        if _is_count(rest[at]):
            size = int(rest[at].value)
        at += 1
    nouns = [t for t in rest[:at] if t.kind == "NOUN"]
    if any(t.kind == "NUM" for t in rest[at - 1 : at]) and not nouns and at and _is_amount(rest[at:]):
        return None
    return Share(terms=(*nouns, *rest[at:]), least=least, none=none, size=size, loose=loose)


def _is_count(term: Term) -> bool:
    return term.kind == "NUM" and term.value == int(term.value) and 1 <= term.value <= MOST_READINGS


def _is_amount(terms: Sequence[Term]) -> bool:
    """Whether a number before these is what is compared rather than how many ("at least 30")."""
    return not terms or terms[0].kind not in ("OF", "THERE", "IS", "IT", "READING", "TREE", "PLACE", "NOUN")


def one_after_another(loop: d.Loop, holder: d.DraftBlock, site: Site, said: Sequence[Term]) -> list[d.DraftBlock]:
    """Put what a loop does at each place one after the other in its place, so that each reading has a name.

    Returns:
        For each place the steps that are done there, as a block.

    Raises:
        Unclear: The places are too many, or only the robot can tell how many there are.
    """
    places = _places_of(loop, site)
    if places is None:
        raise unclear(
            said,
            message("the number of readings is not known before the robot is there"),
            message("name the trees"),
        )
    if len(places) > MOST_READINGS:
        raise unclear(
            said,
            message("{count} readings are too many to compare", count=len(places)),
            message("test each of them by itself"),
        )
    at = holder.steps.index(loop)
    del holder.steps[at]
    made: list[d.DraftBlock] = []
    for place in places:
        body = d.copy_block(loop.body, lambda _: True, {}, lambda: "")
        first = body.steps[0]
        if isinstance(first, d.DraftCapture) and first.at is None:
            first.at, first.at_said = place, loop.said
        else:
            body.steps.insert(0, d.Go(place=place, said=loop.said))
        made.append(d.DraftBlock(steps=list(body.steps)))
        for step in body.steps:
            holder.add(step)
            holder.steps.insert(at, holder.steps.pop())
            at += 1
    return made


def _places_of(loop: d.Loop, site: Site) -> list[s.Selector] | None:
    """The places of a loop, each as a selector of its own; None if they cannot be told one by one."""
    select = loop.select
    if loop.optional or loop.at_most is not None or loop.until is not None:
        return None
    named = named_places(select)
    if named and named != (select,) and all(part.single for part in named):
        return list(named)
    if (some := as_some(select)) is not None:
        of, fresh = some.of, s.NotVisited(of=some.of)
        return [s.Take(count=1, of=of if k == 0 and of.relative else fresh) for k in range(some.count)]
    if select.relative:
        return None
    try:
        number = len(resolve(select, site, Context(here=site.start)))
    except (PlaceError, TaskError):
        return None
    return [s.Nth(nth=k, of=select) for k in range(1, number + 1)]
