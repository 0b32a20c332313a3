"""Find the events of a robot in the words of a request: "someone is in the row", "it starts raining".

An event is named by a clause or a noun of its profile; ``events.toml`` has the turns of phrase. Each is one edge of the
chart, and so are the words of responses, which are looked for only where there is an event.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from fieldhand.compatibility import tomllib
from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.tokens import Word, ranges_of
from fieldhand.robot.events import MonitoredEvent
from fieldhand.robot.model import RobotProfile
from fieldhand.robot.units import conversion
from fieldhand.task.watches import EventBeyond, EventHolds
from fieldhand.terms import Test

#: Tests by the name of the phrases for them.
_TESTS: Mapping[str, Test] = {"above": "gt", "least": "ge", "below": "lt", "most": "le"}


@dataclass(frozen=True, slots=True)
class EventMention:
    """An event in a request.

    Attributes:
        condition: Event, or its comparison with a threshold.
        start, end: Range of its words.
        is_noun: True for a noun ("rain"), False for a clause ("it rains").
        clear: True if the words say that it does not hold ("nobody is near", "the gate is open").
    """

    condition: EventHolds | EventBeyond
    start: int
    end: int
    is_noun: bool
    clear: bool = False


@cache
def phrases() -> Mapping[str, Any]:
    """Return the tables of events.toml."""
    return tomllib.loads((files("fieldhand.planning.grammar") / "events.toml").read_text(encoding="utf-8"))


def nouns_of(event: MonitoredEvent) -> tuple[str, ...]:
    """Return the nouns by which an event is called: its own, and those that mean the same."""
    own = {word for noun in event.words for word in (noun, plural_of(noun))}
    same = (alike for alike in phrases()["words"].values() if own & {*alike})
    return tuple(sorted({*own, *(word for alike in same for word in alike)}, key=lambda word: (-len(word), word)))


@dataclass(frozen=True)
class EventPatterns:
    """The patterns of a robot's events."""

    clauses: tuple[tuple[MonitoredEvent, str, re.Pattern[str]], ...]
    nouns: tuple[tuple[MonitoredEvent, str, re.Pattern[str]], ...]

    @classmethod
    def of(cls, robot: RobotProfile) -> EventPatterns:
        """Return the patterns of a robot."""
        clauses: list[tuple[MonitoredEvent, str, re.Pattern[str]]] = []
        nouns: list[tuple[MonitoredEvent, str, re.Pattern[str]]] = []
        for event in robot.events:
            clauses += [(event, kind, pattern) for kind, pattern in _clauses_of(event)]
            nouns += [(event, kind, pattern) for kind, pattern in _nouns_of(event)]
        return cls(tuple(clauses), tuple(nouns))

    def mentions(self, words: Sequence[Word]) -> Iterator[EventMention]:
        """Yield the events that words mention."""
        text = " ".join(word.norm for word in words)
        starts = {sum(len(word.norm) + 1 for word in words[:k]): k for k in range(len(words))} if self.clauses else {}
        for is_noun, patterns in ((False, self.clauses), (True, self.nouns)):
            for event, kind, pattern in patterns:
                for first, last in ranges_of(pattern, words):
                    at = next(offset for offset, k in starts.items() if k == first)
                    found = pattern.match(text, at)
                    condition = None if found is None else _condition(event, kind, found)
                    if condition is not None:
                        yield EventMention(condition, first, last, is_noun, kind == "clear")


#: The patterns of a robot without events.
NO_EVENTS = EventPatterns(clauses=(), nouns=())


def _clauses_of(event: MonitoredEvent) -> Iterator[tuple[str, re.Pattern[str]]]:
    """Yield the patterns of the clauses that say an event, each with its kind."""
    said = phrases()["said"]
    if event.unit:
        for kind in _TESTS:
            yield kind, _pattern(said[kind], event)
    if event.unit and (own := _own_states(event)):
        yield "above", _pattern(said["own_above"], event, own)
    if event.can_hold and not event.unit and (event.verbs or not event.states):
        yield "holds", _pattern(said["noun"], event)
    if event.can_hold and event.verbs:
        yield "holds", _pattern(said["verb"], event)
    if event.can_hold and event.states:
        yield "holds", _pattern(said["state"], event)
        if own := _own_states(event):
            yield "holds", _pattern(said["own_state"], event, own)
            yield "clear", _pattern(said["clear_own_state"], event, own)
    if event.can_hold:
        yield from (("clear", _pattern(said[name], event)) for name in _clear(event))


def _clear(event: MonitoredEvent) -> tuple[str, ...]:
    """Return the forms of the clauses that deny an event."""
    nouns = ("clear_noun",) if not event.unit and (event.verbs or not event.states) else ()
    people = ("clear_person",) if {*nouns_of(event)} & {*phrases()["words"]["people"]} else ()
    return (*nouns, *people, *(("clear_verb",) if event.verbs else ()), *(("clear_state",) if event.states else ()))


def _nouns_of(event: MonitoredEvent) -> Iterator[tuple[str, re.Pattern[str]]]:
    """Yield the patterns of the nouns that name an event: "rain", "a closed gate", "wind over 5 m/s"."""
    said = phrases()["said"]
    if event.unit:
        for kind in _TESTS:
            yield kind, _pattern(said[kind], event)
    elif event.can_hold and not event.states:
        yield "holds", _pattern(["{det}{noun}(?: (?:who|that|which) {be})?(?: {where})?"], event)
    if event.can_hold and event.states:
        yield "holds", _pattern(["{det}{state} {noun}"], event)
    if event.can_hold and event.verbs:
        yield "holds", _pattern(["{det}{noun}"], event)


def _own_states(event: MonitoredEvent) -> tuple[str, ...]:
    """Return the states that name the event by themselves, by the beginning of one of its nouns ("windy")."""
    return tuple(s for s in event.states if any(s[:4] == noun[:4] for noun in event.words))


def _pattern(forms: Sequence[str], event: MonitoredEvent, states: Sequence[str] = ()) -> re.Pattern[str]:
    frames = phrases()["frames"]
    units = [unit for name in phrases()["units"] if _factor(name, event.unit) for unit in phrases()["units"][name]]
    parts = {
        **frames,
        "noun": _any(nouns_of(event)),
        "verb": _any([form for verb in event.verbs for form in forms_of(verb)]),
        "state": _any(states or event.states),
        "opposite": _any([word for state in states or event.states for word in phrases()["opposites"].get(state, ())]),
        "more": _any([*map(_more, states), *(f"more {state}" for state in states)]),
        "units": _any([*units, event.unit] if event.unit else units),
    }

    def spelt_out(form: str) -> str:
        while (whole := re.sub(r"\{([a-z]+)\}", lambda match: parts[match[1]], form)) != form:
            form = whole
        return form

    # Groups of the same name may stand in one alternative only.
    whole = "|".join(f"(?:{spelt_out(form)})" for form in forms)
    for name in ("number", "unit"):
        whole = _numbered(whole, name)
    return re.compile(rf"(?<!\S)(?:{whole})(?!\S)")


def _numbered(pattern: str, name: str) -> str:
    """Return a pattern whose groups of one name are numbered, since a name can stand only once."""
    parts = pattern.split(f"(?P<{name}>")
    return parts[0] + "".join(f"(?P<{name}{k}>{part}" for k, part in enumerate(parts[1:]))


def _more(state: str) -> str:
    """Return the comparative of a state: "windier"."""
    return f"{state[:-1]}ier" if state.endswith("y") else f"{state.removesuffix('e')}er"


def _any(words: Sequence[str]) -> str:
    return f"(?:{'|'.join(map(re.escape, sorted(set(words), key=len, reverse=True)))})" if words else r"(?!)"


def _condition(event: MonitoredEvent, kind: str, found: re.Match[str]) -> EventHolds | EventBeyond | None:
    if kind in ("holds", "clear"):
        return EventHolds(event=event.name)
    groups = {name[:-1]: text for name, text in found.groupdict().items() if text is not None}
    unit = next((name for name, said in phrases()["units"].items() if groups["unit"] in said), groups["unit"])
    factor = _factor(unit, event.unit)
    if factor is None:
        return None
    value = round(float(groups["number"]) * factor[0] + factor[1], 3)
    return EventBeyond(event=event.name, test=_TESTS[kind], value=value, unit=event.unit)


def _factor(unit: str, wanted: str) -> tuple[float, float] | None:
    """Return scale and offset from a unit to that of the profile; None if they measure something else."""
    if unit in phrases()["factors"]:
        to = conversion("m/s", wanted)
        return None if to is None else (to[0] * phrases()["factors"][unit], to[1])
    return conversion(unit, wanted)


@cache
def _response_words() -> Mapping[tuple[str, ...], tuple[str, ...]]:
    """Return the categories of the phrases of triggers and responses."""
    found: dict[tuple[str, ...], tuple[str, ...]] = {}
    for category, said in phrases()["triggers"].items():
        for phrase in said:
            key = tuple(phrase.split())
            found[key] = (*found.get(key, ()), category)
    return found


@cache
def _response_patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Return the patterns of triggers and responses, with their categories."""
    table = phrases()["responses"]
    parts = {name: part for name, part in table.items() if isinstance(part, str)}
    found: list[tuple[str, re.Pattern[str]]] = []
    for category, forms in table.items():
        if isinstance(forms, list):
            pattern = "|".join(re.sub(r"\{([a-z]+)\}", lambda match: parts[match[1]], form) for form in forms)
            found.append((category, re.compile(rf"(?<!\S)(?:{pattern})(?!\S)")))
    return tuple(found)


def response_words(words: Sequence[Word]) -> Iterator[tuple[str, int, int]]:
    """Yield each phrase of a trigger or response among words: its category, and the range of its words."""
    for category, pattern in _response_patterns():
        yield from ((category, first, last) for first, last in ranges_of(pattern, words))
    longest = max(map(len, _response_words()))
    for start in range(len(words)):
        for end in range(start + 1, min(start + longest, len(words)) + 1):
            for category in _response_words().get(tuple(word.norm for word in words[start:end]), ()):
                yield category, start, end


def says_any_time(words: Sequence[Word]) -> bool:
    """Return True if words contain "at any time" or the like."""
    return any(category == "ANYTIME" for category, _, _ in response_words(words))


def in_event_sentences(words: Sequence[Word], robot: RobotProfile) -> frozenset[int]:
    """Return the numbers of the words of sentences that mention an event of the robot, and of the one behind each."""
    sentences, number = [], 0
    for word in words:
        sentences.append(number)
        number += word.kind == "stop"
    found = {sentences[mention.start] for mention in EventPatterns.of(robot).mentions(words)} if robot.events else set()
    return frozenset(k for k, sentence in enumerate(sentences) if {sentence, sentence - 1} & found)
