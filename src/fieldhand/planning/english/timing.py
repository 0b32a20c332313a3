"""Steps that are told in another order than that in which they are to be done: "but first", "before going back"."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from fieldhand.planning.english.kinds import VERBS
from fieldhand.planning.english.tokens import Term

_LINKS = frozenset({"COMMA", "AND", "THEN"})


def in_time(sentences: Iterable[list[Term]]) -> list[list[Term]]:
    """The sentences in the order in which they are to be done."""
    found: list[list[Term]] = []
    for told in sentences:
        earlier, later = _parted(_reminded(told, found))
        if earlier is None:
            found.append(later)
        elif later:
            found += [earlier, later]
        else:  # "Before that, ...": before what the sentence before it says
            found.insert(max(len(found) - 1, 0), earlier)
    return found


def _reminded(sentence: list[Term], before: list[list[Term]]) -> list[Term]:
    """ "After photographing them, ...": what was told before, said again to say when."""
    doing = len(sentence) > 2 and sentence[1].kind in VERBS and sentence[1].text.lower().endswith("ing")
    if not doing or not before or sentence[0].kind != "THEN" or sentence[0].text.lower() != "after":
        return sentence
    end = next((k for k in range(2, len(sentence)) if sentence[k].kind in VERBS | {"COMMA"}), len(sentence))
    clause, verb = sentence[1:end], _stem(sentence[1])
    known = any(t.kind in VERBS and _stem(t) == verb for other in before for t in other)
    again = any(t.kind in ("IT", "THERE") or t.text.lower() in ("these", "those", "that") for t in clause)
    if not (known or again) or not any(t.kind in VERBS for t in sentence[end:]):
        return sentence
    if any(t.kind == "IDS" or t.kind == "NUM" for t in clause) and not again:
        return sentence
    return [*[_link(t) for t in sentence[:end]], *sentence[end:]]


def _stem(verb: Term) -> str:
    return verb.text.lower().removesuffix("ing").removesuffix("ed").removesuffix("e")[:6]


def _parted(sentence: list[Term]) -> tuple[list[Term] | None, list[Term]]:
    """What is to be done earlier, and what later; None where the order is that of the words."""
    at = next((k for k, t in enumerate(sentence) if t.kind == "FIRSTLY"), None)
    if at is not None:
        before, after = sentence[:at], sentence[at + 1 :]
        if _says_something(after):
            link = _link(sentence[at])
            return ([link, *after], _led_by(before, None)) if _says_something(before) else ([*before, link, *after], [])
        cut = max((k for k, t in enumerate(before) if t.kind in _LINKS), default=0)  # "..., CO2 there beforehand"
        return [*before[cut:], _link(sentence[at])], before[:cut]
    for k, term in enumerate(sentence[:-1]):
        doing = sentence[k + 1].kind in VERBS
        word = term.text.lower()
        if term.kind == "BEFORE" and word == "before" and doing:
            return _around(sentence, k, first=False)
        if term.kind == "THEN" and word == "after" and doing and k and sentence[k - 1].kind not in _LINKS:
            return _around(sentence, k, first=True)
    return None, sentence


def _around(sentence: list[Term], at: int, *, first: bool) -> tuple[list[Term] | None, list[Term]]:
    """What "before" or "after" at a place of the sentence holds, and the rest of it."""
    end = next((k for k in range(at, len(sentence)) if sentence[k].kind == "COMMA"), len(sentence))
    held, before, behind = sentence[at + 1 : end], sentence[:at], sentence[end:]
    if _says_something(before) == _says_something(behind):
        return None, sentence  # of which of the two it is said is for the grammar to ask
    others = [*before, *behind]
    return (held, _led_by(others, sentence[at])) if first else (others, _led_by(held, sentence[at]))


def _says_something(terms: list[Term]) -> bool:
    return any(t.kind not in _LINKS for t in terms)


def _link(term: Term) -> Term:
    """A word that says only in which order."""
    return replace(term, kind="THEN")


def _led_by(terms: list[Term], word: Term | None) -> list[Term]:
    """Terms with the links at their end, and a word that says when, in front of them."""
    end = len(terms)
    while end and terms[end - 1].kind in _LINKS:
        end -= 1
    links = [*terms[end:], *([] if word is None else [word])]
    return [*[_link(t) for t in links], *terms[:end]] if end else []
