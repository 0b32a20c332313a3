"""Constructions of commands to drive, to return and to stop, of leading places, and of the order of visits."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    Again,
    Along,
    DriveCommand,
    Home,
    InAnOrder,
    Lead,
    Nominal,
    PlaceMeaning,
    RankCommand,
    StopCommand,
    Thing,
)
from fieldhand.planning.grammar.places.compass import AWAY_FROM
from fieldhand.planning.grammar.places.groups import both
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.numbers import named_trees
from fieldhand.planning.grammar.places.sampling import bare_points, is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_some, is_by_attribute, is_row_of_place
from fieldhand.site.model import Site
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("drive: TAKE place=place", cost=1.5)
def pick(place: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "take three trees"."""
    return DriveCommand(place, used, picks=True) if place.shape == "several" else None


@construction(
    "stops: first=place [COMMA] [AND] then [COMMA] [AT] second=place",
    "stops: first=stops [COMMA] [AND] then [COMMA] [AT] second=place",
    cost=0.3,
)
def stops(first: PlaceMeaning, second: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "tree 4, then tree 9" behind "go to"."""
    found = both(first, second)
    return replace(found, in_order=True) if isinstance(found, PlaceMeaning) else None


@construction(
    "drive: verb=GO [AT] place=place",
    "drive: verb=GO along=ALONG place=place",
    "drive: VISIT place=place",
    "drive: GO [towards] place=stops",
    "drive: VISIT place=stops",
    cost=0.3,
)
def drive_to(place: PlaceMeaning, used: int, verb: Lex | None = None, along: Lex | None = None) -> DriveCommand | None:
    """Compose "go to tree 4"."""
    if verb is not None and "patrols" in verb.features:
        return None  # of which trees, and what is done there?
    if along is not None and place.shape == "several" and as_some(place.selector) is not None:
        return None  # "along 5 trees": those follow each other
    if along is not None and getattr(place.selector, "shape", "") == "edge":
        return None  # "along the north edge of the meadow", which is no one place
    return DriveCommand(place, used, begins=verb is not None and "begins" in verb.features)


@construction("drive_on: after=THEN [COMMA] word=AT place=place", cost=1.0)
def on_to(after: Lex, word: Lex, place: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "then to tree 9" behind "drive to tree 4 and measure CO2"; "next to tree 9" is a place."""
    moves = "motion" in word.features and not {"names_place", "after_doing"} & after.features
    return DriveCommand(place, used) if moves and place.shape == "one" else None


@construction("drive: verb=MEASURE place=place", "drive: verb=TAKE place=place", cost=2.0)
def look_at(place: PlaceMeaning, verb: Lex, used: int) -> DriveCommand | None:
    """Compose "inspect row 4" before what is done there."""
    return DriveCommand(place, used) if place.shape == "area" and "goes_there" in verb.features else None


@construction("drive: way=drive [COMMA] word=THEN", cost=0.3)
def drive_afterwards(way: DriveCommand, word: Lex, used: int) -> DriveCommand | None:
    """Compose "return to the charger afterwards"."""
    return replace(way, used=used) if "when_done" in word.features and way.returns else None


@construction("drive: way=drive INSTEAD", cost=0.2)
def drive_instead(way: DriveCommand, used: int) -> DriveCommand:
    """Compose "go five trees south instead", in another case."""
    return replace(way, used=used, instead=True)


@construction("drive: way=ALONG where=region GO", "drive: AT place=place GO", "drive: ALONG place=place GO", cost=0.3)
def goes_there(
    used: int, place: PlaceMeaning | None = None, where: s.Selector | None = None, way: Lex | None = None
) -> DriveCommand | None:
    """Compose "up row 3 you go" and "off to tree 4 you go"."""
    if where is not None:
        return drive_along(where, used, way)
    return DriveCommand(place, used) if place is not None and place.shape == "one" else None


@construction("drive: GO ALONG n=count inner=nominal", cost=0.1)
def along_so_many(n: int, inner: Nominal, used: int) -> DriveCommand | None:
    """Compose "drive along 5 trees", which follow each other in a row."""
    if inner.single or inner.complete or n < 2:
        return None
    return DriveCommand(PlaceMeaning(s.Successive(count=n, of=inner.selector), "several", count=n), used)


@construction("towards: AT", "towards: ALONG", cost=0.0)
def towards() -> str:
    """Compose "to"."""
    return "to"


@construction("drive: STARTING place=marker", "drive: STARTING [AT] place=marker", cost=0.2)
def starting_from(place: s.Selector, used: int) -> DriveCommand:
    """Compose "starting from the barn"."""
    return DriveCommand(PlaceMeaning(place, "one"), used, begins=True)


@construction("drive: verb=GO WITH place=place", cost=0.5)
def begin_with(verb: Lex, place: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "start with tree 4"."""
    begins = place.shape == "one" and "goes_on" not in verb.features
    return DriveCommand(place, used, begins=True) if begins else None


@construction("again: verb=GO WITH place=place", cost=0.5)
def go_on_with(verb: Lex, place: PlaceMeaning, used: int) -> Again | None:
    """Compose "continue with tree 5", where the same is done."""
    return Again(place, used) if "goes_on" in verb.features else None


@construction("lead: verb=GO WITH place=place", "lead: place=place FIRSTONE", cost=0.8)
def begin_in(place: PlaceMeaning, used: int, verb: Lex | None = None) -> Lead | None:
    """Compose "start with row 1" before what is done there."""
    begins = verb is None or "goes_on" not in verb.features
    return Lead(place, used, begins=begins) if place.shape == "area" else None


@construction("drive: word=RETURN [AT] place=place", cost=0.5)
def come_back_to(place: PlaceMeaning, word: Lex, used: int) -> DriveCommand | None:
    """Compose "come back to tree 4" and "ending at the charger"."""
    if place.selector.named_marker not in ("", "charger"):
        return None  # the end of the mission
    ends = "ends_there" in word.features
    return DriveCommand(place, used, returns=True, ends=ends) if place.shape == "one" else None


@construction("drive: word=RETURN [relation] where=region", cost=0.6, given=("site",))
def end_on_ground(word: Lex, where: s.Selector, used: int, site: Site) -> DriveCommand | None:
    """Compose "finish at the trough" and "end up in the wet corner"."""
    middle = bare_points(where, site, 1)
    ends = bool({"ends_there", "back", "needs_place"} & word.features) or word.text in ("park", "park up")
    if middle is None or is_keep_out(where, site) or not ends:
        return None
    return DriveCommand(PlaceMeaning(middle, "one"), used, returns=True, ends="ends_there" in word.features)


@construction(
    "drive: GO way=ALONG where=region", "drive: verb=GO to=AT where=region", "drive: verb=GO where=region", cost=0.2
)
def drive_along(
    where: s.Selector, used: int, way: Lex | None = None, to: Lex | None = None, verb: Lex | None = None
) -> DriveCommand:
    """Compose "drive along row 3"."""
    place = PlaceMeaning(where, "area")
    if way is None:
        begins = verb is not None and "begins" in verb.features
        to_it = to is not None and not to.features.isdisjoint({"motion", "within"})
        return DriveCommand(place, used, begins=begins and to_it, to=to_it)
    along: Along = "up" if "upwards" in way.features else "down" if "downwards" in way.features else "along"
    return DriveCommand(place, used, along=along)


@construction("ordered: order=ORDERED", "ordered: AT order=ORDERED", cost=0.1)
def compass_order(order: Lex) -> tuple[str, str, bool]:
    """Compose "from west to east"."""
    return (order.value[0], "", False)


@construction("ordered: ORDEROF attribute=ATTR", "ordered: ORDEROF DET attribute=ATTR", cost=0.1)
def order_of_attribute(attribute: Lex) -> list[tuple[str, str, bool]]:
    """Compose "in order of age"."""
    return [("attribute", name, False) for name in attribute.value]


@construction(
    "an_end: [DET] side=DIR [FINISH]",
    "an_end: [DET] side=DIR FINISH OF [DET] [ROW]",
    "an_end: [DET] side=DIR SIDE",
    "an_end: ITS side=DIR FINISH",
    "an_end: [DET] side=MOST [TREE]",
    "an_end: [DET] side=MOST ONE",
    cost=0.1,
)
def an_end(side: Lex) -> str | None:
    """Compose "the south end"."""
    return side.value if side.value in AWAY_FROM else None


@construction(
    "ordered: FROM side=an_end",
    "ordered: [GOING] STARTING side=an_end",
    "ordered: side=an_end FIRSTONE",
    "ordered: side=an_end BEGINSTHERE",
    "ordered: STARTING side=an_end [COMMA] [AND] ENDING last=an_end",
    "ordered: [GOING] FROM side=an_end AT last=an_end",
    "ordered: ONWAY [AT] last=an_end",
    "ordered: AT last=an_end ONWAY",
    cost=0.1,
)
def from_an_end(side: Side | None = None, last: Side | None = None) -> tuple[str, str, bool] | None:
    """Compose "from its southern end", "the south end being where you begin" and "going north"."""
    if side is None:
        return next(((by, "", False) for by in AWAY_FROM.values() if by.endswith(f"_to_{last}")), None)
    by = AWAY_FROM[side]
    return (by, "", False) if last is None or by == f"{side}_to_{last}" else None


@construction(
    "ordered: [GOING] FROM [DET] first=ranking [ONE] AT [DET] last=ranking [ONE]",
    cost=0.1,
)
def from_best_to_worst(first: tuple[str, bool], last: tuple[str, bool]) -> tuple[str, str, bool] | None:
    """Compose "from the oldest to the youngest"."""
    if not first[0] or first[0] != last[0] or first[1] == last[1]:
        return None
    return ("attribute", first[0], not first[1])


@construction("ordered: [DET] rank=ranking [TREE] FIRSTONE", "ordered: STARTING [DET] rank=ranking [ONE]", cost=0.1)
@construction("ordered: STARTING [DET] rank=ranking TREE", cost=0.1)
def best_first(rank: tuple[str, bool]) -> tuple[str, str, bool] | None:
    """Compose "oldest first"."""
    return ("attribute", rank[0], not rank[1]) if rank[0] else None


@construction(
    "ranked_first: SORT trees=place BY [DET] attribute=ATTR",
    "ranked_first: SORT trees=place BY [DET] attribute=ATTR [COMMA] HIGHTOLOW",
    cost=0.2,
)
def ranked_first(trees: PlaceMeaning, attribute: Lex, used: int) -> list[RankCommand] | None:
    """Compose "rank the trees by yield, high to low"."""
    if trees.shape != "several" or trees.count is not None or trees.per is not None:
        return None
    return [RankCommand(trees, name, used) for name in attribute.value]


@construction("order: order=ordered", "order: GO order=ordered", "order: APPROACH order=ordered", cost=0.2)
def in_an_order(order: tuple[str, str, bool], used: int) -> InAnOrder:
    """Compose "visit them from west to east" and "come at it from the south"."""
    return InAnOrder(order[0], order[1], order[2], used)


@construction("order: VISIT one=order", cost=0.2)
def visited_in_order(one: InAnOrder, used: int) -> InAnOrder:
    """Compose "visited in the shortest order"."""
    return replace(one, used=used)


@construction("order: ONEBYONE", cost=0.2)
def one_by_one(used: int) -> InAnOrder:
    """Compose "go along row 3 tree by tree"."""
    return InAnOrder("each", "", False, used)


@construction(
    "order: INORDER",
    "order: ORDERBY THISORDER ORDERWORD",
    "order: ORDERBY [DET] ORDERWORD GIVEN",
    "order: KEEPORDER THISORDER ORDERWORD",
    "order: KEEPORDER DET ORDERWORD [GIVEN]",
    "order: [DET] ORDERWORD MATTERS",
    "order: [DET] ORDERWORD [COMMA] [IS] GIVEN",
    cost=0.2,
)
def in_that_order(used: int) -> InAnOrder:
    """Compose "in that order", "in the order listed" and "the order matters"."""
    return InAnOrder("", "", False, used)


@construction("things: some=things [COMMA] order=order [COMMA]", cost=0.3)
def things_in_that_order(some: tuple[Thing, ...], order: InAnOrder) -> tuple[Thing, ...] | None:
    """Compose "CO2 and a picture, in that order," before their place."""
    return some if len(some) > 1 and not order.by else None


@construction("order: REVERSE", cost=0.2)
def in_reverse_order(used: int) -> InAnOrder:
    """Compose "in reverse order"."""
    return InAnOrder("reverse", "", False, used)


@construction(
    "order: NOORDER",
    "order: DISTINCT",
    "order: ACTV DISTINCT",
    "order: verb DISTINCT",
    "order: VISIT DISTINCT",
    "order: [DET] ORDERWORD [COMMA] [IS] ORDERFREE",
    "order: [ORDERBY] WHATEVER ORDERWORD [ORDERSUITS]",
    "order: [ORDERBY] WHATEVER ORDERWORD [IS] ORDERBEST",
    "order: WHATEVER ORDERWORD REMAINS",
    "order: ORDERWORD COMMA WHATEVER",
    "order: ORDERBY [DET] ORDERBEST ORDERWORD",
    "order: [DET] ORDERBEST ORDERWORD",
    "order: ORDERBY [DET] ORDERWORD [WHICH] [IS] ORDERBEST",
    "order: CHOOSEORDER [DET] ORDERWORD [ITSELF]",
    cost=0.2,
)
def in_any_order(used: int) -> InAnOrder:
    """Compose "in any order", "in whatever order suits you" and "the order of visits is free"."""
    return InAnOrder("any", "", False, used)


@construction(
    "order: INEACHCASE [GO] [AT] [DET] NEAREST [ONE] [NEXTONE] [LEFT]",
    "order: [GO] [AT] [DET] NEAREST [ONE] [LEFT] NEXTONE",
    "order: [GO] [AT] [DET] NEAREST [ONE] [LEFT] INEACHCASE",
    "order: INEACHCASE [GO] [AT] [DET] NEAREST TREE [NEXTONE] [LEFT]",
    "order: [GO] [AT] [DET] NEAREST TREE [LEFT] NEXTONE",
    cost=0.1,
)  # fmt: skip
def always_the_nearest(used: int) -> InAnOrder:
    """Compose "always going to the nearest one next"."""
    return InAnOrder("any", "nearest", False, used)


@construction("lead: place=place", cost=1.6)
def bare_place(place: PlaceMeaning, used: int) -> Lead | None:
    """Compose "tree 4, ..."."""
    return Lead(place, used, relation="") if place.shape in ("one", "several", "area") else None


@construction("lead: word=relation place=place", cost=0.5)
def lead(place: PlaceMeaning, used: int, word: str) -> Lead | None:
    """Compose "at tree 4, ..."."""
    return Lead(place, used, word) if place.shape in ("one", "several", "area") else None


@construction("lead: word=relation place=place [COMMA] AND relation second=place", cost=3.0)
def lead_to_both(place: PlaceMeaning, second: PlaceMeaning, used: int, word: str) -> list[Lead] | None:
    """Compose "at tree 4 and at tree 9, ..."."""
    found = both(place, second)
    places = found if isinstance(found, list) else [] if found is None else [found]
    return [Lead(replace(one, in_order=True), used, word) for one in places] or None


@construction("lead: word=THEN place=place", cost=0.5)
def after_the_last(place: PlaceMeaning, word: Lex, used: int) -> Lead | None:
    """Compose "after the last one, ..." of what is done there as well."""
    last = place.like is not None and place.like.kind == "nth" and place.like.number == -1
    return Lead(place, used) if last and "after_doing" in word.features else None


@construction(
    "lead: [ONRECORD] [COMMA] MAPLISTS [DET] inner=nominal", "lead: MAPLISTS [DET] inner=nominal [COMMA] ONRECORD",
    "lead: [ONRECORD] [COMMA] MAPLISTS n=count inner=nominal", cost=0.3, given=("site",),
)  # fmt: skip
def listed_on_the_map(inner: Nominal, used: int, site: Site, n: int | None = None) -> Lead | None:
    """Compose "our map lists some plants with a moisture over 40", all of which are meant."""
    found = ids_of(inner.selector, site) if is_by_attribute(inner.selector) else None
    if not inner.plural or inner.single or inner.pronoun or not found or n not in (None, len(found)):
        return None
    return Lead(PlaceMeaning(inner.selector, "several", each=True), used, relation="topic")


@construction("lead: TOPIC place=place", "lead: place=place TOPIC", cost=0.3)
def topic(place: PlaceMeaning, used: int) -> Lead | None:
    """Compose "our focus is the northern half", of what the next sentences are about."""
    return Lead(place, used, relation="topic") if place.shape in ("one", "several", "area") else None


@construction(
    "lead: relation place=place [COMMA] things=things [OF] [DET] [GROUND] MATTERS",
    "lead: things=things relation place=place MATTERS",
    cost=0.3,
)
def topic_things(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> Lead | None:
    """Compose "in the northern half the nitrate of the soil matters"."""
    if place.shape not in ("one", "several", "area") or any(one.count is not None for one in things):
        return None
    return Lead(place, used, relation="topic", things=things)


@construction("lead: site IS place=place", cost=0.6)
def topic_of_site(place: PlaceMeaning, used: int) -> Lead | None:
    """Compose "the farm has four corners"."""
    return Lead(place, used, relation="topic") if place.shape == "several" else None


@construction("lead: place=place REMAINS", cost=0.3)
def enough_places(place: PlaceMeaning, used: int) -> Lead | None:
    """Compose "four trees will do"."""
    return Lead(place, used, relation="topic") if place.shape == "several" else None


@construction("RETURN: GO word=RETURN", cost=0.2)
def go_and_return(word: Lex) -> Lex | None:
    """Compose "toddle on back" before the place."""
    return word if "back" in word.features else None


@construction(
    "RETURN: MISSION [MUST] word=RETURN",
    "RETURN: [DET] word=LASTSTOP [IS]",
    "RETURN: [DET] word=LASTSTOP COMMA",
    cost=0.2,
)
def mission_ends(word: Lex) -> Lex | None:
    """Compose "the mission should end" and "last stop:" before the place."""
    ends = {"needs_place", "ends_there"} & word.features or not word.features
    return replace(word, features=frozenset({"needs_place", "ends_there"})) if ends else None


@construction("home: word=GOHOME", "home: word=RETURN", "home: word=RETURN AT DET PLOT", cost=0.3)
def go_home(word: Lex, used: int) -> Home | None:
    """Compose "go home", to where the robot started."""
    return None if {"ends", "needs_place"} & word.features else Home(None, used)


@construction(
    "home: word=RETURN AT marker=marker", "home: word=RETURN marker=marker", "home: GOHOME AT marker=marker", cost=0.2
)
def return_to(marker: s.Selector, used: int, word: Lex | None = None) -> Home | None:
    """Compose "return to the start" and "meet me at the end"."""
    if marker.named_marker in ("", "charger"):
        return None
    last = word is not None and "meets" in word.features
    return Home("return_to_start" if marker.named_marker == "start" else "return_to_end", used, when_done=last)


@construction("home: way=home [COMMA] [AND] RATHERTHAN [AT] other=marker", cost=0.2)
def home_and_not(way: Home, other: s.Selector, used: int) -> Home | None:
    """Compose "come back to the start, not the end"."""
    known = {"return_to_start": "start", "return_to_end": "end"}.get(way.then or "")
    return replace(way, used=used) if known and other.named_marker not in ("", known) else None


@construction("drive: way=drive [COMMA] [AND] RATHERTHAN [AT] other=marker", cost=0.3)
def there_and_not(way: DriveCommand, other: s.Selector, used: int) -> DriveCommand | None:
    """Compose "finish at the charger rather than at the end marker"."""
    known = way.place.selector.named_marker
    return replace(way, used=used) if known and other.named_marker not in ("", known) else None


@construction("home: way=home [COMMA] word=THEN", cost=0.2)
def home_in_the_end(way: Home, word: Lex, used: int) -> Home | None:
    """Compose "come back when done"."""
    return Home(way.then, used, when_done=True) if "when_done" in word.features else None


@construction("drive: way=drive [COMMA] word=THEN", cost=0.3)
def drive_in_the_end(way: DriveCommand, word: Lex, used: int) -> DriveCommand | None:
    """Compose "go to the charger at the end"."""
    return replace(way, used=used) if "when_done" in word.features else None


@construction("home: RETURN AT it=IT", cost=0.5)
def return_to_it(it: Lex, used: int) -> Home | None:
    """Compose "come back to it", of a marker that was named before."""
    return None if "of_several" in it.features else Home(None, used, to_it=True)


@construction("halt: noun=FINISH", cost=0.6)
def finish(noun: Lex, used: int) -> StopCommand | None:
    """Compose "finish"."""
    return StopCommand(used) if "ends" in noun.features else None


@construction("halt: STOP", cost=0.2)
def halt(used: int) -> StopCommand:
    """Compose "stop"."""
    return StopCommand(used)


@construction("drive: BEAT [word=AT] place=place", cost=0.8)
def be_there(place: PlaceMeaning, used: int, word: Lex | None = None) -> DriveCommand | None:
    """Compose "be at tree 4 (at sunrise and read CO2 there)"."""
    del word
    single = place.shape == "one" and not place.optional and place.per is None
    return DriveCommand(place, used) if single else None


@construction("halt: STAY", cost=0.2)
def stay(used: int) -> StopCommand:
    """Compose "stay there" and "don't come back"."""
    return StopCommand(used, stays=True)


@construction("again: REPEAT", "again: REPEAT relation place=place", cost=0.2)
@construction("again: AGAIN relation place=place", "again: relation place=place AGAIN", cost=0.6)
def again(used: int, place: PlaceMeaning | None = None) -> Again:
    """Compose "do the same at tree 9" and "(and) again at tree 9"."""
    return Again(place, used)


@construction(
    "round: word=REPEAT [DET] noun=ROUND",
    "round: word=TAKE DET noun=ROUND",
    "round: noun=WHOLETHING",
    "round: word=REPEAT",
    cost=0.0,
)
def whole_round(word: Lex | None = None, noun: Lex | None = None) -> tuple[bool, bool]:
    """Compose "do that whole round": is it all that was done, and does its number count what was done?"""
    whole = noun is not None or (word is not None and "whole" in word.features)
    return whole, word is not None and "performs" in word.features


@construction(
    "again: what=round AGAIN",
    "again: what=round times=often",
    "again: what=round times=often all_of=INALL",
    "again: what=round more=more_times",
    "again: times=count noun=ROUND",
    "again: times=count noun=ROUND OF DET",
    "again: times=often all_of=INALL",
    "again: AGAIN several=GROUPALL",
    "again: several=GROUPALL AGAIN",
    cost=0.2,
)
def repeated(
    used: int,
    what: tuple[bool, bool] | None = None,
    times: int = 1,
    more: int | None = None,
    all_of: Lex | None = None,
    noun: Lex | None = None,
    several: Lex | None = None,
) -> list[Again] | None:
    """Compose "do that whole round three times", "repeat it another two times", "three rounds" and "once more both"."""
    whole, performs = (False, False) if what is None and noun is None and several is None else what or (True, False)
    if several is not None or (more is None and times < 2):
        both = several is not None and "two" in several.features
        return [Again(None, used, times=1, whole=whole, both=both)] if whole else None
    if more is not None:
        return [Again(None, used, times=more, whole=whole)]
    in_all = Again(None, used, times=times, in_all=True, whole=whole or performs)
    further = Again(None, used, times=times, whole=whole)
    if all_of is not None or noun is not None or (whole and performs):
        return [in_all]
    return [further, replace(in_all, whole=whole)]


@construction(
    "more_times: ANOTHER times=COUNT",
    "more_times: times=COUNT MORE",
    "more_times: ANOTHER n=count TIMES",
    "more_times: n=count MORE TIMES",
    cost=0.1,
)
def more_times(times: Lex | None = None, n: int = 1) -> int:
    """Compose "another two times" and "twice more"."""
    return n if times is None else int(times.value)


@construction("again: trees=numbers [COMMA] SAMEWAY", "again: SAMEFOR trees=numbers", cost=0.2, given=("site",))
def the_same_of_numbers(trees: tuple[str, ...], used: int, site: Site) -> Again | None:
    """Compose "31 same" and "the same for 40 and 60", on a site whose trees have numbers."""
    return Again(named_trees(trees), used) if all(name in site.by_id for name in trees) else None


@construction(
    "again: place=place [COMMA] SAMEWAY",
    "again: SAMEWAY place=place",
    "again: TAKE place=place SAMEWAY",
    "again: SEENAS place=place SAMEWAY",
    "again: SAMEFOR place=place",
    cost=0.2,
)
def the_same_way(place: PlaceMeaning, used: int) -> Again:
    """Compose "do row 4 the same way" and "the same for row 4"."""
    return Again(place, used)


@construction("again: word=TAKE place=place", cost=1.5)
def do_there(word: Lex, place: PlaceMeaning, used: int) -> Again | None:
    """Compose "do tree 9 (as well)", where the same is done."""
    return Again(place, used) if "performs" in word.features and place.shape in ("one", "several", "area") else None


@construction("again: REPEAT where=rows", cost=0.2)
def again_in_row(where: s.Selector, used: int) -> Again | None:
    """Compose "do the same two rows over"."""
    return Again(PlaceMeaning(where, "area"), used) if is_row_of_place(where) else None


@construction("drive: WHICHONE inner=nominal [IS] NEAREST [AT] to=place", cost=0.3)
def which_is_nearest(inner: Nominal, to: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "which tree stands closest to the charger?"."""
    if inner.single or inner.plural or inner.complete or to.shape != "one":
        return None
    return DriveCommand(PlaceMeaning(s.Nearest(to=to.selector, of=inner.selector), "one"), used)


@construction("drive: GO where=each_row", "drive: GO ALONG where=each_row", cost=0.3)
def drive_each_row(where: s.Selector, used: int) -> DriveCommand:
    """Compose "walk every row"."""
    return DriveCommand(PlaceMeaning(where, "area"), used)
