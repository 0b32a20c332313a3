"""Checks that no coordinate invented by a model enters a plan.

The plan language names places and has no element for a position, so most attempts fail schema validation. The free
names of a draft (labels, readings, zones, ids) and tests of a site's own coordinate columns remain; both may contain
only values from the request, the site or the profile.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import fields
from typing import Any

from fieldhand.places import selectors
from fieldhand.planning.llm.review import AnswerProblem
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Site
from fieldhand.task import conditions, plan
from fieldhand.task.codec import TaskDraft
from fieldhand.task.plan import Node
from fieldhand.terms import Value

#: Usual names of coordinate columns.
_COLUMNS = frozenset(
    {
        *("lat", "latitude", "lon", "long", "lng", "longitude", "x", "y", "utm x", "utm y", "east", "north"),
        *("easting", "northing", "coordinate", "coordinates", "position", "gps", "geometry", "wkt", "point"),
    }
)
_DECIMAL = re.compile(r"\d+[.,]\d+|\d+\s*\N{DEGREE SIGN}")
#: A single decimal number in a sentence may be a conversion; a pair of precise ones is a position.
_PAIR = re.compile(r"[-+]?\d{1,3}\.\d{2,}\s*\N{DEGREE SIGN}?\s*[NSEW]?[\s,;/]+[-+]?\d{1,3}\.\d{2,}")


def coordinates(draft: TaskDraft, request: str, site: Site) -> tuple[AnswerProblem, ...]:
    """Return a problem for each literal coordinate of a draft that the request does not contain."""
    found = [problem for node in plan.walk(draft.plan) for problem in _of_node(node, request, site)]
    for sentence in draft.assumptions:
        pairs = [pair for pair in _PAIR.findall(sentence) if pair not in request]
        found += [_problem(pair, "an assumption", "") for pair in pairs]
    return tuple(dict.fromkeys(found))


def _of_node(node: Node, request: str, site: Site) -> Iterator[AnswerProblem]:
    for owner in _parts(node):
        for field in fields(owner):
            value = getattr(owner, field.name)
            if not isinstance(value, str) or field.name in ("id", "action", "quantity", "unit"):
                continue
            number = _DECIMAL.search(value)
            if number and number[0] not in request and not _is_of_site(value, site):
                yield _problem(number[0], f"the {field.name.replace('_', ' ')} {value[:60]!r}", node.id)
        if isinstance(owner, selectors.Where | conditions.TreeHas) and phrase(owner.attribute) in _COLUMNS:
            yield from _of_column(owner.attribute, owner.value, request, node.id)


def _parts(node: Node) -> Iterator[Any]:
    """Yield the node and every part of its selector and condition."""
    yield node
    selector, condition = node.selector, node.tested
    yield from selector.walk() if selector is not None else ()
    yield from conditions.walk(condition) if condition is not None else ()


def _of_column(attribute: str, value: Value, request: str, where: str) -> Iterator[AnswerProblem]:
    numbers = {float(text) for text in re.findall(r"[-+]?\d+(?:\.\d+)?", request)}
    if isinstance(value, bool) or (isinstance(value, float | int) and value in numbers):
        return
    if isinstance(value, str) and value.lower() in request.lower():
        return
    yield _problem(str(value)[:40], f"a test of the column {attribute[:40]!r}", where)


def _is_of_site(value: str, site: Site) -> bool:
    """Return True if a name with digits belongs to the site ("zone 3.5", "tree 12.4")."""
    return (
        value in site.by_id
        or any(value == zone.name for zone in site.zones)
        or any(value in values for values in site.attributes.values())
        or value in site.attributes
        or any(value in (row.name, block.name) for block in site.planting.blocks for row in block.rows)
    )


def _problem(number: str, place: str, where: str) -> AnswerProblem:
    message = f"{place} holds {number!r}, which reads as a coordinate and is not in the request: name the place instead"
    return AnswerProblem(kind="coordinate", message=message, where=where)
