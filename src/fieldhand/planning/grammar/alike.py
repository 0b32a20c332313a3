"""Plans that differ in their words only: each visits the same places on this site and does the same there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from fieldhand.errors import PlaceError, TaskError
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selector import Selector
from fieldhand.planning.planner import Planned
from fieldhand.site.model import Site
from fieldhand.task.plan import Node

#: Fields that tell from which words a part of a plan comes, and how it is called.
_OF_WORDS = frozenset({"said", "at_said", "id"})


def different_on_site(plans: Sequence[Planned], site: Site) -> list[Planned]:
    """Return the first of each group of plans that do the same at the same places of a site."""
    if len(plans) < 2:
        return list(plans)
    found: dict[Any, Planned] = {}
    for plan in plans:
        task = plan.task
        key = (_done(task.composition, site, ordered=False), _done(task.constraints, None, ordered=False))
        found.setdefault(repr(key), plan)
    return list(found.values())


def _done(value: Any, site: Site | None, *, ordered: bool) -> Any:
    """Return a part of a plan with the places of the site in place of selectors, and without the words it comes from.

    Args:
        value: Part of a plan.
        site: The site; None to leave selectors as they are.
        ordered: True if the places are visited in the order that they have.
    """
    if isinstance(value, Selector):
        return value if site is None or value.relative else _places(value, site, ordered=ordered)
    if isinstance(value, tuple | list):
        return tuple(_done(item, site, ordered=ordered) for item in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    if isinstance(value, Node):
        ordered = value.keeps_order
        site = None if value.work is not None else site  # the ground of an area is more than its plants
    parts = {one.name: _done(getattr(value, one.name), site, ordered=ordered) for one in fields(value)}
    return (type(value).__name__, *((name, part) for name, part in parts.items() if name not in _OF_WORDS))


def _places(selector: Selector, site: Site, *, ordered: bool) -> Any:
    try:
        names = [
            (one.kind, one.id, one.side, round(one.x, 3), round(one.y, 3))
            for one in resolve(selector, site, Context(here=site.start))
        ]
    except (PlaceError, TaskError):
        return selector
    return tuple(names) if ordered else tuple(sorted(set(names)))
