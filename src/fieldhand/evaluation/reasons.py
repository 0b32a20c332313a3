"""Reasons for the guard's decisions, in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.mission_budget import MissionBudget
from fieldhand.forecast.mission_state import MissionState, Visit
from fieldhand.forecast.resource_limits import ResourceLimit
from fieldhand.forecast.route_cost import RouteCost
from fieldhand.language import Number, joined, message
from fieldhand.language.words import listed, say_place, some_names
from fieldhand.site.model import Place

Floats = NDArray[np.float64]

#: Maximum number of places that are named; the others are counted.
MAX_NAMED = 6


@dataclass(frozen=True, kw_only=True)
class RoundTrip:
    """A route to a place and home.

    Attributes:
        way: Cost of the route, including the work at the place.
        to: First place of the route.
        more: True if other work follows before the robot drives home.
    """

    way: RouteCost
    to: Place
    more: bool = False


def running_short(budget: MissionBudget, state: MissionState, trip: RoundTrip, chances: Floats) -> str:
    """Return "12 m left; going to tree 14 and home takes 14 m on average, 31 % chance of running short"."""
    binding = _binding(budget, chances)
    return message(
        "{known}, {chance} % chance of running short",
        context="log",
        known=_amounts(budget, state, trip, binding),
        chance=f"{100 * chances[binding]:.0f}",
    )


def left_out(
    visits: Sequence[Visit],
    indices: Sequence[int],
    budget: MissionBudget,
    state: MissionState,
    trip: RoundTrip,
    chances: Floats,
) -> str:
    """Return which optional visits are given up and why, with the figures of the one least likely to run short.

    "trees 14, 15 and 22: 31 % chance of running short (12 m left; going to tree 14 and home takes 14 m on average)".
    """
    binding = _binding(budget, chances)
    return message(
        "{places}: {chance} % chance of running short ({why})",
        context="log",
        places=named(visits, indices),
        chance=f"{100 * chances[binding]:.0f}",
        why=_amounts(budget, state, trip, binding),
    )


def _binding(budget: MissionBudget, chances: Floats) -> int:
    return int((chances - budget.accepted).argmax())


def _amounts(budget: MissionBudget, state: MissionState, trip: RoundTrip, binding: int) -> str:
    """Return the amount left of a limit, and the mean amount that a round trip needs."""
    resource = budget.resources(state)[binding]
    takes = trip.way.sums[0] * resource.per_metre + resource.of_work(budget.robot, trip.way.work)
    left = _amount(resource, resource.limit - resource.used(state.spent))
    ways = {"place": _name(trip.to), "takes": _amount(resource, takes)}
    if resource.kind == "reserve":
        held = message("{left} left above the reserve", context="log", left=left)
    else:
        held = message("{left} left", context="log", left=left)
    if trip.more:
        goes = message(
            "going to {place}, doing what must follow, and home takes {takes} on average", context="log", **ways
        )
    else:
        goes = message("going to {place} and home takes {takes} on average", context="log", **ways)
    return joined("; ", (held, goes))


def no_way(visits: Sequence[Visit], indices: Sequence[int]) -> str:
    """Return "there is no way to trees 3 and 4"."""
    return message("there is no way to {places}", context="log", places=named(visits, indices))


def too_many(visits: Sequence[Visit], indices: Sequence[int], chosen_from: int) -> str:
    """Return why visits were excluded from the choice: "trees 3 and 4: 19,998 others cost less to reach"."""
    others = Number(f"{chosen_from:,}")
    return message(
        "{places}: {count} others cost less to reach",
        context="log",
        places=named(visits, indices),
        count=others,
    )


def named(visits: Sequence[Visit], indices: Sequence[int]) -> str:
    """Return places in words: "tree 14", "trees 14, 15 and 22", "trees 14, 15, 16, 17, 18, 19 and 6 more"."""
    names = [visits[i].place.id for i in indices]
    if len(names) == 1:
        return _name(visits[indices[0]].place)
    ids = some_names(names, MAX_NAMED) if len(names) > MAX_NAMED else listed(names)
    if all(visits[i].place.kind == "tree" for i in indices):
        return message("trees {ids}", context="log", ids=ids)
    return message("places {ids}", context="log", ids=ids)


def _name(place: Place) -> str:
    if place.kind == "tree":
        return say_place(place.kind, place.id, place.side)
    return message("the {id} marker", context="log", id=place.id) if place.kind == "marker" else place.id


def _amount(resource: ResourceLimit, value: float) -> str:
    match resource.kind:
        case "distance_m":
            return message("{metres} m", context="log", metres=Number(f"{value:.0f}"))
        case "duration_s":
            return message("{seconds} s", context="log", seconds=Number(f"{value:.0f}"))
        case _:
            return message("{percent} % of the battery", context="log", percent=Number(f"{value:.1f}"))
