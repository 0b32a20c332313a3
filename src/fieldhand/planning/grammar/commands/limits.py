"""Constructions of limits on distance, time and battery."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, LimitClause, VisitLimit
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_LIMITED = ("metres", "seconds", "percent")


@construction(
    "limit: INSIDE most=amount [of_what]",
    "limit: word=AT most=amount [of_what]",
    "limit: USE [less] most=amount [of_what]",
    "limit: GO less most=amount [of_what]",
    "limit: INSIDE most=amount OF GO",
    cost=0.4,
)
def at_most(most: Amount, used: int, word: Lex | None = None) -> LimitClause | None:
    """Compose "within 500 m"."""
    if most.unit not in _LIMITED or (word is not None and ("in_time" not in word.features or most.unit != "seconds")):
        return None
    return LimitClause(most, False, used)


@construction("limit: HAVE most=amount [of_what]", cost=0.3)
def given_so_much(most: Amount, used: int) -> LimitClause | None:
    """Compose "you have 20 minutes"."""
    return LimitClause(most, False, used) if most.unit in _LIMITED else None


@construction("less: word=UPTO", "less: word=CMP", cost=0.0)
def less(word: Lex) -> str | None:
    """Compose "less than"."""
    return "less" if word.value in (None, "UPTO") or word.value[0] in ("lt", "le") else None


@construction(
    "of_what: OF BATTERY",
    "of_what: BATTERY",
    "of_what: LIMIT",
    "of_what: OF DET BATTERY",
    "of_what: AT LIMIT",
    cost=0.1,
)
def of_what() -> str:
    """Compose "of battery"."""
    return "of"


@construction(
    "limit: WITHOUT GO check=CMP most=amount [of_what]",
    "limit: WITHOUT USE check=CMP most=amount [of_what]",
    "limit: WITHOUT check=CMP most=amount [of_what]",
    cost=0.3,
)
def not_more_than(check: Lex, most: Amount, used: int) -> LimitClause | None:
    """Compose "without driving more than 100 m"."""
    return LimitClause(most, False, used) if check.value[0] in ("gt", "ge") and most.unit in _LIMITED else None


@construction(
    "limit: KEEP least=amount [of_what] [LEFT]",
    "limit: KEEP check=CMP least=amount [of_what] [LEFT]",
    "limit: KEEP least=amount [of_what] [LEFT] word=THEN",
    "limit: KEEP check=CMP least=amount [of_what] [LEFT] word=THEN",
    "limit: KEEP [DET] BATTERY check=CMP least=amount",
    "limit: BEFORE BATTERY [IS] [at] least=amount [LEFT]",
    "limit: [DET] BATTERY STAYSOVER least=amount",
    "limit: NEVERLET [DET] BATTERY GOUNDER least=amount",
    cost=0.3,
)
def keep(least: Amount, used: int, check: Lex | None = None, word: Lex | None = None) -> LimitClause | None:
    """Compose "keep at least 30 % battery" and "the battery must not go under 30 %"."""
    if least.unit != "percent" or (check is not None and check.value[0] not in ("gt", "ge")):
        return None
    return None if word is not None and "when_done" not in word.features else LimitClause(least, True, used)


@construction("limit: RETURN BEFORE BATTERY [IS] [at] least=amount [LEFT]", cost=0.2)
def back_before(least: Amount, used: int) -> LimitClause | None:
    """Compose "be back before the battery is at 30 %"."""
    return LimitClause(least, True, used, back=True) if least.unit == "percent" else None


@construction(
    "limit: home IF [DET] BATTERY [IS] check=CMP least=amount",
    "limit: IF [DET] BATTERY [IS] check=CMP least=amount [COMMA] home",
    cost=0.2,
)
def home_below(check: Lex, least: Amount, used: int) -> LimitClause | None:
    """Compose "return if the battery drops below 25 %"."""
    if check.value[0] not in ("lt", "le") or least.unit != "percent":
        return None
    return LimitClause(least, True, used, back=True)


@construction("limit: less most=amount of_what", cost=0.5)
def at_most_of_driving(most: Amount, used: int) -> LimitClause | None:
    """Compose "at most 100 m of driving"."""
    return LimitClause(most, False, used) if most.unit in _LIMITED else None


@construction("at: AT", "at: CMP", cost=0.0)
def at_word() -> str:
    """Compose "at"."""
    return "at"


@construction(
    "limit: AT less most=amount [of_what]",
    "limit: FOR less most=amount [of_what]",
    "limit: WITH most=amount AS UPPERLIMIT",
    "limit: WITH [DET] DRIVEN LIMITEDTO most=amount",
    "limit: [DET] DRIVEN [IS] LIMITEDTO most=amount",
    "limit: HAVE most=amount TOPS",
    "limit: most=amount TOPS",
    cost=0.3,
)
def limited_to(most: Amount, used: int) -> LimitClause | None:
    """Compose "with the driving distance limited to 80 m"."""
    return LimitClause(most, False, used) if most.unit in _LIMITED else None


@construction(
    "visit_limit: n=count [OFTHEM] TOPS",
    "visit_limit: n=count TREE TOPS",
    "visit_limit: check=CMP n=count",
    "visit_limit: check=CMP n=count OFTHEM",
    "visit_limit: STOP word=THEN n=count TREE",
    cost=0.5,
)
def visits_at_most(n: int, used: int, word: Lex | None = None, check: Lex | None = None) -> VisitLimit | None:
    """Compose "five at most", "at most five of them" and "give up after 8 trees"."""
    if (word is not None and "after_doing" not in word.features) or (check is not None and check.value != ("le", "")):
        return None
    return VisitLimit(n, used)
