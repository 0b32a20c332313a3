"""Text about the places of a step: names, order of visits, and expected number of visits."""

from __future__ import annotations

from fieldhand.language import counted, message
from fieldhand.language.words import say_rounded
from fieldhand.places.selector import Selector
from fieldhand.places.wording import say_places, say_selector
from fieldhand.site.model import Site
from fieldhand.task.plan import ForEach
from fieldhand.wording.resolved_places import ResolvedPlaces

#: Optional visits with a probability below the first value are named, if there are no more than the second.
_SURE, _NAMED = 0.9, 6


def say_expected(resolved: ResolvedPlaces | None) -> str:
    """Return the forecast for an optional step: it fits the budget or not, or how often if it is repeated."""
    if resolved is None:
        return ""
    fit, times = sum(bool(visit) for visit in resolved.visits), len(resolved.visits)
    if times > 1 and 0 < fit < times:
        return message("(according to the estimate, about {count} of {total} times)", count=fit, total=times)
    return (
        message("(according to the estimate, it does)") if fit else message("(according to the estimate, it does not)")
    )


def say_expected_visits(resolved: ResolvedPlaces | None) -> str:
    """Return the expected number of optional visits, the probability of running short, and the visits dropped first."""
    if resolved is None or resolved.visit_forecast is None:
        return ""
    chance = message(
        "{expected} of {total} expected, {chance} % chance of running short",
        expected=say_rounded(resolved.visit_forecast.visits),
        total=len(resolved.places) + len(resolved.shed),
        chance=say_rounded(100 * resolved.short),
    )
    doubtful = sorted((chance, place) for place, chance in resolved.visit_forecast.chances.items() if chance < _SURE)
    if not 0 < len(doubtful) <= _NAMED:
        return message("({expectation})", expectation=chance)
    ids, count = say_places(tuple(place for _, place in doubtful)), len(doubtful)
    if {place.kind for place in (*resolved.places, *resolved.shed)} == {"tree"}:
        first = counted("tree {ids} is left out first", "trees {ids} are left out first", count, ids=ids)
    else:
        first = counted("{ids} is left out first", "{ids} are left out first", count, ids=ids)
    return message("({expectation}; {gone_first})", expectation=chance, gone_first=first)


def say_ids(selector: Selector, resolved: ResolvedPlaces | None, site: Site) -> str:
    """Return the ids of the places if they are few and not named yet, or those of each group."""
    if resolved is None:
        return ""
    if resolved.known and (groups := selector.say_groups(resolved.places, site)):
        return message("({ids})", ids=groups)
    ids = tuple(p.id for p in resolved.places)
    text = say_selector(selector)
    if selector.decided_by_readings:
        return message("(decided on the way by the readings)")
    if not resolved.known:
        return message("(decided on the way; most likely {ids})", ids=say_places(ids))
    new = 0 < len(ids) <= 12 and not all(i in text.split() for i in ids)
    return message("({ids})", ids=say_places(ids)) if new else ""


def in_order(node: ForEach, at: str, count: int) -> str:
    """Return the text of the places with the order of visits, if there are several."""
    if count < 2:
        return at
    if node.order == "given":
        return message("{at_places}, in that order", at_places=at)
    return message("{at_places}, in the order with the least driving", at_places=at)
