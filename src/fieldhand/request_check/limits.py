"""Check budgets, reserve, speed and distances of a plan against the request."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import takewhile

from fieldhand.language import Number, message
from fieldhand.request_check.amounts import StatedAmount
from fieldhand.request_check.mismatch import PlanMismatch
from fieldhand.request_check.plan_facts import PlanFacts
from fieldhand.request_check.request_facts import RequestFacts
from fieldhand.request_check.words import TREES, quoted, words_in
from fieldhand.task.frames import BudgetKind

_KINDS: dict[BudgetKind, tuple[str, str]] = {
    "distance_m": ("length", "m"), "duration_s": ("time", "s"), "energy_percent": ("percent", "%"),
}  # fmt: skip
#: Words for the robot's remaining energy.
BATTERY = frozenset({"battery", "charge", "energy", "power", "capacity"})
_KEEPS = frozenset(
    {"keep", "keeping", "reserve", "left", "leave", "leaving", "remain", "remains", "remaining", "before"}
)
_USES = frozenset({"use", "uses", "using", "used", "spend", "spending", "within", "consume", "more", "most", "up"})
#: Words shortly before a limit on distance or time.
_LIMITS = words_in("""
    within in under most more less than maximum max limit limited only up exceed exceeding longer have spend
    spending budget of further over use using takes take
    """)
#: Words of a request that asks to recharge, and words that may.
_RECHARGING = frozenset({"recharge", "recharges", "recharging", "recharged"})
_CHARGING = _RECHARGING | {"charge", "charges", "charging", "charged", "charger", "dock", "top", "topping", "tops"}
#: Relative tolerance for rounded conversions.
_CLOSE = 0.02
#: Words that ask for a speed by other means than its number.
_SPEEDS = frozenset({"slow", "slowly", "slower", "speed", "pace", "fast", "faster", "throttle"})
#: Words of waits, and the number of words behind one within which its time is stated.
_WAITS = words_in(
    "wait waits waiting pause pauses pausing linger lingering dwell settle settling stay staying stop stopping"
)
_NEAR = 4
_PARTS = {
    "half": 0.5, "quarter": 0.25, "third": 1 / 3, "fifth": 0.2, "tenth": 0.1, "thirds": 2 / 3, "quarters": 0.75,
}  # fmt: skip


def limit_mismatches(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield contradictions in budgets, reserve, speed and distances."""
    for amount in facts.amounts:
        if amount.kind == "percent":
            yield from _battery(facts, plan, amount)
            yield from _share(facts, plan, amount)
        elif amount.kind in ("time", "length"):
            yield from _dropped(facts, plan, amount)
        elif amount.kind == "speed" and not _drives(plan, amount.values[0]):
            what_differs = message(
                "the request says '{amount}' as a speed, but the plan does not drive at that speed", amount=amount.words
            )
            yield PlanMismatch(kind="limit", what=what_differs)
    yield from _invented(facts, plan)
    yield from _waits(facts, plan)
    yield from _recharging(facts, plan)
    if facts.as_many and not any(getattr(node, "optional", False) for node in plan.nodes):
        yield PlanMismatch(
            kind="limit",
            what=message("the request asks for as many as possible, but no visit of the plan is optional"),
        )


def _battery(facts: RequestFacts, plan: PlanFacts, amount: StatedAmount) -> Iterator[PlanMismatch]:
    """Yield a battery share of the request that is neither a budget nor a reserve of the plan."""
    sentence = {t.text for t in facts.tokens if t.sentence == amount.sentence}
    if not sentence & BATTERY or facts.conditional(amount.sentence):
        return
    percent = amount.values[0]
    if any(abs(percent - x) < 0.5 for x in plan.charges_percent):
        return
    reserve = plan.task.constraints.reserve_percent
    budgets = [b.limit for b in plan.task.constraints.budgets if b.kind == "energy_percent"]
    used = [*budgets, *([100.0 - reserve] if reserve is not None else [])]
    left = [*([reserve] if reserve is not None else []), *(100.0 - b for b in budgets)]
    keeps, uses = bool(sentence & _KEEPS), bool(sentence & _USES)
    ways = [*(left if keeps or not uses else []), *(used if uses or not keeps else [])]
    if not any(abs(percent - x) < 0.5 for x in ways):
        yield PlanMismatch(
            kind="limit",
            what=message("the request limits the battery by '{amount}', but the plan does not", amount=amount.words),
        )


def _share(facts: RequestFacts, plan: PlanFacts, amount: StatedAmount) -> Iterator[PlanMismatch]:
    """Yield a share of the trees in the request that the plan lacks ("10 % of the vines")."""
    near = [token.text for token in facts.tokens[amount.index + 1 : amount.index + 8]]
    behind = list(takewhile(lambda word: word not in ".,;:!?", near))
    if "of" not in behind[:2] or TREES.isdisjoint(behind) or BATTERY & set(behind) or facts.negated(amount.index):
        return
    if not any(number.kind == "percent" and _close(number.value, amount.values[0]) for number in plan.numbers):
        yield PlanMismatch(
            kind="count",
            what=message("the request says '{amount}', which the plan does not contain", amount=amount.words),
        )


def _recharging(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield a charge of the battery that only the request or only the plan contains."""
    if plan.recharges and not facts.words & _CHARGING and not facts.unknown:
        yield PlanMismatch(
            kind="limit", what=message("the plan charges the battery, which the request does not mention")
        )
    elif not plan.recharges and facts.words & _RECHARGING:
        yield PlanMismatch(kind="limit", what=message("the request asks to recharge, but the plan does not"))


def _dropped(facts: RequestFacts, plan: PlanFacts, amount: StatedAmount) -> Iterator[PlanMismatch]:
    """Yield a stated distance or time that the plan lacks."""
    value = amount.values[0]
    limit: BudgetKind = "distance_m" if amount.kind == "length" else "duration_s"
    have = [b.limit for b in plan.task.constraints.budgets if b.kind == limit]
    have += [x for test in plan.tests for x in test.values]
    have += [node.dwell_s for node in plan.nodes if node.dwell_s] if amount.kind == "time" else []
    have += plan.waits
    rests = [node.dwell_s for node in plan.nodes if node.dwell_s]
    if amount.kind == "time" and rests and sum(rests) <= value < sum(rests) + max(rests):
        return  # "every 7 minutes over the next hour"
    if amount.kind == "length":
        have += [number.value for number in plan.numbers if number.kind == "length"]
        have += _parameters(plan)
        have += [x * unit for test in plan.tests if test.attribute for x in test.values for unit in (0.01, 0.001)]
    if any(_close(value, x) for x in have):
        return
    before = {t.text for t in facts.tokens[max(0, amount.index - 6) : amount.index]}
    after = {t.text for t in facts.tokens[amount.index : amount.index + 4]}
    if amount.kind == "length" and facts.spaced and plan.trees:
        return  # the plan names the trees at that distance
    if amount.kind == "length" or before & _LIMITS:
        if amount.kind == "length" and not (before & _LIMITS or after & {"apart", "intervals", "interval", "spacing"}):
            return
        yield PlanMismatch(
            kind="limit",
            what=message("the request says '{amount}', which the plan does not contain", amount=amount.words),
        )


def _drives(plan: PlanFacts, metres_per_second: float) -> bool:
    """Return True if the plan limits the speed of the mission or of a part to this value, or watches for it."""
    if any(test.unit in ("m/s", "km/h") and _close(metres_per_second, x) for test in plan.tests for x in test.values):
        return True
    return any(_close(speed, metres_per_second) for _, speed in _speeds(plan))


def _speeds(plan: PlanFacts) -> list[tuple[str, float]]:
    """Return the speed limits of a plan, each with its node; that of the whole mission without one."""
    whole = plan.task.constraints.speed_m_s
    parts = [(node.id, node.pace_m_s) for node in plan.nodes if math.isfinite(node.pace_m_s)]
    parts += [("", slow.speed_m_s) for slow in plan.task.constraints.slow if slow.speed_m_s is not None]
    parts += [("", watch.speed_m_s) for watch in plan.task.composition.watches if watch.speed_m_s is not None]
    return [*([] if whole is None else [("", whole)]), *parts]


def _waits(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield waits of the request that the plan lacks, and waits of the plan whose time the request does not state."""
    planned = [node for node in plan.nodes if node.dwell_s]
    if not planned and not plan.waits:
        for amount in facts.amounts:
            near = facts.tokens[max(0, amount.index - _NEAR) : amount.index]
            before = {token.text for token in near if token.sentence == amount.sentence}
            if amount.kind == "time" and _WAITS & before and not facts.negated(amount.index):
                what = message(
                    "the request says '{words}', but nothing in the plan waits",
                    words=quoted(facts.tokens[amount.index - 1 : amount.index + 2]),
                )
                yield PlanMismatch(kind="limit", what=what)
    for node in planned:
        if not any(_close(node.dwell_s, x) for x in _stated(facts, "time")):
            what = message(
                "the plan waits {seconds} s, which the request does not mention", seconds=Number(f"{node.dwell_s:g}")
            )
            yield PlanMismatch(kind="limit", what=what, node=node.id)


def _parameters(plan: PlanFacts) -> list[float]:
    """Return numeric parameters of actions, also converted from centimetres to metres."""
    stated = [
        value for node in plan.nodes for _, value in getattr(node, "parameters", ()) if isinstance(value, float | int)
    ]
    return [x for value in stated for x in (float(value), float(value) / 100.0)]


def _invented(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield limits and distances of the plan that the request does not state."""
    for budget in plan.task.constraints.budgets:
        kind, unit = _KINDS[budget.kind]
        if not any(_close(budget.limit, x) for x in _stated(facts, kind)):
            yield PlanMismatch(
                kind="limit",
                what=message(
                    "the plan has a budget of {limit} {unit}, which the request does not mention",
                    limit=Number(f"{budget.limit:g}"),
                    unit=unit,
                ),
            )
    reserve = plan.task.constraints.reserve_percent
    in_time = bool(facts.words & BATTERY and _stated(facts, "time"))  # "keep 30 minutes of battery"
    if reserve is not None and not in_time and not any(abs(reserve - x) < 0.5 for x in _stated(facts, "percent")):
        yield PlanMismatch(
            kind="limit",
            what=message(
                "the plan keeps {percent} % of the battery, which the request does not mention",
                percent=Number(f"{reserve:g}"),
            ),
        )
    for node, speed in _speeds(plan):
        if facts.words & _SPEEDS or any(_close(speed, x) for a in facts.amounts for x in a.values):
            continue
        yield PlanMismatch(
            kind="limit",
            what=message(
                "the plan drives at {speed} m/s, which the request does not mention", speed=Number(f"{speed:g}")
            ),
            node=node,
        )
    for number in plan.numbers:
        if number.kind == "percent" and not any(_close(number.value, x) for x in _stated(facts, "percent")):
            yield PlanMismatch(
                kind="count",
                what=message(
                    "the plan holds {number} % ({what}), which the request does not mention",
                    number=Number(f"{number.value:g}"),
                    what=number.what,
                ),
                node=number.node,
            )
        if number.kind == "length" and not any(_close(number.value, x) for x in _stated(facts, "length")):
            yield PlanMismatch(
                kind="distance",
                what=message(
                    "the plan holds {number} m ({what}), which the request does not mention",
                    number=Number(f"{number.value:g}"),
                    what=number.what,
                ),
                node=number.node,
            )


def _stated(facts: RequestFacts, kind: str) -> list[float]:
    """Return the stated amounts of a kind; a number without a unit may be of any kind."""
    found = [x for a in facts.amounts if a.kind == kind for x in a.values]
    plain = [x for a in facts.amounts if a.kind in ("plain", "times") for x in a.values]
    if kind == "percent":
        found += [100.0 - x for x in found] + [100.0 * part for word, part in _PARTS.items() if word in facts.words]
        return found + plain + [100.0 - x for x in plain]
    if kind == "time":
        units = [(u, s) for u, s in (("hour", 3600.0), ("minute", 60.0)) if {u, f"{u}s"} & facts.words]
        found += [part * s for _, s in units for part in (1.0, *_PARTS.values(), 1.5, 0.75)]
        found += [sum(found[:2])] if len(found) > 1 else []
        return found + [x * s for x in plain for s in (1.0, 60.0, 3600.0)]
    units = [(u, s) for u, s in (("kilometre", 1000.0), ("kilometer", 1000.0), ("km", 1000.0), ("mile", 1609.344))]
    found += [part * s for u, s in units if {u, f"{u}s"} & facts.words for part in (1.0, *_PARTS.values())]
    return found + [x * s for x in plain for s in (1.0, 0.3048)]


def _close(a: float, b: float) -> bool:
    return abs(a - b) <= max(0.01, _CLOSE * abs(a))
