"""Constructions of ground on which the robot drives slowly: "at most 0.5 m/s within 10 m of the pond"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.ways import kept_from
from fieldhand.planning.grammar.meaning import PaceClause, PlaceMeaning, SlowPlace, WayRule
from fieldhand.planning.grammar.places.steps import Distance
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction

SlowPlaces = tuple[SlowPlace, ...]


@construction(
    "slow_there: word=AT place=place", "slow_there: ALONG place=place", "slow_there: THROUGH place=place", cost=0.1
)
def there(place: PlaceMeaning, word: Lex | None = None) -> SlowPlaces | None:
    """Compose "in row 3"."""
    if word is not None and "within" not in word.features:
        return None
    places = kept_from(place)
    return None if places is None else tuple(SlowPlace(one, 0.0) for one in places)


@construction("slow_there: at=distance", cost=0.1)
def within_distance(at: Distance) -> SlowPlaces | None:
    """Compose "within 10 m of the pond"."""
    low, high, to = at
    places = None if low or high is None else kept_from(to, high)
    return None if places is None or high is None else tuple(SlowPlace(one, high) for one in places)


@construction("slow_there: NEAR place=place", "slow_there: NEXTTO place=place", cost=0.1)
def nearby(place: PlaceMeaning) -> SlowPlaces | None:
    """Compose "near the pond", of which no distance is said."""
    places = kept_from(place, 1.0)
    return None if places is None else tuple(SlowPlace(one, None) for one in places)


@construction("slow_there: first=slow_there AND second=slow_there", cost=0.1)
def both_places(first: SlowPlaces, second: SlowPlaces) -> SlowPlaces:
    """Compose "in row 3 and within 10 m of the pond"."""
    return (*first, *second)


@construction("way_rule: how=pace [COMMA] at=slow_there", "way_rule: at=slow_there [COMMA] how=pace", cost=0.2)
def slow_at(how: PaceClause, at: SlowPlaces, used: int) -> WayRule:
    """Compose "drive at most 0.5 m/s within 10 m of the pond"."""
    return WayRule(slow=tuple(replace(one, pace=how) for one in at), used=used)
