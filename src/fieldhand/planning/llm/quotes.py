"""The words of the request that a draft quotes, found again as ranges of characters: a model cannot count those.

A quote is found whatever its case and white space. Words that stand there several times are taken in their order: each
quote of them means the next place, and the last one again when they are used up.
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
    used: dict[str, int] = {}
    wrong: list[tuple[str, str]] = []
    for element in root.iter("*"):
        name = str(element.tag).rpartition("}")[2]
        for attribute in ("said", "at-said", *QUOTED.values()):
            element.attrib.pop(attribute, "")
        quoted = str(element.attrib.pop(QUOTES, ""))
        found: list[Span] = []
        for quote in filter(None, (part.strip() for part in quoted.split(_BETWEEN))):
            span = _find(quote, request, used)
            if span is None:
                where = f"line {line_of(element)} <{name}>"
                wrong.append((where, f"the request does not say {quote!r}: quote its words as they stand there"))
            else:
                found.append(span)
        if found:
            element.set(QUOTED.get(name, "said"), " ".join(f"{start}-{end}" for start, end in found))
    return wrong


def _find(quote: str, request: str, used: dict[str, int]) -> Span | None:
    """Where a quote stands; ``used`` counts how often each was asked for."""
    words = quote.split()
    pattern = r"\s+".join(re.escape(word) for word in words)
    places = [m.span() for m in re.finditer(rf"(?<!\w){pattern}(?!\w)", request, re.IGNORECASE)]
    places = places or [m.span() for m in re.finditer(pattern, request, re.IGNORECASE)]
    if not places:
        return None
    key = " ".join(words).lower()
    at = used.get(key, 0)
    used[key] = at + 1
    return places[min(at, len(places) - 1)]
