"""The words of the request that a draft quotes, found again as ranges of characters: a model cannot count those.

A quote is found whatever its case and white space. Words that stand there several times mean the first place that no
other quote covers, and the last one when all are covered: of "check CO2 ... check the vines", "check" beside "check
CO2" is the second.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fieldhand.task.codec_shapes import QUOTED, QUOTES
from fieldhand.task.codec_xml import line_of
from fieldhand.task.plan import Span

if TYPE_CHECKING:
    from lxml.etree import _Element

#: Between two quotes of one attribute.
_BETWEEN = "|"


def place_quotes(root: _Element, request: str) -> list[tuple[str, str]]:
    """Put ranges in place of quotes, and take away ranges that the model wrote. ``root`` is changed.

    Returns:
        Where and what, for each quote that is not in the request.
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
    """Return True if another quote means these words."""
    return any(start <= place[0] and place[1] <= end for start, end in taken)


def _places(quote: str, request: str) -> list[Span]:
    """Return everywhere that a quote stands, whatever its case and white space."""
    pattern = r"\s+".join(re.escape(word) for word in quote.split())
    places = [m.span() for m in re.finditer(rf"(?<!\w){pattern}(?!\w)", request, re.IGNORECASE)]
    return places or [m.span() for m in re.finditer(pattern, request, re.IGNORECASE)]
