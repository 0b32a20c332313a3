"""Build the schema of Task documents from the shapes of the dataclasses and a robot's capabilities."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from dataclasses import MISSING, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, get_args

from fieldhand.task.capabilities import Capabilities, ChoiceParameter, NumberParameter
from fieldhand.task.codec_shapes import (
    DRAFT_DEFAULTS,
    FAMILIES,
    NAMESPACE,
    QUOTES,
    Attribute,
    Child,
    Shape,
    all_shapes,
    element_name,
    shape_of,
)
from fieldhand.task.codec_text import INTEGER, NUMBER, SPANS, number_text
from fieldhand.task.plan import Node

if TYPE_CHECKING:
    from lxml.etree import _Element

_XS = "http://www.w3.org/2001/XMLSchema"

#: Restrictions beyond the type of a field: XSD facets by field name, for every class.
_FACETS: dict[str, dict[str, str]] = {
    "count": {"minInclusive": "1", "maxInclusive": "1000"},
    "times": {"minInclusive": "1", "maxInclusive": "1000"},
    "at_most": {"minInclusive": "1", "maxInclusive": "1000000"},
    "at_least": {"minInclusive": "2", "maxInclusive": "1000"},
    "expected": {"minInclusive": "0"},
    "distance_m": {"minInclusive": "0"},
    "DoneEarlier.at_least": {"minInclusive": "1", "maxInclusive": "1000"},
    "last_missions": {"minInclusive": "1", "maxInclusive": "1000"},
    "last_hours": {"minInclusive": "1", "maxInclusive": "100000"},
    "last_days": {"minInclusive": "1", "maxInclusive": "100000"},
    "last_months": {"minInclusive": "1", "maxInclusive": "1200"},
    "laps": {"minInclusive": "1", "maxInclusive": "100"},
    "limit": {"minExclusive": "0"},
    "failure_probability": {"minExclusive": "0", "maxExclusive": "1"},
    "reserve_percent": {"minInclusive": "0", "maxExclusive": "100"},
    "return_percent": {"minExclusive": "0", "maxExclusive": "100"},
    "recharge_below_percent": {"minExclusive": "0", "maxExclusive": "100"},
    "recharge_until_percent": {"minExclusive": "0", "maxInclusive": "100"},
    "recharge_at_most": {"minInclusive": "1", "maxInclusive": "1000"},
    "until_percent": {"minExclusive": "0", "maxInclusive": "100"},
    "BatteryBelow.percent": {"minExclusive": "0", "maxExclusive": "100"},
    "duration_s": {"minExclusive": "0", "maxInclusive": "604800"},
    "reward": {"minInclusive": "0"},
    "every_min": {"minInclusive": "0", "maxInclusive": "1440"},
    "every_days": {"minInclusive": "1", "maxInclusive": "366"},
    "late_min": {"minInclusive": "0", "maxInclusive": "10080"},
    "done_by_min": {"minInclusive": "0", "maxInclusive": "10080"},
    "offset_min": {"minInclusive": "-1440", "maxInclusive": "1440"},
    "seconds": {"minExclusive": "0", "maxInclusive": "86400"},
    "speed_m_s": {"minInclusive": "0.01", "maxInclusive": "20"},
    "at_most_s": {"minInclusive": "1", "maxInclusive": "86400"},
}


def _xs(parent: _Element, tag: str, **attributes: str) -> _Element:
    from lxml import etree

    return etree.SubElement(parent, f"{{{_XS}}}{tag}", attributes)


@dataclass(frozen=True, kw_only=True)
class SchemaBuilder:
    """Builds one schema."""

    capabilities: Capabilities
    draft: bool

    @cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """Return the shapes of every class that this robot can use: testing a level needs a quantity that has one."""
        return tuple(s for s in all_shapes().values() if s.head is None or s.head.optional or self.heads(s))

    def usable(self, options: Iterable[type]) -> list[type]:
        """Return those classes that this robot can use."""
        known = {s.cls for s in self.shapes}
        return [o for o in options if shape_of(o).cls in known]

    def heads(self, shape: Shape) -> list[str]:
        """Return the actions, quantities or events allowed in an element."""
        if shape.head is None:
            return []
        if shape.head.of == "event":
            measured = bool(shape.head.attributes)
            return [name for name, e in self.capabilities.events.items() if (e.unit if measured else e.holds)]
        if shape.head.of != "quantity":
            is_implement = shape.head.of == "implement"
            return [name for name, a in self.capabilities.actions.items() if a.is_implement == is_implement]
        needs_level = any(a.field == "level" for a in shape.head.attributes)
        return [name for name, q in self.capabilities.quantities.items() if q.levels or not needs_level]

    def root(self) -> _Element:
        """Return the whole schema."""
        from lxml import etree

        nsmap = {"xs": _XS, "f": NAMESPACE}
        schema = etree.Element(
            f"{{{_XS}}}schema", nsmap=nsmap, targetNamespace=NAMESPACE, elementFormDefault="qualified"
        )
        self.task_element(schema)
        for options, family in FAMILIES.items():
            group = _xs(_xs(schema, "group", name=family), "choice")
            for option in self.usable(options):
                _xs(group, "element", name=element_name(option), type=f"f:{type_name(option)}")
        for shape in self.shapes:
            self.complex_type(schema, shape)
        self.simple_types(schema)
        return schema

    def task_element(self, schema: _Element) -> None:
        """Add the root element: ids are unique, and goals and state variables name existing nodes."""
        task = _xs(schema, "element", name="task", type="f:Task")
        nodes = "|".join(f".//f:{element_name(n)}" for n in self.usable(get_args(Node)))
        for name, selector in (("node-id", nodes), ("goal-id", ".//f:goal")):
            kind = "key" if name == "node-id" and not self.draft else "unique"
            unique = _xs(task, kind, name=name)
            _xs(unique, "selector", xpath=selector)
            _xs(unique, "field", xpath="@id")
        for name in () if self.draft else ("goal", "variable"):
            keyref = _xs(task, "keyref", name=f"{name}-node", refer="f:node-id")
            _xs(keyref, "selector", xpath=f".//f:{name}")
            _xs(keyref, "field", xpath="@node")

    def complex_type(self, schema: _Element, shape: Shape) -> None:
        """Add the type of the element of one class."""
        made = _xs(schema, "complexType", name=type_name(shape.cls))
        documented = _xs(_xs(made, "annotation"), "documentation")
        documented.text = " ".join((inspect.getdoc(shape.cls) or "").replace("``", "'").split())
        if shape.head:
            self.head_content(made, shape)
        elif shape.children and shape.children[0].direct:
            self.parts(made, shape.children[0])
        elif shape.children:
            content = _xs(made, "all")
            for child in shape.children:
                self.child(content, shape, child)
        for attribute in self.attributes(shape):
            self.attribute(made, shape.cls, attribute)

    def attributes(self, shape: Shape) -> tuple[Attribute, ...]:
        """Return the attributes of an element. A draft quotes words of the request where a Task has ranges."""
        quotes = Attribute(field=QUOTES, name=QUOTES, kind="text", default="")
        quotable = self.draft and any(a.kind == "spans" for a in shape.attributes)
        return (*shape.attributes, quotes) if quotable else shape.attributes

    def head_content(self, made: _Element, shape: Shape) -> None:
        """Add one action or quantity; its sibling ``at`` may come before or after."""
        if not shape.children:
            self.head_choice(made, shape)
            return
        if not self.heads(shape):
            only = _xs(made, "sequence")
            for child in shape.children:
                self.child(only, shape, child)
            return
        if len(shape.children) > 1 and all(child.default is not MISSING for child in shape.children):
            self.any_order(made, shape, (None, *shape.children), needs_head=True)
            return
        either = _xs(made, "choice")
        after = _xs(either, "sequence")
        self.head_choice(after, shape)
        before = _xs(either, "sequence")
        for child in shape.children:
            self.child(after, shape, child)
            self.child(before, shape, child, required=True)
        self.head_choice(before, shape, optional=shape.head is not None and shape.head.optional)

    def any_order(self, parent: _Element, shape: Shape, parts: tuple[Child | None, ...], *, needs_head: bool) -> None:
        """Add parts that may be left out, in any order, and the element of the quantity (None), which is required."""
        either = _xs(parent, "choice", **({} if needs_head else {"minOccurs": "0"}))
        for part in parts:
            once = _xs(either, "sequence")
            if part is None:
                self.head_choice(once, shape)
            else:
                self.child(once, shape, part, required=True)
            rest = tuple(other for other in parts if other is not part)
            if rest:
                self.any_order(once, shape, rest, needs_head=needs_head and part is not None)

    def head_choice(self, parent: _Element, shape: Shape, *, optional: bool = False) -> None:
        """Add an element for each action or quantity, with the attributes that depend on it."""
        choice = _xs(parent, "choice", **({"minOccurs": "0"} if optional else {}))
        for name in self.heads(shape):
            made = _xs(_xs(choice, "element", name=name), "complexType")
            if shape.head and shape.head.of == "quantity":
                quantity = self.capabilities.quantities[name]
                for attribute in shape.head.attributes:
                    words = {"unit": (quantity.unit,), "level": quantity.levels}.get(attribute.field)
                    self.attribute(made, shape.cls, attribute, words=words)
                continue
            if shape.head and shape.head.of == "event":
                for attribute in shape.head.attributes:
                    unit = (self.capabilities.events[name].unit,) if attribute.field == "unit" else None
                    self.attribute(made, shape.cls, attribute, words=unit)
                continue
            for key, parameter in self.capabilities.actions[name].parameters.items():
                _parameter(_xs(made, "attribute", name=key), parameter)

    def child(self, content: _Element, shape: Shape, child: Child, *, required: bool = False) -> None:
        """Add the element of a field with other parts."""
        must = required or self.required(shape.cls, child.field, child.default)
        least = {} if must else {"minOccurs": "0"}
        if child.kind == "text":
            _xs(content, "element", name=child.name, type="xs:string", **least)
        elif child.kind == "inline":
            option = shape_of(child.options[0]).cls
            _xs(content, "element", name=child.name, type=f"f:{type_name(option)}", **least)
        else:
            made = _xs(_xs(content, "element", name=child.name, **least), "complexType")
            self.parts(made, child)

    def parts(self, made: _Element, child: Child) -> None:
        """Add the content of an element with one part or several."""
        must = child.default is MISSING or (child.kind == "one" and not child.direct)
        occurs = {
            "minOccurs": "1" if must else "0",
            "maxOccurs": "unbounded" if child.kind in ("many", "texts") else "1",
        }
        inside = _xs(made, "sequence")
        if child.kind == "texts":
            _xs(inside, "element", name=child.name.removesuffix("s"), type="xs:string", **occurs)
        elif child.options in FAMILIES:
            _xs(inside, "group", ref=f"f:{FAMILIES[child.options]}", **occurs)
        elif len(child.options) == 1:
            for option in self.usable(child.options):
                _xs(inside, "element", name=element_name(option), type=f"f:{type_name(option)}", **occurs)
        else:
            either = _xs(inside, "choice", **occurs)
            for option in self.usable(child.options):
                _xs(either, "element", name=element_name(option), type=f"f:{type_name(option)}")

    def required(self, cls: type, field: str, default: object) -> bool:
        """Return True if a field is required."""
        derived = self.draft and (field in DRAFT_DEFAULTS or (cls, field) in DRAFT_DEFAULTS)
        return default is MISSING and not derived

    def attribute(
        self, made: _Element, cls: type, attribute: Attribute, *, words: tuple[str, ...] | None = None
    ) -> None:
        """Add the attribute of a plain field."""
        use = {"use": "required"} if self.required(cls, attribute.field, attribute.default) else {}
        words = words or attribute.choices
        if attribute.field == "action" and attribute.default is MISSING:
            words = tuple(self.capabilities.actions)
        bounds = _FACETS.get(f"{cls.__name__}.{attribute.field}", _FACETS.get(attribute.field, {}))
        facets = bounds if attribute.kind in ("integer", "number") else {}
        if words and attribute.kind != "choices":
            _enumeration(_xs(made, "attribute", name=attribute.name, **use), words)
        elif attribute.kind == "choices":
            several = _xs(_xs(made, "attribute", name=attribute.name, **use), "simpleType")
            _enumeration(_xs(several, "list"), words)
        elif facets:
            simple = _xs(_xs(made, "attribute", name=attribute.name, **use), "simpleType")
            restriction = _xs(simple, "restriction", base=f"f:{attribute.kind}")
            for facet, bound in facets.items():
                _xs(restriction, facet, value=bound)
        else:
            base = "xs:boolean" if attribute.kind == "flag" else f"f:{attribute.kind}"
            _xs(made, "attribute", name=attribute.name, type=base, **use)
        if attribute.kind == "value":
            _enumeration(_xs(made, "attribute", name=f"{attribute.name}-as"), ("text",))

    def simple_types(self, schema: _Element) -> None:
        """Add the types of plain values. Numbers must be finite, whereas XSD's own types allow INF and NaN."""
        for name, base, facets in (
            ("text", "xs:string", {"minLength": "1"}),
            ("value", "xs:string", {}),
            ("integer", "xs:integer", {"pattern": INTEGER}),
            ("number", "xs:double", {"pattern": NUMBER}),
            ("spans", "xs:token", {"pattern": SPANS}),
        ):
            restriction = _xs(_xs(schema, "simpleType", name=name), "restriction", base=base)
            for facet, value in facets.items():
                _xs(restriction, facet, value=value)


def type_name(cls: type) -> str:
    """Return the XSD type of the element of a class: ``GoTo`` for ``<go-to>``."""
    return "".join(word.capitalize() for word in element_name(cls).split("-"))


def _enumeration(attribute: _Element, words: Iterable[str]) -> None:
    restriction = _xs(_xs(attribute, "simpleType"), "restriction", base="xs:token")
    for word in words:
        _xs(restriction, "enumeration", value=word)


def _parameter(attribute: _Element, parameter: NumberParameter | ChoiceParameter) -> None:
    if isinstance(parameter, ChoiceParameter):
        _enumeration(attribute, parameter.choices)
        return
    restriction = _xs(_xs(attribute, "simpleType"), "restriction", base="f:number")
    for facet, bound in (("minInclusive", parameter.minimum), ("maxInclusive", parameter.maximum)):
        if bound is not None:
            _xs(restriction, facet, value=number_text(bound))
