"""Constructions of commands to capture something: at a place, or at each of several."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    UNSAID_THING,
    CaptureCommand,
    Nominal,
    PlaceMeaning,
    Thing,
)
from fieldhand.planning.grammar.places.groups import of_each_kind
from fieldhand.planning.grammar.places.numbers import named_trees
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    are_rows,
    as_every_nth,
    as_some,
    as_zone,
    is_across,
    is_one_row,
    specifies_part,
)
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_ALL = s.Trees()


@construction(
    "capture: verb things=things word=relation place=place", "capture: verb things=things place=here", cost=0.3
)
def capture_at(things: tuple[Thing, ...], place: PlaceMeaning, used: int, word: str = "at") -> CaptureCommand:
    """Compose "take a picture at tree 4"."""
    return CaptureCommand(things, place, used, relation=word)


@construction("capture: verb place=owned_by things=things", cost=0.3)
def owned(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand:
    """Compose "take the first tree's picture"."""
    return CaptureCommand(things, place, used, relation="of")


@construction("capture: verb things=things", cost=0.4)
def capture_here(things: tuple[Thing, ...], used: int) -> CaptureCommand:
    """Compose "take a picture"."""
    return CaptureCommand(things, None, used)


@construction(
    "capture: things=things SHOULD verb relation place=place",
    "capture: things=things SHOULD verb place=here",
    "capture: things=things SHOULD verb",
    "capture: things=things IS verb relation place=place",
    "capture: things=things verb relation place=place",
    "capture: things=things COMMA verb relation place=place",
    cost=0.4,
)
def passive(things: tuple[Thing, ...], used: int, place: PlaceMeaning | None = None) -> CaptureCommand:
    """Compose "a picture should be taken at tree 4"."""
    return CaptureCommand(things, place, used)


@construction("capture: relation place=place things=things", "capture: FOR place=place COMMA things=things", cost=1.0)
def topic_at(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "at tree 5 a CO2 reading"."""
    said = topic(place, things, used)
    return None if said is None else replace(said, relation="lead")


@construction(
    "capture: place=place COMMA things=things",
    "capture: place=place things=things",
    "capture: place=place WITH things=things",
    cost=0.9,
)
def topic(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "tree 4: a picture"."""
    if place.shape not in ("one", "several", "area") or any(one.action == LAST_THING for one in things):
        return None
    several = tuple(replace(one, plural=True) for one in things) if place.shape == "area" else things
    return CaptureCommand(several, place, used)


@construction("capture: things=things place=here", cost=1.2)
def there_without_verb(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "canopy temperature and CO2 at each of them"."""
    return CaptureCommand(things, place, used, relation="plain") if place.shape in ("here", "those") else None


@construction("capture: WITH things=things relation place=place", cost=0.9)
def with_things(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "with a picture at every tree" behind "drive along row 3"."""
    return CaptureCommand(things, place, used) if place.each else None


@construction("capture: things=things PER TREE", "capture: verb things=things PER TREE", cost=0.8)
def per_tree(things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "one CO2 reading per tree"."""
    if any(one.count not in (None, 1) for one in things):
        return None
    once = tuple(replace(one, count=None, plural=True) for one in things)
    return CaptureCommand(once, PlaceMeaning(s.Trees(), "those", each=True), used, relation="each")


@construction(
    "capture: things=things COMMA place=place",
    "capture: things=things COMMA relation place=place",
    "capture: things=things place=place",
    cost=1.2,
)
def comment(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "a picture: tree 4"."""
    return topic(place, things, used)


@construction("capture: place=place SHOULD things=things", "capture: place=place SHOULD things=things verb", cost=0.5)
def needs(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "tree 4 needs a picture"."""
    return topic(place, things, used)


@construction(
    "capture: verb=ACTV place=place WITH things=things",
    "capture: MEASURE place=place WITH things=things",
    "capture: GO ALONG place=place WITH things=things",
    cost=0.6,
)
def with_camera(
    place: PlaceMeaning, things: tuple[Thing, ...], used: int, verb: Lex | None = None
) -> CaptureCommand | None:
    """Compose "photograph tree 4 with two pictures"."""
    if verb is not None and verb.value.actions[0] != things[0].action:
        return None
    return CaptureCommand(tuple(replace(one, count=None) for one in things), place, used)


@construction("capture: TAKE place=place WITH things=things", cost=0.6)
def do_with_camera(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "do rows 1 and 3 with the thermal camera"."""
    return topic(place, tuple(replace(one, count=None) for one in things), used)


@construction("capture: place=place SHOULD verb=ACTV", "capture: place=place IS verb=ACTV", cost=0.4)
def place_passive(place: PlaceMeaning, verb: Lex, used: int) -> CaptureCommand:
    """Compose "tree 4 should be photographed"."""
    return act_on(verb, place, used)


@construction(
    "capture: verb things=things PER noun=ROW",
    "capture: things=things PER noun=ROW",
    "capture: verb things=things PER noun=ROW in_ block=block",
    "capture: things=things PER noun=ROW in_ block=block",
    "capture: [verb] things=things PER noun=ROW in_ rows=rows",
    cost=0.3,
)
def per_row(
    things: tuple[Thing, ...], noun: Lex, used: int, block: s.Selector | None = None, rows: s.Selector | None = None
) -> CaptureCommand | None:
    """Compose "take a picture per row"."""
    rows = rows or (s.Rows() if block is None else s.Rows(of=block))
    return None if noun.plural else CaptureCommand(things, PlaceMeaning(s.Trees(), "area", each=True, per=rows), used)


@construction(
    "capture: [verb] things=things PER kind=ATTR",
    "capture: [verb] things=things FOR kinds=each_kind",
    cost=0.3,
    given=("site",),
)
def per_kind(
    things: tuple[Thing, ...], used: int, site: Site, kind: Lex | None = None, kinds: tuple[Lex, int] | None = None
) -> list[CaptureCommand] | None:
    """Compose "take a picture per variety", at so many trees of each."""
    counts = {one.count or 1 for one in things}
    if len(counts) > 1 or any(one.plural and one.count is None for one in things):
        return None
    some = s.Take(count=counts.pop(), of=s.Trees())
    places = of_each_kind(some, (kind, 0) if kind is not None else kinds, site)
    once = tuple(replace(one, count=None) for one in things)
    return None if places is None else [CaptureCommand(once, place, used) for place in places]


@construction("capture: [verb] things=things blocks=per_block", cost=0.3)
def captures_per_block(things: tuple[Thing, ...], blocks: tuple[s.Selector, ...], used: int) -> CaptureCommand:
    """Compose "take a picture per block"."""
    return CaptureCommand(things, PlaceMeaning(s.Trees(), "area", each=True, per=s.UnionOf(parts=blocks)), used)


@construction(
    "capture: verb things=things PER noun=CORNER", "capture: things=things PER noun=CORNER [OF] [site]", cost=0.3
)
def per_corner(things: tuple[Thing, ...], noun: Lex, used: int) -> CaptureCommand | None:
    """Compose "take one picture per corner"."""
    return (
        None if noun.plural else CaptureCommand(things, PlaceMeaning(s.Corners(), "several", each=True, count=4), used)
    )


@construction(
    "capture: [verb] things=things SPREAD where=region",
    "capture: [verb] things=things SPREAD site",
    "capture: [verb] things=things EVENLYALONG site",
    "capture: [verb] things=things even=EVENLYALONG where=region",
    "capture: SCATTER things=things OVER where=region",
    "capture: SCATTER things=things OVER site",
    cost=0.3,
)
def spread_over(
    things: tuple[Thing, ...], used: int, where: s.Selector = _ALL, even: Lex | None = None
) -> CaptureCommand | None:
    """Compose "take 6 pictures spread over the pond zone"."""
    counts = {one.count for one in things}
    count = counts.pop()
    if counts or count is None or count < 2:
        return None
    zone = as_zone(where)
    if (zone is not None and zone.outside) or (even is not None and are_rows(where)):
        return None
    over = s.Spread(count=count, of=where) if zone is None else s.PointsIn(zone=zone.zone, count=count)
    points = PlaceMeaning(over, "several", count=count)
    return CaptureCommand(tuple(replace(one, count=None) for one in things), points, used)


@construction("here: word=THERE", cost=0.1)
def here(word: Lex) -> PlaceMeaning:
    """Compose "there"."""
    several = "of_several" in word.features
    return PlaceMeaning(
        s.Trees() if several and "of_trees" in word.features else s.Here(),
        "those" if several else "here",
        each="of_each" in word.features,
        one_tree=not several and "of_trees" in word.features,
    )


@construction(
    "capture: verb things=things place=place",
    cost=0.9,
)
def thing_and_step(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "take a picture 4 trees further along" and "take a picture every 5 trees"."""
    every = as_every_nth(place.selector) is not None and place.each and all(one.count in (None, 1) for one in things)
    return CaptureCommand(things, place, used) if place.shape == "step" or is_across(place.selector) or every else None


@construction("capture: verb things=things place=halfway", cost=0.3)
def capture_halfway(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand:
    """Compose "take a picture halfway along row 4"."""
    return CaptureCommand(things, place, used)


@construction("capture: verb=ACTV place=place", "capture: verb=ACTV relation place=place", cost=0.3)
def act_on(verb: Lex, place: PlaceMeaning, used: int) -> CaptureCommand:
    """Compose "photograph tree 4"."""
    naming: Naming = verb.value
    return CaptureCommand((Thing(naming.actions[0]),), place, used, relation="of")


@construction(
    "capture: GO [towards] place=place FOR things=things", "capture: VISIT place=place FOR things=things", cost=0.3
)
def go_for(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "go to tree 4 for a picture"."""
    if place.shape not in ("one", "several"):
        return None
    return CaptureCommand(things, place, used, relation="lead" if place.shape == "one" else "at")


@construction("capture: act=capture [COMMA] EACH", "capture: act=capture EACH [OFTHEM]", cost=0.2)
def of_each(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "photograph trees 4 and 9, two pictures each"."""
    if act.place is None or act.place.shape != "several" or not all(one.count for one in act.things):
        return None
    return replace(act, place=replace(act.place, each=True), used=used)


@construction(
    "capture: act=capture [COMMA] times=COUNT EACH", "capture: act=capture [COMMA] n=count TIMES EACH", cost=0.2
)
def so_often_at_each(act: CaptureCommand, used: int, times: Lex | None = None, n: int = 1) -> CaptureCommand | None:
    """Compose "photograph trees 4 and 9, twice each"."""
    if any(one.count is not None for one in act.things):
        return None
    number = n if times is None else int(times.value)
    return of_each(replace(act, things=tuple(replace(one, count=number) for one in act.things)), used)


@construction("capture: act=capture [COMMA] number=things EACH", cost=0.2)
def so_many_of_each(act: CaptureCommand, number: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "photograph trees 4 and 9, two pictures each"."""
    if any(one.count is not None for one in act.things) or {one.action for one in act.things} != {
        one.action for one in number
    }:
        return None
    return of_each(replace(act, things=number), used)


@construction("capture: [verb] things=things EACH relation place=place", cost=0.2)
def each_of_them(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "3 pictures each of trees 4 and 9"."""
    return of_each(CaptureCommand(things, place, used), used)


@construction("capture: CAUSE place=place verb=ACTV", cost=0.3)
def have_it_done(place: PlaceMeaning, verb: Lex, used: int) -> CaptureCommand | None:
    """Compose "I want tree 4 photographed"."""
    return act_on(verb, place, used) if "participle" in verb.features else None


@construction(
    "capture: READING relation place=place COMMA things=things",
    "capture: things=things COMMA trees=numbers",
    "capture: [verb] things=things AT trees=numbers",
    cost=0.9,
    given=("site",),
)
def by_numbers(
    things: tuple[Thing, ...],
    used: int,
    site: Site,
    place: PlaceMeaning | None = None,
    trees: tuple[str, ...] = (),
) -> CaptureCommand | None:
    """Compose "readings at trees 5 to 8: CO2" and "CO2 at 5, 6 and 7" on a site whose trees have numbers."""
    if place is None:
        if not all(name in site.by_id for name in trees):
            return None
        place = named_trees(trees)
    return CaptureCommand(things, place, used)


@construction("capture: USE things=things relation place=place", cost=0.4)
def use_camera(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "use the thermal camera on tree 4"."""
    if place.shape == "area" or any(one.count is not None for one in things):
        return None
    return CaptureCommand(things, place, used)


@construction(
    "capture: act=capture [COMMA] [relation] EACH noun=TREE",
    "capture: act=capture [COMMA] ONEBYONE",
    "capture: act=capture FULLSTOP EACH noun=TREE",
    "capture: act=capture FULLSTOP ENTIRE",
    "capture: act=capture [COMMA] ENTIRE",
    cost=0.3,
)
def at_every_tree(act: CaptureCommand, used: int, noun: Lex | None = None) -> CaptureCommand | None:
    """Compose "measure CO2 along row 4, every tree" and "measure CO2 along row 4 tree by tree"."""
    if (noun is not None and noun.plural) or act.place is None or act.place.shape != "area":
        return None
    if act.place.per is not None or any(one.count is not None for one in act.things):
        return None
    return replace(act, place=replace(act.place, shape="several", each=True), used=used)


@construction(
    "capture: GO FARTHEST FOR things=things",
    "capture: GO FARTHEST FOR things=things OF inner=nominal",
    "capture: GO FARTHEST FOR things=things OF other=ANOTHER inner=nominal",
    cost=0.3,
)
def far_away_for(
    things: tuple[Thing, ...], used: int, inner: Nominal | None = None, other: Lex | None = None
) -> CaptureCommand | None:
    """Compose "move as far away as possible for a CO2 reading of another tree"."""
    if inner is not None and (inner.single or inner.plural or inner.complete):
        return None
    trees = s.Trees() if inner is None else inner.selector
    far = s.Farthest(origin=s.Here(), of=trees if other is None else s.NotVisited(of=trees))
    return CaptureCommand(things, PlaceMeaning(far, "one"), used)


@construction(
    "capture: act=capture [COMMA] n=count POINT REMAINS",
    "capture: act=capture [COMMA] n=count TREE REMAINS",
    "capture: act=capture [COMMA] n=count [OFTHEM] REMAINS",
    "capture: act=capture [COMMA] AT n=count POINT",
    cost=0.2,
)
def at_so_many(act: CaptureCommand, n: int, used: int) -> CaptureCommand | None:
    """Compose "measure CO2 along row 4, three spots will do"."""
    if act.place is None or act.place.shape != "area" or act.place.per is not None or act.spacing is not None:
        return None
    if any(one.count is not None for one in act.things):
        return None
    return replace(act, things=tuple(replace(one, count=n, plural=True) for one in act.things), used=used)


@construction("capture: act=capture [COMMA] EVENLYSPACED", cost=0.2)
def evenly_spaced(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "5 CO2 readings in row 3, evenly spread"."""
    counts = {one.count for one in act.things}
    rows = None if act.place is None or act.place.shape != "area" or act.place.per is not None else act.place.selector
    count = counts.pop()
    if rows is None or counts or count is None or count < 2 or not (are_rows(rows) and is_one_row(rows)):
        return None
    place = PlaceMeaning(s.Evenly(count=count, of=rows), "several", count=count)
    return replace(act, things=tuple(replace(one, count=None) for one in act.things), place=place, used=used)


@construction("capture: act=capture [COMMA] ANY [TREE] REMAINS", "capture: act=capture [COMMA] FREECHOICE", cost=0.2)
def whichever_it_is(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "one CO2 reading in each row, any tree is good"."""
    if act.place is None or act.place.shape == "those":
        return None
    chosen = any(one.count is not None for one in act.things) and act.place.shape == "area"
    some = chosen or any(as_some(part) is not None for part in act.place.selector.members)
    return replace(act, used=used) if some else None


@construction("capture: FOR kinds=each_kind [COMMA] act=capture", cost=0.2, given=("site",))
def for_each_kind(kinds: tuple[Lex, int], act: CaptureCommand, used: int, site: Site) -> list[CaptureCommand] | None:
    """Compose "for each variety, photograph three trees"."""
    if act.place is None or act.place.shape not in ("one", "several") or any(one.count for one in act.things):
        return None
    places = of_each_kind(act.place.selector, kinds, site)
    return None if places is None else [replace(act, place=place, used=used) for place in places]


@construction("capture: act=capture COMMA ASMANY as_can", cost=0.2)
def as_many_of_those(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "photograph the yellow trees, as many as you can"."""
    if act.place is None or act.place.shape != "several" or act.place.count is not None or act.place.per is not None:
        return None
    return replace(act, place=replace(act.place, optional=True), used=used)


@construction("capture: act=capture [COMMA] RANDOM", cost=0.2)
def chosen_at_random(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "ten trees per block, chosen at random"."""
    if act.place is None or act.place.shape not in ("one", "several") or act.place.per is not None:
        return None
    parts = tuple(some_at_random(part) for part in act.place.selector.members)
    if not parts or any(part is None for part in parts):
        return None
    chosen = tuple(part for part in parts if part is not None)
    selector = chosen[0] if len(chosen) == 1 else s.UnionOf(parts=chosen)
    return replace(act, place=replace(act.place, selector=selector), used=used)


def some_at_random(selector: s.Selector) -> s.Selector | None:
    """Return as many of a group at random as a selector takes of it in any way; None for other selectors."""
    some = as_some(selector)
    return None if some is None else s.RandomSample(count=some.count, of=some.of)


@construction("capture: act=capture INSTEAD", cost=0.2)
def instead(act: CaptureCommand, used: int) -> CaptureCommand:
    """Compose "take the air temperature instead", in another case."""
    return replace(act, used=used, instead=True)


@construction("capture: act=capture BYGOING", cost=0.1)
def by_going_there(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "take pictures of two nearby trees by going to them"."""
    return replace(act, used=used) if act.place is not None else None


@construction("capture: act=capture IS WANTED", cost=0.2)
def is_wanted(act: CaptureCommand, used: int) -> CaptureCommand:
    """Compose "pictures of the yellow trees are what I want"."""
    return replace(act, used=used)


@construction("capture: act=capture IS", cost=0.6)
def is_as_well(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "a picture of each is", behind what is not required."""
    return replace(act, used=used) if act.relation == "plain" else None


@construction("capture: place=place IS WANTED things=things word=relation", cost=0.3)
def are_wanted(place: PlaceMeaning, things: tuple[Thing, ...], word: str, used: int) -> CaptureCommand | None:
    """Compose "the yellow trees are what I want pictures of"."""
    if place.shape == "area" and not all(one.plural for one in things):
        return None
    return CaptureCommand(things, place, used, relation=word)


@construction("capture: verb=ACTV", cost=0.6)
def act_here(verb: Lex, used: int) -> CaptureCommand:
    """Compose "photograph"."""
    naming: Naming = verb.value
    return CaptureCommand((Thing(naming.actions[0]),), None, used)


@construction(
    "capture: verb place=place FOR things=things", "capture: verb relation place=place FOR things=things", cost=0.4
)
def measure_for(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand:
    """Compose "measure tree 4 for temperature"."""
    return CaptureCommand(things, place, used)


@construction(
    "capture: [verb] ASMANY things=things relation place=place as_can",
    "capture: [verb] ASMANY things=things as_can relation place=place",
    "capture: [verb] ASMANY things=things as_can",
    "capture: [verb] ASMANY things=things relation place=place",
    cost=0.3,
)
def as_many_captures(things: tuple[Thing, ...], used: int, place: PlaceMeaning | None = None) -> CaptureCommand | None:
    """Compose "take as many pictures as you can in row 3"."""
    if not all(one.plural and one.count is None for one in things):
        return None
    if place is None:
        place = PlaceMeaning(s.Trees(), "several")
    named = all(one.named_tree for one in place.selector.members)
    if place.shape not in ("several", "area") or (place.count is not None and not named):
        return None
    return CaptureCommand(things, replace(place, shape="several", optional=True, count=None), used)


@construction("capture: things=things word=relation place=place", cost=1.2)
def without_verb(things: tuple[Thing, ...], word: str, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "a picture of tree 4"."""
    if word == "of" and any(one.action == LAST_THING for one in things):
        return None
    return CaptureCommand(things, place, used, relation=word)


@construction("capture: act=capture COMMA relation place=place", cost=0.2)
def specified(act: CaptureCommand, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "take pictures in row 4, at the yellow trees"."""
    area = act.place
    if area is None or area.shape != "area" or act.within is not None or act.spacing is not None:
        return None
    if not specifies_part(place.selector):
        return None
    return replace(act, place=place, within=area, used=used, relation="at")


@construction("capture: act=capture times=COUNT", cost=0.2)
def so_often(act: CaptureCommand, times: Lex, used: int) -> CaptureCommand | None:
    """Compose "take a picture twice"."""
    return replace(act, times=times.value, used=used) if act.times == 1 else None


@construction("capture: act=capture AGAIN", cost=0.2)
def once_more(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "sample CO2 again", where the robot is, and "photograph it again"."""
    known = act.place is None or act.place.shape in ("here", "one")
    return replace(act, used=used) if known and act.relation in ("at", "of") else None


@construction("capture: MEASURE place=place [COMMA] BY act=capture", cost=0.3)
def measure_by(place: PlaceMeaning, act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "measure another tree by taking a picture"."""
    return replace(act, place=place, used=used, relation="at") if act.place is None and act.spacing is None else None


@construction("capture: MEASURE IT place=here", "capture: MEASURE IT AT place=place", cost=0.4)
def measure_it(place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "measure it there" and "measure it at tree 4"."""
    return CaptureCommand((Thing(LAST_THING),), place, used) if place.shape != "area" else None


@construction("capture: verb=ACTV word=DET", "capture: verb=ACTV several=GROUPALL", cost=0.8)
def act_on_those(verb: Lex, used: int, word: Lex | None = None, several: Lex | None = None) -> CaptureCommand | None:
    """Compose "photograph that" and "photograph both"."""
    if word is not None and not {"demonstrative", "those"} & word.features:
        return None
    of_several = several is not None or (word is not None and "those" in word.features)
    return act_on(verb, PlaceMeaning(s.Here(), "those" if of_several else "here"), used)


@construction("capture: MEASURE place=place", "capture: MEASURE AT place=place", cost=4.0)
def check_place(place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "check tree 4", which does not say what is measured there."""
    if place.shape not in ("one", "several", "area"):
        return None
    return CaptureCommand((Thing(UNSAID_THING, plural=place.shape == "area"),), place, used)


@construction(
    "capture: verb things=things OF site",
    "capture: verb=ACTV site",
    "capture: MEASURE site",
    cost=1.5,
)
def of_site(used: int, things: tuple[Thing, ...] = (), verb: Lex | None = None) -> CaptureCommand:
    """Compose "take a picture of the orchard"."""
    if verb is not None:
        naming: Naming = verb.value
        things = (Thing(naming.actions[0]),)
    unsaid = (Thing(UNSAID_THING, plural=True),)
    return CaptureCommand(things or unsaid, PlaceMeaning(s.Trees(), "area"), used, relation="of")


@construction("capture: VISIT place=place AND verb things=things", cost=0.6)
def visit_and(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "visit three trees and take a picture"."""
    if place.shape != "several" or any(one.count not in (None, 1) for one in things):
        return None
    return CaptureCommand(things, place, used)


@construction("capture: relation place=place times=COUNT", "capture: place=place times=COUNT", cost=1.0)
def elsewhere_so_often(place: PlaceMeaning, times: Lex, used: int) -> CaptureCommand | None:
    """Compose "at tree 6 twice" behind "at tree 5 three times"."""
    if place.shape not in ("one", "several"):
        return None
    return CaptureCommand((Thing(LAST_THING),), place, used, times=times.value)


@construction("capture: ASMANY [DET] inner=nominal as_can verb=ACTV", cost=0.3)
def as_many_as_it_can(inner: Nominal, verb: Lex, used: int) -> CaptureCommand | None:
    """Compose "as many of the yellow trees as it can photograph"."""
    if inner.single or not inner.plural:
        return None
    return act_on(verb, PlaceMeaning(inner.selector, "several", optional=True), used)


@construction("capture: MAXIMISE NUMBEROF inner=nominal verb=ACTV", cost=0.2)
def maximise(inner: Nominal, verb: Lex, used: int) -> CaptureCommand | None:
    """Compose "maximise the number of trees photographed"."""
    if inner.single or not inner.plural:
        return None
    return act_on(verb, PlaceMeaning(inner.selector, "several", optional=True), used)


@construction("capture: things=things REMAINS", cost=0.6)
def enough(things: tuple[Thing, ...], used: int) -> CaptureCommand:
    """Compose "one picture is enough", where a condition says when."""
    return bare_things(things, used)


@construction("capture: things=things", cost=2.5)
def bare_things(things: tuple[Thing, ...], used: int) -> CaptureCommand:
    """Compose "a CO2 reading", where a condition says when it is taken."""
    return CaptureCommand(things, None, used, relation="bare")


@construction(
    "capture: verb [DET] GROUND FOR things=things relation place=place",
    "capture: verb things=things OF [DET] GROUND relation place=place",
    "capture: verb things=things AT [DET] GROUND relation place=place",
    cost=0.3,
)
def of_the_ground(things: tuple[Thing, ...], place: PlaceMeaning, used: int) -> CaptureCommand:
    """Compose "test the soil for nitrate at tree 6"."""
    return CaptureCommand(things, place, used)


@construction("capture: verb things=things where=place_where", cost=0.3)
def capture_where(things: tuple[Thing, ...], where: PlaceMeaning, used: int) -> CaptureCommand:
    """Compose "take a picture wherever vigor is below 0.4"."""
    return CaptureCommand(things, where, used)


@construction("capture: verb=ACTV things=things word=relation place=place", cost=0.4)
def verb_and_thing(
    verb: Lex, things: tuple[Thing, ...], word: str, place: PlaceMeaning, used: int
) -> CaptureCommand | None:
    """Compose "clip a leaf from tree 4"."""
    if any(one.action not in verb.value.actions for one in things):
        return None
    return CaptureCommand(things, place, used, relation=word)
