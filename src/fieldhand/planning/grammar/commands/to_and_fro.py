"""Constructions of drives between two places, so many times: "go back and forth between the gates three times"."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    Again,
    Amount,
    CaptureCommand,
    Connective,
    DriveCommand,
    LinkedCommand,
    PlaceMeaning,
    Said,
    Thing,
)
from fieldhand.planning.grammar.places.sampling import bare_points, is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Maximum number of rounds.
_MOST_ROUNDS = 100


@dataclass(frozen=True, slots=True)
class Shuttle:
    """A drive between two places.

    Attributes:
        places: The two places.
        used: Tokens of the phrase, without those of how often.
        times: Number of rounds; 0 if the phrase gives none.
        of_times: Tokens of how often.
        things: What is captured at each of them.
        battery: Charge of the battery in percent at which it ends.
    """

    places: tuple[PlaceMeaning, PlaceMeaning]
    used: int
    times: int = 0
    of_times: int = 0
    things: tuple[Thing, ...] = ()
    battery: float | None = None


@construction("rounds_made: n=often", "rounds_made: n=count ROUND", "rounds_made: FOR n=count ROUND", cost=0.0)
def rounds_made(n: int, used: int) -> tuple[int, int] | None:
    """Compose "three times" with its tokens."""
    return (n, used) if 1 < n <= _MOST_ROUNDS else None


@construction("turning_place: place=place", "turning_place: where=region", cost=0.0, given=("site",))
def turning_place(
    site: Site, place: PlaceMeaning | None = None, where: s.Selector | None = None
) -> PlaceMeaning | None:
    """Compose "tree 4" and "the trough", to whose middle the robot drives."""
    if where is None:
        return place
    middle = None if is_keep_out(where, site) else bare_points(where, site, 1)
    return None if middle is None else PlaceMeaning(middle, "one")


@construction(
    "two_places: BETWEEN first=turning_place AND second=turning_place",
    "two_places: FROM first=turning_place AT second=turning_place",
    cost=0.0,
)
def two_places(first: PlaceMeaning, second: PlaceMeaning) -> tuple[PlaceMeaning, PlaceMeaning] | None:
    """Compose "between tree 4 and tree 9"."""
    known = all(one.shape == "one" and not one.refers_back and not one.optional for one in (first, second))
    return (first, second) if known and first.selector != second.selector else None


@construction("two_places: BETWEEN both=place", cost=0.2)
def both_places(both: PlaceMeaning) -> tuple[PlaceMeaning, PlaceMeaning] | None:
    """Compose "between the two gates"."""
    if both.shape != "several" or len(both.selector.members) != 2 or both.count not in (None, 2):
        return None
    first, second = (PlaceMeaning(part, "one", tokens=both.tokens) for part in both.selector.members)
    return first, second


@construction(
    "shuttle: [KEEPON] [GO] TOANDFRO places=two_places", "shuttle: [KEEPON] verb=GO places=two_places", cost=0.1
)
def to_and_fro(places: tuple[PlaceMeaning, PlaceMeaning], used: int, verb: Lex | None = None) -> Shuttle | None:
    """Compose "go back and forth between tree 4 and tree 9" and "patrol between the gates"."""
    return Shuttle(places, used) if verb is None or "patrols" in verb.features else None


@construction("shuttle: one=shuttle [COMMA] low=until_low", cost=0.1)
@construction("shuttle: [KEEPON] low=until_low [COMMA] one=shuttle", cost=0.1)
def shuttle_until_low(one: Shuttle, low: Amount, used: int) -> Shuttle | None:
    """Compose "back and forth between the gates until the battery is down to 40 %"."""
    known = one.battery is None and not one.times
    return replace(one, times=_MOST_ROUNDS, battery=low.number, of_times=used & ~one.used) if known else None


@construction(
    "shuttle: [GO] TOANDFRO times=rounds_made places=two_places",
    "shuttle: GO times=rounds_made TOANDFRO places=two_places",
    "shuttle: GO BETWEEN first=place AND second=place [COMMA] times=rounds_made",
    cost=0.1,
)
def to_and_fro_so_often(
    times: tuple[int, int],
    used: int,
    places: tuple[PlaceMeaning, PlaceMeaning] | None = None,
    first: PlaceMeaning | None = None,
    second: PlaceMeaning | None = None,
) -> Shuttle | None:
    """Compose "go back and forth three times between tree 4 and tree 9"."""
    if places is None and first is not None and second is not None:
        places = two_places(first, second)
    number, tokens = times
    return None if places is None else Shuttle(places, used & ~tokens, number, tokens)


@construction("shuttle: one=shuttle [COMMA] times=rounds_made", cost=0.1)
def shuttle_so_often(one: Shuttle, times: tuple[int, int], used: int) -> Shuttle | None:
    """Compose "back and forth between tree 4 and tree 9, three times"."""
    number, tokens = times
    return None if one.times else replace(one, times=number, of_times=tokens, used=used & ~tokens)


@construction(
    "shuttle: one=shuttle [COMMA] WITH things=things [place=here]",
    "shuttle: one=shuttle [COMMA] [AND] act=capture",
    cost=0.1,
)
def shuttle_with(
    one: Shuttle,
    used: int,
    things: tuple[Thing, ...] = (),
    place: PlaceMeaning | None = None,
    act: CaptureCommand | None = None,
) -> Shuttle | None:
    """Compose "back and forth between tree 4 and tree 9 with a picture at each"."""
    if act is not None:
        things, place = act.things, act.place
        if act.times != 1 or act.spacing is not None or act.within is not None:
            return None
    fits = place is None or (place.each and place.shape in ("here", "those"))
    return replace(one, things=things, used=used & ~one.of_times) if fits and not one.things else None


@construction("command: one=shuttle", cost=0.2)
def only_driven(one: Shuttle) -> Again | None:
    """Compose "go back and forth between the gates until the battery is at 40 %", with nothing done there."""
    used = one.used | one.of_times
    return None if one.things else Again(None, used, times=one.times, drives=one.places, battery=one.battery)


@construction("said: one=shuttle", cost=0.2)
def shuttled(one: Shuttle) -> Said | None:
    """Compose "go back and forth between tree 4 and tree 9 three times" as the first commands."""
    if not one.times or not one.things:
        return None
    then = Connective(False, True, 0)
    made: list[LinkedCommand] = []
    for place in one.places:
        before = then if made else None
        made.append(LinkedCommand(before, DriveCommand(place, one.used)))
        made.append(LinkedCommand(then, CaptureCommand(one.things, PlaceMeaning(s.Here(), "here"), one.used)))
    again = Again(None, one.of_times, times=one.times, in_all=True, whole=True, battery=one.battery)
    return Said((*made, LinkedCommand(then, again)))
