"""Constructions of clauses that capture something: parts in many orders make one command, and adjuncts change it.

A clause is a sequence of parts: a verb, captures, a place, "should". :data:`_ORDERS` lists the orders that English has;
a part that leads to none of them does not join. Adjuncts ("every 10 m", "twice", "one per tree") may stand anywhere
behind the first part, and are applied when the clause is complete, in the order in which they were said.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.commands.things import named_capture, soil_test
from fieldhand.planning.grammar.meaning import LAST_THING, CaptureCommand, ParameterValue, PlaceMeaning, Thing
from fieldhand.planning.grammar.places.vague import as_many_of_best
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_every_nth, as_some, is_across
from fieldhand.robot.model import RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Kinds of parts: ``v`` a verb for any capture, ``a`` the verb of one action, ``g`` a drive to a place, ``u`` "use",
#: ``t`` captures, ``w`` captures behind "with", ``f`` captures behind "for", ``m`` "as many" before captures, ``z`` the
#: ground, ``p`` a place behind a preposition, ``b`` a place by itself, ``h`` "there" and other adverbs, ``o`` a place
#: that owns what follows, ``s`` "should be", ``i`` "is", ``c`` "have" and "let",
#: ``d`` "I want" behind what is wanted, ``e`` "to be", ``k`` a drive along rows.
Kind = Literal["v", "a", "g", "u", "t", "w", "f", "m", "z", "p", "b", "h", "o", "s", "i", "c", "d", "e", "k"]
#: How a complete clause is composed: with a verb, as a topic and what is done there, or as captures alone.
Form = Literal["verb", "act", "topic", "bare"]

_ORDERS: dict[str, Form] = {
    # take a picture (at tree 4); take at tree 4 a picture; take the first tree's picture
    "vt": "verb", "vtp": "verb", "vth": "verb", "vpt": "verb", "vht": "verb", "vot": "verb",
    # take a picture 4 trees further along; take as many pictures as you can in row 3
    "vtb": "verb", "vmt": "verb", "vmtp": "verb", "mt": "verb", "mtp": "verb",
    # measure tree 4 for CO2; test for CO2 at tree 4; do row 3 with the thermal camera; use the camera on tree 4
    "vbf": "verb", "vpf": "verb", "vf": "verb", "vfp": "verb", "vbw": "verb", "utp": "verb",
    # go to tree 4 for a picture; test the soil for nitrate at tree 6
    "gf": "verb", "vzf": "verb", "vzfp": "verb", "vtz": "verb", "vtzp": "verb",
    # every 10 m along row 3 take a picture; row 3, every 10 m, photograph; every 10 m for a picture; do row 3, thermal
    "pvt": "verb", "bvt": "verb", "pa": "act", "ba": "act", "f": "bare", "w": "bare", "vbt": "topic",
    # photograph tree 4 (with two pictures); clip a leaf from tree 4
    "a": "act", "ab": "act", "ap": "act", "ah": "act", "abw": "act", "at": "act", "atp": "act",
    # tree 4 (should be) checked for CO2; have tree 4 looked at with the camera; have the soil tested for nitrate
    "bvf": "verb", "bvw": "verb", "bsvf": "verb", "bsvw": "verb", "cbvf": "verb", "cbvw": "verb", "vzpf": "verb",
    "zpvf": "verb", "zpsvf": "verb", "zsvfp": "verb", "czpvf": "verb", "czvf": "verb", "czvfp": "verb",
    # a picture should be taken at tree 4; CO2 at tree 4 should be measured; a picture taken at tree 4
    "tsv": "verb", "tsvp": "verb", "tsvh": "verb", "tpsv": "verb", "tivp": "verb", "tvp": "verb", "tvh": "verb",
    # there take a picture; at each one photograph
    "hvt": "verb", "ha": "act",
    # tree 4 should be photographed; I want tree 4 photographed
    "bsa": "act", "bia": "act", "cba": "act",
    # I want a picture taken of tree 4; let a picture be taken at tree 4; let tree 4 be photographed
    "ctv": "verb", "ctvp": "verb", "ctvh": "verb", "ctiv": "verb", "ctivp": "verb", "ctivh": "verb", "ctpiv": "verb",
    "cbia": "act",
    # to be photographed: trees 4 and 5; to be measured: CO2 at tree 4; a picture to be taken at tree 4
    "eab": "act", "eap": "act", "evt": "verb", "evtp": "verb", "evth": "verb", "bea": "act", "bevf": "verb",
    "tevp": "verb", "tpev": "verb", "tevh": "verb",
    # their temperature I want; the temperature at tree 4 I would know; of tree 4 a picture I want
    "td": "verb", "tpd": "verb", "thd": "verb", "otd": "verb", "ptd": "verb", "btd": "topic",
    # tree 4 needs a picture (taken)
    "bst": "topic", "bstv": "topic",
    # drive along row 4 with a picture every 10 m
    "kw": "topic", "kt": "topic",
    # at tree 4 I'd like a picture
    "pct": "topic", "hct": "verb",
    # tree 4: a picture; at tree 4 a picture; a picture of tree 4; a picture: tree 4
    "bt": "topic", "bw": "topic", "wp": "topic", "pt": "topic", "tp": "topic", "th": "topic", "tb": "topic",
    # a picture is needed at tree 4
    "tsp": "topic",
    "t": "bare",
}  # fmt: skip
_BEGINNINGS = {order[:length] for order in _ORDERS for length in range(1, len(order) + 1)}
#: Orders whose last part a comma may set off ("tree 4, a picture").
_SET_OFF = {"hv", "ha", "bt", "pt", "tb", "tp", "tv", "bst", "vbt", "eab", "evt"}


#: Orders that begin with the place of stops ("along row 3, every 10 m, take a picture").
_STOPS_FIRST = {"pvt", "bvt", "pa", "ba"}


@dataclass(frozen=True, slots=True)
class Clause:
    """The parts of a clause.

    Attributes:
        order: Kinds of its parts, in their order.
        verb: Verb of an action.
        things: Captures.
        place: Place.
        relation: What ties the captures to the place.
        adjuncts: What changes the command.
    """

    order: str
    verb: Lex | None = None
    things: tuple[Thing, ...] = ()
    place: PlaceMeaning | None = None
    relation: str = "at"
    adjuncts: tuple[Adjunct, ...] = ()


#: Returns a command as an adjunct changes it; several if it may mean several, None if it does not fit.
Change = Callable[[CaptureCommand, Any], CaptureCommand | list[CaptureCommand] | None]


@dataclass(frozen=True, slots=True)
class Adjunct:
    """A phrase that changes the command of its clause.

    Attributes:
        change: Function that changes it.
        value: Its second argument.
        of_many: True if the phrase belongs to "as many".
        of_place: True if it stands behind the place.
        may_lead: True if it may stand before the clause.
        is_sentence: True if it may be a sentence by itself behind the clause.
        late: True if it changes what the others have made of the command.
        lays_out: True for points that are laid out, at which the clause behind it captures.
    """

    change: Change
    value: Any = None
    of_many: bool = False
    of_place: bool = False
    may_lead: bool = False
    is_sentence: bool = False
    late: bool = False
    lays_out: bool = False


def _part(kind: Kind, **meaning: Any) -> Clause:
    return Clause(kind, **meaning)


@construction("part: verb", cost=0.0)
def verb_part() -> Clause:
    """Compose "take"."""
    return _part("v")


@construction("part: REPEAT", cost=0.6)
def repeat_part() -> Clause:
    """Compose "repeat" before what is captured again."""
    return _part("v")


@construction("part: REPEAT DET reading=READING", cost=0.3)
def repeat_reading_part(reading: Lex) -> Clause | None:
    """Compose "repeat the measurement", the one taken last."""
    return None if reading.plural else Clause("vt", things=(Thing(LAST_THING),))


@construction("part: verb=ACTV", cost=0.1)
def act_part(verb: Lex) -> Clause:
    """Compose "photograph"."""
    return _part("a", verb=verb)


@construction("part: verb=ACTV how=parameter", cost=0.2, given=("robot",))
def act_on_part(verb: Lex, how: ParameterValue, robot: RobotProfile) -> Clause | None:
    """Compose "photograph the trunk"."""
    made = with_parameter(Thing(verb.value.actions[0]), how, robot) if isinstance(how.value, str) else None
    return None if made is None else _part("a", verb=verb, things=(made,))


@construction("part: GO [towards] place=place", "part: VISIT place=place", cost=0.2)
def go_part(place: PlaceMeaning) -> Clause | None:
    """Compose "go to tree 4"."""
    if place.shape not in ("one", "several"):
        return None
    return _part("g", place=place, relation="lead" if place.shape == "one" else "at")


@construction("part: GO ALONG place=place", cost=0.3)
def go_along_part(place: PlaceMeaning) -> Clause | None:
    """Compose "drive along row 4" before "with a picture every 10 m", and "go along the leeks"."""
    whole = place.shape == "area" or (place.shape == "several" and place.count is None)
    return _part("k", place=place, relation="along") if whole and place.per is None else None


@construction("part: [relation] DET GROUND", cost=0.8)
def ground_part() -> Clause:
    """Compose "the soil" of "test the soil for nitrate" and "nitrate in the soil"."""
    return _part("z")


@construction("part: USE", cost=0.3)
def use_part() -> Clause:
    """Compose "use"."""
    return _part("u")


@construction("part: HANDLES things=things [PUTIN]", cost=0.5)
def handled_part(things: tuple[Thing, ...]) -> Clause:
    """Compose "stick the moisture probe into the soil"."""
    return Clause("ut", things=things)


@construction("part: ASMANY", cost=0.0)
def as_many_part() -> Clause:
    """Compose "as many"."""
    return _part("m")


@construction("part: things=things", cost=0.0)
def things_part(things: tuple[Thing, ...]) -> Clause:
    """Compose "a picture"."""
    return _part("t", things=things)


@construction("part: WITH things=things", cost=0.0)
def with_part(things: tuple[Thing, ...]) -> Clause:
    """Compose "with the thermal camera"."""
    return _part("w", things=things)


@construction(
    "part: WITH word=DET noun=NOUN [INSTRUMENT]", "part: WITH word=DET noun=SOILTEST", cost=0.1, given=("robot",)
)
def with_instrument(word: Lex, noun: Lex, robot: RobotProfile) -> list[Clause] | None:
    """Compose "with the moisture probe", of as many readings as there are places."""
    named = named_capture(noun) if isinstance(noun.value, Naming) else None
    things = soil_test(noun, robot) if named is None else [named]
    if "definite" not in word.features or noun.plural or not things:
        return None
    return [_part("w", things=(replace(one, plural=True),)) for one in things]


@construction("part: FOR things=things", cost=0.0)
def for_part(things: tuple[Thing, ...]) -> Clause:
    """Compose "for CO2"."""
    return _part("f", things=things)


@construction("part: word=relation place=place", cost=0.0)
def place_part(word: str, place: PlaceMeaning) -> Clause | None:
    """Compose "at tree 4"; "along the south edge" are several places."""
    if word == "along" and getattr(place.selector, "shape", "") == "edge":
        return None
    return _part("p", place=place, relation=word)


@construction("part: place=place", cost=0.0)
def bare_place_part(place: PlaceMeaning) -> Clause:
    """Compose "tree 4"."""
    return _part("b", place=place)


@construction("part: place=here", "part: place=halfway", "part: place=place_where", cost=0.0)
def here_part(place: PlaceMeaning) -> Clause:
    """Compose "there", "halfway along row 4" and "wherever vigor is below 0.4"."""
    return _part("h", place=place)


@construction("part: place=owned_by", cost=0.0)
def owner_part(place: PlaceMeaning) -> Clause:
    """Compose "the first tree's"."""
    return _part("o", place=place, relation="of")


@construction("part: SHOULD", cost=0.0)
def should_part() -> Clause:
    """Compose "should be"."""
    return _part("s")


@construction("part: IS", cost=0.2)
def is_part() -> Clause:
    """Compose "is"."""
    return _part("i")


@construction("part: CAUSE", cost=0.0)
def cause_part() -> Clause:
    """Compose "I want"."""
    return _part("c")


@construction("part: DESIRED", cost=0.0)
def desired_part() -> Clause:
    """Compose "I would know" behind what is to be known."""
    return _part("d")


@construction("part: TOBE", cost=0.2)
def to_be_part() -> Clause:
    """Compose "to be" of "to be photographed"."""
    return _part("e")


@construction("clause: part=part", cost=0.0)
def first_part(part: Clause) -> Clause | None:
    """Compose the first part of a clause."""
    return part if part.order in _BEGINNINGS else None


@construction("clause: clause=clause part=part", cost=0.1, given=("robot",))
def next_part(clause: Clause, part: Clause, robot: RobotProfile) -> Clause | None:
    """Compose a clause with a further part, if there is such an order."""
    order = clause.order + part.order
    if order.endswith("tz") and any(_has_view_of_ground(thing, robot) for thing in clause.things):
        return None  # "a picture of the ground" is one of its views
    if order not in _BEGINNINGS or (clause.place is not None and part.place is not None):
        return None
    if clause.things and part.things:
        return None  # "photograph the trunk" names what is captured
    is_done = order == "ba" and part.verb is not None and "participle" in part.verb.features  # "tree 4 photographed"
    if order in _STOPS_FIRST and not clause.adjuncts and not is_done:
        return None  # "at tree 4 take a picture" is a place, and a command that is done there
    return Clause(
        order,
        verb=clause.verb or part.verb,
        things=clause.things or part.things,
        place=clause.place or part.place,
        relation=part.relation if part.place is not None else clause.relation,
        adjuncts=(*clause.adjuncts, *part.adjuncts),
    )


def _has_view_of_ground(thing: Thing, robot: RobotProfile) -> bool:
    """Return True for a capture of which one of the choices is the ground."""
    action = robot.action.get(thing.action)
    return action is not None and any("ground" in one.choices for one in action.parameters)


@construction("clause: clause=clause COMMA part=part", cost=0.4, given=("robot",))
def part_set_off(clause: Clause, part: Clause, robot: RobotProfile) -> Clause | None:
    """Compose "tree 4, a picture" and "five readings, each 10 m apart, in row 4"."""
    behind = clause.adjuncts and part.order in ("p", "v", "a")
    return next_part(clause, part, robot) if behind or clause.order + part.order in _SET_OFF else None


@construction("clause: clause=clause [COMMA] adjunct=adjunct", cost=0.1)
def with_adjunct(clause: Clause, adjunct: Adjunct) -> Clause | None:
    """Compose "take a picture twice"."""
    if (adjunct.of_many and "m" not in clause.order) or (adjunct.of_place and clause.place is None):
        return None
    return replace(clause, adjuncts=(*clause.adjuncts, adjunct))


@construction(
    "clause: adjunct=adjunct [COMMA] clause=clause",
    "clause: adjunct=adjunct AND clause=clause",
    "clause: adjunct=adjunct INORDERTO clause=clause",
    cost=0.3,
)
def adjunct_first(adjunct: Adjunct, clause: Clause) -> Clause | None:
    """Compose "every 10 m take a picture"."""
    if not adjunct.may_lead or (clause.verb is None and any(one.action == LAST_THING for one in clause.things)):
        return None  # "(readings along row 5,) 15 m apart, four of them"
    return replace(clause, adjuncts=(adjunct, *clause.adjuncts))


def _commands(clause: Clause, used: int, *forms: Form) -> list[CaptureCommand] | None:
    """Return what a complete clause may mean; None if it is not complete, or of another form."""
    form = _ORDERS.get(clause.order)
    if form is None:
        return None
    if clause.order in ("f", "w") and not clause.adjuncts:
        return None
    if form == "bare" and clause.adjuncts:
        form = "topic"  # "four readings 20 m apart"
    if form not in forms:
        return None
    command = _COMPOSED[form](clause, used)
    commands = [] if command is None else [command]
    for adjunct in sorted(clause.adjuncts, key=lambda one: one.late):
        changed = [adjunct.change(one, adjunct.value) for one in commands]
        commands = [one for made in changed if made is not None for one in (made if isinstance(made, list) else [made])]
    return [_placed(one) for one in commands] or None


def _placed(command: CaptureCommand) -> CaptureCommand:
    """Return captures to which an adjunct gave a place as captures at it."""
    place = command.place
    given = command.relation == "bare" and (place is not None or command.spacing is not None)
    if given and place is not None and place.shape == "those":
        return replace(command, relation="plain")  # "a picture each", of the places spoken of
    return replace(command, relation="at") if given else command


@construction("capture: clause=clause", cost=0.1)
def with_verb(clause: Clause, used: int) -> list[CaptureCommand] | None:
    """Compose "take a picture at tree 4" and "tree 4 should be photographed"."""
    return _commands(clause, used, "verb", "act")


@construction("capture: clause=clause", cost=0.9)
def without_verb(clause: Clause, used: int) -> list[CaptureCommand] | None:
    """Compose "tree 4: a picture"."""
    return _commands(clause, used, "topic")


@construction("capture: clause=clause", cost=2.5)
def captures_alone(clause: Clause, used: int) -> list[CaptureCommand] | None:
    """Compose "a CO2 reading", where a condition says when it is taken."""
    return _commands(clause, used, "bare")


def _with_verb(clause: Clause, used: int) -> CaptureCommand | None:
    """Return a command whose verb does not name its captures."""
    things, place = clause.things, clause.place
    if "m" in clause.order:
        return _as_many(clause, used)
    if clause.order == "vtb" and (place is None or not _is_adverbial(place, things)):
        return None
    if clause.order == "vbw":  # "do rows 1 and 3 with the thermal camera"
        return _topic(replace(clause, things=once(things)), used)
    if place is not None and clause.order == "utp" and (place.shape == "area" or once(things) != things):
        return None
    return CaptureCommand(things, place, used, relation=clause.relation)


def _is_adverbial(place: PlaceMeaning, things: tuple[Thing, ...]) -> bool:
    """Return True for a place that needs no preposition: "4 trees further along", "every 5 trees"."""
    every = as_every_nth(place.selector) is not None and place.each and all(one.count in (None, 1) for one in things)
    return place.shape == "step" or is_across(place.selector) or every


def _as_many(clause: Clause, used: int) -> CaptureCommand | None:
    """Return as many captures as possible ("take as many pictures as you can in row 3")."""
    said_so = any(adjunct.of_many for adjunct in clause.adjuncts)
    place = clause.place or (PlaceMeaning(s.Trees(), "several") if said_so else None)
    if place is None or not all(one.plural and one.count is None for one in clause.things):
        return None
    named = all(one.named_tree for one in place.selector.members)
    if place.shape not in ("several", "area") or (place.count is not None and not named and not place.vague):
        return None
    most = as_many_of_best(replace(place, shape="several", optional=True, count=None))
    return CaptureCommand(clause.things, most, used)


def _act(clause: Clause, used: int) -> CaptureCommand | None:
    """Return a command whose verb names its capture."""
    verb = clause.verb
    if verb is None or ("c" in clause.order and "participle" not in verb.features):
        return None
    naming: Naming = verb.value
    things = clause.things or (Thing(naming.actions[0]),)
    if any(one.action not in naming.actions for one in things):
        return None
    if "w" in clause.order:
        return CaptureCommand(once(things), clause.place, used)
    if clause.place is None:
        return CaptureCommand(things, None, used)
    if clause.place.shape == "area" and "t" not in clause.order:  # "photograph row 3": each of its trees
        things = tuple(replace(one, plural=True) for one in things)
    return CaptureCommand(things, clause.place, used, relation=clause.relation if "t" in clause.order else "of")


def _topic(clause: Clause, used: int) -> CaptureCommand | None:
    """Return a command without a verb: a place and what is done there."""
    things, place = clause.things, clause.place
    if place is None:
        return _bare(clause, used)
    if clause.order == "th":
        return CaptureCommand(things, place, used, relation="plain") if place.shape in ("here", "those") else None
    if clause.order in ("kw", "kt") and clause.adjuncts:
        return CaptureCommand(things, place, used, relation="along") if place.shape == "area" else None
    if clause.order in ("kw", "kt"):  # "go along row 3 with the thermal camera"
        plain = clause.order == "kw" and all(one.count is None and one.plural for one in things)
        return CaptureCommand(things, place, used) if plain else None
    if clause.order == "wp":
        return CaptureCommand(things, place, used) if place.each else None  # "with a picture at every tree"
    if clause.order in ("tp", "tsp"):
        refers = clause.relation == "of" and any(one.action == LAST_THING for one in things)
        return (
            None if refers and place.shape != "one" else CaptureCommand(things, place, used, relation=clause.relation)
        )
    if place.shape not in ("one", "several", "area") or any(one.action == LAST_THING for one in things):
        return None
    if "s" in clause.order and place.count and as_some(place.selector) is not None:
        return None  # "two trees get a picture" may announce which ones
    several = tuple(replace(one, plural=True) for one in things) if place.shape == "area" else things
    return CaptureCommand(several, place, used, relation="lead" if clause.order in ("pt", "pct") else "at")


def _bare(clause: Clause, used: int) -> CaptureCommand:
    """Return captures alone."""
    return CaptureCommand(clause.things, None, used, relation="bare")


_COMPOSED: dict[Form, Callable[[Clause, int], CaptureCommand | None]] = {
    "verb": _with_verb,
    "act": _act,
    "topic": _topic,
    "bare": _bare,
}


def once(things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Return captures without their numbers."""
    return tuple(replace(one, count=None) for one in things)
