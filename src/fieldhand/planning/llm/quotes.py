"""Locate the words that a draft quotes in the request as character ranges, since a model cannot count characters.

Case and white space are ignored. Words that occur several times refer to the first occurrence not covered by another
quote, or to the last one if all are covered: of "check CO2 ... check the vines", "check" beside "check CO2" refers
to the second.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fieldhand.task.codec_shapes import QUOTED, QUOTES
from fieldhand.task.codec_xml import line_of
from fieldhand.task.plan import Span

if TYPE_CHECKING:
    from lxml.etree import _Element

#: Separator between the quotes of one attribute.
_BETWEEN = "|"


def place_quotes(root: _Element, request: str) -> list[tuple[str, str]]:
    """Replace the quotes in ``root`` by ranges, and remove ranges that the model wrote.

    Returns:
        Location and description of each quote that the request does not contain.
    """
    quotes: list[tuple[_Element, str, list[Span]]] = []
    for element in root.iter("*"):
        for attribute in ("said", "at-said", *QUOTED.values()):
            element.attrib.pop(attribute, "")
        quoted = str(element.attrib.pop(QUOTES, ""))
        found = ((quote, _places(quote, request)) for quote in map(str.strip, quoted.split(_BETWEEN)) if quote)
        quotes += [(element, quote, places) for quote, places in found]
    wrong = [
        (
            f"line {line_of(element)} <{_name(element)}>",
            f"the request does not say {quote!r}: quote its words as they stand there",
        )
        for element, quote, places in quotes
        if not places
    ]
    said: dict[_Element, list[Span]] = {}
    taken: list[Span] = [places[0] for _, _, places in quotes if len(places) == 1]
    for element, _, places in quotes:
        if places:
            span = places[0] if len(places) == 1 else next((p for p in places if not _covered(p, taken)), places[-1])
            taken.append(span)
            said.setdefault(element, []).append(span)
    for element, spans in said.items():
        element.set(QUOTED.get(_name(element), "said"), " ".join(f"{start}-{end}" for start, end in spans))
    return wrong


def _name(element: _Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _covered(place: Span, taken: list[Span]) -> bool:
    """Return True if another quote already refers to these words."""
    return any(start <= place[0] and place[1] <= end for start, end in taken)


def _places(quote: str, request: str) -> list[Span]:
    """Return every occurrence of a quote, ignoring case and white space."""
    pattern = r"\s+".join(re.escape(word) for word in quote.split())
    places = [m.span() for m in re.finditer(rf"(?<!\w){pattern}(?!\w)", request, re.IGNORECASE)]
    return places or [m.span() for m in re.finditer(pattern, request, re.IGNORECASE)]
