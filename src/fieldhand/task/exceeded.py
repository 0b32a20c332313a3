"""Limits of a Task that a mission exceeded, found in its event log: budgets, and the charge that must be left.

The log alone says it: the robot is not asked. Figures are compared as they stand in the log, up to the rounding of
floating-point sums.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fieldhand.clock import clock_time
from fieldhand.language import Number, joined, message
from fieldhand.language.words import say_place
from fieldhand.task.frames import BudgetKind, Constraints
from fieldhand.task.results import Arrived, Driving, Event, MissionStatus, Started

LimitKind = BudgetKind | Literal["reserve"]

#: Relative difference that floating-point sums may make.
ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True)
class Exceeded:
    """A limit that was exceeded.

    Attributes:
        kind: A budget, or ``reserve``: the charge that must be left.
        used: Metres, seconds or percent of the battery at the end; of ``reserve`` the charge left.
        limit: In the same unit.
        t: Second of the mission at which the log first shows it.
        near: Where the robot was then: "on the way to the end"; empty where the log does not say.
        why: All of it in words.
    """

    kind: LimitKind
    used: float
    limit: float
    t: float
    near: str
    why: str


def exceeded_limits(
    constraints: Constraints, events: Sequence[Event], reserve_percent: float | None = None
) -> tuple[Exceeded, ...]:
    """Return the limits that a mission exceeded, budgets in their order, then the reserve.

    Args:
        constraints: The Task's.
        events: The event log, from its beginning; it may stop anywhere.
        reserve_percent: Charge that must be left where neither Task nor log says it.
    """
    started = next((e for e in events if isinstance(e, Started)), None)
    if started is None:
        return ()
    reserve = constraints.reserve_percent
    if reserve is None:
        reserve = reserve_percent if started.reserve_percent is None else started.reserve_percent
    limits: list[tuple[LimitKind, float]] = [(b.kind, b.limit) for b in constraints.budgets]
    if reserve is not None:
        limits.append(("reserve", reserve))
    found = (_exceeded(kind, limit, started, events) for kind, limit in limits)
    return tuple(one for one in found if one is not None)


def is_exceeded(kind: LimitKind, used: float, limit: float) -> bool:
    """Return True if that is beyond the limit by more than rounding; of ``reserve``, below it."""
    slack = ROUNDING * max(1.0, abs(limit))
    return used < limit - slack if kind == "reserve" else used > limit + slack


def final_status(status: MissionStatus, found: Sequence[Exceeded]) -> MissionStatus:
    """Return the status of a mission that ended so: one that is over and beyond a limit is ``exceeded``."""
    return "exceeded" if found and status in ("completed", "returned") else status


def reason_with(found: Sequence[Exceeded], reason: str) -> str:
    """Return why a mission was no success: the limits that it exceeded, then the reason that its end gave."""
    return joined("; ", [*(one.why for one in found), *([reason] if reason else [])])


def say_status(status: MissionStatus) -> str:
    """Say how a mission ended, to follow "mission": "completed", "ended, limit exceeded"."""
    match status:
        case "completed":
            return message("completed", context="mission")
        case "returned":
            return message("returned", context="mission")
        case "exceeded":
            return message("ended, limit exceeded", context="mission")
        case "faulted":
            return message("faulted", context="mission")
        case "aborted":
            return message("aborted", context="mission")


def say_exceeded(kind: LimitKind, used: float, limit: float, t: float, near: str) -> str:
    """Say which limit was exceeded, when and where."""
    amounts = {"used": _digits(used, limit), "allowed": _digits(limit, limit)}
    match kind:
        case "distance_m":
            what = message("{used} m of {allowed} m driven", context="log", **amounts)
        case "duration_s":
            what = message("{used} s of {allowed} s taken", context="log", **amounts)
        case "energy_percent":
            what = message("{used} % of the battery used where {allowed} % were allowed", context="log", **amounts)
        case "reserve":
            what = message("{used} % charge left where {allowed} % must be left", context="log", **amounts)
    if not near:
        return message("{what}: limit exceeded at {time}", context="log", what=what, time=clock_time(t))
    return message("{what}: limit exceeded at {time}, {near}", context="log", what=what, time=clock_time(t), near=near)


def _exceeded(kind: LimitKind, limit: float, started: Started, events: Sequence[Event]) -> Exceeded | None:
    used = [(event, amount) for event in events if (amount := _amount(kind, started, event)) is not None]
    if not used or not is_exceeded(kind, used[-1][1], limit):
        return None
    first = next(event for event, amount in used if is_exceeded(kind, amount, limit))
    near = _near(first, events[: events.index(first)])
    why = say_exceeded(kind, used[-1][1], limit, first.t, near)
    return Exceeded(kind=kind, used=used[-1][1], limit=limit, t=first.t, near=near, why=why)


def _amount(kind: LimitKind, started: Started, event: Event) -> float | None:
    """Return how much of a limit an event shows as used; None if it does not."""
    if kind == "duration_s":
        return event.t - started.t
    if kind == "distance_m":
        metres: float | None = getattr(event, "travelled_m", None)
        return metres
    charge: float | None = getattr(event, "charge_percent", None)
    return charge if charge is None or kind == "reserve" else started.charge_percent - charge


def _near(event: Event, before: Sequence[Event]) -> str:
    """Return where the robot was at an event, or on which way: an arrival shows what happened before it."""
    last = next((e for e in (event, *reversed(before)) if isinstance(e, Arrived | Driving)), None)
    if last is None:
        return ""
    place = say_place(last.kind, last.place)
    if last is not event and isinstance(last, Arrived):
        return message("at {place}", context="log", place=place)
    return message("on the way to {place}", context="log", place=place)


def _digits(value: float, limit: float) -> str:
    """A number with as many decimals as tell it from the limit."""
    for decimals in range(1, 7):
        said = f"{value:.{decimals}f}"
        if value == limit or said != f"{limit:.{decimals}f}":
            break
    return Number(said.rstrip("0").rstrip(".") if "." in said else said)
