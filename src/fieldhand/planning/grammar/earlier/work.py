"""Find what is said of earlier work in the words of a request: "not visited", "that we measured CO2 at"."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.places.earlier.period import EVER, Period
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.naming import Naming, Phrase
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.earlier.periods import PastTime, matches_in, tables
from fieldhand.planning.grammar.earlier.work_patterns import work_patterns
from fieldhand.site.earlier_missions import EarlierOutcome

#: Quantity of work that is only said to be measured: the one that the plan measures there, or else any.
SAME_MEASURE = "="
#: Beginning of an action or a quantity of a clause that names no period, which may be of an earlier mission or of this.
OPEN_TIME = "~"
#: Action and quantity of a piece of work, of which one may be empty.
Way = tuple[str, str]

ANY_WORK: Way = ("", "")
MEASURED_WORK: Way = ("", SAME_MEASURE)
_TIMES = {"once": 1, "twice": 2, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6}


@dataclass(frozen=True, slots=True)
class EarlierWork:
    """Work of earlier missions, as a clause states it.

    Attributes:
        ways: Action and quantity, one for each meaning of the words.
        outcomes: Result, one for each meaning.
        negated: True for "not visited".
        at_least: Number of missions.
        unsaid: True if the words say that it was before without a period ("already", "never").
        needs_period: True if the clause means earlier work only with a period ("with a picture from last week").
    """

    ways: tuple[Way, ...]
    outcomes: tuple[EarlierOutcome, ...] = ("done",)
    negated: bool = False
    at_least: int = 1
    unsaid: bool = False
    needs_period: bool = False

    def selectors(self, when: PastTime | None) -> list[s.Selector]:
        """Return the places of every tree that fit, one selector for each meaning; none if the period does not fit."""
        if when is None and not self.unsaid:
            if self.needs_period or self.outcomes == ("done",):
                return []
            last = [self._places(way, outcome, Period(last_missions=1), None) for outcome, way in self._meanings]
            return [*last, *self.selectors(PastTime(EVER, unsaid=True))]
        if when is not None and (when.longer or when.lasting) and self.outcomes != ("done",):
            return []
        if when is not None and when.lasting and not self.negated:
            return []
        period = EVER if when is None else when.period
        return list(dict.fromkeys(self._places(way, outcome, period, when) for outcome, way in self._meanings))

    @property
    def _meanings(self) -> list[tuple[EarlierOutcome, Way]]:
        return [(outcome, way) for outcome in self.outcomes for way in self.ways]

    def _places(self, way: Way, outcome: EarlierOutcome, period: Period, when: PastTime | None) -> s.Selector:
        action, measured = ("", "") if outcome == "left_out" else way
        if when is None or when.unsaid:
            action = of_some_time(action)
        done = s.DoneEarlier(action=action, measured=measured, outcome=outcome, at_least=self.at_least, period=period)
        if when is not None and when.longer:
            # "More than a week ago" tells of the last time: it was done, but not in the last week.
            ago = s.Excluding(places=done, of=replace(done, period=EVER))
            return s.Excluding(places=ago) if self.negated else ago
        return s.Excluding(places=done) if self.negated else done


def of_some_time(name: str) -> str:
    """Return the name of an action or a quantity of a clause that names no period."""
    return f"{OPEN_TIME}{name}"


def earlier_work(
    words: Sequence[Word], lexicon: Lexicon, camera: Naming | None
) -> Iterator[tuple[int, int, EarlierWork]]:
    """Yield the clauses about earlier work in words, each with the range of its words.

    Args:
        words: Words of a request.
        lexicon: Words of the robot.
        camera: The action that takes pictures, if the robot has just one.
    """
    if not any(word.norm in _openings() for word in words):
        return
    nouns, verbs = _nouns(lexicon, camera), _verbs(lexicon, camera)
    for kind, pattern in work_patterns(tuple(sorted(map(" ".join, nouns))), tuple(sorted(verbs))):
        for first, last, found in matches_in(pattern, words):
            work = _work(kind, {name: text or "" for name, text in found.groupdict().items()}, nouns, verbs)
            if work is not None:
                yield first, last, work


@cache
def _openings() -> frozenset[str]:
    """Return words of which every clause about earlier work has one."""
    known = tables()
    phrases = [phrase for name in ("participles", "works", "actives") for of in known[name].values() for phrase in of]
    single = {word for phrase in phrases for word in phrase.split()} - {"not", "to", "at", "out", "on", "up"}
    more = {"did", "didn't", "could", "couldn't", "failed", "wrong", "with", "without", "no", "have", "has", "work"}
    more |= {"still", "outstanding", "left", "finished"}
    return frozenset({*single, *more, "taken", "took", "got", "made", "filmed", "scanned", "recorded", "clipped"})


def _nouns(lexicon: Lexicon, camera: Naming | None) -> Mapping[Phrase, tuple[Way, ...]]:
    """Return what the nouns of the robot's work mean."""
    found: dict[Phrase, tuple[Way, ...]] = {}
    for phrase, entry in lexicon.own.items():
        if entry.kind == "NOUN":
            naming: Naming = entry.value
            named = tuple(("", name) for name in naming.quantities) or tuple((name, "") for name in naming.actions[:1])
            found[phrase] = named
    if camera is not None:
        for noun in ("picture", "photo", "photograph", "image", "shot", "pic", "snapshot"):
            found.setdefault((noun,), ((camera.actions[0], ""),))
            found.setdefault((f"{noun}s",), ((camera.actions[0], ""),))
    return found


def _verbs(lexicon: Lexicon, camera: Naming | None) -> Mapping[str, tuple[Way, ...]]:
    """Return what the past participles of work mean."""
    known = tables()
    found: dict[str, tuple[Way, ...]] = dict.fromkeys(known["participles"]["measured"], (MEASURED_WORK,))
    for action, verbs in known["works"].items():
        found |= dict.fromkeys(verbs, ((action, ""),))
    if camera is not None:
        found |= dict.fromkeys(known["participles"]["picture"], ((camera.actions[0], ""),))
    for phrase, entry in lexicon.own.items():
        if len(phrase) != 1 or not (phrase[0].endswith("ed") or phrase[0] == "cut"):
            continue
        if entry.kind == "ACTV":
            naming: Naming = entry.value
            found[phrase[0]] = ((naming.actions[0], ""),)
        elif entry.kind == "WORKV":
            found[phrase[0]] = ((str(entry.value), ""),)
    samplers = (way for phrase, ways in _nouns(lexicon, camera).items() if phrase[-1] == "sample" for way in ways)
    taken = next((way for way in samplers if "sample" in way[0].split("_")), None)
    if taken is not None:
        found["sampled"] = (MEASURED_WORK, taken)
    return found | dict.fromkeys(known["participles"]["any"], (ANY_WORK,))


def _work(
    kind: str, said: Mapping[str, str], nouns: Mapping[Phrase, Any], verbs: Mapping[str, Any]
) -> EarlierWork | None:
    """Return the work of a clause; None if it says something else."""
    named: tuple[Way, ...] = nouns.get(tuple(said.get("noun", "").split()), ())
    match kind:
        case "passive":
            return _passive(said, named, verbs)
        case "active":
            return _active(said, named, verbs)
        case "not":
            return _not_done(said, named, verbs)
        case "where":
            made = EarlierWork(named, unsaid=_says_before(said))
            negated = _negated(said)
            if negated is None:
                return None
            return replace(made, negated=negated != bool(said["no"]))
        case "with":
            denied = bool({"no", "not", "without", "lacking", "lack", "don't"} & {*said["with"].split()})
            return EarlierWork(named, negated=denied, needs_period=True)
        case "still":
            return EarlierWork((ANY_WORK,), outcomes=("left_out",))
        case _:
            return _failed(said, named, verbs)


def _words(text: str) -> list[str]:
    return text.split()


def _negated(said: Mapping[str, str]) -> bool | None:
    """Return True for "not yet", False for a clause without "not", None for one with two."""
    lead = _words(said.get("lead", ""))
    count = sum(word in ("not", "never") or word.endswith("n't") for word in lead)
    if "to" in lead:
        return True if count == 0 and {"yet", "still"} & set(lead) else None
    return None if count > 1 else bool(count)


def _says_before(said: Mapping[str, str]) -> bool:
    words = {*_words(said.get("lead", "")), *_words(said.get("tail", ""))}
    return bool(words & {"already", "never", "yet", "ever", "previously", "before", "far", "last"})


def _at_least(said: Mapping[str, str]) -> int:
    words = _words(said.get("times", ""))
    number = next(
        (_TIMES.get(word, int(word) if word.isdigit() else 0) for word in words if word in _TIMES or word.isdigit()), 1
    )
    return number + ("than" in words)


def _passive(said: Mapping[str, str], named: tuple[Way, ...], verbs: Mapping[str, Any]) -> EarlierWork | None:
    negated, verb = _negated(said), said["verb"]
    if negated is None:
        return None
    if verb in tables()["participles"]["left_out"]:
        return None if negated or named else EarlierWork((ANY_WORK,), outcomes=("left_out",), unsaid=_says_before(said))
    ways = named or verbs.get(verb, ())
    if not ways:
        return None
    return EarlierWork(ways, negated=negated, at_least=_at_least(said), unsaid=_says_before(said))


def _active(said: Mapping[str, str], named: tuple[Way, ...], verbs: Mapping[str, Any]) -> EarlierWork | None:
    known = tables()["actives"]
    negated, verb = _negated(said), said["verb"]
    if negated is None:
        return None
    unsaid = _says_before(said)
    if verb in known["left_out"]:
        return None if negated or named else EarlierWork((ANY_WORK,), outcomes=("left_out",), unsaid=unsaid)
    ways = named or verbs.get(verb, ())
    if not ways:
        ways = (
            (ANY_WORK,)
            if verb in known["any"]
            else (MEASURED_WORK,)
            if verb in known["measured"]
            else verbs.get("photographed", ())
        )
    if not ways or (verb in known["picture"] and named):
        return None
    return EarlierWork(ways, negated=negated, at_least=_at_least(said), unsaid=unsaid)


def _not_done(said: Mapping[str, str], named: tuple[Way, ...], verbs: Mapping[str, Any]) -> EarlierWork | None:
    known = tables()["bases"]
    verb, how = said["verb"], said["not"]
    tried = not how.startswith(("did", "never", "forgot", "had no time", "have", "haven't", "hadn't", "had not"))
    if verb in known["left_out"]:
        return None if named else EarlierWork((ANY_WORK,), outcomes=("left_out",))
    if how == "had no time to" or how.endswith("managed to"):
        return EarlierWork((ANY_WORK,), outcomes=("left_out",))
    ways: tuple[Way, ...] = named or ((MEASURED_WORK,) if verb in known["measured"] else ())
    if verb in known["picture"]:
        ways = () if named else verbs.get("photographed", ())
        if not ways:
            return None
    if tried:
        return (
            EarlierWork(ways, outcomes=("failed",))
            if ways
            else EarlierWork((ANY_WORK,), outcomes=("left_out", "failed"))
        )
    return EarlierWork(ways or (ANY_WORK,), negated=True)


def _failed(said: Mapping[str, str], named: tuple[Way, ...], verbs: Mapping[str, Any]) -> EarlierWork | None:
    verb = said.get("verb", "")
    if not verb:
        return EarlierWork(named or (ANY_WORK,), outcomes=("failed",))
    ways = verbs.get(verb, ())
    if not ways or ways == (ANY_WORK,):
        return EarlierWork((ANY_WORK,), outcomes=("left_out", "failed"))
    return EarlierWork(ways, outcomes=("failed",))
