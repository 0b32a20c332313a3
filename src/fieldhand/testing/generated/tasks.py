"""Hypothesis strategies for Tasks and their parts, derived from the dataclasses: a new selector needs no edit.

Names of places and readings come from a small pool, so that they often coincide. A reading is not necessarily taken
before it is tested. Numbers are finite; text is anything that XML can represent.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from datetime import datetime, timedelta, timezone
from functools import cached_property, reduce
from operator import or_
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin

from hypothesis import strategies as st

from fieldhand.compatibility import UTC
from fieldhand.hidden_characters import find_hidden
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import SELECTORS
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.task.build import make_task
from fieldhand.task.capabilities import (
    ActionCapability,
    Capabilities,
    ChoiceParameter,
    EventCapability,
    NumberParameter,
    QuantityCapability,
)
from fieldhand.task.codec_shapes import hints_of
from fieldhand.task.conditions import Condition, Level
from fieldhand.task.frames import Budget, Constraints, FaultedExit, Resource, Task
from fieldhand.task.plan import Act, Node, Span, WorkAlong
from fieldhand.task.timing import Timing
from fieldhand.task.watches import EventAbsent, EventBeyond, EventHolds, Watch
from fieldhand.task.ways import Avoid, OnlyGate, SlowNear
from fieldhand.terms import Value

#: A robot with every kind of parameter, an action that measures two quantities, an implement, and a quantity without
#: level words.
ROVER = Capabilities(
    actions={
        "take_picture": ActionCapability(parameters={"view": ChoiceParameter(choices=("canopy", "trunk"))}),
        "probe_soil": ActionCapability(
            measures=("soil_moisture", "soil_ph"),
            parameters={"depth_cm": NumberParameter(minimum=5, maximum=60, unit="cm"), "gain": NumberParameter()},
        ),
        "read_co2": ActionCapability(measures=("co2",)),
        "spray": ActionCapability(
            parameters={"rate_l_ha": NumberParameter(minimum=50, maximum=800, unit="l/ha")}, is_implement=True
        ),
    },
    quantities={
        "soil_moisture": QuantityCapability(unit="percent", levels=("low", "very high")),
        "soil_ph": QuantityCapability(unit="pH"),
        "co2": QuantityCapability(unit="ppm", levels=("low",)),
    },
    events={
        "person_near": EventCapability(),
        "wind": EventCapability(unit="m/s", holds=False),
        "frost": EventCapability(unit="degC"),
    },
)

_seen = st.one_of(st.sampled_from(" <>&\"'é樹🌳\u00a0"), st.characters(exclude_categories=("C", "Zl", "Zp")))
_seen = _seen.filter(lambda c: find_hidden(c) is None)
texts = st.text(_seen, max_size=30)
requests = st.text(st.one_of(st.sampled_from("\t\n"), _seen), max_size=30)
names = st.sampled_from(("a", "b", "first tree", "r1"))
numbers = st.floats(allow_nan=False, allow_infinity=False)
values = st.one_of(texts.filter(bool), numbers, st.booleans(), st.sampled_from(("10", "true", "1e3", " 7", ".5", "-")))
_times = st.datetimes(
    datetime(2020, 1, 1), datetime(2040, 1, 1), timezones=st.sampled_from((UTC, timezone(timedelta(hours=-3.5))))
).map(lambda time: time.isoformat(timespec="seconds"))

_BY_FIELD: dict[str, st.SearchStrategy[Any]] = {
    "id": names,
    "label": names,
    "reading": names,
    "count": st.integers(1, 50),
    "times": st.integers(1, 50),
    "at_least": st.integers(2, 50),
    "laps": st.integers(1, 50),
    "at_most": st.integers(1, 50),
    "expected": st.integers(0, 500),
    "distance_m": st.floats(0, 1e6),
    "limit": st.floats(0, 1e6, exclude_min=True),
    "failure_probability": st.floats(0, 1, exclude_min=True, exclude_max=True),
    "reserve_percent": st.floats(0, 100, exclude_max=True),
    "seconds": st.floats(0, 86400, exclude_min=True),
    "speed_m_s": st.floats(0.01, 20),
    "every_min": st.integers(0, 1440),
    "every_days": st.integers(1, 366),
    "late_min": st.integers(0, 10080),
    "done_by_min": st.integers(0, 10080),
    "offset_min": st.floats(-1440, 1440),
    "at_most_s": st.floats(1, 86_400),
    "percent": st.floats(0, 100, exclude_min=True, exclude_max=True),
    "until_percent": st.floats(0, 100, exclude_min=True),
    "duration_s": st.floats(1, 604_800),
    "last_missions": st.integers(1, 50),
    "last_hours": st.integers(1, 1000),
    "last_days": st.integers(1, 1000),
    "last_months": st.integers(1, 100),
}
_spans = st.lists(st.tuples(st.integers(0, 999), st.integers(0, 999)), max_size=2).map(tuple)


@dataclass(frozen=True)
class Parts:
    """Strategies for parts of Tasks that a robot can execute, with a maximum nesting ``depth``."""

    capabilities: Capabilities
    depth: int = 3
    _made: dict[Any, st.SearchStrategy[Any]] = field(default_factory=dict, compare=False)

    @cached_property
    def selectors(self) -> st.SearchStrategy[Any]:
        """Return a strategy for selectors."""
        return self.one_of(SELECTORS, self.depth)

    @cached_property
    def conditions(self) -> st.SearchStrategy[Any]:
        """Return a strategy for conditions."""
        return self.one_of(get_args(Condition), self.depth)

    @cached_property
    def plans(self) -> st.SearchStrategy[Any]:
        """Return a strategy for plans."""
        return self.one_of(get_args(Node), self.depth)

    def one_of(self, options: tuple[type, ...], depth: int) -> st.SearchStrategy[Any]:
        """Return a strategy for any of some classes; at depth 0 only for those without nested parts."""
        usable = [o for o in options if depth > 0 or not _needs_parts(o)]
        usable = [o for o in usable if o not in (EventHolds, EventAbsent, EventBeyond) or self._events(o)]
        return st.one_of(*(self._deferred(o, depth) for o in usable))

    def _deferred(self, cls: type, depth: int) -> st.SearchStrategy[Any]:
        return st.deferred(lambda: self.instance(cls, depth))

    def instance(self, cls: type, depth: int = 1) -> st.SearchStrategy[Any]:
        """Return a strategy for instances of one class with parts at most ``depth`` deep."""
        if (cls, depth) not in self._made:
            hints = hints_of(cls)
            drawn = {}
            for one in fields(cls):
                if depth == 0 and one.default is not MISSING and _holds_parts(hints[one.name]):
                    continue
                strategy = self.of_hint(one.name, hints[one.name], depth)
                given = one.default is MISSING or one.name == "id"
                drawn[one.name] = strategy if given else st.one_of(st.just(one.default), strategy)
            made = st.builds(
                cls, **(drawn | {k: st.just("") for k in drawn if k in ("quantity", "event", "unit", "level")})
            )
            self._made[cls, depth] = self.fitted(cls, made)
        return self._made[cls, depth]

    def of_hint(self, name: str, hint: Any, depth: int) -> st.SearchStrategy[Any]:
        """Return a strategy for the values of a field."""
        if get_origin(hint) in (Union, UnionType) and NoneType in get_args(hint):
            rest = reduce(or_, (a for a in get_args(hint) if a is not NoneType))
            return st.one_of(st.none(), self.of_hint(name, rest, depth))
        if name in ("at", "begun", "as_of") and hint is str:
            return _times
        if name == "reward" and hint is float:
            return st.floats(0, 1e6)
        if name in _BY_FIELD and hint is not bool:
            return _BY_FIELD[name]
        if hint == Value:
            return values
        if hint == tuple[Span, ...]:
            return _spans
        if name == "parameters":
            return st.just(())
        if get_origin(hint) is tuple:
            inner = get_args(hint)[0]
            least = 0 if get_origin(inner) is Literal else 1
            return st.lists(self.of_hint("", inner, depth), min_size=least, max_size=3).map(tuple)
        if get_origin(hint) is Literal:
            return st.sampled_from(get_args(hint))
        if hint is Selector:
            return self.one_of(SELECTORS, depth - 1)
        if get_origin(hint) in (Union, UnionType):
            return self.one_of(get_args(hint), depth - 1)
        if isinstance(hint, type) and hasattr(hint, "__dataclass_fields__"):
            return self.instance(hint, depth)
        plain = {str: texts.filter(bool), float: numbers, int: st.integers(-1000, 1000), bool: st.booleans()}
        return plain[hint]

    def fitted(self, cls: type, made: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        """Return a strategy for instances with an action or quantity of the robot and matching parameters and units."""
        if cls is Act:
            return st.builds(_with_action, made, self.actions())
        if cls is WorkAlong:
            works = any(action.is_implement for action in self.capabilities.actions.values())
            chosen = [st.just(("", ())), *([self.actions(implements=True)] if works else [])]
            return st.builds(_with_action, made, st.one_of(chosen))
        if cls in (EventHolds, EventAbsent, EventBeyond):
            known = self._events(cls)
            return st.builds(_with_event, made, st.sampled_from(known), st.just(self.capabilities.events))
        if "quantity" in {one.name for one in fields(cls)}:
            able = {n: q for n, q in self.capabilities.quantities.items() if q.levels or cls is not Level}
            if not able:
                return st.nothing()
            return st.builds(_with_quantity, made, st.sampled_from(sorted(able)), st.just(able), st.integers(0, 9))
        return made

    def _events(self, cls: type) -> list[str]:
        """Return the events of the robot that a condition of a class can test."""
        events = self.capabilities.events
        return sorted(n for n, e in events.items() if (e.unit if cls is EventBeyond else e.holds))

    def actions(
        self, *, implements: bool = False
    ) -> st.SearchStrategy[tuple[str, tuple[tuple[str, str | float], ...]]]:
        """Return a strategy for an action with some of its parameters."""

        def parameters(name: str) -> st.SearchStrategy[Any]:
            specs = self.capabilities.actions[name].parameters
            each = {key: _parameter(spec) for key, spec in specs.items()}
            drawn = st.fixed_dictionaries({}, optional=each)
            return st.tuples(st.just(name), drawn.map(lambda d: tuple(d.items())))

        able = [name for name, a in self.capabilities.actions.items() if a.is_implement == implements]
        return st.sampled_from(sorted(able)).flatmap(parameters) if able else st.nothing()

    def tasks(self) -> st.SearchStrategy[Task]:
        """Return a strategy for complete Tasks from ``make_task``: with ids, goals and state variables.

        Some contain earlier missions, whether they depend on them or not.
        """
        quantities = self.capabilities.quantities
        measures = {
            name: tuple((q, quantities[q].unit) for q in action.measures)
            for name, action in self.capabilities.actions.items()
        }
        made = st.builds(
            make_task,
            request=requests,
            plan=self.plans,
            measures=st.just(measures),
            resources=st.lists(self.instance(Resource), max_size=2).map(tuple),
            timing=st.one_of(st.none(), self.one_of(get_args(Timing), 1)),
            constraints=st.builds(
                Constraints,
                budgets=st.lists(self.instance(Budget), max_size=2).map(tuple),
                reserve_percent=st.none() | _BY_FIELD["reserve_percent"],
                reserve_said=_spans,
                speed_m_s=st.none() | _BY_FIELD["speed_m_s"],
                avoid=st.lists(self.instance(Avoid), max_size=2).map(tuple),
                only_gates=st.lists(self.instance(OnlyGate), max_size=2).map(tuple),
                slow=st.lists(self.instance(SlowNear), max_size=2).map(tuple),
                return_percent=st.none() | _BY_FIELD["percent"],
                recharge=st.booleans(),
                recharge_below_percent=st.none() | _BY_FIELD["percent"],
                recharge_until_percent=st.none() | _BY_FIELD["until_percent"],
                recharge_at_most=st.none() | st.integers(1, 1000),
                energy_said=_spans,
            ),
            nominal=st.sampled_from(("return_to_end", "return_to_start", "stay")),
            faulted=st.lists(self.instance(FaultedExit), max_size=3).map(tuple),
            assumptions=st.lists(texts, max_size=2).map(tuple),
            read_as=requests,
            warnings=st.lists(texts, max_size=2).map(tuple),
            nominal_said=_spans,
            no_part=_spans,
            watches=st.lists(self.instance(Watch), max_size=2).map(tuple),
        )
        earlier = st.none() | st.none() | self.instance(EarlierMissions, 3)
        return st.builds(lambda task, earlier: replace(task, earlier=earlier), made, earlier)


def _with_action(node: Act | WorkAlong, chosen: tuple[str, tuple[tuple[str, str | float], ...]]) -> Act | WorkAlong:
    return replace(node, action=chosen[0], parameters=chosen[1])


def _with_quantity(part: Any, name: str, able: Mapping[str, QuantityCapability], pick: int) -> Any:
    quantity = able[name]
    if isinstance(part, Level):
        return replace(part, quantity=name, level=quantity.levels[pick % len(quantity.levels)])
    units = {"unit": quantity.unit} if hasattr(part, "unit") else {}
    return replace(part, quantity=name, **units)


def _with_event(part: Any, name: str, events: Mapping[str, EventCapability]) -> Any:
    return replace(part, event=name, **({"unit": events[name].unit} if isinstance(part, EventBeyond) else {}))


def _parameter(spec: NumberParameter | ChoiceParameter) -> st.SearchStrategy[str | float]:
    if isinstance(spec, ChoiceParameter):
        return st.sampled_from(spec.choices)
    return st.floats(spec.minimum, spec.maximum, allow_nan=False, allow_infinity=False)


def _holds_parts(hint: Any) -> bool:
    if isinstance(hint, type):
        return hasattr(hint, "__dataclass_fields__")
    return any(_holds_parts(a) for a in get_args(hint) if a is not NoneType and get_origin(hint) is not Literal)


def _needs_parts(cls: type) -> bool:
    hints = hints_of(cls)
    return any(f.default is MISSING and _holds_parts(hints[f.name]) for f in fields(cls))
