"""Terms arranged for the grammar: sentences, amounts, limits, and what each comma and each "and" does.

English says the same thing with or without a comma, and an "and" joins two trees as well as two commands. Which it is can be
seen from what stands on either side; deciding that here keeps the grammar free of ambiguity.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from fieldhand.planning.english.tokens import Term
from fieldhand.task.plan import Span

VERBS = frozenset({"TAKE", "MEASURE", "ACTV", "GO", "VISIT", "RETURN", "GOHOME", "STOP", "REPEAT"})
STARTS = VERBS | {"IF", "WHERE", "OTHERWISE", "TRY", "BUDGET", "THEN", "NOORDER", "INORDER"}
RELATIONS = frozenset({"OF", "AT", "FROM", "NEXTTO", "NEAR", "WITHIN", "INSIDE", "OUTSIDE", "EXCEPT", "WITH", "FOR"})
QUANTITY = frozenset({"DET", "EACH", "ANY", "ANOTHER", "NUM", "MORE", "ASMANY", "UPTO"})
BEFORE_NOUN = QUANTITY | {"OTHER", "ORD", "LEVEL", "NOUN", "OF", "STILL", "LAST", "IF"}
#: Behind these, "one" stands for a tree ("a different one", "the last one").
ONE_OF_A_KIND = frozenset(
    {"OTHER", "DET", "LAST", "ORD", "ATTRVAL", "NEAREST", "MOST", "SUPER", "DIR", "NEARBY", "FAR", "FARTHEST"}
)
#: Nouns that a compass word needs behind it ("the north-east corner").
NEEDS_HEAD = frozenset(
    {"TREE", "CORNER", "EDGE", "HALF", "QUARTER", "SIDE", "FINISH", "PLOT", "MIDDLE", "PLACE", "DIR", "MOST"}
)
#: Verbs that are nouns behind an article or a number ("two samples", "a check").
VERB_NOUNS = frozenset(
    {
        "sample",
        "samples",
        "reading",
        "readings",
        "check",
        "checks",
        "test",
        "tests",
        "scan",
        "scans",
        "probe",
        "measurement",
        "survey",
    }
)


@dataclass(frozen=True, kw_only=True)
class Limit:
    """A limit on a resource.

    Attributes:
        unit: ``metres``, ``seconds`` or ``percent``.
        keep: The amount must be left at the end; else it may be used.
    """

    amount: float
    unit: str
    keep: bool = False


@dataclass(frozen=True, kw_only=True)
class Amount:
    """A number with a unit, converted to metres, seconds, degC, ppm, percent, years or kg."""

    number: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class Break:
    """What separates two parts: whether "then" or "and" was said."""

    then: bool = False
    joined: bool = False


@dataclass(frozen=True, kw_only=True)
class Sentence:
    """A sentence ready for the grammar.

    Attributes:
        then: It begins with "then", "after that", "from there" or the like.
    """

    terms: tuple[Term, ...]
    then: bool = False


@dataclass(frozen=True, kw_only=True)
class Arranged:
    """The sentences of a request, and the words that need no grammar: filler, and reasons with their text."""

    sentences: tuple[Sentence, ...]
    filler: tuple[Span, ...] = ()
    reasons: tuple[str, ...] = ()


def arrange(terms: list[Term], request: str) -> Arranged:
    """Arrange the terms of a request."""
    kept, filler, reasons = _without_filler(terms, request)
    sentences = [_sentence(group) for group in _split(kept)]
    return Arranged(sentences=tuple(s for s in sentences if s.terms), filler=tuple(filler), reasons=tuple(reasons))


def _split(terms: list[Term]) -> Iterable[list[Term]]:
    group: list[Term] = []
    for term in terms:
        if term.kind == "STOPMARK":
            yield group
            group = []
        else:
            group.append(term)
    yield group


def _without_filler(terms: list[Term], request: str) -> tuple[list[Term], list[Span], list[str]]:
    kept: list[Term] = []
    filler: list[Span] = []
    reasons: list[str] = []
    at = 0
    while at < len(terms):
        term = terms[at]
        if term.kind == "FILLER":
            filler.append(term.span)
        elif term.kind == "PURPOSE":
            end = at
            while end < len(terms) and terms[end].kind not in ("COMMA", "STOPMARK", "THEN"):
                end += 1
            clause = terms[at:end]
            if any(t.kind in ("NUM", "AMOUNT", "IF", "OTHERWISE") for t in clause):
                kept.append(replace(term, kind="UNKNOWN"))  # a reason that holds a condition is no mere reason
            else:
                filler.append((term.start, clause[-1].end))
                reasons.append(request[term.start : clause[-1].end])
                at = end
                continue
        else:
            kept.append(term)
        at += 1
    return kept, filler, reasons


def _sentence(terms: list[Term]) -> Sentence:
    terms = _amounts(terms)
    terms = _nouns_and_verbs(terms)
    terms = _limits(terms)
    terms = _ids(terms)
    terms = _with_heads(terms)
    terms, then = _separated(terms)
    return Sentence(terms=tuple(terms), then=then)


def _amounts(terms: list[Term]) -> list[Term]:
    found: list[Term] = []
    for term in terms:
        last = found[-1] if found else None
        if term.kind == "UNIT" and last is not None and last.kind == "NUM":
            unit, factor, offset = term.value
            value = Amount(number=round(last.value * factor + offset, 6), unit=unit)
            found[-1] = Term(
                kind="AMOUNT", text=f"{last.text} {term.text}", start=last.start, end=term.end, value=value
            )
        elif term.kind == "TIMES" and last is not None and last.kind == "NUM":
            found[-1] = replace(last, kind="COUNT", end=term.end, value=int(last.value))
        else:
            found.append(term)
    return found


def _nouns_and_verbs(terms: list[Term]) -> list[Term]:
    """Words that are both, told apart by what stands around them."""
    found: list[Term] = []
    for index, term in enumerate(terms):
        before = found[-1].kind if found else ""
        after = terms[index + 1].kind if index + 1 < len(terms) else ""
        at_start = before in ("", "COMMA", "AND", "THEN", "OTHERWISE", "TRY")
        if term.kind == "MEASURE" and before in BEFORE_NOUN and term.text.lower() in VERB_NOUNS:
            term = replace(term, kind="READING", plural=term.text.lower().endswith("s"))
        elif term.kind in ("FINISH", "START") and at_start and "point" not in term.text and "marker" not in term.text:
            if after in RELATIONS:
                term = replace(term, kind="RETURN" if term.kind == "FINISH" else "GO")
            elif term.kind == "FINISH":
                term = replace(term, kind="STOP")
        elif term.kind == "WHICH" and term.text.lower() in ("that", "which"):
            if after in ("NOUN", "READING", "TREE", "PLOT", "CORNER", "PLACE", "MIDDLE", "NUM"):
                term = replace(term, kind="DET")
            elif before == "AT" or (before == "IF"):
                term = replace(term, kind="IT")
        elif term.kind == "RETURN" and before in ("DET", "OF", "AT") and term.text.lower() in ("end", "finish"):
            term = replace(term, kind="FINISH")
        elif term.kind == "GO" and term.text.lower() == "start" and before in ("DET", "AT", "FROM", "OF"):
            term = replace(term, kind="START")
        elif (
            term.kind == "EACH"
            and (after in ("", "COMMA", "AND", "STOPMARK", "THEN"))
            and before in ("NOUN", "READING")
        ):
            term = replace(term, kind="EACHTAIL")
        elif term.kind == "THEN" and term.text.lower() in ("after", "next", "step") and after in ("TREE", "NUM", "DET"):
            term = replace(term, kind="NEAREST" if term.text.lower() == "next" else "UNKNOWN")
        elif term.kind == "NUM" and term.text.lower() == "one" and before in ONE_OF_A_KIND:
            term = replace(term, kind="PLACE")
        elif term.kind == "NEAR" and term.text.lower() == "by" and after in ("TAKE", "MEASURE", "ACTV"):
            term = replace(term, kind="BY")
        elif (
            term.kind == "ORD"
            and term.value == 1
            and before in ("", "COMMA", "AND")
            and after in (*VERBS, "COMMA", "AT")
        ):
            term = replace(term, kind="THEN")
        if term.kind == "NOUN" and found and found[-1].kind == "OF" and len(found) > 1 and found[-2].kind == "READING":
            reading = found[-2]
            found[-2:] = []
            term = replace(term, start=reading.start, plural=reading.plural)
        if (
            term.kind == "NOUN"
            and before == "DET"
            and len(found) > 2
            and found[-2].kind == "OF"
            and found[-3].kind == "READING"
        ):
            reading = found[-3]
            found[-3:] = []
            term = replace(term, start=reading.start, plural=reading.plural)
        if term.kind == "READING" and before == "NOUN":
            noun = found.pop()
            term = replace(noun, end=term.end, plural=term.plural)
        found.append(term)
    return found


_LESS = r"(?:<CMP\.(?:gt|lt|le)>|<UPTO>)"
_USED = r"(?:(?:<AT>|<OF>)?(?:<BATTERY>|<LIMIT>))*"
_LIMITS: tuple[tuple[re.Pattern[str], bool], ...] = (
    (
        re.compile(
            rf"<WITHOUT>(?:<GO>|<USE>|<RETURN>|<TAKE>)?(?:<CMP\.(?:gt|le)>)?(?:<CMP\.gt>)?(<AMOUNT\.(?:metres|seconds|percent)>){_USED}"
        ),
        False,
    ),
    (
        re.compile(
            rf"(?:<BEFORE>)<BATTERY>(?:<IS>|<CMP\.lt>|<CMP\.le>|<AT>|<GO>|<THEN>)*(<AMOUNT\.percent>|<NUM>){_USED}(?:<LEFT>)?"
        ),
        True,
    ),
    (re.compile(rf"(?:<KEEP>|<WITH>)(?:<CMP\.ge>)?(<AMOUNT\.percent>){_USED}(?:<LEFT>)?(?:<AT><DET><FINISH>)?"), True),
    (re.compile(r"(?:<BATTERY>)(?:<IS>|<NOT>|<ISNOT>)*(?:<CMP\.ge>|<CMP\.gt>)(<AMOUNT\.percent>)"), True),
    (re.compile(rf"(?:<INSIDE>)(<AMOUNT\.(?:seconds|percent)>){_USED}"), False),
    (re.compile(rf"(?:<INSIDE>)(<AMOUNT\.metres>)(?!<OF>|<FROM>|<AT>){_USED}"), False),
    (
        re.compile(
            rf"(?:<AT>)?(?:<GO>|<USE>|<RETURN>)?{_LESS}(<AMOUNT\.(?:seconds|percent|metres)>)(?!<OF><DET>?<[A-Z]*TREE>|<FROM>){_USED}"
        ),
        False,
    ),
    (re.compile(rf"(?:<USE>)(<AMOUNT\.(?:seconds|percent|metres)>){_USED}"), False),
)


def _limits(terms: list[Term]) -> list[Term]:
    """Limits on driving, time and battery as one term each, wherever in the sentence they stand."""
    conditional = any(t.kind in ("IF", "WHERE") for t in terms)
    for pattern, keep in _LIMITS:
        code, places = _code(terms)
        for match in reversed(list(pattern.finditer(code))):
            first, last = places[match.start()], places[match.end() - 1]
            inside = terms[first : last + 1]
            amount = terms[places[match.start(1)]]
            if (
                conditional
                and not keep
                and not any(t.kind in ("GO", "USE", "BATTERY", "LIMIT", "INSIDE", "WITHOUT") for t in inside)
            ):
                continue  # "if it is below 20 %" is a reading, not a limit
            if (
                first > 0
                and terms[first - 1].kind in ("IS", "ISNOT", "ATTR", "WHICH", "TREE", "NOUN", "READING", "BATTERY")
                and not keep
            ):
                if not any(t.kind in ("GO", "USE", "BATTERY", "LIMIT", "INSIDE", "WITHOUT") for t in inside):
                    continue
            value = amount.value if isinstance(amount.value, Amount) else Amount(number=amount.value, unit="percent")
            limit = Limit(amount=value.number, unit=value.unit, keep=keep)
            text = " ".join(t.text for t in inside)
            terms = [
                *terms[:first],
                Term(kind="BUDGET", text=text, start=inside[0].start, end=inside[-1].end, value=limit),
                *terms[last + 1 :],
            ]
            code, places = _code(terms)
    return _within(terms)


def _within(terms: list[Term]) -> list[Term]:
    """ "Within 20 m of", "less than 20 m from", "20 m from" as one relation."""
    found: list[Term] = []
    at = 0
    while at < len(terms):
        group = terms[at : at + 3]
        kinds = [t.kind for t in group]
        if (
            len(group) == 3
            and (
                kinds[0] == "INSIDE" or (kinds[0] == "CMP" and group[0].value[0] in ("lt", "le")) or kinds[0] == "UPTO"
            )
            and kinds[1] == "AMOUNT"
            and group[1].value.unit == "metres"
            and kinds[2] in ("OF", "FROM", "AT")
        ):
            text = " ".join(t.text for t in group)
            found.append(
                Term(kind="WITHIN", text=text, start=group[0].start, end=group[2].end, value=group[1].value.number)
            )
            at += 3
        else:
            found.append(terms[at])
            at += 1
    return found


def _ids(terms: list[Term]) -> list[Term]:
    """ "Trees 4 to 9" and "trees 4-9" as the numbers between."""
    found: list[Term] = []
    at = 0
    while at < len(terms):
        term = terms[at]
        run = terms[at : at + 3]
        dashed = (
            len(run) == 3
            and run[0].kind == run[2].kind == "NUM"
            and (run[1].kind == "DASH" or (run[1].kind == "AT" and run[1].text.lower() == "to"))
        )
        if dashed and found and found[-1].kind == "TREE":
            low, high = int(run[0].value), int(run[2].value)
            ids = tuple(range(low, high + 1)) if low <= high <= low + 10_000 else ()
            found.append(Term(kind="IDS", text=f"{low} to {high}", start=run[0].start, end=run[2].end, value=ids))
            at += 3
            continue
        found.append(term)
        at += 1
    return found


def _with_heads(terms: list[Term]) -> list[Term]:
    """ "The north-east, then the south-west corner": a compass word alone borrows the noun of the next."""
    found: list[Term] = []
    for index, term in enumerate(terms):
        found.append(term)
        after = terms[index + 1].kind if index + 1 < len(terms) else ""
        if term.kind != "DIR" or after in NEEDS_HEAD:
            continue
        heads = [t for t in terms if t.kind in ("CORNER", "HALF", "QUARTER", "SIDE", "EDGE")]
        ahead = next((t for t in heads if t.start > term.start), heads[-1] if heads else None)
        if ahead is not None:
            found.append(replace(ahead, text="", start=term.end, end=term.end, plural=False))
    return found


def _code(terms: list[Term]) -> tuple[str, dict[int, int]]:
    """The kinds of the terms as text for a regular expression, and which term each character belongs to."""
    code = ""
    places: dict[int, int] = {}
    for index, term in enumerate(terms):
        detail = ""
        if term.kind == "CMP":
            detail = f".{term.value[0]}"
        elif term.kind == "AMOUNT":
            detail = f".{term.value.unit}"
        piece = f"<{term.kind}{detail}>"
        places.update(dict.fromkeys(range(len(code), len(code) + len(piece)), index))
        code += piece
    return code, places


def _separated(terms: list[Term]) -> tuple[list[Term], bool]:
    """Commas, "and" and "then" as SEP or JOIN; whether the sentence begins with "then"."""
    found: list[Term] = []
    opened = ""  # the conjunction that a condition stands under
    at = 0
    while at < len(terms):
        term = terms[at]
        if term.kind in ("COMMA", "AND", "THEN", "OR", "DASH") and not (term.kind == "OR" and opened):
            end = at
            while end < len(terms) and terms[end].kind in ("COMMA", "AND", "THEN", "OR"):
                end += 1
            end = max(end, at + 1)
            run, rest = terms[at:end], terms[end:]
            joins = not any(t.kind == "THEN" for t in run) and _joins(found, rest, opened)
            kinds = {t.kind for t in run}
            if joins:
                found.append(replace(run[0], kind="JOIN", end=run[-1].end, value="or" if "OR" in kinds else "and"))
            else:
                value = Break(then="THEN" in kinds, joined="AND" in kinds)
                found.append(replace(run[0], kind="SEP", end=run[-1].end, value=value))
                opened = ""
            at = end
            continue
        if term.kind in STARTS | {"BY"} and found and found[-1].kind != "SEP" and term.kind not in ("THEN", "BY"):
            if found[-1].kind == "AT" and found[-1].text.lower() in ("to", "in"):
                found.pop()  # "to the corner to take a picture"
            if not (term.kind in VERBS and found and found[-1].kind == "BY"):
                found.append(Term(kind="SEP", text="", start=term.start, end=term.start, value=Break()))
                opened = ""
        if term.kind == "WHERE":
            term = replace(term, kind="IF", value="where")
        if term.kind == "IF":
            opened = "IF"
        found.append(term)
        if term.kind in ("OTHERWISE", "TRY"):
            found.append(Term(kind="SEP", text="", start=term.end, end=term.end, value=Break()))
        at += 1
    return _trimmed(found)


def _joins(before: list[Term], after: list[Term], opened: str) -> bool:
    """Whether a comma or "and" joins two things of a kind."""
    if not before or not after or after[0].kind in STARTS or after[0].kind == "BUDGET":
        return False
    if opened:
        return (
            before[-1].kind not in ("IF",)
            and any(
                t.kind in ("NUM", "AMOUNT", "LEVEL", "CMP", "BETWEEN")
                for t in _until(after, lambda t: t.kind in ("COMMA", *STARTS))
            )
            and not any(t.kind in ("TREE",) for t in after[:4] if before[-1].kind in ("LEVEL", "AMOUNT"))
        )
    if after[0].kind in RELATIONS:
        return False
    head = next((t for t in after if t.kind not in QUANTITY | {"ORD", "OTHER", "MORE"}), None)
    noun_ahead = head is not None and head.kind in ("NOUN", "READING")
    noun_behind = _last_head(before) in ("NOUN", "READING")
    return noun_ahead == noun_behind and before[-1].kind not in ("SEP", "OTHERWISE", "TRY", "BUDGET")


def _until(terms: list[Term], stop: Callable[[Term], bool]) -> Iterable[Term]:
    for term in terms:
        if stop(term):
            return
        yield term


def _last_head(before: list[Term]) -> str:
    for term in reversed(before):
        if term.kind == "SEP":
            break
        if term.kind in (
            "NOUN",
            "READING",
            "TREE",
            "CORNER",
            "MIDDLE",
            "EDGE",
            "HALF",
            "QUARTER",
            "SIDE",
            "START",
            "FINISH",
            "CHARGER",
            "PLOT",
            "PLACE",
            "ZONE",
            "DIR",
            "MOST",
            "IDS",
            "THERE",
        ):
            return term.kind
    return ""


def _trimmed(terms: list[Term]) -> tuple[list[Term], bool]:
    """Separators that follow each other made one, and none at either end."""
    then = False
    found: list[Term] = []
    for term in terms:
        if term.kind != "SEP":
            found.append(term)
        elif not found:
            then = then or term.value.then
        elif found[-1].kind == "SEP":
            both = Break(
                then=found[-1].value.then or term.value.then, joined=found[-1].value.joined or term.value.joined
            )
            found[-1] = replace(found[-1], value=both, end=max(found[-1].end, term.end))
        else:
            found.append(term)
    while found and found[-1].kind == "SEP":
        found.pop()
    return found, then
