"""Spanish words about earlier missions: periods of the past, what was done in them, and superlatives."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib
from fieldhand.places.earlier.period import Period
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.earlier.periods import PastTime, matches_in
from fieldhand.planning.grammar.earlier.work import ANY_WORK, MEASURED_WORK, EarlierWork, Way
from fieldhand.robot.model import RobotProfile

_NUMBERS = {
    "un": 1, "una": 1, "dos": 2, "tres": 3, "cuatro": 4, "cinco": 5, "seis": 6, "siete": 7, "ocho": 8, "nueve": 9,
    "diez": 10, "doce": 12, "catorce": 14, "veinte": 20, "treinta": 30,
}  # fmt: skip
_WEEKDAYS = {
    "lunes": "mon", "martes": "tue", "miercoles": "wed", "jueves": "thu", "viernes": "fri", "sabado": "sat",
    "domingo": "sun",
}  # fmt: skip
_MONTHS = ("ene", "feb", "mar", "abr", "may", "jun", "jul", "ago", "sep", "oct", "nov", "dic")
_LAST_DAYS = (31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)
_UNITS = {"semana": "week", "mes": "month", "ano": "year"}


@cache
def _tables() -> Mapping[str, Any]:
    return tomllib.loads((files("fieldhand.planning.grammar.spanish") / "earlier.toml").read_text(encoding="utf-8"))


def _compiled(pattern: str) -> re.Pattern[str]:
    parts = _tables()["parts"]
    while (whole := re.sub(r"\{([a-z]+)\}", lambda match: parts[match[1]], pattern)) != pattern:
        pattern = whole
    return re.compile(rf"(?<!\S)(?:{pattern})(?!\S)")


@cache
def _patterns() -> tuple[tuple[str, Any, re.Pattern[str]], ...]:
    """Return the patterns of all phrases: category, what the words are, pattern."""
    known = _tables()
    found = [("PERIOD", kind, pattern) for kind, patterns in known["periods"].items() for pattern in patterns]
    for kind, verbs in known["work"].items():
        found.append(
            (
                "WORKSAID",
                kind,
                rf"(?:(?:que|donde) )?{{lead}}(?:{'|'.join(verbs)})(?P<tail>(?: (?:todavia|aun|ya|antes))?)",
            )
        )
    found.append(("WAS", None, "|".join(known["was"]["was"])))
    found += [("MOSTREAD", tuple(value), pattern) for pattern, value in known["most"].items()]
    found += [("STATISTIC", value, pattern) for pattern, value in known["extreme"].items()]
    return tuple((category, kind, _compiled(pattern)) for category, kind, pattern in found)


def earlier_edges(words: Sequence[Word], robot: RobotProfile) -> Iterator[tuple[str, int, int, Any]]:
    """Yield the phrases about earlier missions: category, range of the words, and value.

    Superlatives are read only beside a period.

    Args:
        words: Words of a Spanish request.
        robot: The robot.
    """
    found = []
    for category, kind, pattern in _patterns():
        for first, last, match in matches_in(pattern, words):
            groups = {name: text or "" for name, text in match.groupdict().items()}
            value = (
                _period(kind, groups)
                if category == "PERIOD"
                else _work(kind, groups, robot)
                if category == "WORKSAID"
                else kind
            )
            if value is not None or category == "WAS":
                found.append((category, first, last, value))
    past = any(category == "PERIOD" for category, *_ in found)
    yield from (edge for edge in found if past or edge[0] not in ("MOSTREAD", "STATISTIC"))


def _period(kind: str, said: Mapping[str, str]) -> PastTime | None:
    count = _NUMBERS.get(said.get("count", ""), 0) or int(said.get("count") or 1)
    unit = re.sub(r"(?<=mes)es$|(?<!me)s$", "", said.get("unit", ""))
    month = _month(said.get("month", ""))
    day = f"--{month:02d}-{int(said['number']):02d}" if month and said.get("number") else ""
    if day and not 0 < int(said["number"]) <= _LAST_DAYS[month - 1]:
        return None
    match kind:
        case "yesterday" | "today":
            return PastTime(Period(calendar=kind))
        case "this" | "last":
            name: Any = f"{kind}_{_UNITS[unit]}"
            return PastTime(Period(calendar=name))
        case "rolling" | "longer" | "lasting":
            return PastTime(_rolling(unit, count), longer=kind == "longer", lasting=kind == "lasting")
        case "mission" | "missions":
            return PastTime(Period(last_missions=count))
        case "weekday":
            weekday: Any = _WEEKDAYS[said["day"]]
            return PastTime(Period(calendar=weekday))
        case "since":
            first = _WEEKDAYS.get(said.get("first", ""), "") or day or f"--{month:02d}-01"
            return PastTime(Period(first_day=first))
        case "day":
            return PastTime(Period(first_day=day, last_day=day))
        case "month" if month != 2:
            return PastTime(Period(first_day=f"--{month:02d}-01", last_day=f"--{month:02d}-{_LAST_DAYS[month - 1]}"))
        case "ever":
            return PastTime(Period(), unsaid=True)
        case _:
            return None


def _month(said: str) -> int:
    return _MONTHS.index(said[:3].replace("set", "sep")) + 1 if said else 0


def _rolling(unit: str, count: int) -> Period:
    match unit:
        case "hora":
            return Period(last_hours=count)
        case "dia":
            return Period(last_days=count)
        case "semana":
            return Period(last_days=7 * count)
        case "mes":
            return Period(last_months=count)
        case _:
            return Period(last_months=12 * count)


def _work(kind: str, said: Mapping[str, str], robot: RobotProfile) -> EarlierWork | None:
    lead = {*said["lead"].split(), *said["tail"].split()}
    negated = bool(lead & {"no", "nunca"}) or (bool(lead & {"todavia", "aun"}) and "no" in lead)
    unsaid = bool(lead & {"ya", "nunca", "todavia", "aun", "antes"})
    if kind in ("left_out", "failed"):
        outcome: Any = kind
        return None if negated else EarlierWork((ANY_WORK,), outcomes=(outcome,), unsaid=unsaid)
    ways: dict[str, tuple[Way, ...]] = {"any": (ANY_WORK,), "measured": (MEASURED_WORK,)}
    cameras = [action.name for action in robot.actions if {"picture", "photo"} & {*action.words}]
    if kind == "picture":
        return EarlierWork(((cameras[0], ""),), negated=negated, unsaid=unsaid) if len(cameras) == 1 else None
    return EarlierWork(ways.get(kind, ((kind, ""),)), negated=negated, unsaid=unsaid)
