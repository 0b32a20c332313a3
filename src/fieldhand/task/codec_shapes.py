"""XML form of every part of a Task, derived from the dataclasses.

A class becomes an element (``AnyOrder`` is ``any-order``); a plain field becomes an attribute (``at_most`` is
``at-most``); a field with other parts becomes a child element of that name around them, or, if it is the only such
field of the class, the parts become direct children. Fields equal to their default are omitted. Whatever depends on one
action or one quantity goes into an element of that name (``<co2 value="400" unit="ppm"/>``), so that a schema can
restrict its values. Codec and schema both use these shapes: a new selector, condition or plan node needs no change in
either.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields, replace
from functools import cache
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from fieldhand.places.filters.not_visited import NotVisited
from fieldhand.places.picks.random_sample import RandomSample
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import SELECTORS
from fieldhand.places.sources.union_of import UnionOf
from fieldhand.task.conditions import Between, Compare, Condition, Level
from fieldhand.task.frames import Budget, Command, Composition, Constraints, FaultedExit, Task, Then
from fieldhand.task.plan import Act, InOrder, Node, OptionalStep, Span, StopMission, WorkAlong
from fieldhand.task.timing import Timing
from fieldhand.task.watches import Watch, WatchCondition
from fieldhand.task.ways import Avoid, OnlyGate, SlowNear
from fieldhand.terms import Value

NAMESPACE = "urn:fieldhand:task:1"

AttributeKind = Literal["text", "integer", "number", "flag", "choice", "choices", "spans", "value"]
ChildKind = Literal["text", "texts", "inline", "one", "many"]


@dataclass(frozen=True, kw_only=True)
class ExitsElement:
    """The ``<exits>`` of a Task: where the robot goes when the plan is done, and on each fault."""

    nominal: Then = "return_to_end"
    nominal_said: tuple[Span, ...] = ()
    faulted: tuple[FaultedExit, ...] = ()


@dataclass(frozen=True, kw_only=True)
class TaskComposition:
    """The ``<task-composition>`` element: plan, exits and watches. XML stand-in for ``frames.Composition``."""

    plan: Node
    exits: ExitsElement = ExitsElement()
    watches: tuple[Watch, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ConstraintsElement:
    """Limits of the whole mission: budgets, then places to avoid, gates to use, slow places; reserve and speed.

    Attributes:
        reserve_percent: Charge to leave at the end; None for the profile's reserve.
        speed_m_s: Maximum speed; None for the robot's.
        return_percent: Charge at which the robot drives home, wherever it is; None for the profile's.
        recharge: Charge at the site's charger whenever the work needs it, and go on.
        recharge_below_percent: Charge below which it goes to the charger although the next visit would still fit.
        recharge_until_percent: Charge up to which it charges; None for the profile's.
        recharge_at_most: Maximum number of charges; None for any number.
    """

    parts: tuple[Budget | Avoid | OnlyGate | SlowNear, ...] = ()
    reserve_percent: float | None = None
    reserve_said: tuple[Span, ...] = ()
    speed_m_s: float | None = None
    return_percent: float | None = None
    recharge: bool = False
    recharge_below_percent: float | None = None
    recharge_until_percent: float | None = None
    recharge_at_most: int | None = None
    energy_said: tuple[Span, ...] = ()


#: Attribute in which a draft quotes words of the request, and the ranges that replace it in each element (``said`` in
#: nodes and budgets).
QUOTES = "words"
QUOTED = {"command": "no-part", "exits": "nominal-said", "constraints": "reserve-said"}
#: Elements not named after their field.
_NAMES: dict[tuple[type, str], str] = {
    (Task, "composition"): "task-composition",
    (Command, "variables"): "state",
    (Task, "earlier"): "earlier-missions",
}
#: Elements that are not named after their class: their names are part of the file format.
_ELEMENT_NAMES: dict[type, str] = {
    FaultedExit: "faulted",
    ExitsElement: "exits",
    ConstraintsElement: "constraints",
    InOrder: "sequence",
    OptionalStep: "optional",
    StopMission: "stop",
    NotVisited: "other",
    RandomSample: "random",
    UnionOf: "union",
}
#: Fields with text of any length, written as elements.
_TEXTS = {(Command, "request"), (Command, "read_as"), (Command, "assumptions"), (Command, "warnings")}
#: Fields that depend on the quantity, written into its element.
_OF_QUANTITY = ("value", "low", "high", "unit", "level")
#: Fields without a default that a draft may omit, since ``task.build.make_task`` derives them.
DRAFT_DEFAULTS: dict[tuple[type, str] | str, Any] = {
    "id": "",
    (Command, "request"): "",
    (Task, "command"): Command(request=""),
}


@dataclass(frozen=True, kw_only=True)
class Attribute:
    """A field written as an attribute.

    Attributes:
        choices: Allowed words, where the kind is ``choice`` or ``choices``.
        default: Default value; ``MISSING`` if the attribute is required.
    """

    field: str
    name: str
    kind: AttributeKind
    choices: tuple[str, ...] = ()
    default: Any = MISSING


@dataclass(frozen=True, kw_only=True)
class Child:
    """A field written as child elements.

    Attributes:
        options: Classes allowed inside; empty for text.
        direct: The parts are direct children, without an element named after the field around them.
    """

    field: str
    name: str
    kind: ChildKind
    options: tuple[type, ...] = ()
    default: Any = MISSING
    direct: bool = False


@dataclass(frozen=True, kw_only=True)
class NamedElement:
    """A child element named after an action, a quantity or an event, with everything that depends on it.

    Attributes:
        attributes: Attributes that depend on the quantity or event. An action's parameters are not listed: only a
            profile defines them.
        optional: The element may be omitted.
    """

    field: str
    of: Literal["action", "quantity", "event", "implement"]
    attributes: tuple[Attribute, ...] = ()
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Shape:
    """XML form of one class. ``attributes`` and ``children`` follow the order of its fields."""

    cls: type
    element: str
    attributes: tuple[Attribute, ...]
    children: tuple[Child, ...]
    head: NamedElement | None = None


#: Attributes of ``<constraints>`` about recharging, which have the names of the fields of Constraints.
_ENERGY = (
    "return_percent",
    "recharge",
    "recharge_below_percent",
    "recharge_until_percent",
    "recharge_at_most",
    "energy_said",
)

#: Classes with a stand-in that XML groups differently, and the conversions to and from it.
SURROGATES: dict[type, tuple[type, Callable[[Any], Any], Callable[[Any], Any]]] = {
    Composition: (
        TaskComposition,
        lambda c: TaskComposition(
            plan=c.plan,
            exits=ExitsElement(nominal=c.nominal, nominal_said=c.nominal_said, faulted=c.faulted),
            watches=c.watches,
        ),
        lambda t: Composition(
            plan=t.plan,
            nominal=t.exits.nominal,
            nominal_said=t.exits.nominal_said,
            faulted=t.exits.faulted,
            watches=t.watches,
        ),
    ),
    Constraints: (
        ConstraintsElement,
        lambda c: ConstraintsElement(
            parts=(*c.budgets, *c.avoid, *c.only_gates, *c.slow),
            reserve_percent=c.reserve_percent,
            reserve_said=c.reserve_said,
            speed_m_s=c.speed_m_s,
            **{name: getattr(c, name) for name in _ENERGY},
        ),
        lambda t: Constraints(
            budgets=tuple(part for part in t.parts if isinstance(part, Budget)),
            reserve_percent=t.reserve_percent,
            reserve_said=t.reserve_said,
            speed_m_s=t.speed_m_s,
            avoid=tuple(part for part in t.parts if isinstance(part, Avoid)),
            only_gates=tuple(part for part in t.parts if isinstance(part, OnlyGate)),
            slow=tuple(part for part in t.parts if isinstance(part, SlowNear)),
            **{name: getattr(t, name) for name in _ENERGY},
        ),
    ),
}

#: Families of classes whose members are interchangeable in a document, by name.
FAMILIES: dict[tuple[type, ...], str] = {
    SELECTORS: "selector",
    get_args(Condition): "condition",
    get_args(WatchCondition): "watched",
    get_args(Node): "node",
    get_args(Timing): "timing",
}


def element_name(cls: type) -> str:
    """Return the element name of a class: ``GoTo`` is ``go-to``."""
    return _ELEMENT_NAMES.get(cls) or re.sub(r"(?<!^)(?=[A-Z])", "-", cls.__name__).lower()


def hints_of(cls: type) -> dict[str, Any]:
    """Return the type of each field, with the mutually recursive families resolved."""
    tests = {"Compare": Compare, "Between": Between, "Level": Level}
    return get_type_hints(cls, localns={"Node": Node, "Selector": Selector, "Condition": Condition, **tests})


@cache
def shape_of(cls: type) -> Shape:
    """Return the XML form of a class, or that of its stand-in."""
    if cls in SURROGATES:
        return shape_of(SURROGATES[cls][0])
    hints = hints_of(cls)
    names = [f.name for f in fields(cls)]
    of_head = _OF_QUANTITY if {"quantity", "event"} & set(names) else ()
    in_head = ("action", "parameters") if cls in (Act, WorkAlong) else ("quantity", "event")
    attributes: list[Attribute] = []
    of_quantity: list[Attribute] = []
    children: list[Child] = []
    for field in fields(cls):
        name = _NAMES.get((cls, field.name), field.name.replace("_", "-"))
        # A plan that is built in Python may leave its ids empty: make_task assigns them. A document states them.
        hint, default = hints[field.name], MISSING if field.name == "id" else field.default
        if field.name in in_head:
            continue
        if (cls, field.name) in _TEXTS:
            kind: ChildKind = "text" if hint is str else "texts"
            children.append(Child(field=field.name, name=name, kind=kind, default=default))
        elif attribute := _attribute(field.name, name, hint, default):
            (of_quantity if field.name in of_head else attributes).append(attribute)
        else:
            children.append(_child(field.name, name, hint, default))
    head = _head(cls, names, tuple(of_quantity))
    if head is None and len(children) == 1 and children[0].kind in ("one", "many"):
        only = children[0]
        children = [replace(only, direct=True)]
    return Shape(cls=cls, element=element_name(cls), attributes=tuple(attributes), children=tuple(children), head=head)


def _head(cls: type, names: list[str], of_quantity: tuple[Attribute, ...]) -> NamedElement | None:
    if cls is Act:
        return NamedElement(field="action", of="action")
    if "event" in names:
        return NamedElement(field="event", of="event", attributes=of_quantity)
    if cls is WorkAlong:
        return NamedElement(field="action", of="implement", optional=True)
    return NamedElement(field="quantity", of="quantity", attributes=of_quantity) if "quantity" in names else None


def _without_none(hint: Any) -> Any:
    if get_origin(hint) in (Union, UnionType) and NoneType in get_args(hint):
        rest = tuple(a for a in get_args(hint) if a is not NoneType)
        return rest[0] if len(rest) == 1 else Union[rest]  # noqa: UP007  there is no | over a tuple
    return hint


def _attribute(field: str, name: str, hint: Any, default: Any) -> Attribute | None:
    """Return the attribute of a plain field; None for a field with other parts."""
    hint = _without_none(hint)
    plain: dict[Any, AttributeKind] = {str: "text", int: "integer", float: "number", bool: "flag", Value: "value"}
    plain[tuple[Span, ...]] = "spans"
    if hint in plain:
        return Attribute(field=field, name=name, kind=plain[hint], default=default)
    if get_origin(hint) is Literal:
        return Attribute(field=field, name=name, kind="choice", choices=get_args(hint), default=default)
    if get_origin(hint) is tuple and get_origin(get_args(hint)[0]) is Literal:
        words = get_args(get_args(hint)[0])
        return Attribute(field=field, name=name, kind="choices", choices=words, default=default)
    return None


def _child(field: str, name: str, hint: Any, default: Any) -> Child:
    hint = _without_none(hint)
    many = get_origin(hint) is tuple
    inner = get_args(hint)[0] if many else hint
    options: tuple[type, ...] = (inner,)
    if inner is Selector:
        options = SELECTORS
    elif get_origin(inner) in (Union, UnionType):
        options = get_args(inner)
    kind: ChildKind = "many" if many else "one" if options != (inner,) else "inline"
    return Child(field=field, name=name, kind=kind, options=options, default=default)


def all_shapes() -> dict[type, Shape]:
    """Return the shape of every class that can occur in a Task, the Task first."""
    found: dict[type, Shape] = {}

    def visit(cls: type) -> None:
        if cls not in found:
            found[cls] = shape_of(cls)
            for child in found[cls].children:
                for option in child.options:
                    visit(option)

    visit(Task)
    return found
