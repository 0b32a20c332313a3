"""Find the periods of the past in the words of a request: "last week", "in the last 3 days", "since Monday"."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib
from fieldhand.places.earlier.period import Period
from fieldhand.planning.english.tokens import Word

_NUMBERS = {
    "a": 1, "an": 1, "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9,
    "ten": 10, "eleven": 11, "twelve": 12, "fourteen": 14, "twenty": 20, "thirty": 30, "": 1,
}  # fmt: skip
_NTH = {
    "first": "1", "second": "2", "third": "3", "fourth": "4", "fifth": "5", "sixth": "6", "seventh": "7", "eighth": "8",
    "ninth": "9", "tenth": "10", "twelfth": "12", "fifteenth": "15", "twentieth": "20",
}  # fmt: skip
_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
_LAST_DAYS = (31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)


@dataclass(frozen=True, slots=True)
class PastTime:
    """A period of the past as a phrase states it.

    Attributes:
        period: The period.
        longer: True for "more than a week ago": before the period, and not in it.
        lasting: True for "for two weeks", which is said of what was not done.
        unsaid: True for "already" and "before", which name no period.
    """

    period: Period
    longer: bool = False
    lasting: bool = False
    unsaid: bool = False


@cache
def tables() -> Mapping[str, Any]:
    """Return the tables of words.toml."""
    return tomllib.loads((files("fieldhand.planning.grammar.earlier") / "words.toml").read_text(encoding="utf-8"))


def spelt_out(pattern: str) -> str:
    """Return a pattern with the named parts of words.toml in it."""
    parts = tables()["parts"]
    while (whole := re.sub(r"\{([a-z]+)\}", lambda match: parts[match[1]], pattern)) != pattern:
        pattern = whole
    return pattern


def compiled(pattern: str) -> re.Pattern[str]:
    """Return the pattern of whole words."""
    return re.compile(rf"(?<!\S){spelt_out(pattern)}(?!\S)")


def matches_in(pattern: re.Pattern[str], words: Sequence[Word]) -> Iterator[tuple[int, int, re.Match[str]]]:
    """Yield each match of a pattern with the range of its words, those that overlap among them."""
    text = " ".join(word.norm for word in words)
    starts, ends, at = {}, {}, 0
    for k, word in enumerate(words):
        starts[at], ends[at + len(word.norm)] = k, k + 1
        at += len(word.norm) + 1
    for begin, first in starts.items():
        found = pattern.match(text, begin)
        if found is not None and found.end() in ends and found.end() > begin:
            yield first, ends[found.end()], found


def periods_in(words: Sequence[Word], *, owned: bool = False) -> Iterator[tuple[int, int, PastTime]]:
    """Yield the periods that words state, each with the range of its words.

    Args:
        words: Words of a request.
        owned: True for possessives: "last week's".
    """
    for kind, pattern in _patterns("owned" if owned else "periods"):
        for first, last, found in matches_in(pattern, words):
            period = _READ[kind](found.groupdict())
            if period is not None:
                yield first, last, period


@cache
def past_verbs() -> re.Pattern[str]:
    """Return the pattern of verbs in the past behind which stands what was read: "was", "came out at"."""
    ordered = sorted(tables()["was"]["was"], key=len, reverse=True)
    return compiled(f"(?:{'|'.join(ordered)})")


@cache
def _patterns(table: str) -> tuple[tuple[str, re.Pattern[str]], ...]:
    return tuple((kind, compiled(pattern)) for kind, patterns in tables()[table].items() for pattern in patterns)


def _rolling(groups: Mapping[str, str | None]) -> PastTime | None:
    said = groups.get("count") or ""
    count = _NUMBERS[said] if said in _NUMBERS else int(said)
    unit = (groups["unit"] or "").removesuffix("s")
    if count < 1:
        return None
    match unit:
        case "hour":
            return PastTime(Period(last_hours=count))
        case "day":
            return PastTime(Period(last_days=count))
        case "week":
            return PastTime(Period(last_days=7 * count))
        case "fortnight":
            return PastTime(Period(last_days=14 * count))
        case "month":
            return PastTime(Period(last_months=count))
        case _:
            return PastTime(Period(last_months=12 * count))


def _longer(groups: Mapping[str, str | None]) -> PastTime | None:
    rolling = _rolling(groups)
    return None if rolling is None else PastTime(rolling.period, longer=True)


def _lasting(groups: Mapping[str, str | None]) -> PastTime | None:
    rolling = _rolling(groups)
    return None if rolling is None else PastTime(rolling.period, lasting=True)


def _missions(groups: Mapping[str, str | None]) -> PastTime | None:
    said = groups.get("count") or ""
    count = _NUMBERS[said] if said in _NUMBERS else int(said)
    return PastTime(Period(last_missions=count)) if count else None


def _calendar(part: str) -> Callable[[Mapping[str, str | None]], PastTime]:
    def read(groups: Mapping[str, str | None]) -> PastTime:
        unit = groups.get("unit")
        name: Any = f"{part}_{unit}" if unit else part
        return PastTime(Period(calendar=name))

    return read


def _weekday(groups: Mapping[str, str | None]) -> PastTime:
    name: Any = (groups["day"] or "")[:3]
    return PastTime(Period(calendar=name))


def _since(groups: Mapping[str, str | None]) -> PastTime | None:
    first = day_named(groups["first"] or "")
    return PastTime(Period(first_day=first)) if first else None


def _on_day(groups: Mapping[str, str | None]) -> PastTime | None:
    day = day_named(groups["day"] or "")
    return PastTime(Period(first_day=day, last_day=day)) if day else None


def _days(groups: Mapping[str, str | None]) -> PastTime | None:
    last = day_named(groups["last"] or "")
    number = groups.get("number")
    if number is None:
        first = day_named(groups["first"] or "")
    else:
        first = f"{last[:-2]}{int(number):02d}" if 0 < int(number) < 32 and last[-2:].isdigit() else ""
    return PastTime(Period(first_day=first, last_day=last)) if first and last else None


def _month(groups: Mapping[str, str | None]) -> PastTime | None:
    year, name = groups.get("year"), groups.get("month")
    if name is None:
        return PastTime(Period(first_day=f"{year}-01-01", last_day=f"{year}-12-31"))
    span = month_named(name, year)
    return None if span is None else PastTime(Period(first_day=span[0], last_day=span[1]))


def month_named(name: str, year: str | None) -> tuple[str, str] | None:
    """Return the first and the last day of a month; None for another word, and if the last depends on the year."""
    if name[:3] not in _MONTHS:
        return None
    number = _MONTHS.index(name[:3]) + 1
    last = _LAST_DAYS[number - 1]
    if year is None:
        return None if number == 2 else (f"--{number:02d}-01", f"--{number:02d}-{last}")
    last = 28 if number == 2 and int(year) % 4 else last
    return f"{year}-{number:02d}-01", f"{year}-{number:02d}-{last}"


def _ever(_groups: Mapping[str, str | None]) -> PastTime:
    return PastTime(Period(), unsaid=True)


#: How a period is read from the groups of its pattern.
_READ: Mapping[str, Callable[[Mapping[str, str | None]], PastTime | None]] = {
    "yesterday": _calendar("yesterday"),
    "today": _calendar("today"),
    "this": _calendar("this"),
    "last": _calendar("last"),
    "rolling": _rolling,
    "lasting": _lasting,
    "longer": _longer,
    "mission": _missions,
    "missions": _missions,
    "weekday": _weekday,
    "since": _since,
    "day": _on_day,
    "month": _month,
    "days": _days,
    "ever": _ever,
    "earlier": lambda _: PastTime(Period()),
}


def day_named(said: str) -> str:
    """Return a day as a period has it; empty for one that no calendar has."""
    words = [_NTH.get(word, word) for word in said.replace(",", " ").split() if word not in ("the", "of", "-")]
    if len(words) == 1:
        name = words[0]
        if name[:3] in ("mon", "tue", "wed", "thu", "fri", "sat", "sun"):
            return name[:3]
        return f"--{_MONTHS.index(name[:3]) + 1:02d}-01"
    if words[0].isdigit() and len(words[0]) == 4:
        return "-".join(words) if _exists(int(words[1]), int(words[2])) else ""
    year = next((word for word in words if len(word) == 4 and word.isdigit()), "")
    month = next(_MONTHS.index(word[:3]) + 1 for word in words if word[:3] in _MONTHS)
    day = next(int(re.sub(r"\D", "", word)) for word in words if word[:1].isdigit() and word != year)
    if not _exists(month, day):
        return ""
    return f"{year}-{month:02d}-{day:02d}" if year else f"--{month:02d}-{day:02d}"


def _exists(month: int, day: int) -> bool:
    return 0 < month < 13 and 0 < day <= _LAST_DAYS[month - 1]
