"""Why the guard says no, in words that a grower reads."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.forecast.limits import Resource
from fieldhand.forecast.state import Spent, Visit
from fieldhand.site.model import Place

#: Places beyond this many are counted, not named.
MAX_NAMED = 6


def running_short(
    resource: Resource, spent: Spent, place: Place, takes: float, chance: float, *, more: bool = False
) -> str:
    """What is left of a limit, what a way takes of it on average, and how likely that is too much.

    Args:
        resource: The limit that binds.
        spent: Used since the mission began.
        place: Where the way leads first.
        takes: What the way takes, in the units of the limit.
        chance: Of running short on it.
        more: Whether there is something to be done between that place and home.
    """
    left = _amount(resource, resource.limit - resource.used(spent))
    above = " above the reserve" if resource.kind == "reserve" else ""
    way = f"going to {_name(place)}, doing what must follow, and home" if more else f"going to {_name(place)} and home"
    average = _amount(resource, takes)
    return f"{left} left{above}; {way} takes {average} on average, {100 * chance:.0f} % chance of running short"


def _name(place: Place) -> str:
    return {"tree": f"tree {place.id}", "marker": f"the {place.id} marker"}.get(place.kind, place.id)


def named(visits: Sequence[Visit], indices: Sequence[int]) -> str:
    """Some places in words: "tree 14", "trees 14, 15 and 22", "trees 14, 15, 16, 17, 18, 19 and 6 more"."""
    names = [visits[i].place.id for i in indices]
    if len(names) == 1:
        return _name(visits[indices[0]].place)
    kind = "trees" if all(visits[i].place.kind == "tree" for i in indices) else "places"
    if len(names) <= MAX_NAMED:
        return f"{kind} {', '.join(names[:-1])} and {names[-1]}"
    return f"{kind} {', '.join(names[:MAX_NAMED])} and {len(names) - MAX_NAMED} more"


def _amount(resource: Resource, value: float) -> str:
    match resource.kind:
        case "distance_m":
            return f"{value:.0f} m"
        case "duration_s":
            return f"{value:.0f} s"
        case _:
            return f"{value:.1f} % of the battery"
