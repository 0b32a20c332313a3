"""What is said of each row or block: once for each of them, where a selector cannot say it of all."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.sets import Group
from fieldhand.planning.selections import as_every_nth, as_rows, is_in_block, names_several_rows
from fieldhand.site.model import Site
from fieldhand.terms import Side

#: More rows than this are not planned one by one.
MOST_ONE_BY_ONE = 60
#: Selectors that pick from all that is left: said of each row, they are said once for each.
_PICKS = (
    s.Top, s.Extreme, s.AmongExtreme, s.Middle, s.EdgeMiddle, s.Nearest, s.Farthest, s.Adjacent, s.Take, s.Successive,
    s.RandomSample, s.Spread, s.Evenly, s.First, s.Last, s.Corners, s.Nth, s.Spaced, s.Edge, s.Half, s.Quarter,
    s.Ordered,
)  # fmt: skip


def one_by_one(selector: s.Selector, site: Site) -> tuple[s.Selector, ...]:
    """The rows of a selection, each as a selector of its own."""
    try:
        places = resolve(selector, site, Context(here=site.start))
    except (PlaceError, TaskError):
        return ()
    planting = site.planting
    index = [site.by_id[place.id].index for place in places if place.id in site.by_id]
    numbers = sorted({int(k) for k in planting.row_of[index] if k >= 0})
    parts = selector.members
    named_rows = [named_by for part in parts if (named_by := as_rows(part)) is not None]
    inner_most = {part.of for part in named_rows}
    plain = len(inner_most) == 1 and len(named_rows) == len(parts)
    of = next(iter(inner_most)) if plain else selector
    made: list[s.Selector] = []
    for k in numbers:
        row = planting.rows[k]
        block = planting.blocks[row.block]
        named = len(planting.blocks) > 1 and not is_in_block(of)
        inner = s.InBlock(block=block.name, of=of) if named else of
        made.append(s.Rows(first=row.name, last=row.name, of=inner))
    return tuple(made)


def distributed(found: FoundPlace, group: Group, bag: Bag) -> FoundPlace:
    """ "The oldest tree of each row": a pick that is said of each row, said once for each of them."""
    if group.one_by_one and found.at_most is not None:
        raise bag.fault(
            message("a largest number for each row is not supported yet"),
            message("say how many in each row, or up to how many in all"),
        )
    one = found.selector.any_of is not None and found.selector.single and not found.many
    if one and group.rows is not None and not group.one_by_one and names_several_rows(group.rows):
        text = text_of(bag.phrase.terms)
        choices = (
            message("{said} in each of the rows", context="answer", said=text),
            message("one in all", context="answer"),
        )
        raise Question(
            message("'{said}': one in each of the rows, or one in all?", context="question", said=text), choices
        )
    if not group.one_by_one or group.rows is None or not _picks_from(found.selector, group.rows):
        return found
    if len(group.one_by_one) > MOST_ONE_BY_ONE:
        raise bag.fault(
            message("there are {count} of them, too many to handle one by one", count=len(group.one_by_one)),
            message("name some rows"),
        )
    parts = tuple(swapped(found.selector, group.rows, one) for one in group.one_by_one)
    return FoundPlace(selector=s.UnionOf(parts=parts), many=True, each=True, assumed=found.assumed)


def spread_over(selector: s.Selector, area: s.Selector, ones: Iterable[s.Selector]) -> s.Selector:
    """A selection of an area, made of each of its parts."""
    parts = tuple(swapped(selector, area, one) for one in ones)
    return parts[0] if len(parts) == 1 else s.UnionOf(parts=parts)


def counted_from(selector: s.Selector, side: Side) -> s.Selector:
    """A selection whose every so many-th tree is counted from a side."""
    for part in selector.walk():
        if (every := as_every_nth(part)) is not None:
            return swapped(selector, every, replace(every, counted_from=side))
    return selector


def _picks_from(selector: s.Selector, area: s.Selector) -> bool:
    if selector == area:
        return False
    inner = [part for part in selector.inner if any(p == area for p in part.walk())]
    return bool(inner) and (isinstance(selector, _PICKS) or any(_picks_from(part, area) for part in inner))


def swapped(selector: s.Selector, old: s.Selector, new: s.Selector) -> s.Selector:
    """The selector with one part in the place of another."""
    if selector == old:
        return new
    changed: dict[str, object] = {}
    for name in selector.__dataclass_fields__:
        value = getattr(selector, name)
        if isinstance(value, s.Selector):
            changed[name] = swapped(value, old, new)
        elif isinstance(value, tuple) and any(isinstance(item, s.Selector) for item in value):
            changed[name] = tuple(swapped(item, old, new) for item in value)
    outer: Any = selector
    made: s.Selector = replace(outer, **changed)
    return made
