"""Constructions of captures: their kinds and numbers, and the words that tie them to a place."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.english.naming import Naming, split
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import LAST_THING, UNSAID_THING, Thing
from fieldhand.planning.grammar.places.numbers import VAGUE_NUMBERS
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction


def named_capture(noun: Lex, *, count: int | None = None, plural: bool = False) -> Thing | None:
    """Return the capture that a noun names; None if it names only a quantity that no action measures."""
    naming: Naming = noun.value
    if not naming.actions:
        return None
    return Thing(naming.actions[0], count=count, plural=plural, parameters=naming.parameters)


@construction("thing: [word=DET] noun=NOUN", cost=0.0)
def thing(noun: Lex, word: Lex | None = None) -> Thing | list[Thing] | None:
    """Compose "a picture", and "some pictures" with the numbers that it may mean."""
    made = named_capture(noun, plural=noun.plural)
    if made is None or not noun.plural or word is None or "vague" not in word.features:
        return made
    return [replace(made, count=count, some=True) for count in (None, *VAGUE_NUMBERS)]


@construction("thing: word=DET noun=NOUN", "thing: word=ANOTHER noun=NOUN", cost=0.0)
def one_thing(word: Lex, noun: Lex) -> Thing | None:
    """Compose "another picture"."""
    return named_capture(noun, count=1) if "one" in word.features and not noun.plural else None


@construction("thing: n=count [MORE] noun=NOUN", "thing: ANOTHER n=count noun=NOUN", cost=0.0)
def so_many_things(n: int, noun: Lex) -> Thing | None:
    """Compose "three pictures"."""
    return named_capture(noun, count=n, plural=True)


@construction("thing: word=DET LAST noun=NOUN", "thing: n=count LAST noun=NOUN", cost=0.2)
def last_thing(noun: Lex, word: Lex | None = None, n: int = 1) -> Thing | None:
    """Compose "one last picture" and "a final reading"; "the last picture" is one that was taken."""
    if noun.plural != (n > 1) or (word is not None and "indefinite" not in word.features):
        return None
    return named_capture(noun, count=n, plural=n > 1)


@construction(
    "thing: [DET] noun=NOUN word=READING", "thing: word=READING OF [DET] noun=NOUN",
    "thing: [DET] noun=NOUN INSTRUMENT",
    cost=0.1,
)  # fmt: skip
def reading_of(noun: Lex, word: Lex | None = None) -> Thing | None:
    """Compose "the temperature reading" and "the moisture probe"."""
    return named_capture(noun, plural=word is not None and word.plural)


@construction(
    "thing: HOWMUCH [DET] noun=NOUN",
    "thing: HOWMUCH [DET] noun=NOUN IS AT DET GROUND",
    "thing: HOWMUCH [DET] noun=NOUN THEREIS",
    "thing: HOW LEVEL IS [DET] noun=NOUN",
    "thing: HOW LEVEL [DET] noun=NOUN IS",
    cost=0.1,
)
def how_much(noun: Lex) -> Thing | None:
    """Compose "how much nitrate is in the soil"."""
    return reading_of(noun)


@construction("thing: n=count noun=NOUN READING", "thing: n=count READING OF [DET] noun=NOUN", cost=0.1)
def readings_of(n: int, noun: Lex) -> Thing | None:
    """Compose "three temperature readings"."""
    return named_capture(noun, count=n, plural=True)


@construction(
    "thing: n=count",
    "thing: n=count ONE",
    "thing: n=count READING",
    "thing: n=count more=MORE READING",
    "thing: n=count more=MORE POINT",
    "thing: more=ANOTHER n=count [READING]",
    "thing: more=IT [THERE] n=more_times",
    cost=1.5,
)
def so_many_of_them(n: int, more: Lex | None = None) -> Thing:
    """Compose "two more"."""
    return Thing(LAST_THING, count=n, plural=n > 1, more=more is not None)


@construction("thing: ANOTHER", "thing: ANOTHER ONE", "thing: ANOTHER READING", cost=1.5)
def another_of_them() -> Thing:
    """Compose "another one"."""
    return Thing(LAST_THING, count=1, more=True)


@construction("thing: [DET] rank=ORD noun=NOUN", cost=0.3)
def second_thing(rank: Lex, noun: Lex) -> Thing | None:
    """Compose "a second picture"."""
    return named_capture(noun, count=1) if rank.value == 2 and not noun.plural else None


@construction("thing: [word=DET] reading=READING", "thing: n=count reading=READING", cost=4.0)
def unsaid_reading(reading: Lex, n: int | None = None, word: Lex | None = None) -> Thing | None:
    """Compose "readings", which does not say what is read."""
    if word is not None and ("indefinite" not in word.features or reading.plural):
        return None
    return Thing(UNSAID_THING, count=n, plural=reading.plural)


@construction("thing: [DET] noun=SOILTEST", "thing: n=count noun=SOILTEST", cost=0.3, given=("robot",))
def soil_test(noun: Lex, robot: RobotProfile, n: int | None = None) -> list[Thing] | None:
    """Compose "a soil test", which may be each of the readings that the robot takes of soil."""
    plural = noun.text.endswith("s")
    names = [one.name for one in robot.actions if one.measures and "soil" in split(one.name)]
    if "samples" in noun.features and len(names) == 1:
        return None  # soil itself may be meant, which the robot does not take
    return [Thing(name, count=n, plural=plural) for name in names] or None


@construction("thing: IT AGAIN", "thing: DET SAME", cost=0.5)
def it_again() -> Thing:
    """Compose "the same"."""
    return Thing(LAST_THING)


@construction("things: one=thing", cost=0.0)
def things(one: Thing) -> tuple[Thing, ...]:
    """Compose "two pictures"."""
    return (one,)


@construction("things: one=thing times=COUNT", cost=1.2)
def thing_so_often(one: Thing, times: Lex) -> tuple[Thing, ...] | None:
    """Compose "CO2 twice" before its place."""
    return None if one.count not in (None, 1) else (replace(one, count=times.value, plural=True),)


@construction("things: one=thing n=more_times", cost=1.0)
def thing_so_often_again(one: Thing, n: int) -> tuple[Thing, ...] | None:
    """Compose "CO2 twice more"."""
    return None if one.count not in (None, 1) else (replace(one, count=n, plural=n > 1),)


@construction("things: first=things AND second=things", "things: first=things COMMA second=things", cost=0.3)
def more_things(first: tuple[Thing, ...], second: tuple[Thing, ...]) -> tuple[Thing, ...] | None:
    """Compose "a picture and the temperature"."""
    names = [one.action for one in (*first, *second)]
    return (*first, *second) if len(set(names)) == len(names) else None


@construction("things: [FIRSTONE] first=things [COMMA] [AND] then [COMMA] second=things", cost=0.6)
def things_in_turn(first: tuple[Thing, ...], second: tuple[Thing, ...]) -> tuple[Thing, ...] | None:
    """Compose "first CO2, then a picture", at one place."""
    return more_things(first, second)


@construction("things: first=things COMMA AND second=things COMMA", cost=0.4)
def things_aside(first: tuple[Thing, ...], second: tuple[Thing, ...]) -> tuple[Thing, ...] | None:
    """Compose "a photo (and a CO2 sample)" before its place."""
    return more_things(first, second)


@construction("things: BOTH first=things AND second=things", cost=0.1)
def both_things(first: tuple[Thing, ...], second: tuple[Thing, ...]) -> tuple[Thing, ...] | None:
    """Compose "both CO2 and the air temperature"."""
    return more_things(first, second)


@construction("verb: TAKE", "verb: MEASURE", "verb: CLIP", "verb: KEEPTAKING", cost=0.0)
def capture_verb() -> str:
    """Compose "take"."""
    return "take"


@construction("relation: arrived AT", cost=0.2)
def on_arrival() -> str:
    """Compose "when you get to"."""
    return "at"


@construction(
    "arrived: WHERE [MISSION] [IS]",
    "arrived: WHILE [MISSION] [IS]",
    "arrived: ASSOONAS [MISSION] [IS]",
    "arrived: WHERE [MISSION] GO",
    "arrived: ASSOONAS [MISSION] GO",
    "arrived: ARRIVE",
    cost=0.1,
)
def arrived() -> str:
    """Compose "when you are" before a place."""
    return "when"


@construction(
    "relation: word=AT",
    "relation: word=OF",
    "relation: word=FOR",
    "relation: word=FROM",
    cost=0.0,
)
def relation(word: Lex) -> str | None:
    """Compose "of"."""
    if "possessive" in word.features:
        return "of"
    return None if "motion" in word.features else "at"


@construction("relation: ALONG", cost=0.0)
def along() -> str:
    """Compose "along", which does not say at which trees."""
    return "along"
