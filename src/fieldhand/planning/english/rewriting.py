"""Terms as a text of their kinds, so that a regular expression can say which of them belong together."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from fieldhand.planning.english.tokens import Term

#: What a run of terms becomes, given the term before it; None to leave it as it is.
Make = Callable[[list[Term], Term | None], list[Term] | None]
Rule = tuple[re.Pattern[str], Make]
#: Kinds whose word matters besides; its spaces are written as underscores.
_SPELT = frozenset({"EACH", "AT", "GO", "OTHER", "NUM", "AND", "THEN", "PLACE", "FINISH"})


def rewritten(terms: list[Term], rules: tuple[Rule, ...]) -> list[Term]:
    """The terms with what the rules find replaced, rule after rule."""
    for pattern, make in rules:
        code, places = coded(terms)
        for match in reversed(list(pattern.finditer(code))):
            if match.end() == match.start():
                continue
            first, last = places[match.start()], places[match.end() - 1]
            made = make(terms[first : last + 1], terms[first - 1] if first else None)
            if made is not None:
                terms = [*terms[:first], *made, *terms[last + 1 :]]
    return terms


def coded(terms: list[Term]) -> tuple[str, Mapping[int, int]]:
    """The kinds of the terms as text, and which term each character belongs to."""
    code = ""
    places: dict[int, int] = {}
    for index, term in enumerate(terms):
        piece = f"<{term.kind}{_detail(term)}>"
        places.update(dict.fromkeys(range(len(code), len(code) + len(piece)), index))
        code += piece
    return code, places


def _detail(term: Term) -> str:
    match term.kind:
        case "CMP":
            return f".{term.value[0]}"
        case "AMOUNT":
            return f".{term.value.unit}"
        case "ORD":
            return f".{term.value}"
        case "DIR" | "MOST":
            return f".{term.value}"
        case kind if kind in _SPELT:
            return "." + "_".join(re.findall(r"[\w']+", term.text.lower()))
        case _:
            return ""


def merged(terms: list[Term], kind: str, value: Any = None, plural: bool = False) -> Term:
    """Several terms as one of another kind."""
    ordered = sorted(terms, key=lambda t: (t.start, t.end))
    text = " ".join(t.text for t in ordered if t.text)
    start, end = ordered[0].start, max(t.end for t in ordered)
    return Term(kind=kind, text=text, start=start, end=end, value=value, plural=plural)


def silent(kind: str, at: int, like: Term | None = None) -> Term:
    """A term that no word says."""
    if like is not None:
        return replace(like, kind=kind, text="", start=at, end=at, plural=False)
    return Term(kind=kind, text="", start=at, end=at)
