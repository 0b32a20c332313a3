"""Constructions of what is done on the way home and behind it, and of where the robot is in the end."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    DriveCommand,
    Home,
    LimitClause,
    LinkedCommand,
    PlaceMeaning,
    Said,
)
from fieldhand.planning.grammar.places.sampling import bare_points, is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "said: word=ONTHEWAY [COMMA] one=capture FULLSTOP rest=said",
    "said: word=ONTHEWAY [COMMA] one=capture COMMA BUT FIRSTONE rest=said",
    cost=0.2,
)  # fmt: skip
def on_the_way_home(word: Lex, one: CaptureCommand, rest: Said, used: int) -> Said | None:
    """Compose "on your way home, read the CO2 at tree 4. Photograph row 3."."""
    if "homewards" not in word.features or one.place is None:
        return None
    own = used & ~one.used & ~rest.used
    return Said((*rest.clauses, LinkedCommand(Connective(True, True, own), one)))


@construction("said: before=said joint=joint BACKAGAIN [COMMA] one=capture", cost=0.1)
def done_at_home(before: Said, joint: Connective, one: CaptureCommand, used: int) -> Said:
    """Compose "... When you get back, read the CO2.", which is at the start if no place is said."""
    own = used & ~joint.used & ~one.used & ~before.used
    if one.place is None:
        one = replace(one, place=PlaceMeaning(s.Marker(name="start"), "one"), relation="at")
    last = Connective(True, True, joint.used | own)
    return Said((*before.clauses, LinkedCommand(last, one)))


@construction(
    "said: before=said joint=joint STAYV [AT] place=place", "said: before=said joint=joint STAYV relation where=region",
    cost=0.6, given=("site",),
)  # fmt: skip
def stays_there(
    before: Said,
    joint: Connective,
    used: int,
    site: Site,
    place: PlaceMeaning | None = None,
    where: s.Selector | None = None,
) -> Said | None:
    """Compose "... and stay at the gate"."""
    spot = bare_points(where, site, 1) if where is not None and not is_keep_out(where, site) else None
    there = PlaceMeaning(spot, "one") if spot is not None else place
    if there is None or there.shape != "one" or there.selector.relative:
        return None
    own = used & ~joint.used & ~before.used
    return Said((*before.clauses, LinkedCommand(joint, DriveCommand(there, own, returns=True, ends=True))))


@construction(
    "time_up: WHERE TIMEUP", "time_up: ASSOONAS TIMEUP", "time_up: WHERE [DET] amount IS DONE",
    "time_up: ASSOONAS [DET] amount IS DONE", "time_up: INGOODTIME", cost=0.1,
)  # fmt: skip
def time_up() -> str:
    """Compose "when the time is up"."""
    return "time is up"


@construction(
    "by_time: way=drive [COMMA] time_up", "by_time: time_up [COMMA] way=drive",
    "by_time: way=home [COMMA] time_up", "by_time: time_up [COMMA] way=home", cost=0.1,
)  # fmt: skip
def there_in_time(way: DriveCommand | Home, used: int) -> DriveCommand | Home:
    """Compose "be at the table when the time is over"."""
    if not isinstance(way, DriveCommand):
        return replace(way, used=used)
    marker = way.place.selector.named_marker
    if marker in ("start", "end"):
        return Home("return_to_start" if marker == "start" else "return_to_end", used)
    return replace(way, used=used, returns=True, ends=True)


@construction("by_time: BEAT [relation] where=region [COMMA] time_up", cost=0.2, given=("site",))
@construction("by_time: time_up [COMMA] BEAT [relation] where=region", cost=0.2, given=("site",))
def on_ground_in_time(where: s.Selector, used: int, site: Site) -> DriveCommand | None:
    """Compose "be at the rose bed when the time is over"."""
    spot = None if is_keep_out(where, site) else bare_points(where, site, 1)
    return None if spot is None else DriveCommand(PlaceMeaning(spot, "one"), used, returns=True, ends=True)


@construction("said: before=said joint=joint way=by_time", cost=0.1)
def ended_in_time(before: Said, joint: Connective, way: DriveCommand | Home) -> Said | None:
    """Compose "... and be at the table when the time is over", of a time that was said."""
    limits = [one.command for one in before.clauses if isinstance(one.command, LimitClause) and not one.command.keep]
    known = any(one.amount.unit == "seconds" for one in limits)
    return Said((*before.clauses, LinkedCommand(joint, way))) if known else None
