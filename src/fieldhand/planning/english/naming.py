"""Names in words for the captures of a robot and the trees of a site."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.robot.implement import rate_unit
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.site.model import Site

Phrase = tuple[str, ...]

#: Words of an action that takes pictures.
_PICTURES = frozenset({"picture", "photo", "image", "thermal picture"})

#: Words of an attribute's name that say its unit, not what it is.
_UNIT_WORDS = frozenset({"m", "kg", "years", "cm", "mm", "of", "the", "percent", "pct"})
#: An attribute with more texts than this is a label of each tree rather than a kind of tree.
_MOST_TEXTS = 200
_LONGEST_TEXT, _LONGEST_ZONE = 40, 60
#: Words in the names of zones of water.
_WATERS = frozenset({"pond", "lake", "reservoir", "pool", "basin", "dam", "lagoon"})


@dataclass(frozen=True, kw_only=True)
class NameEntry:
    """The meaning of a phrase: a terminal of the grammar, its value, and whether it is a noun in the plural.

    Attributes:
        cost: Price of the meaning, higher for one that is less likely than another of the same words.
    """

    kind: str
    value: Any = None
    plural: bool = False
    cost: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Naming:
    """Meanings of a noun for a robot: actions that yield it, with their parameters, and quantities that it names."""

    actions: tuple[str, ...] = ()
    quantities: tuple[str, ...] = ()
    parameters: tuple[tuple[str, str | float], ...] = ()


def takes_pictures(action: Action) -> bool:
    """Return True for the action of a camera."""
    return not _PICTURES.isdisjoint(action.words)


def split(phrase: str) -> Phrase:
    """A phrase as words in the form in which the lexicon keeps them."""
    return tuple(
        w for w in re.split(r"[\s_\-\u2013]+", phrase.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'")) if w
    )


def robot_entries(robot: RobotProfile) -> Iterator[tuple[Phrase, NameEntry]]:
    """Nouns and verbs of the robot's own. A word of several actions keeps them all, the usual one first."""
    actions: dict[Phrase, list[str]] = {}
    quantities: dict[Phrase, list[str]] = {}
    at_places = [action for action in robot.actions if action.implement is None]
    for action in at_places:
        # "read_co2" is a verb and a noun: as one noun it would be none behind "if it is low, read CO2 ...".
        for word in (*action.words, *(() if "_" in action.name and action.words else (action.name,))):
            actions.setdefault(split(word), []).append(action.name)
    for quantity in robot.quantities:
        for word in (*quantity.words, quantity.name):
            quantities.setdefault(split(word), []).append(quantity.name)
    for phrase in dict.fromkeys((*actions, *quantities)):
        if not phrase:
            continue
        named, measured = actions.get(phrase, []), quantities.get(phrase, [])
        measuring = [a.name for a in robot.actions if a.name not in named and set(a.measures) & set(measured)]
        naming = Naming(actions=(*named, *measuring), quantities=tuple(measured))
        yield phrase, NameEntry(kind="NOUN", value=naming)
        yield _plural(phrase), NameEntry(kind="NOUN", value=naming, plural=True)
    for implement in robot.implements.values():
        for verb in implement.verbs:
            for form in forms_of(verb):
                yield split(form), NameEntry(kind="WORKV", value=implement.name)
        for word in implement.words:
            if word not in implement.verbs:
                yield split(word), NameEntry(kind="WORKN", value=implement.name)
    for action in at_places:
        for verb in action.verbs:
            for form in forms_of(verb):
                yield split(form), NameEntry(kind="ACTV", value=Naming(actions=(action.name,)))


def parameter_entries(robot: RobotProfile) -> Iterator[tuple[Phrase, NameEntry]]:
    """Choices, names and units of the parameters of a robot's actions."""
    choices: dict[Phrase, list[tuple[str, str]]] = {}
    names: dict[Phrase, list[str]] = {}
    adjectives: dict[str, list[str]] = vocabulary()["adjectives_of"]
    for parameter in {one.name: one for action in robot.actions for one in action.parameters}.values():
        for choice in parameter.choices:
            for word in (choice, *vocabulary()["other_choices"].get(choice, ())):
                choices.setdefault(split(word), []).append((parameter.name, choice))
        words = name_words(parameter.name)
        for phrase in (tuple(words), *((word,) for noun in words for word in adjectives.get(noun, ()))):
            names.setdefault(phrase, []).append(parameter.name)
        if parameter.unit:
            yield split(parameter.unit), NameEntry(kind="UNIT", value=(parameter.unit, 1.0, 0.0))
            for said, factor in rate_words(parameter.unit):
                yield said, NameEntry(kind="UNIT", value=(parameter.unit, factor, 0.0))
    for phrase, meant in choices.items():
        yield phrase, NameEntry(kind="CHOICE", value=tuple(meant))
        yield _plural(phrase), NameEntry(kind="CHOICE", value=tuple(meant), plural=True)
    for phrase, found in names.items():
        if phrase:
            yield phrase, NameEntry(kind="PARAMETER", value=tuple(found))
            if _plural(phrase) not in names:
                yield _plural(phrase), NameEntry(kind="PARAMETER", value=tuple(found), plural=True)


def rate_words(unit: str) -> Iterator[tuple[Phrase, float]]:
    """Yield the unit of a rate in words, with what one of it is in that unit: "litres per hectare" for ``l/ha``."""
    rate = rate_unit(unit)
    if rate is None:
        return
    words = vocabulary()["rates"]
    amounts = words["amounts"].get(rate.amount, [rate.amount])
    per = rate.area_m2 or rate.length_m
    for size in words["areas" if rate.area_m2 else "lengths"]:
        for amount, joint, of in product(amounts, words["joints"], size["words"]):
            yield split(f"{amount} {joint} {of}"), round(per / size["size"], 9)


def site_entries(site: Site) -> Iterator[tuple[Phrase, NameEntry]]:
    """Attributes, their texts and zones of the site."""
    values: dict[Phrase, list[tuple[str, str]]] = {}
    names: dict[Phrase, list[str]] = {}
    for attribute, found in site.attributes.items():
        for text in _texts(found):
            values.setdefault(split(text), []).append((attribute, text))
        as_written = (attribute.lower(),) if split(attribute) else ()  # "yield_kg"
        for phrase in filter(None, (*_spoken(attribute), as_written)):
            if attribute not in names.setdefault(phrase, []):
                names[phrase].append(attribute)
    for phrase, meant in values.items():
        yield phrase, NameEntry(kind="ATTRVAL", value=tuple(meant))
        yield _plural(phrase), NameEntry(kind="ATTRVAL", value=tuple(meant), plural=True)
    for phrase, attributes in names.items():
        yield phrase, NameEntry(kind="ATTR", value=tuple(attributes))
        yield _plural(phrase), NameEntry(kind="ATTR", value=tuple(attributes), plural=True)
    for zone in site.zones:
        name = split(zone.name)
        if zone.kind != "boundary" and name and len(zone.name) <= _LONGEST_ZONE:
            for phrase in (name, (*name, "zone"), ("zone", *name), (*name, "area"), ("area", *name)):
                yield phrase, NameEntry(kind="ZONE", value=zone.name)
    for head, numbered in numbered_zones_of(site).items():
        yield split(head), NameEntry(kind="NUMBEREDZONE", value=numbered)
        yield _plural(split(head)), NameEntry(kind="NUMBEREDZONE", value=numbered, plural=True)
    waters = [zone.name for zone in site.zones if zone.kind != "boundary" and _WATERS & {*split(zone.name)}]
    if len(waters) == 1:  # "the water" is the only pond
        yield ("the", "water"), NameEntry(kind="ZONE", value=waters[0])
        yield ("the", "water's", "edge"), NameEntry(kind="ZONE", value=waters[0])


def numbered_zones_of(site: Site) -> dict[str, tuple[tuple[str, str], ...]]:
    """Return the numbers and names of zones that differ only in their number, in its order, by the rest of the name."""
    found: dict[str, list[tuple[str, str]]] = {}
    for zone in site.zones:
        head, _, number = zone.name.rpartition(" ")
        if (
            zone.kind == "zone"
            and number.isdecimal()
            and split(head)
            and (number, zone.name) not in found.get(head, ())
        ):
            found.setdefault(head, []).append((number, zone.name))
    return {head: tuple(sorted(zones, key=lambda z: int(z[0]))) for head, zones in found.items() if len(zones) > 1}


def _texts(found: tuple[Any, ...]) -> list[str]:
    texts = [value for value in found if isinstance(value, str) and len(value) <= _LONGEST_TEXT and split(value)]
    return texts if len(texts) <= _MOST_TEXTS else []


def name_words(attribute: str) -> list[str]:
    """Return the words of an attribute's name without its unit: "age" for ``age_years``."""
    return [word for word in split(attribute) if word not in _UNIT_WORDS]


def _spoken(attribute: str) -> set[Phrase]:
    """Return the names of an attribute in words: its name, that without its unit, and other words for it."""
    base = name_words(attribute)
    spoken = {split(attribute), tuple(base)}
    for hint, words in vocabulary()["aliases"].items():
        if hint in base:
            for word in words:
                spoken |= {split(" ".join(base).replace(hint, word)), split(word)}
    return {phrase for phrase in spoken if phrase}


def _plural(phrase: Phrase) -> Phrase:
    return (*phrase[:-1], plural_of(phrase[-1]))
