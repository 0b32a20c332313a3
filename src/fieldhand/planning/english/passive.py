""" "The first tree imaged", "CO2 measured at tree 4", "a picture taken of each": the verb in front of its object."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.planning.english.kinds import PLACES, RELATIONS, VERBS
from fieldhand.planning.english.tokens import Term

_CAPTURES = frozenset({"TAKE", "MEASURE", "ACTV"})
_IRREGULAR = frozenset({"taken", "shot", "done", "made", "read", "got", "gotten", "run"})
#: Where what was spoken of before ends.
_BEGINS = (VERBS | {"IF", "WHERE", "UNLESS", "UNTIL", "WHETHER", "THEN", "OTHERWISE", "TRY", "IFSO"}) - _CAPTURES
_LINKS = frozenset({"COMMA", "AND", "DASH"})
#: Words that may stand behind a verb in the passive; anything else would be its object.
_BEHIND = (
    RELATIONS | _LINKS | {"THERE", "THEN", "COUNT", "AGAIN", "BY", "WHERE", "IF", "NOORDER", "INORDER", "STOPMARK"}
)
_HEADS = (PLACES - {"THERE", "IT"}) | {"DET", "EACH", "NUM", "NOUN", "ANY", "ANOTHER", "ORD", "LAST", "ATTRVAL"}
_HEADS = _HEADS | {"NEAREST", "FARTHEST", "SUPER", "EVERYNTH", "OTHER", "READING", "MORE"}


def with_passives(terms: list[Term]) -> list[Term]:
    """The terms of a sentence, each verb that stands behind what is done to put in front of it."""
    found = list(terms)
    for k, term in enumerate(terms):
        if term.kind not in _CAPTURES or not _is_participle(term):
            continue
        after = found[k + 1].kind if k + 1 < len(found) else ""
        begin = _begin(found, k)
        subject = found[begin:k]
        if begin == k or subject[0].kind not in _HEADS or (after and after not in _BEHIND):
            continue
        if term.kind == "TAKE" and not any(t.kind in ("NOUN", "READING") for t in subject):
            continue
        found[begin : k + 1] = [term, *subject]
    return found


def _is_participle(term: Term) -> bool:
    words = term.text.lower().split()
    return bool(words) and (words[-1] in _IRREGULAR or words[-1].endswith("ed"))


def _begin(terms: Sequence[Term], verb: int) -> int:
    """Where the phrase begins that a verb in the passive is about; ``verb`` if there is none."""
    at = verb
    while at > 0 and terms[at - 1].kind not in _BEGINS | _CAPTURES:
        at -= 1
    if at > 0 and terms[at - 1].kind not in ("THEN", "OTHERWISE"):
        links = [k for k in range(at, verb) if terms[k].kind in _LINKS]
        return links[-1] + 1 if links else verb
    leads = [k for k in range(at, verb) if terms[k].kind == "COMMA" and terms[at].kind in RELATIONS]
    return leads[-1] + 1 if leads else at
