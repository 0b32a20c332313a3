"""Find the limits of a Task that a mission exceeded: budgets, and the charge to leave in reserve.

Everything is computed from the event log alone. Figures are compared up to the rounding of floating-point sums.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fieldhand.clock import clock_time
from fieldhand.language import Number, joined, message
from fieldhand.language.words import say_near
from fieldhand.task.frames import BudgetKind, Constraints
from fieldhand.task.results import Arrived, ChargeEnded, Driving, Event, MissionStatus, Started

LimitKind = BudgetKind | Literal["reserve"]

#: Relative tolerance for floating-point sums.
ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True)
class Exceeded:
    """A limit that was exceeded.

    Attributes:
        kind: Kind of the budget, or ``reserve`` for the charge to leave.
        used: Amount used at the end, in metres, seconds or percent of the battery; for ``reserve`` the charge left.
        limit: The limit, in the same unit.
        t: Mission time in seconds at which the log first shows it.
        near: Location of the robot then: "on the way to the end"; empty where the log does not show it.
        why: Explanation as a sentence.
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
    """Return the limits that a mission exceeded: budgets in their order, then the reserve.

    Args:
        constraints: Constraints of the Task.
        events: Event log from its beginning; it may end anywhere.
        reserve_percent: Charge to leave where neither Task nor log states one.
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
    """Return True if an amount is beyond a limit by more than rounding; for ``reserve``, below it."""
    slack = ROUNDING * max(1.0, abs(limit))
    return used < limit - slack if kind == "reserve" else used > limit + slack


def final_status(status: MissionStatus, exceeded: Sequence[Exceeded]) -> MissionStatus:
    """Return the status of a mission: ``exceeded`` if it ended normally beyond a limit, else as given."""
    return "exceeded" if exceeded and status in ("completed", "returned") else status


def reason_with(exceeded: Sequence[Exceeded], reason: str) -> str:
    """Return the reason why a mission was no success: the exceeded limits, then the reason recorded at its end."""
    return joined("; ", [*(one.why for one in exceeded), *([reason] if reason else [])])


def say_status(status: MissionStatus) -> str:
    """Return the end of a mission in words that follow "mission": "completed", "ended, limit exceeded"."""
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
    """Return a sentence on which limit was exceeded, when and where."""
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
    used = _used(kind, started, events)
    if not used or not is_exceeded(kind, used[-1][1], limit):
        return None
    first = next(event for event, amount in used if is_exceeded(kind, amount, limit))
    near = _near(first, events[: events.index(first)])
    why = say_exceeded(kind, used[-1][1], limit, first.t, near)
    return Exceeded(kind=kind, used=used[-1][1], limit=limit, t=first.t, near=near, why=why)


def _used(kind: LimitKind, started: Started, events: Sequence[Event]) -> list[tuple[Event, float]]:
    """Return the events that show how much of a limit is used. What was charged does not give energy back."""
    found: list[tuple[Event, float]] = []
    charged = 0.0
    for event in events:
        if isinstance(event, ChargeEnded):
            charged += event.gained_percent
        if (amount := _amount(kind, started, event)) is not None:
            found.append((event, amount + charged if kind == "energy_percent" else amount))
    return found


def _amount(kind: LimitKind, started: Started, event: Event) -> float | None:
    """Return the amount of a limit that an event shows as used; None if it shows none."""
    if kind == "duration_s":
        return event.t - started.t
    if kind == "distance_m":
        metres: float | None = getattr(event, "travelled_m", None)
        return metres
    charge: float | None = getattr(event, "charge_percent", None)
    return charge if charge is None or kind == "reserve" else started.charge_percent - charge


def _near(event: Event, before: Sequence[Event]) -> str:
    """Return the location of the robot at an event; an arrival reports on the drive before it."""
    last = next((e for e in (event, *reversed(before)) if isinstance(e, Arrived | Driving)), None)
    if last is None:
        return ""
    return say_near(last.kind, last.place, arrived=last is not event and isinstance(last, Arrived))


def _digits(value: float, limit: float) -> str:
    """Return a number with enough decimals to distinguish it from the limit."""
    for decimals in range(1, 7):
        text = f"{value:.{decimals}f}"
        if value == limit or text != f"{limit:.{decimals}f}":
            break
    return Number(text.rstrip("0").rstrip(".") if "." in text else text)
