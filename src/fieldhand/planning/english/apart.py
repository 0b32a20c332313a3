"""Trees at a distance from each other: they stand where they stand, so those that fit best are looked for."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import dist

import numpy as np

from fieldhand.errors import PlaceError, TaskError
from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.found import Found
from fieldhand.planning.english.tokens import Term
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.site.places import resolve
from fieldhand.task import selectors as s

#: Trees whose distance differs by more than this share of what was asked for are not "so far apart".
_TOLERANCE = 0.25
#: So many trees are tried as the first.
_MOST_TRIES = 200
#: More trees than this are not chosen one by one.
MOST_TREES = 60


def trees_apart(of: s.Selector, count: int, metres: float, *, least: bool, site: Site, said: Sequence[Term]) -> Found:
    """So many trees, each so far from the one before it and no nearer to any other.

    Args:
        of: The trees to choose from; nothing that only the robot can tell.
        metres: The distance, a least one if ``least``.

    Raises:
        Unclear: There are no such trees.
    """
    if s.is_relative(of) or count > MOST_TREES:
        raise unclear(said, "which trees these are cannot be told now", "name the trees, or leave the distance out")
    try:
        trees = [place for place in resolve(of, site, Context(here=site.start)) if place.id in site.by_id]
    except (PlaceError, TaskError):
        trees = []
    chosen = _chosen(trees, count, metres, least)
    if not chosen:
        what = f"there are no {count} trees {'at least ' if least else ''}{metres:g} m from each other"
        raise unclear(said, what, "ask for fewer, or for a smaller distance")
    legs = [dist(a.xy, b.xy) for a, b in pairwise(chosen)]
    between = f"{min(legs):.1f}" if min(legs) == max(legs) else f"{min(legs):.1f} to {max(legs):.1f}"
    names = ", ".join(place.id for place in chosen)
    told = f"Trees stand where they stand: the {count} that were chosen ({names}) are {between} m from one to the next."
    selector = s.Union(parts=tuple(s.TreeIs(tree=place.id) for place in chosen))
    return Found(selector=selector, many=True, counted=count, assumed=(told,))


def _chosen(trees: Sequence[Place], count: int, metres: float, least: bool) -> list[Place]:
    """The first trees that fit, beginning with each in turn; each time the one that fits best."""
    xy = np.array([tree.xy for tree in trees], dtype=float).reshape(-1, 2)
    nearest = metres if least else metres * (1 - _TOLERANCE)
    for first in range(0, len(trees), max(1, len(trees) // _MOST_TRIES)):
        chosen = [first]
        free = np.ones(len(trees), dtype=bool)
        while len(chosen) < count:
            away = np.hypot(*(xy - xy[chosen[-1]]).T)
            free &= away >= nearest
            off = np.where(free, np.abs(away - metres), np.inf)
            best = int(off.argmin())
            if not free[best] or (not least and off[best] > metres * _TOLERANCE):
                break
            chosen.append(best)
        if len(chosen) == count:
            return [trees[k] for k in chosen]
    return []
