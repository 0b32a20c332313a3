"""What each comma and each "and" does: it separates two parts (SEP) or joins two things of a kind (JOIN).

English says the same thing with or without a comma, and an "and" joins two trees as well as two commands. Which it is
can be seen from what stands on either side; deciding it here keeps the grammar free of ambiguity.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from fieldhand.planning.english.kinds import PLACES, QUANTITY, RELATIONS, STARTS
from fieldhand.planning.english.tokens import Term
from fieldhand.task.plan import Span

_BETWEEN_PARTS = frozenset({"COMMA", "AND", "THEN", "OR"})
#: Behind these nothing is joined.
_ENDS_PART = frozenset({"SEP", "OTHERWISE", "TRY", "BUDGET", "IFSO", "FITS", "INORDER", "NOORDER", "ORDERED"})
_THINGS = PLACES | {"NOUN", "READING", "ORD", "LAST", "NEAREST", "FARTHEST", "SUPER", "ATTRVAL", "EVERYWHERE", "CMP"}
#: Of a condition: what a second predicate holds ("below 30 or above 40").
_TESTS = frozenset({"NUM", "AMOUNT", "LEVEL", "CMP", "BETWEEN", "ATTRVAL"})


@dataclass(frozen=True, kw_only=True)
class Break:
    """What separates two parts: whether "then" or "and" was said, or a colon stands there."""

    then: bool = False
    joined: bool = False
    listed: bool = False


def separated(terms: list[Term]) -> tuple[list[Term], bool, list[Span]]:
    """Commas, "and" and "then" as SEP or JOIN; whether the sentence begins with "then"; words that do nothing."""
    found: list[Term] = []
    silent: list[Span] = []
    opened = False  # within a condition
    at = 0
    while at < len(terms):
        term = terms[at]
        if term.kind in _BETWEEN_PARTS and not (term.kind == "OR" and opened and terms[at + 1 :]):
            end = at
            while end < len(terms) and terms[end].kind in _BETWEEN_PARTS:
                end += 1
            run, rest = terms[at:end], terms[end:]
            at = end
            if rest and rest[0].kind == "EXCEPT" and all(t.kind == "COMMA" for t in run):
                silent += [t.span for t in run]  # "every tree, except tree 5"
                continue
            separator = _separator(run, found, rest, opened)
            opened = opened and separator.kind == "JOIN"
            found.append(separator)
            continue
        if term.kind in STARTS and found and found[-1].kind not in ("SEP", "BY"):
            if found[-1].kind == "AT" and found[-1].text.lower() in ("to", "in"):
                silent.append(found.pop().span)  # "to the corner to take a picture"
            found.append(_break_at(term.start))
            opened = False
        if found and found[-1].kind == "BUDGET" and term.kind in RELATIONS:
            found.append(_break_at(term.start))  # "spend 10 minutes | in the northern half"
        if opened and _says_what(found, terms, at):
            found.append(_break_at(term.start))
            opened = False
        if term.kind in ("WHERE", "UNLESS"):
            term = replace(term, kind="IF", value=term.kind.lower())
        opened = opened or term.kind in ("IF", "UNTIL", "WHETHER")
        found.append(term)
        if term.kind in ("OTHERWISE", "TRY", "IFSO", "FITS"):
            found.append(_break_at(term.end))
        at += 1
    return *_trimmed(found), silent


def _says_what(before: list[Term], terms: list[Term], at: int) -> bool:
    """ "If it is over 38 | a CO2 as well": what is to be taken, behind a test that is complete."""
    article = terms[at].kind in ("DET", "NUM", "ANOTHER") and terms[at].text.lower() not in ("the", "that", "this")
    if not article or not before or before[-1].kind not in ("NUM", "AMOUNT", "LEVEL"):
        return False
    noun = terms[at + 1 : at + 2]
    ahead = terms[at + 2].kind if at + 2 < len(terms) else ""
    tested = any(t.kind in ("CMP", "BETWEEN", "LEVEL", "IS") for t in before[-4:])
    return bool(noun) and noun[0].kind == "NOUN" and tested and ahead not in ("IS", "ISNOT", "CMP", "JOIN")


def _break_at(place: int) -> Term:
    return Term(kind="SEP", text="", start=place, end=place, value=Break())


def _separator(run: list[Term], before: list[Term], after: list[Term], opened: bool) -> Term:
    kinds = {t.kind for t in run}
    listed = any(t.text == ":" for t in run)
    text, end = " ".join(t.text for t in run), run[-1].end
    if "THEN" not in kinds and not listed and _joins(before, after, opened):
        return replace(run[0], kind="JOIN", text=text, end=end, value="or" if "OR" in kinds else "and")
    if "OR" in kinds:
        return replace(run[0], kind="OR", text=text, end=end)  # "take a picture or measure CO2": no grammar takes it
    return replace(
        run[0], kind="SEP", text=text, end=end, value=Break(then="THEN" in kinds, joined="AND" in kinds, listed=listed)
    )


def _joins(before: list[Term], after: list[Term], opened: bool) -> bool:
    """Whether a comma or "and" joins two things of a kind."""
    if not before or not after or after[0].kind in STARTS:
        return False
    if opened:
        clause = list(_until(after, lambda t: t.kind in ("COMMA", *STARTS)))
        tests = any(t.kind in _TESTS for t in clause)
        return (
            before[-1].kind not in ("IF", "UNTIL", "WHETHER")
            and tests
            and not any(t.kind in ("TREE", "IDS") for t in clause[:4])
        )
    if after[0].kind in RELATIONS or (after[0].kind == "THERE" and len(after) > 1):
        return False
    counted = next((t for t in after if t.kind not in QUANTITY), None)
    if counted is not None and counted.kind in RELATIONS and after[0].kind in QUANTITY:
        return False  # "two in the north and | three in the south"
    head = next((t for t in after if t.kind not in QUANTITY | {"ORD", "OTHER", "MORE"}), None)
    noun_ahead = head is not None and head.kind in ("NOUN", "READING")
    noun_behind = _last_head(before) in ("NOUN", "READING")
    return noun_ahead == noun_behind and before[-1].kind not in _ENDS_PART


def _until(terms: list[Term], stop: Callable[[Term], bool]) -> Iterable[Term]:
    for term in terms:
        if stop(term):
            return
        yield term


def _last_head(before: list[Term]) -> str:
    for term in reversed(before):
        if term.kind == "SEP":
            break
        if term.kind in _THINGS:
            return term.kind
    return ""


def _trimmed(terms: list[Term]) -> tuple[list[Term], bool]:
    """Separators that follow each other made one, and none at either end but with its words."""
    then = False
    found: list[Term] = []
    for term in terms:
        if term.kind == "SEP" and found and found[-1].kind == "SEP":
            last: Break = found[-1].value
            both = Break(
                then=last.then or term.value.then,
                joined=last.joined or term.value.joined,
                listed=last.listed or term.value.listed,
            )
            found[-1] = replace(found[-1], value=both, end=max(found[-1].end, term.end))
        else:
            found.append(term)
    if found and found[0].kind == "SEP":
        then = found[0].value.then
    return found, then
