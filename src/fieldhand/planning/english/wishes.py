"""Wishes that no plan can express, recognised by their words: schedules, waiting, spraying, counting, the weather.

Some are looked for before anything is read, so that no turn of phrase and no reading can leave them out. The others are
looked for once a request is refused, and say what its unknown words ask for.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from typing import Literal

from fieldhand.compatibility import tomllib
from fieldhand.language import message
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.naming import Phrase, split
from fieldhand.planning.english.tokens import Word, ranges_of
from fieldhand.task.plan import Span

#: What a robot or a site has instead of that which is wished for.
Offers = Literal["", "actions", "places", "properties", "events"]

#: Words with which no wish begins.
_BEFORE = frozenset({"of", "for", "with", "in", "at", "to", "from", "and", "any", "on", "by", "near", "but", "so"})
#: Words for other times than one, and those that part the work or tell of something earlier.
_OTHER_TIMES = frozenset({"now", "again", "later", "afterwards", "earlier", "repeat", "once", "twice", "first"})
_PARTS = frozenset({"then", "was", "were", "been", "did", "had", "has", "have", "saw", "took", "since", "until"})
#: First words of clauses that tell something, and their verbs.
_SUBJECTS = frozenset({"the", "our", "my", "it", "they", "there", "these", "those", "this", "we"})
_STATING = frozenset({"is", "are", "was", "were", "look", "looks", "seem", "seems"})
_POLITE = frozenset({",", "please", "thanks"})
#: What stands before the first word of a clause.
_OPENING = (
    *(". ", "; ", "! ", "? ", ", ", ": ", "and ", "then ", "or ", "but ", "please ", "also ", "you to ", "you "),
    *("robot ", "it to ", "i want to ", "to be ", "be ", "go ", "just ", "let's "),
)
_CLAUSE = rf"(?:^|{'|'.join(f'(?<={re.escape(before)})' for before in _OPENING)})"
_WORD = r"(?<!\S)"


@dataclass(frozen=True, kw_only=True)
class WishKind:
    """A kind of wishes, as ``wishes.toml`` describes it.

    Attributes:
        what: Template of what the words ask for.
        advice: Template of what to say instead.
        early: True if it is looked for before anything is read.
        now: True if it is a time that may be the one at which the mission is to start anyway.
        begins: True if it is looked for at the beginning of clauses only.
        clause: True if unknown words of the same clause belong to it.
        aside: True if the rest of the request is a request without the words.
        rest: True if all that follows in the same clause belongs to it.
        offers: What is listed in the advice.
        work: True if its first word is a verb for which the robot has no action.
        works: True if it is looked for only where the request asks for no work of an implement of the robot.
        example: Form of a request with the same purpose, with a placeholder for another request.
        said: Regular expressions of its words.
    """

    what: str
    advice: str
    early: bool
    now: bool
    begins: bool
    clause: bool
    aside: bool
    rest: bool
    offers: Offers
    work: bool
    works: bool
    example: str
    said: tuple[str, ...]

    @property
    def waits(self) -> bool:
        """True if it asks to wait, which a plan can do until an event is over."""
        return "asks for waiting" in self.what

    @property
    def lacks_action(self) -> bool:
        """True if it asks for something that an action of a robot could do."""
        return self.offers == "actions"

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """Matches its words; compiled when it is first needed, since most kinds are needed by refusals only."""
        return re.compile(rf"{_CLAUSE if self.begins else _WORD}(?:{'|'.join(self.said)})(?!\S)")


@dataclass(frozen=True, kw_only=True)
class Wish:
    """A part of a request that no plan can express: the words ``first`` to ``last``, the latter excluded."""

    kind: WishKind
    first: int
    last: int

    def span(self, words: Sequence[Word]) -> Span:
        """Return the range of characters of its words."""
        return (words[self.first].start, words[self.last - 1].end)

    def say(self, said: str, robot: str) -> str:
        """Return what the words ask for.

        Args:
            said: The words.
            robot: Name of the robot.
        """
        return message(self.kind.what, context="wish", said=said, robot=robot)

    def advise(self, robot: str, offers: str) -> str:
        """Return what to say instead; ``offers`` lists what the robot or the site has."""
        return message(self.kind.advice, context="wish", robot=robot, offers=offers)


def early_wishes(words: Sequence[Word], lexicon: Lexicon) -> list[Wish]:
    """Return the wishes that no reading can leave out."""
    entries = (lexicon.own.get((word.norm,)) for word in words)
    works = any(entry is not None and entry.kind in ("WORKV", "WORKN") for entry in entries)
    kinds = [kind for kind in wish_kinds() if kind.early and not (works and kind.works)]
    found = [wish for wish in _longest(_found(words, kinds)) if not _is_told(wish, words)]
    times = [wish for wish in found if wish.kind.now]
    if len(times) == 1 and _is_of_whole_request(times[0], words):
        found.remove(times[0])
    return found


def _is_told(wish: Wish, words: Sequence[Word]) -> bool:
    """Return True for the time of a clause that tells something: "the aphids are bad this year"."""
    if "is not a time" not in wish.kind.what or (wish.last < len(words) and words[wish.last].kind == "word"):
        return False
    begin = wish.first
    while begin and words[begin - 1].kind not in ("comma", "stop"):
        begin -= 1
    told = [word.norm for word in words[begin : wish.first]]
    if "because" in told:
        told = told[told.index("because") + 1 :]
    return begin > 0 and bool(told) and told[0] in _SUBJECTS and not _STATING.isdisjoint(told[1:])


def says_start(words: Sequence[Word]) -> bool:
    """Return True if words contain a time at which a mission may be to start ("this morning")."""
    return any(True for _ in _found(words, [kind for kind in wish_kinds() if kind.now]))


def _is_of_whole_request(wish: Wish, words: Sequence[Word]) -> bool:
    """Return True for the only time of a request, at the beginning or the end of its first sentence.

    Elsewhere it may be the time of a part of the work, or of something earlier ("the trees pruned this morning").
    """
    before = words[: wish.first]
    if any(word.kind == "stop" or word.norm in _OTHER_TIMES for word in before):
        return False
    if any(word.norm in _OTHER_TIMES for word in words[wish.last :]):
        return False
    rest = [word for word in words[wish.last :] if word.norm not in _POLITE]
    ends = not rest or rest[0].kind == "stop"
    parted = any(word.kind == "comma" or word.norm in _PARTS or _is_past(word) for word in before)
    return not before or (ends and not parted and before[-1].norm not in _BEFORE)


def wishes(words: Sequence[Word], lexicon: Lexicon) -> list[Wish]:
    """Return all wishes, but for those that the robot or the site has a word for ("mow" on a robot that mows)."""
    own = _own_phrases(lexicon)
    attributes = frozenset(phrase for phrase, entry in lexicon.own.items() if entry.kind == "ATTR")
    nouns = frozenset(phrase for phrase, entry in lexicon.own.items() if entry.kind == "NOUN")
    names = list(_named(words, own))
    found = [wish for wish in _found(words, wish_kinds()) if not _is_own(wish, words, own, attributes, nouns)]
    found = [wish for wish in found if not _is_told(wish, words)]
    return _longest([w for w in found if w.kind.early or not any(a <= w.first and w.last <= b for a, b in names)])


def _is_past(word: Word) -> bool:
    """Return True for a word with the ending of a verb in the past."""
    return word.norm.endswith("ed") and word.norm != "need"


def _found(words: Sequence[Word], kinds: Sequence[WishKind]) -> Iterator[Wish]:
    for kind in kinds:
        for first, last in ranges_of(kind.pattern, words):
            while not kind.early and first < last - 1 and words[first].norm in _BEFORE:
                first += 1
            yield Wish(kind=kind, first=first, last=last)


def _longest(found: Iterator[Wish] | Sequence[Wish]) -> list[Wish]:
    """Return the wishes in the order of the words, without those whose words are part of a longer one."""
    kept: list[Wish] = []
    for wish in sorted(found, key=lambda wish: wish.first - wish.last):
        if all(wish.last <= other.first or other.last <= wish.first for other in kept):
            kept.append(wish)
    return sorted(kept, key=lambda wish: wish.first)


def _own_phrases(lexicon: Lexicon) -> frozenset[Phrase]:
    site = lexicon.site
    markers = (name for _, name in site.marker_names)
    gates, zones = (gate.place.id for gate in site.gates), (zone.name for zone in site.zones)
    names = {split(name) for name in (*gates, *zones, *markers)}
    return frozenset(phrase for phrase in {*lexicon.own, *names} if phrase)


def _named(words: Sequence[Word], own: frozenset[Phrase]) -> Iterator[tuple[int, int]]:
    """Yield the ranges of names of several words: "weather mast", which asks for no weather."""
    norms = [word.norm for word in words]
    longest = max(map(len, own), default=0)
    for first in range(len(norms)):
        for last in range(first + 2, min(first + longest, len(norms)) + 1):
            if tuple(norms[first:last]) in own:
                yield first, last


def _is_own(
    wish: Wish, words: Sequence[Word], own: frozenset[Phrase], attributes: frozenset[Phrase], nouns: frozenset[Phrase]
) -> bool:
    """Return True if the robot or the site has a word for what is wished for: its verb, or its last noun.

    An attribute of the site's plants is none for a reading of more words: "measure the soil moisture".
    """
    if wish.kind.early:
        return False
    norms = tuple(word.norm for word in words[wish.first : wish.last])
    if wish.kind.begins:  # "spray row 3", "take leaf samples"
        return any(norms[:end] in own or norms[-end:] in nouns for end in range(1, len(norms) + 1))
    named = [norms[-length:] for length in range(1, len(norms) + 1) if norms[-length:] in own]
    return any(phrase not in attributes or len(phrase) == len(norms) for phrase in named)


@cache
def wish_kinds() -> tuple[WishKind, ...]:
    """Return the kinds of wishes of ``wishes.toml``."""
    text = (files("fieldhand.planning.english") / "wishes.toml").read_text(encoding="utf-8")
    return tuple(
        WishKind(
            what=known["what"],
            advice=known["advice"],
            early=known.get("early", False),
            now=known.get("now", False),
            begins=known.get("begins", False),
            clause=known.get("clause", False),
            aside=known.get("aside", False),
            rest=known.get("rest", False),
            offers=known.get("offers", ""),
            work=known.get("work", False),
            works=known.get("works", False),
            example=known.get("example", ""),
            said=tuple(known["said"]),
        )
        for known in tomllib.loads(text)["wish"]
    )
