"""Wording of the nouns of a Task: numbers, units, lists, sides, actions; selectors are described elsewhere.

Read-back, map and report share these functions, so that each thing has one name everywhere. They return English text
as messages, which every language of :mod:`fieldhand.language` can translate.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Literal

from fieldhand.language import Message, Number, counted, joined, message, named, shaped
from fieldhand.terms import CornerName, Side, Test

SIDES: dict[Side, str] = {
    "north": message("northern"),
    "east": message("eastern"),
    "south": message("southern"),
    "west": message("western"),
}
CORNERS: dict[CornerName, str] = {
    "nw": message("north-west"),
    "ne": message("north-east"),
    "se": message("south-east"),
    "sw": message("south-west"),
}
#: Compass directions: "from the north"; with intermediate winds, since rows run in any direction.
COMPASS: dict[str, str] = {
    "north": message("north", context="compass"),
    "north-east": message("north-east", context="compass"),
    "east": message("east", context="compass"),
    "south-east": message("south-east", context="compass"),
    "south": message("south", context="compass"),
    "south-west": message("south-west", context="compass"),
    "west": message("west", context="compass"),
    "north-west": message("north-west", context="compass"),
}
TESTS: dict[Test, str] = {
    "lt": "below",
    "le": "at most",
    "gt": "above",
    "ge": "at least",
    "eq": "exactly",
    "ne": "other than",
}
UNITS = {
    "degC": "°C",
    "degF": "°F",
    "percent": "%",
    "m_s": "m/s",
    "deg": "°",
    "umol_m2_s": "µmol/(m²·s)",
    "unitless": "",
}

#: Ten years in seconds, above which a duration in hours is meaningless to a person.
_YEARS_S = 10 * 365.25 * 86_400.0

_MINUS = "\N{MINUS SIGN}"
_ACRONYMS = {"co2": "CO₂", "ndvi": "NDVI", "ph": "pH", "ec": "EC", "rgb": "RGB", "par": "PAR", "lidar": "LiDAR"}
_IRREGULAR = {"leaf": "leaves", "fruit": "fruit", "co₂": "CO₂", "datum": "data"}
#: Verbs whose object is read rather than produced: "read the soil moisture".
_READING_VERBS = frozenset({"read", "measure", "record", "sense", "monitor", "inspect", "check"})


def say_name(name: str) -> str:
    """Return a name with underscores as words: ``ambient_temperature`` is "ambient temperature", ``co2`` is "CO₂"."""
    words = _words(name)
    return named(words, "name", message("“{name}”", context="name", name=words))


def _words(name: str) -> str:
    return " ".join(_ACRONYMS.get(part.lower(), part) for part in re.split(r"[_\s]+", name) if part)


def say_number(value: float, digits: int = 6) -> str:
    """Return a number without superfluous digits: 33.0 is "33", 0.5 is "0.5"."""
    if not math.isfinite(value):
        return message("an unknown number")
    text = f"{value:.{digits}g}"
    if "e" in text:
        text = f"{value:,.0f}" if abs(value) >= 1 else f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return Number(text.replace("-", _MINUS))


def say_rounded(value: float, digits: int = 0) -> str:
    """Return a number rounded to a number of decimals: 12.345 with one is "12.3"."""
    return Number(f"{value:.{digits}f}")


def say_quantity(value: float, unit: str) -> str:
    """Return a value with its unit: "33 °C", "40 %", "400 ppm"."""
    return joined(" ", [part for part in (say_number(value), say_unit(unit)) if part])


def say_unit(unit: str) -> str:
    """Return a unit as printed: ``degC`` is "°C"."""
    return UNITS.get(unit, unit.replace("_", " "))


def say_value(value: str | float | bool) -> str:
    """Return the value of an attribute: "yellow", "12.5", "yes"."""
    if isinstance(value, bool):
        return message("yes") if value else message("no")
    return value if isinstance(value, str) else say_number(value)


def say_place(kind: str, name: str, side: str = "") -> str:
    """Return a place in the form that follows "at": "tree 12", "the east side of tree 12", "the end"."""
    if kind == "tree" and side in COMPASS:
        return message("the {side} side of tree {id}", context="log", side=COMPASS[side], id=name)
    if kind == "tree":
        return message("tree {id}", context="log", id=name)
    if kind == "gap":
        return name
    return message("the {role}", context="log", role=named(name, "role"))


def say_near(kind: str, name: str, *, arrived: bool) -> str:
    """Return the location of a robot that has arrived at a place, or drives there: "at tree 12"."""
    if arrived:
        return message("at {place}", context="log", place=say_place(kind, name))
    return message("on the way to {place}", context="log", place=say_place(kind, name))


def say_tree(tree: str) -> str:
    """Return a tree by its id: "tree 81"."""
    return message("tree {id}", id=tree)


def say_side(tree: str, side: Side) -> str:
    """Return a side of a tree: "the east side of tree 81"."""
    return message("the {side} side of {tree}", side=COMPASS[side], tree=say_tree(tree))


def say_marker(name: str) -> str:
    """Return a marker in words: "the end marker", "the charger"."""
    match name:
        case "charger":
            return message("the charger")
        case "start":
            return message("the start marker")
        case "end":
            return message("the end marker")
    return message("the {name} marker", name=say_name(name))


def say_gate(gate: str) -> str:
    """Return a gate in words: "the gate", or "the gate “north gate”" if it has a name."""
    return message("the gate") if say_name(gate).lower() == "gate" else message("the gate “{gate}”", gate=gate)


def say_zone(zone: str) -> str:
    """Return a zone by its name: "the zone “wet corner”"."""
    return message("the zone “{zone}”", zone=zone)


def some_names(names: Sequence[str], most: int, sign: str = ", ") -> str:
    """Return up to ``most`` names and the number of the remaining ones: "14, 15 and 6 more"."""
    shown = joined(sign, names[:most])
    if len(names) <= most:
        return shown
    return message("{items} and {count} more", items=shown, count=len(names) - most)


def say_duration(seconds: float) -> str:
    """Return a duration in words: "45 s", "12 min", "1 h 05 min"; very large and infinite values are safe."""
    if math.isnan(seconds):
        return message("an unknown time")
    if seconds > _YEARS_S:
        return message("more than ten years")
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02d} min"


def say_wait(seconds: float) -> str:
    """Return a duration without rounding it to minutes: "45 s", "2 min 30 s", "1 h 30 min"."""
    if seconds < 60 or seconds != round(seconds) or seconds > _YEARS_S:
        return joined(" ", (say_number(seconds), "s"))
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    parts = [f"{hours} h" if hours else "", f"{minutes} min" if minutes else "", f"{rest} s" if rest else ""]
    return " ".join(filter(None, parts))


def say_times(count: int) -> str:
    """Return a frequency: "once", "twice", "5 times"."""
    if count == 1:
        return message("once")
    return message("twice") if count == 2 else message("{count} times", count=count)


def say_count(count: int, noun: str) -> str:
    """Return a count with its noun: "1 tree", "4 trees"."""
    return counted(f"{{count}} {noun}", f"{{count}} {plural(noun)}", count)


def plural(noun: str) -> str:
    """Return the plural of a noun phrase whose head is its last word."""
    head, space, last = noun.rpartition(" ")
    irregular = _IRREGULAR.get(last.lower())
    if irregular is not None:
        many = irregular
    elif re.search(r"(s|x|z|ch|sh)$", last):
        many = f"{last}es"
    elif re.search(r"[^aeiou]y$", last):
        many = f"{last[:-1]}ies"
    else:
        many = f"{last}s"
    return f"{head}{space}{many}"


def article(noun: str) -> str:
    """Return the noun with "a" or "an"."""
    first = noun.split(" ", 1)[0]
    # An acronym is spelled out when read, so the sound of its first letter decides ("an RGB picture").
    spelt = len(first) > 1 and first.isupper()
    vowel = first[:1] in "AEFHILMNORSX" if spelt else first[:1].lower() in set("aeiou")
    return f"{'an' if vowel else 'a'} {noun}"


def listed(items: Sequence[str], last: Literal["and", "or"] = "and") -> str:
    """Return a list in words: "81, 12 and 5"."""
    if len(items) < 2:
        return joined("", items)
    held = joined(", ", items[:-1])
    if last == "or":
        return message("{items} or {last}", items=held, last=items[-1])
    return message("{items} and {last}", items=held, last=items[-1])


def say_action(name: str, count: int = 1) -> str:
    """Return an action as a verb phrase: "take a thermal picture", "read the soil moisture twice"."""
    if {*"{}"} & {*name}:  # no profile has such a name, but a Task may
        once = message("do “{action}”", action=name)
        return once if count == 1 else message("do “{action}” {times}", action=name, times=say_times(count))
    verb, _, rest = name.strip("_").partition("_")
    thing = _words(rest)
    if not thing:
        return _of_action(_words(verb), f"{_words(verb)} {{times}}", count)
    if verb in _READING_VERBS:
        bare = thing if thing in _ACRONYMS.values() else f"the {thing}"
        return _of_action(f"{verb} {bare}", f"{verb} {bare} {{times}}", count)
    return _of_action(f"{verb} {article(thing)}", f"{verb} {{count}} {plural(thing)}", count)


def say_captures(name: str, count: int) -> str:
    """Return the counted results of an action: "3 thermal pictures", "1 reading of CO₂"."""
    if {*"{}"} & {*name}:
        return counted("{count} capture of “{name}”", "{count} captures of “{name}”", count, name=name)
    verb, _, rest = name.strip("_").partition("_")
    thing = _words(rest) or _words(verb)
    one, many = (f"{thing} reading", f"{thing} readings") if verb in _READING_VERBS else (thing, plural(thing))
    text = counted(f"{{count}} {one}", f"{{count}} {many}", count, context="captures")
    text.instead = counted("{count} capture of “{name}”", "{count} captures of “{name}”", count, name=thing)
    return text


def _of_action(once: str, often: str, count: int) -> Message:
    """Return a verb phrase, to be translated if a catalogue contains it and quoted otherwise."""
    text = counted(once, often, count, context="action", times=say_times(count))
    quoted = message("do “{action}”", action=once)
    text.instead = quoted if count == 1 else message("do “{action}” {times}", action=once, times=say_times(count))
    return text


def capitalised(text: str) -> str:
    """Return the text with its first letter in upper case and the rest unchanged."""
    return shaped(text, _with_capital)


def _with_capital(text: str) -> str:
    return text[:1].upper() + text[1:]
