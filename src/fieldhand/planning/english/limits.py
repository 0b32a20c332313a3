"""Amounts with units, and limits on driving, time and battery, wherever in a sentence they stand."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from fieldhand.planning.english.tokens import Term
from fieldhand.task.plan import Span


@dataclass(frozen=True, kw_only=True)
class Amount:
    """A number with a unit, converted to metres, seconds, degC, ppm, percent, years or kg."""

    number: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class LimitPhrase:
    """A limit on a resource.

    Attributes:
        unit: ``metres``, ``seconds`` or ``percent``.
        keep: The amount must be left at the end; else it may be used.
        said: Range of the request that says it.
    """

    amount: float
    unit: str
    keep: bool = False
    said: Span = (0, 0)

    def as_said(self, said: Span) -> LimitPhrase:
        """The same, said elsewhere."""
        return replace(self, said=said)


_LESS = r"(?:<CMP\.(?:lt|le)>|<UPTO>)"
_OF_WHAT = r"(?:(?:<AT>|<OF>)?(?:<DET>)?(?:<BATTERY>|<LIMIT>))*"
_ANY_UNIT = r"(<AMOUNT\.(?:metres|seconds|percent)>)"
_NOT_A_PLACE = r"(?!<OF>|<FROM>|<AT>|<THERE>)"
#: How limits are said, over the kinds of the terms, and whether the amount is to be left rather than used.
_PATTERNS: tuple[tuple[re.Pattern[str], bool], ...] = (
    # "without driving more than 100 m", "never use over 30 %"
    (re.compile(rf"<WITHOUT>(?:<GO>|<USE>|<RETURN>|<TAKE>)?<CMP\.(?:gt|ge)>{_ANY_UNIT}{_OF_WHAT}"), False),
    # "before the battery is at 30 %"
    (
        re.compile(
            r"<BEFORE><BATTERY>(?:<IS>|<CMP\.lt>|<CMP\.le>|<AT>|<GO>|<THEN>)*(<AMOUNT\.percent>|<NUM>)"
            rf"{_OF_WHAT}(?:<LEFT>)?"
        ),
        True,
    ),
    # "keep 20 % in reserve", "with at least 20 % left"
    (re.compile(rf"<KEEP>(?:<CMP\.ge>)?(<AMOUNT\.percent>){_OF_WHAT}(?:<LEFT>)?(?:<AT><DET><FINISH>)?"), True),
    (re.compile(rf"<WITH>(?:<CMP\.ge>)?(<AMOUNT\.percent>){_OF_WHAT}<LEFT>(?:<AT><DET><FINISH>)?"), True),
    (re.compile(r"<KEEP><BATTERY>(?:<CMP\.ge>|<CMP\.gt>)(<AMOUNT\.percent>)"), True),
    # "within 20 minutes", "in 20 minutes", "in at most 20 minutes", "within 300 feet of driving"
    (re.compile(rf"(?:<INSIDE>|<AT>{_LESS}|<AT>)(<AMOUNT\.seconds>){_OF_WHAT}"), False),
    (re.compile(rf"(?:<INSIDE>|<WITH>)(<AMOUNT\.percent>){_OF_WHAT}"), False),
    (re.compile(rf"<INSIDE>(<AMOUNT\.metres>)(?:<OF><LIMIT>|{_NOT_A_PLACE}){_OF_WHAT}"), False),
    # "drive at most 200 m", "using no more than 30 % of the battery", "up to 500 m in all"
    (re.compile(rf"<GO>{_LESS}(<AMOUNT\.metres>)(?:<OF><LIMIT>|{_NOT_A_PLACE}){_OF_WHAT}"), False),
    (re.compile(rf"(?:<AND>)?<USE>{_LESS}?{_ANY_UNIT}{_OF_WHAT}"), False),
    (re.compile(rf"<TAKE>{_LESS}(<AMOUNT\.seconds>){_OF_WHAT}"), False),
    (re.compile(rf"{_LESS}{_ANY_UNIT}(?:(?:<AT>|<OF>)?(?:<DET>)?(?:<BATTERY>|<LIMIT>))+"), False),
    (re.compile(rf"(?:<FOR>){_LESS}(<AMOUNT\.seconds>)"), False),
)
#: Behind these, an amount belongs to what is tested or compared, not to a budget.
_COMPARED = frozenset({"IS", "ISNOT", "NOT", "ATTR", "WHICH", "TREE", "NOUN", "READING", "IT", "STILL"})
_OF_A_BUDGET = frozenset({"GO", "USE", "BATTERY", "LIMIT", "INSIDE", "WITHOUT", "KEEP", "BEFORE"})


def with_amounts(terms: list[Term]) -> list[Term]:
    """Numbers and their units as one term each; "3 times" as a count."""
    found: list[Term] = []
    for term in terms:
        if term.kind == "UNIT" and len(found) > 1 and found[-1].kind == "DASH" and found[-2].kind == "NUM":
            dash = found.pop()  # "15-meter intervals"
            found[-1] = replace(found[-1], text=f"{found[-1].text}{dash.text}", end=dash.end)
        last = found[-1] if found else None
        if term.kind == "UNIT" and last is not None and last.kind == "NUM":
            _share_unit(found, term)
            unit, factor, offset = term.value
            value = Amount(number=round(last.value * factor + offset, 6), unit=unit)
            text = f"{last.text} {term.text}"
            found[-1] = Term(kind="AMOUNT", text=text, start=last.start, end=term.end, value=value)
        elif term.kind == "TIMES" and last is not None and last.kind == "MORE" and _is_whole(found[-2:-1]):
            found.pop()  # "three more times"
            text = f"{found[-1].text} {last.text} {term.text}"
            found[-1] = replace(found[-1], kind="COUNT", text=text, end=term.end, value=int(found[-1].value))
        elif last is not None and last.kind == "COUNT" and (term.kind == "MORE" or _in_all(term)):
            found[-1] = replace(last, text=f"{last.text} {term.text}", end=term.end)
        elif term.kind == "TIMES" and last is not None and last.kind == "NUM" and last.value == int(last.value):
            text = f"{last.text} {term.text}"
            found[-1] = replace(last, kind="COUNT", text=text, end=term.end, value=int(last.value))
        else:
            found.append(term)
    return found


def _share_unit(found: list[Term], unit: Term) -> None:
    """ "Between 70 and 80 °F": the first number has the unit of the second. ``found`` is changed."""
    run = [t.kind for t in found[-4:]]
    joined = len(found) > 3 and found[-2].kind in ("AND", "DASH", "AT")
    if joined and run[0] == "BETWEEN" and run[1] == "NUM":
        name, factor, offset = unit.value
        first = found[-3]
        value = Amount(number=round(first.value * factor + offset, 6), unit=name)
        found[-3] = replace(first, kind="AMOUNT", value=value)


def _is_whole(terms: list[Term]) -> bool:
    return bool(terms) and terms[0].kind == "NUM" and terms[0].value == int(terms[0].value)


def _in_all(term: Term) -> bool:
    return term.kind == "LIMIT" and term.text.lower() in ("in all", "in total", "altogether", "all in all", "overall")


def with_limits(terms: list[Term]) -> list[Term]:
    """Limits as one term each."""
    for pattern, keep in _PATTERNS:
        code, places = _code(terms)
        for match in reversed(list(pattern.finditer(code))):
            first, last = places[match.start()], places[match.end() - 1]
            inside, before = terms[first : last + 1], terms[:first]
            if _is_compared(inside, before) and not keep:
                continue
            amount = terms[places[match.start(1)]].value
            value = amount if isinstance(amount, Amount) else Amount(number=float(amount), unit="percent")
            text = " ".join(t.text for t in inside)
            start, end = inside[0].start, inside[-1].end
            limit = LimitPhrase(amount=value.number, unit=value.unit, keep=keep, said=(start, end))
            budget = Term(kind="BUDGET", text=text, start=start, end=end, value=limit)
            terms = [*before, budget, *terms[last + 1 :]]
    return _within(terms)


def _is_compared(inside: list[Term], before: list[Term]) -> bool:
    """Whether an amount is what a reading or a tree is compared with ("if it is below 20 %")."""
    said = {t.kind for t in inside} & _OF_A_BUDGET
    if before and before[-1].kind in _COMPARED and not said:
        return True
    clause = []
    for term in reversed(before):
        if term.kind in ("COMMA", "THEN", "BUDGET"):
            break
        clause.append(term.kind)
    return bool({"IF", "WHERE", "UNLESS", "WHETHER"} & set(clause)) and "USE" not in said and "KEEP" not in said


def _within(terms: list[Term]) -> list[Term]:
    """ "Within 20 m of", "less than 20 m from" and "at least 20 m away from" as one relation each."""
    found: list[Term] = []
    at = 0
    while at < len(terms):
        group = terms[at : at + 3]
        beyond = group[0].kind == "CMP" and group[0].value[0] in ("gt", "ge")
        close = group[0].kind in ("INSIDE", "UPTO") or (group[0].kind == "CMP" and group[0].value[0] in ("lt", "le"))
        if (
            len(group) == 3
            and (close or beyond)
            and group[1].kind == "AMOUNT"
            and group[1].value.unit == "metres"
            and (group[2].kind in ("OF", "FROM") or group[2].text.lower() in ("of it", "from it"))
        ):
            text = " ".join(t.text for t in group)
            start, end = group[0].start, group[2].end
            kind = "WITHIN" if close else "BEYOND"
            found.append(Term(kind=kind, text=text, start=start, end=end, value=group[1].value.number))
            if group[2].kind == "THERE":
                found.append(replace(group[2], kind="IT", text="it", start=end, end=end))
            at += 3
        else:
            found.append(terms[at])
            at += 1
    return found


def _code(terms: list[Term]) -> tuple[str, Mapping[int, int]]:
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
