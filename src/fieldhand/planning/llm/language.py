"""Description of the plan language for a model: the form and meaning of every element.

The description is a compact rendering of the draft schema. Forms come from :mod:`fieldhand.task.codec_shapes`, as the
schema does; meanings are the docstrings of the classes, so nothing is written twice. Parts of a draft that
``task.build`` derives (ids, goals, state, resources, spans) are omitted.
"""

from __future__ import annotations

import inspect
import re
from dataclasses import MISSING
from functools import cache
from typing import get_args

from fieldhand.errors import ModelError
from fieldhand.places.earlier.period import Period
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import SELECTORS
from fieldhand.task import plan
from fieldhand.task.codec_shapes import FAMILIES, Attribute, Child, Shape, all_shapes, element_name, shape_of
from fieldhand.task.conditions import Condition
from fieldhand.task.frames import Budget, Constraints, FaultedExit
from fieldhand.task.plan import Node
from fieldhand.task.timing import DayTime, Timing
from fieldhand.task.watches import Watch, WatchCondition
from fieldhand.task.ways import Avoid, OnlyGate, SlowNear

#: Letters that stand for any element of a family in the forms.
LETTERS = {"node": "N", "condition": "C", "selector": "S", "watched": "W"}

#: Attributes that only the program writes.
DERIVED = frozenset(
    {
        "id",
        "said",
        "at-said",
        "along-said",
        "reserve-said",
        "energy-said",
        "nominal-said",
        "no-part",
        "seed",
        "time-zone",
    }
)

_KINDS = {"text": "name", "integer": "int", "number": "number", "flag": "true", "value": "value"}

#: Sets of choices shared by many elements, by their abbreviation.
ABBREVIATED = {"SIDE": "north|east|south|west", "TEST": "lt|le|gt|ge|eq|ne"}


@cache
def describe_language() -> str:
    """Return the nodes, conditions, selectors, constraints and times, one element per paragraph.

    Raises:
        ModelError: Python runs with ``-OO``, which removes the docstrings that the description is made from.
    """
    if plan.__doc__ is None:
        raise ModelError(
            "the plan language cannot be described without docstrings",
            where="python -OO",
            advice="run Python without -OO",
        )
    sections = (
        ("Nodes (N), what is done", get_args(Node)),
        ("Conditions (C), what an if or an until tests", get_args(Condition)),
        ("Selectors (S), how places are named", (*SELECTORS, Period)),
        ("Constraints", (Constraints, Budget, Avoid, OnlyGate, SlowNear, FaultedExit)),
        ("Times, when the whole mission runs", (*get_args(Timing), DayTime)),
    )
    rendered = [
        f"## {title}\n" + "\n".join(_paragraph(shape_of(cls)) for cls in classes) for title, classes in sections
    ]
    short = "; ".join(f"{word} is {choices}" for word, choices in ABBREVIATED.items())
    return "\n\n".join([f"In these forms {short}.", *rendered])


@cache
def describe_watches() -> str:
    """Return the elements of watches, for a robot that detects events: one element per paragraph."""
    return "\n".join(_paragraph(shape_of(cls)) for cls in (Watch, *get_args(WatchCondition)))


def _paragraph(shape: Shape) -> str:
    """Return one element: its form, then its meaning."""
    return f"{_form(shape)}\n  {_meaning(shape)}"


def _form(shape: Shape) -> str:
    """Return the opening tag of an element with its children; the end tag is omitted to save tokens."""
    attributes = [_attribute(a) for a in shape.attributes if a.name not in DERIVED]
    inside = []
    if shape.head and shape.head.of == "action":
        inside.append("<ACTION/>")
    elif shape.head and shape.head.of == "implement":
        inside.append("[<ACTION/>]")
    elif shape.head:
        inside.append(f"<{' '.join([shape.head.of.upper(), *map(_attribute, shape.head.attributes)])}/>")
    inside += [_child(child) for child in shape.children]
    opening = " ".join([shape.element, *attributes])
    return f"<{opening}>{' '.join(inside)}" if inside else f"<{opening}/>"


def _attribute(attribute: Attribute) -> str:
    match attribute.kind:
        case "choice":
            value = "|".join(attribute.choices)
            for word, choices in ABBREVIATED.items():
                value = value.replace(choices, word)
        case "choices":
            value = f"some of: {' '.join(attribute.choices)}"
        case kind:
            value = _KINDS.get(kind, kind)
    if attribute.kind == "integer" and isinstance(attribute.default, int) and attribute.default:
        value = str(attribute.default)
    written = f'{attribute.name}="{value}"'
    return written if attribute.default is MISSING else f"[{written}]"


def _child(child: Child) -> str:
    letter = LETTERS.get(FAMILIES.get(child.options, ""), "")
    letter = f"{letter}{_unless_given(child)}"
    between = "|" if child.kind == "one" else ""
    part = letter or between.join(f"<{element_name(option)}/>" for option in child.options)
    many = f"{part}..." if child.kind == "many" else part
    whole = many if child.direct else f"<{child.name}>{many}</{child.name}>"
    if child.kind == "inline":  # the element itself has the attributes of that class
        (option,) = child.options
        whole = part if part == f"<{child.name}/>" else f"<{child.name} {element_name(option).upper()}/>"
    if child.name == "of" and not child.direct:
        whole = "OF"
    return whole if child.default is MISSING else f"[{whole}]"


def _unless_given(child: Child) -> str:
    """Return the selector assumed if a child is omitted, unless that is every tree."""
    if child.name == "of" or child.default is MISSING or not isinstance(child.default, Selector):
        return ""
    name = f" = {child.name}" if child.direct else ""
    return f"{name} (<{element_name(type(child.default))}/>)"


def _meaning(shape: Shape) -> str:
    """Return the docstring on one line, followed by its attributes."""
    text, _, attributes = inspect.cleandoc(shape.cls.__doc__ or "").partition("\n\nAttributes:\n")
    if shape.cls in get_args(Node):  # how it is carried out is for whoever does it
        text = text.partition("\n\n")[0]
    shown = {a.field for a in shape.attributes if a.name not in DERIVED} | {child.field for child in shape.children}
    attributes = "\n".join(line for line in _entries(attributes) if _named(line) & shown)
    attributes = re.sub(r"(?m)^ {4}(\w+(?:, \w+)*):", lambda m: f"{m[1].replace('_', '-')}:", attributes)
    return _plain(f"{text} {attributes}")


def _entries(attributes: str) -> list[str]:
    """Return the entries of a docstring's Attributes section, with continuation lines joined."""
    return re.split(r"\n(?= {4}\w)", attributes) if attributes else []


def _named(entry: str) -> set[str]:
    return set(re.findall(r"\w+", entry.partition(":")[0]))


def _plain(text: str) -> str:
    """Return a docstring on one line, without reStructuredText markup and with code converted to XML."""
    return " ".join(re.sub(r"(?::\w+:`[~.\w]*?(\w+)`)|``([^`]+)``", _as_xml, text).split())


def _as_xml(code: re.Match[str]) -> str:
    """Return ``Bound(label=...)`` as its element, ``at_most`` as its attribute, and anything else unchanged."""
    written = code[1] or code[2]
    name, _, keyword = written.rstrip(")").partition("(")
    if name in _elements():
        attribute = f' {keyword.removesuffix("=...")}="..."' if keyword else ""
        return f"<{_elements()[name]}{attribute}>"
    return f"`{_attributes().get(written, written)}`"


@cache
def _elements() -> dict[str, str]:
    return {cls.__name__: shape.element for cls, shape in all_shapes().items()}


@cache
def _attributes() -> dict[str, str]:
    return {a.field: a.name for shape in all_shapes().values() for a in shape.attributes}
