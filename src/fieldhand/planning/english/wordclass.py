"""Words that can be several things, told apart by what stands around them; and trees by their numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from fieldhand.planning.english.kinds import QUANTITY, RELATIONS, VERBS
from fieldhand.planning.english.tokens import Term

_BEFORE_NOUN = QUANTITY | {"OTHER", "ORD", "LEVEL", "NOUN", "OF", "STILL", "LAST", "IF"}
#: Behind these, "one" stands for a tree ("a different one", "the last one").
_ONE_OF_A_KIND = frozenset(
    {"OTHER", "DET", "LAST", "ORD", "ATTRVAL", "NEAREST", "MOST", "SUPER", "DIR", "NEARBY", "FAR", "FARTHEST", "MIDDLE"}
)
#: Verbs that are nouns behind an article or a number ("two samples", "a check").
_VERB_NOUNS = frozenset({"sample", "reading", "check", "test", "scan", "probe", "measurement", "survey"})
_CLAUSE_STARTS = frozenset({"", "COMMA", "AND", "THEN", "OTHERWISE", "TRY", "FITS"})
_CLAUSE_ENDS = frozenset({"", "COMMA", "AND", "THEN", "STOPMARK"})
#: What a number in a list of tree numbers cannot stand before ("tree 4 and 2 pictures").
COUNTED = frozenset(
    {"TREE", "NOUN", "READING", "CORNER", "OTHER", "MORE", "NEARBY", "NEAREST", "ATTRVAL", "ADJACENT", "MOST", "SUPER"}
    | {"DIR", "PLACE", "MEASURE", "FAR", "FARTHEST", "ORD", "MIDDLE", "UNIT", "TIMES", "CMP", "ANY", "EDGE", "ATTR"}
)


def classed(terms: list[Term]) -> list[Term]:
    """Terms with those that can be several things made one."""
    found: list[Term] = []
    for index, term in enumerate(terms):
        before = found[-1].kind if found else ""
        after = terms[index + 1].kind if index + 1 < len(terms) else ""
        bound = before == "NUM" and len(found) > 1 and found[-2].kind == "CMP"
        for rule in (
            () if bound and term.kind in ("MEASURE", "ACTV") else _RULES
        ):  # "if it is under 400 sample it again"
            changed = rule(term, before, after)
            if changed is not None:
                term = changed
                break
        _add(found, term)
    return found


def _add(found: list[Term], term: Term) -> None:
    """Append a term; "level of CO2" and "CO2 level" are one noun."""
    kinds = [t.kind for t in found]
    if term.kind == "NOUN" and kinds[-3:] == ["READING", "OF", "DET"]:
        term = replace(term, start=found[-3].start, plural=found[-3].plural)
        del found[-3:]
    elif term.kind == "NOUN" and kinds[-2:] == ["READING", "OF"]:
        term = replace(term, start=found[-2].start, plural=found[-2].plural)
        del found[-2:]
    elif term.kind == "READING" and kinds[-1:] == ["NOUN"]:
        noun = found.pop()
        term = replace(noun, text=f"{noun.text} {term.text}", end=term.end, plural=term.plural)
    found.append(term)


def _verb_as_noun(term: Term, before: str, _after: str) -> Term | None:
    text = term.text.lower()
    if term.kind == "MEASURE" and before in _BEFORE_NOUN and text.removesuffix("s") in _VERB_NOUNS:
        return replace(term, kind="READING", plural=text.endswith("s"))
    if term.kind == "ACTV" and before in ("NUM", "MORE") and text.endswith("s") and term.value.actions:
        return replace(term, kind="NOUN", plural=True)  # "two photographs"
    return None


def _end_and_start(term: Term, before: str, after: str) -> Term | None:
    """ "End" and "start" are places, and what a mission does."""
    text = term.text.lower()
    if term.kind in ("FINISH", "START") and before in _CLAUSE_STARTS and text in ("end", "finish", "start"):
        if after in RELATIONS:
            return replace(term, kind="RETURN" if term.kind == "FINISH" else "GO")
        return replace(term, kind="STOP") if term.kind == "FINISH" else None
    if term.kind == "RETURN" and before in ("DET", "OF", "AT") and text in ("end", "finish"):
        return replace(term, kind="FINISH")
    if term.kind == "GO" and text == "start" and before in ("DET", "AT", "FROM", "OF", "NEAR", "NEXTTO", "WITHIN"):
        return replace(term, kind="START")
    if term.kind == "GO" and text in ("start", "begin") and after == "WITH":
        return term
    return None


def _that(term: Term, before: str, after: str) -> Term | None:
    if term.kind == "WHICH" and term.text.lower() in ("that", "which"):
        if after in ("NOUN", "READING", "TREE", "PLOT", "CORNER", "PLACE", "MIDDLE", "NUM"):
            return replace(term, kind="DET")
        if before in ("AT", "OF", "IF", "WHETHER") or (before in VERBS and after in _CLAUSE_ENDS):
            return replace(term, kind="IT")
    return None


def _each(term: Term, before: str, after: str) -> Term | None:
    if term.kind == "EACH" and after in _CLAUSE_ENDS and before in ("NOUN", "READING"):
        return replace(term, kind="EACHTAIL")
    return None


def _next(term: Term, before: str, after: str) -> Term | None:
    if term.kind == "THEN" and term.text.lower() == "next" and after in ("TREE", "NUM"):
        return replace(term, kind="NEARBY")
    if term.kind == "THEN" and term.text.lower() == "after" and after in ("TREE", "NUM", "DET"):
        return replace(term, kind="UNKNOWN")
    if term.kind == "THEN" and term.text.lower() == "after" and after in VERBS and before not in ("", "AND", "THEN"):
        return replace(term, kind="UNKNOWN")  # "return after taking ..." is said in the opposite order
    return None


def _one(term: Term, before: str, after: str) -> Term | None:
    if term.kind == "NUM" and term.text.lower() == "one" and before in _ONE_OF_A_KIND and after not in COUNTED:
        return replace(term, kind="PLACE")
    if term.kind == "NUM" and term.text.lower() == "one" and after in ("CMP", "BETWEEN", "LEVEL", "IS", "ISNOT"):
        return replace(term, kind="PLACE")  # "until one is low", "one below 400"
    if term.kind == "LAST" and before == "DET" and after in ("COMMA", "AND", "", "STOPMARK"):
        return term
    return None


def _nearest(term: Term, before: str, after: str) -> Term | None:
    """ "The tree nearest | the charger"."""
    if term.kind == "NEAREST" and before in ("TREE", "PLACE") and after in ("DET", "IDS", "CHARGER", "START", "FINISH"):
        return replace(term, kind="NEAR") if not term.text.lower().startswith("the ") else None
    return None


def _by(term: Term, _before: str, after: str) -> Term | None:
    if term.kind == "NEAR" and term.text.lower() == "by" and after in ("TAKE", "MEASURE", "ACTV"):
        return replace(term, kind="BY")
    return None


def _noun_as_verb(term: Term, before: str, after: str) -> Term | None:
    """ "Picture the oldest tree", "image each corner": what an action yields, as the verb for it."""
    orders = before in _CLAUSE_STARTS and after in QUANTITY | {"TREE", "IDS"}
    if term.kind == "NOUN" and orders and not term.plural and " " not in term.text and term.value.actions:
        return replace(term, kind="ACTV")
    return None


def _first(term: Term, before: str, after: str) -> Term | None:
    starts = before in ("", "COMMA", "AND")
    if term.kind == "ORD" and term.value == 1 and starts and after in (*VERBS, "COMMA", "AT", "DET"):
        return replace(term, kind="THEN")
    if term.kind == "LAST" and before in ("COMMA", "AND", "THEN") and after in VERBS:
        return replace(term, kind="THEN")  # "..., and last read the air temperature"
    return None


def _first_of_several(term: Term, before: str, after: str) -> Term | None:
    """ "The south-east corner first, then ...": it says when, not which."""
    ends = after in ("COMMA", "THEN", "AND", "STOPMARK", "")
    said = (term.kind == "ORD" and term.value == 1) or (term.kind == "LAST" and after not in ("AND", "THEN"))
    if said and ends and before in ("CORNER", "TREE", "IDS", "EDGE", "MIDDLE", "PLACE", "DIR", "PLOT"):
        return replace(term, kind="THEN")
    return None


def _reading(term: Term, before: str, after: str) -> Term | None:
    """ "..., reading the CO2 at each tree": the verb."""
    verb = before not in _BEFORE_NOUN | {"MEASURE", "TAKE", "FROM", "AT"}
    if term.kind == "READING" and term.text.lower() == "reading" and verb and after in ("DET", "NOUN"):
        return replace(term, kind="MEASURE", plural=False)
    return None


def _but(term: Term, before: str, after: str) -> Term | None:
    """ "Any tree but tree 4"."""
    trees = before in ("TREE", "PLACE", "CORNER", "EACH") and after in QUANTITY | {
        "IDS",
        "TREE",
        "ATTRVAL",
        "ORD",
        "LAST",
    }
    if term.kind == "AND" and term.text.lower() == "but" and trees:
        return replace(term, kind="EXCEPT")
    return None


def _number(term: Term, _before: str, after: str) -> Term | None:
    if term.kind == "NUMBERED" and term.text.lower() == "number" and after not in ("NUM", "IDS"):
        return replace(term, kind="READING")
    return None


def _whether(term: Term, before: str, _after: str) -> Term | None:
    """ "Check if ..." asks for a reading and a report, which "check, if ..." does not."""
    if term.kind == "IF" and before == "MEASURE" and term.text.lower() == "if":
        return replace(term, kind="WHETHER")
    return None


_RULES: tuple[Callable[[Term, str, str], Term | None], ...] = (
    _verb_as_noun,
    _end_and_start,
    _that,
    _each,
    _next,
    _one,
    _nearest,
    _by,
    _noun_as_verb,
    _first,
    _first_of_several,
    _reading,
    _but,
    _number,
    _whether,
)


def with_ids(terms: list[Term]) -> list[Term]:
    """ "Tree 7", "tree #7", "trees 4, 9 and 12" and "trees 4 to 9" as the ids that they name."""
    found: list[Term] = []
    at = 0
    terms = _numbers_first(terms)
    while at < len(terms):
        term = terms[at]
        if term.kind == "EXCEPT":  # "every tree except 4 and 5"
            ids, end = _id_list(terms, at + 1)
            after = terms[end].kind if end < len(terms) else ""
            found.append(term)
            at += 1
            if ids and after not in COUNTED:
                text = " ".join(t.text for t in terms[at:end])
                found.append(Term(kind="IDS", text=text, start=terms[at].start, end=terms[end - 1].end, value=ids))
                at = end
            continue
        if term.kind != "TREE":
            found.append(term)
            at += 1
            continue
        end = at + 1
        if end < len(terms) and terms[end].kind == "NUMBERED":
            end += 1
        ids, end = _id_list(terms, end)
        if not ids or (end == at + 2 and end < len(terms) and terms[end].kind == "TREE"):  # "the tree | 5 trees down"
            found.append(term)
            at += 1
            continue
        text = " ".join(t.text for t in terms[at:end])
        found.append(Term(kind="IDS", text=text, start=term.start, end=terms[end - 1].end, value=ids))
        at = end
    return found


def with_at_most(terms: list[Term]) -> list[Term]:
    """ "At most 6 trees" says how many, as "up to 6 trees" does, and compares nothing."""
    found = list(terms)
    for k, term in enumerate(terms[:-2]):
        compares = (
            term.kind == "CMP" and term.value == ("le", "") and term.text.lower() not in ("or less", "at or below")
        )
        number, noun = (
            terms[k + 1],
            next((t for t in terms[k + 2 :] if t.kind not in ("OTHER", "DIR", "ATTRVAL")), None),
        )
        if compares and number.kind == "NUM" and noun is not None and noun.kind in ("TREE", "PLACE", "CORNER", "ROW"):
            found[k] = replace(term, kind="UPTO")
    return found


def _numbers_first(terms: list[Term]) -> list[Term]:
    """ "The first three trees" as "the three first trees"."""
    found = list(terms)
    for k in range(len(found) - 2):
        ranked = found[k].kind in ("LAST", "NEAREST", "MOST", "SUPER", "OTHER", "FARTHEST") or (
            found[k].kind == "ORD" and found[k].value == 1
        )
        if (
            ranked
            and found[k + 1].kind == "NUM"
            and found[k + 2].kind
            in ("TREE", "ATTRVAL", "ROW", "CORNER", "PLACE", "DIR", "QUARTER", "HALF", "EDGE", "SIDE")
        ):
            found[k], found[k + 1] = found[k + 1], found[k]
    return found


def _id_list(terms: list[Term], at: int) -> tuple[tuple[str, ...], int]:
    ids, at = _ids(terms, at)
    found = list(ids)
    while ids:
        comma = at
        while comma < len(terms) and terms[comma].kind in ("COMMA", "AND", "NUMBERED"):
            comma += 1
        ids, end = _ids(terms, comma) if comma > at else ((), at)
        after = terms[end].kind if end < len(terms) else ""
        if not ids or after in COUNTED:
            break
        found += ids
        at = end
    return tuple(dict.fromkeys(found)), at


def _ids(terms: list[Term], at: int) -> tuple[tuple[str, ...], int]:
    """One id, or the ids of a range."""
    if at >= len(terms):
        return (), at
    term = terms[at]
    if term.kind == "IDS":
        return term.value, at + 1
    if term.kind != "NUM" or term.value != int(term.value):
        return (), at
    low = int(term.value)
    run = terms[at + 1 : at + 3]
    through = len(run) == 2 and (run[0].kind == "DASH" or run[0].text.lower() in ("to", "through", "up to"))
    if through and run[1].kind == "NUM" and run[1].value == int(run[1].value):
        high = int(run[1].value)
        if low <= high <= low + 10_000:
            return tuple(str(i) for i in range(low, high + 1)), at + 3
    return (str(low),), at + 1
