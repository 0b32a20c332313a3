"""Assumptions where a request leaves out a detail that the plan has."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.planning.english.naming import name_words
from fieldhand.planning.selections import as_beside, as_row_of, rank_of
from fieldhand.site.model import Site
from fieldhand.task.plan import Node, Span, walk

#: Words that say how good trees are, and not by which attribute.
_JUDGED = re.compile(r"\b(?:worst|poorest|best|finest)\b", re.IGNORECASE)


def assumed_ways(plan: Node, request: str, sides: Sequence[Span], site: Site) -> Iterator[str]:
    """Yield for each row that is counted from another one, without a side, which way it is counted.

    Args:
        plan: Plan of the request.
        request: Request as typed.
        sides: Ranges of the request that name sides.
        site: Site of the mission.
    """
    ways = {block.runs_east_west for block in site.planting.blocks}
    for node in walk(plan):
        rows = [
            row for part in (node.selector.walk() if node.selector else ()) if (row := as_row_of(part)) and row.over
        ]
        if not rows or not node.said or any(node.said[0][0] <= start < node.said[-1][1] for start, _ in sides):
            continue
        said = request[node.said[0][0] : node.said[-1][1]]
        higher = rows[0].over > 0
        compass = " or ".join(
            sorted(("south" if way else "east") if higher else ("north" if way else "west") for way in ways)
        )
        if higher:
            yield message(
                "'{said}' is counted towards higher row numbers ({compass}).",
                context="assumption",
                said=said,
                compass=compass,
            )
        else:
            yield message(
                "'{said}' is counted towards lower row numbers ({compass}).",
                context="assumption",
                said=said,
                compass=compass,
            )


def assumed_hands(plan: Node, request: str) -> Iterator[str]:
    """Yield which side of a row is its left or right side, if the request says so.

    Args:
        plan: Plan of the request.
        request: Request as typed.
    """
    if not re.search(r"\b(?:left|right)(?:[ -]?hand)?\b", request, re.IGNORECASE):
        return
    parts = (part for node in walk(plan) for part in (node.selector.walk() if node.selector else ()))
    named = (one.side for part in parts if (one := as_beside(part)) is not None)
    for side in dict.fromkeys(side for side in named if side != "both"):
        hand = message("left") if side in ("east", "north") else message("right")
        yield message(
            "Left and right are as seen when driving a row from its first tree to its last: the {hand} side is the"
            " {side} side.",
            context="assumption",
            hand=hand,
            side=COMPASS[side],
        )


def assumed_qualities(plan: Node, request: str) -> Iterator[str]:
    """Yield by which attribute "the worst" are chosen, if the request does not name it.

    Args:
        plan: Plan of the request.
        request: Request as typed.
    """
    judged = _JUDGED.search(request)
    if judged is None:
        return
    parts = (part for node in walk(plan) for part in (node.selector.walk() if node.selector else ()))
    ranks = (rank for part in parts if (rank := rank_of(part)) is not None)
    for attribute, lowest in dict.fromkeys(ranks):
        name = " ".join(name_words(attribute))
        if name.lower() in request.lower():
            continue
        if lowest:
            yield message(
                "'{said}' is read as: with the lowest {attribute}.",
                context="assumption",
                said=judged[0],
                attribute=name,
            )
        else:
            yield message(
                "'{said}' is read as: with the highest {attribute}.",
                context="assumption",
                said=judged[0],
                attribute=name,
            )


def assumed_wholes(plan: Node, request: str) -> Iterator[str]:
    """Yield for each optional step with several places that all of it is done, or nothing.

    Args:
        plan: Plan of the request.
        request: Request as typed.
    """
    for node in walk(plan):
        if node.is_optional_step and node.said and any(inner.visits_each for inner in walk(node)):
            yield message(
                "'{said}' applies to the whole: all of it is done, or all of it is left out.",
                context="assumption",
                said=request[node.said[0][0] : node.said[-1][1]],
            )
