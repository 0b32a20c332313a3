"""Words for earlier missions: periods, and actions in the passive."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.compatibility import date_from_iso
from fieldhand.language import Number, counted, message, named
from fieldhand.language.words import say_action, say_name, say_quantity
from fieldhand.places.sources.trees import Trees
from fieldhand.places.wording import say_selector

if TYPE_CHECKING:
    from fieldhand.places.earlier.done_earlier import DoneEarlier
    from fieldhand.places.earlier.from_records import FromRecords
    from fieldhand.places.earlier.period import Period
    from fieldhand.places.earlier.recorded_work import EarlierStatistic
    from fieldhand.places.earlier.where_earlier import WhereEarlier
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.model import Site

_CALENDAR = {
    "ever": message("before"),
    "today": message("today"),
    "yesterday": message("yesterday"),
    "this_week": message("this week"),
    "last_week": message("last week"),
    "this_month": message("this month"),
    "last_month": message("last month"),
    "this_year": message("this year"),
    "last_year": message("last year"),
    "mon": message("last Monday"),
    "tue": message("last Tuesday"),
    "wed": message("last Wednesday"),
    "thu": message("last Thursday"),
    "fri": message("last Friday"),
    "sat": message("last Saturday"),
    "sun": message("last Sunday"),
}
_DAYS = {
    "mon": message("Monday"),
    "tue": message("Tuesday"),
    "wed": message("Wednesday"),
    "thu": message("Thursday"),
    "fri": message("Friday"),
    "sat": message("Saturday"),
    "sun": message("Sunday"),
}


def say_period(period: Period) -> str:
    """Return a period as an adverb: "yesterday", "in the last 7 days", "from 2026-11-01 to 2026-11-15"."""
    if period.last_missions is not None:
        return counted("in the last mission", "in the last {count} missions", period.last_missions)
    if period.last_hours is not None:
        return counted("in the last hour", "in the last {count} hours", period.last_hours)
    if period.last_days is not None:
        return counted("in the last 24 hours", "in the last {count} days", period.last_days)
    if period.last_months is not None:
        return counted("in the last month", "in the last {count} months", period.last_months)
    if period.first_day and period.last_day:
        if period.first_day == period.last_day:
            return message("on {day}", day=_day(period.first_day))
        return message("from {first} to {last}", first=_day(period.first_day), last=_day(period.last_day))
    if period.first_day:
        return message("since {day}", day=_day(period.first_day))
    if period.last_day:
        return message("until {day}", day=_day(period.last_day))
    return _CALENDAR[period.calendar]


def _day(text: str) -> str:
    if text in _DAYS:
        return _DAYS[text]
    yearly = text.removeprefix("--")
    try:
        date_from_iso(f"2024-{yearly}" if text.startswith("--") else text)
    except ValueError:
        return message("“{day}”", day=named(text, "day"))
    return Number(yearly)


def say_done(selector: DoneEarlier) -> str:
    """Return the clause of places by what was done there: "visited yesterday to take a picture"."""
    when, what = say_period(selector.period), _purpose(selector)
    match selector.outcome:
        case "left_out":
            return message("left out by a mission {period}", period=when)
        case "failed":
            if not what:
                return message("worked on {period} without success", period=when)
            return message("visited {period} without success to {action}", period=when, action=what)
        case "done":
            if selector.at_least > 1 and not what:
                return message("worked on by at least {count} missions {period}", count=selector.at_least, period=when)
            if selector.at_least > 1:
                return message(
                    "visited by at least {count} missions {period} to {action}",
                    count=selector.at_least,
                    period=when,
                    action=what,
                )
            if not what:
                return message("worked on {period}", period=when)
            return message("visited {period} to {action}", period=when, action=what)


def say_not_done(selector: DoneEarlier) -> str:
    """Return the clause of all other places: "not visited yesterday to take a picture"; empty if there is none."""
    if selector.outcome != "done" or selector.at_least > 1:
        return ""
    when, what = say_period(selector.period), _purpose(selector)
    if not what:
        return message("not worked on {period}", period=when)
    return message("not visited {period} to {action}", period=when, action=what)


def say_nothing_done(selector: DoneEarlier, records: EarlierMissions, site: Site) -> str:
    """Return that no place passes a selector, with the reason and what it means for the other places."""
    words = say_selector(selector)
    why = say_no_mission(records, site) if not records.missions else ""
    if selector.of != Trees():
        none = message("there are none of {trees}", trees=words)
    else:
        none = message(
            "there are none of {trees}, so all {count} trees count as not done", trees=words, count=len(site.trees)
        )
    return message("{what}: {why}", what=none, why=why) if why else none


def say_no_mission(records: EarlierMissions, site: Site) -> str:
    """Return that no mission on a site is on record, and how many simulations do not count."""
    if records.simulations:
        return counted(
            "no earlier mission on '{site}' is on record, except {count} simulation (--count-simulated counts it)",
            "no earlier mission on '{site}' is on record, except {count} simulations (--count-simulated counts them)",
            records.simulations,
            site=site.name,
        )
    return message("no earlier mission on '{site}' is on record", site=site.name)


def doubt_without_reading(selector: FromRecords, quantity: str, period: Period, site: Site) -> str:
    """Return that a selector has no reading to choose by; empty if it has."""
    if site.earlier is None or selector.used(site.earlier):
        return ""
    return say_no_reading(site.earlier, site, quantity, period)


def say_no_reading(records: EarlierMissions, site: Site, quantity: str, period: Period) -> str:
    """Return that no reading of a quantity is on record in a period."""
    if not records.missions:
        return say_no_mission(records, site)
    return message(
        "no earlier reading of {name} is on record ({period})", name=say_name(quantity), period=say_period(period)
    )


def _purpose(selector: DoneEarlier) -> str:
    if selector.action:
        return say_action(selector.action)
    if selector.measured:
        return message("measure the {name}", name=say_name(selector.measured))
    return ""


def say_passed(selector: WhereEarlier) -> str:
    """Return the clause of places by an earlier reading: "whose temperature read last week was above 30 °C"."""
    name, when = say_statistic_of(selector.statistic, selector.quantity), say_period(selector.period)
    amount = say_quantity(selector.value, selector.unit)
    match selector.test:
        case "eq":
            return message("whose {name} read {period} was {amount}", name=name, period=when, amount=amount)
        case "ne":
            return message("whose {name} read {period} was not {amount}", name=name, period=when, amount=amount)
        case "lt":
            return message("whose {name} read {period} was below {amount}", name=name, period=when, amount=amount)
        case "le":
            return message("whose {name} read {period} was at most {amount}", name=name, period=when, amount=amount)
        case "gt":
            return message("whose {name} read {period} was above {amount}", name=name, period=when, amount=amount)
        case "ge":
            return message("whose {name} read {period} was at least {amount}", name=name, period=when, amount=amount)


def say_statistic_of(of: EarlierStatistic, quantity: str) -> str:
    """Return a reading with its statistic, without an article: "temperature" (the latest), "mean temperature"."""
    name = say_name(quantity)
    match of:
        case "latest":
            return name
        case "mean":
            return message("mean {name}", name=name)
        case "median":
            return message("median {name}", name=name)
        case "minimum":
            return message("lowest {name}", name=name)
        case "maximum":
            return message("highest {name}", name=name)
