"""Why the guard says no, in words that a grower reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.means import Means
from fieldhand.forecast.limits import Resource
from fieldhand.forecast.state import MissionState, Visit
from fieldhand.forecast.ways import Way
from fieldhand.site.model import Place

Floats = NDArray[np.float64]

#: Places beyond this many are counted, not named.
MAX_NAMED = 6
#: How reasons begin that say themselves what was left out.
SKIPPED, _NO_WAY = "skipped", "there is no way to"


@dataclass(frozen=True, kw_only=True)
class Errand:
    """A way that leads somewhere and home.

    Attributes:
        way: With its work.
        to: Where it leads first.
        more: Whether there is something to be done between that place and home.
    """

    way: Way
    to: Place
    more: bool = False


def running_short(means: Means, state: MissionState, errand: Errand, chances: Floats) -> str:
    """ "12 m left; going to tree 14 and home takes 14 m on average, 31 % chance of running short"."""
    binding = _binding(means, chances)
    return f"{_amounts(means, state, errand, binding)}, {100 * chances[binding]:.0f} % chance of running short"


def left_out(
    visits: Sequence[Visit], indices: Sequence[int], means: Means, state: MissionState, errand: Errand, chances: Floats
) -> str:
    """Optional visits that are given up, and why, told of the one that is least likely to run short.

    "skipped trees 14, 15 and 22: 31 % chance of running short (12 m left; going to tree 14 and home takes 14 m on
    average)".
    """
    binding = _binding(means, chances)
    words = f"{SKIPPED} {named(visits, indices)}: {100 * chances[binding]:.0f} % chance of running short"
    return f"{words} ({_amounts(means, state, errand, binding)})"


def _binding(means: Means, chances: Floats) -> int:
    return int((chances - means.accepted).argmax())


def _amounts(means: Means, state: MissionState, errand: Errand, binding: int) -> str:
    """What is left of a limit, and what a way takes of it on average."""
    resource = means.resources(state)[binding]
    takes = errand.way.sums[0] * resource.per_metre + resource.of_work(means.robot, errand.way.work)
    left = _amount(resource, resource.limit - resource.used(state.spent))
    above = " above the reserve" if resource.kind == "reserve" else ""
    between = ", doing what must follow," if errand.more else ""
    words = f"going to {_name(errand.to)}{between} and home"
    return f"{left} left{above}; {words} takes {_amount(resource, takes)} on average"


def no_way(visits: Sequence[Visit], indices: Sequence[int]) -> str:
    """ "there is no way to trees 3 and 4"."""
    return f"{_NO_WAY} {named(visits, indices)}"


def names_places(reason: str) -> bool:
    """Whether a reason says itself what was left out, so that who tells it need not name that again."""
    return reason.startswith((f"{SKIPPED} ", f"{_NO_WAY} "))


def named(visits: Sequence[Visit], indices: Sequence[int]) -> str:
    """Some places in words: "tree 14", "trees 14, 15 and 22", "trees 14, 15, 16, 17, 18, 19 and 6 more"."""
    names = [visits[i].place.id for i in indices]
    if len(names) == 1:
        return _name(visits[indices[0]].place)
    kind = "trees" if all(visits[i].place.kind == "tree" for i in indices) else "places"
    if len(names) <= MAX_NAMED:
        return f"{kind} {', '.join(names[:-1])} and {names[-1]}"
    return f"{kind} {', '.join(names[:MAX_NAMED])} and {len(names) - MAX_NAMED} more"


def _name(place: Place) -> str:
    return {"tree": f"tree {place.id}", "marker": f"the {place.id} marker"}.get(place.kind, place.id)


def _amount(resource: Resource, value: float) -> str:
    match resource.kind:
        case "distance_m":
            return f"{value:.0f} m"
        case "duration_s":
            return f"{value:.0f} s"
        case _:
            return f"{value:.1f} % of the battery"
