"""Compare what a request says of earlier missions with the places that its plan selects by them.

Words that state a period which the plan holds are taken out of the request; what else it says of the past, the plan
lacks (:mod:`.unsupported`).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from fieldhand.places import selectors as s
from fieldhand.places.earlier.period import EVER, Period
from fieldhand.places.filters.attribute_dates import is_date
from fieldhand.places.selector import Selector
from fieldhand.request_check import words as w
from fieldhand.robot.model import RobotProfile
from fieldhand.task import plan as p
from fieldhand.task.frames import Task

_UNIT = "hour|day|week|fortnight|month|year"
_DAYS = "monday|tuesday|wednesday|thursday|friday|saturday|sunday"
_MONTHS = "january|february|march|april|may|june|july|august|september|october|november|december"
_MISSION = "mission|run|round|trip|survey|tour|visit|outing|flight|inspection|sweep|job|drive"
_NUMBER = rf"(?:\d+|a|an|{'|'.join(w.NUMBERS)})"
_DATE = (
    rf"(?:\d{{4}}-\d\d-\d\d|(?:the )?\d{{1,2}}(?:st|nd|rd|th)? (?:of )?(?:{_MONTHS})(?: \d{{4}})?"
    rf"|(?:{_MONTHS})(?: (?:the )?\d{{1,2}}(?:st|nd|rd|th)?)?(?:,? \d{{4}})?|(?:{_DAYS})|\d{{1,2}}(?:st|nd|rd|th)?)"
)
#: Phrases for periods of the past, the longest first.
_PERIODS = re.compile(
    r"\b(?:"
    rf"(?:from|between) {_DATE} (?:to|and|until|till|through) {_DATE}"
    rf"|(?:less|more|longer|earlier|fewer) than {_NUMBER} (?:{_UNIT})s? (?:ago|back)"
    rf"|(?:over|under|within|at most|at least|up to)? ?{_NUMBER} (?:{_UNIT})s? (?:ago|back)"
    rf"|(?:last|past|previous|preceding) {_NUMBER} (?:{_UNIT}|{_MISSION})s?"
    rf"|{_NUMBER} (?:last|past|previous|latest) (?:{_MISSION})s?"
    rf"|(?:for|in|over|within|during) (?:(?:more than|over|at least|about) )?{_NUMBER} (?:{_UNIT})s?"
    rf"|(?:this|last|past|previous|current|latest|recent|preceding) (?:{_UNIT}|{_DAYS}|{_MISSION}|time)(?:'s)?"
    rf"|(?:beginning|start) of (?:the|this) (?:{_UNIT})"
    rf"|since (?:last )?{_DATE}|(?:on|of|from|in|during) {_DATE}"
    r"|(?:earlier )?today(?:'s)?|yesterday(?:'s)?|time before"
    rf"|(?:{_DAYS})(?:'s)?"
    r")\b"
)
_DAYS_OF = {"day": 1, "week": 7, "fortnight": 14}


def selected_by_records(task: Task) -> Iterator[Selector]:
    """Yield the selectors of a plan by what earlier missions did or read."""
    for node in p.walk(task.composition.plan):
        if node.selector is not None:
            yield from (part for part in node.selector.walk() if part.uses_records)


def periods_of(task: Task) -> frozenset[Period]:
    """Return the periods of earlier missions, and the days of planting, that a plan holds."""
    return (frozenset(getattr(part, "period", EVER) for part in selected_by_records(task)) | _days_of(task)) - {EVER}


def _days_of(task: Task) -> frozenset[Period]:
    """Return the days with which attributes of plants are compared ("sown before April")."""
    selectors = (node.selector for node in p.walk(task.composition.plan) if node.selector is not None)
    values = (str(getattr(part, "value", "")) for one in selectors for part in one.walk())
    return frozenset(Period(first_day=value, last_day=value) for value in values if is_date(value))


def selects_by_work(task: Task) -> bool:
    """Return True if a place of a plan depends on what earlier missions, or this one so far, did."""
    selectors = (node.selector for node in p.walk(task.composition.plan) if node.selector is not None)
    return any(part.uses_records or part.depends_on == "mission" for one in selectors for part in one.walk())


def without_stated_periods(request: str, task: Task) -> str:
    """Return a request without the words from which the periods of its plan come, if these are what they say."""
    periods = periods_of(task)
    if not periods:
        return request
    for found in reversed(list(_PERIODS.finditer(request.lower()))):
        if any(states(found[0], period) for period in periods):
            request = f"{request[: found.start()]} {request[found.end() :]}"
    return request


def states(words: str, period: Period) -> bool:
    """Return True if words state a period: its unit, its numbers, its days.

    Args:
        words: Words of a request about a time, in lower case.
        period: Period of a plan.
    """
    said = re.findall(r"\d{4}-\d\d-\d\d|[a-z]+|\d+", words)
    numbers = {int(word) for word in said if word.isdigit()}
    numbers |= {int(w.NUMBERS[word]) for word in said if word in w.NUMBERS} | (
        {1} if {"a", "an"} & set(said) else set()
    )
    numbers = numbers or {1}
    units = {word.removesuffix("s") for word in said} & set(_UNIT.split("|"))
    if period.first_day or period.last_day:
        return _states_days(said, {period.first_day, period.last_day} - {""})
    if period.last_missions is not None:
        named = {word.removesuffix("s") for word in said} & {*_MISSION.split("|"), "time"}
        return bool(named) and period.last_missions in numbers
    if period.last_hours is not None:
        return "hour" in units and period.last_hours in numbers
    if period.last_days is not None:
        return any(n * _DAYS_OF.get(unit, 0) == period.last_days for n in numbers for unit in units)
    if period.last_months is not None:
        months = {"month": 1, "year": 12}
        return any(n * months.get(unit, 0) == period.last_months for n in numbers for unit in units)
    part, _, unit = period.calendar.partition("_")
    if unit:
        same = {"this": {"this", "current", "beginning", "start"}, "last": {"last", "previous"}}[part]
        return unit in units and bool(same & set(said))
    return any(word[:3] == part[:3] for word in said)


def _states_days(said: list[str], days: set[str]) -> bool:
    """Return True if words state days of a period: each weekday, month and number of theirs among them."""
    for word in said:
        name = word[:3]
        if word in _DAYS.split("|") and name not in days:
            return False
        months = [month[:3] for month in _MONTHS.split("|")]
        if word in _MONTHS.split("|") and not any(f"-{months.index(name) + 1:02d}-" in day for day in days):
            return False
        if word.isdigit() and not any(int(word) in _numbers(day) for day in days):
            return False
        if "-" in word and word not in days:
            return False
    return True


def _numbers(day: str) -> set[int]:
    return {int(number) for number in re.findall(r"\d+", day)}


def actions_of_records(task: Task, robot: RobotProfile) -> frozenset[str]:
    """Return the actions of a robot whose earlier work or readings select places of a plan."""
    named: set[str] = set()
    for part in selected_by_records(task):
        quantities = {getattr(part, "quantity", ""), getattr(part, "measured", "")}
        named |= {getattr(part, "action", "")}
        named |= {action.name for action in robot.actions if quantities & set(action.measures)}
    return frozenset(named - {""})


def earlier_tests(selector: Selector) -> Iterator[s.WhereEarlier]:
    """Yield a selector if it tests earlier readings."""
    if isinstance(selector, s.WhereEarlier):
        yield selector
