"""Facts stated explicitly in a request, recognized by words, numbers and names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from fieldhand.request_check import words as w
from fieldhand.request_check.amounts import Noun, StatedAmount, amounts, numbers_of
from fieldhand.request_check.words import Token, tokens
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.site.model import Site
from fieldhand.terms import Side

#: Maximum number of distinct values of an attribute that describes kinds of trees rather than naming each.
_MOST_KINDS = 200
_GOES_BACK = (
    r"(?:return|returns|come back|comes back|go back|get back|drive back|head back|travel back|end up|finish up)"
)
_START = r"(?:start|starting point|starting position|starting place|start marker|start point|beginning|home base|home)"
_END = r"(?:end|end point|end marker|finish marker|end position)"
_TO = r"(?: again)? (?:to|at) (?:the |its |your )?"


@dataclass(frozen=True, kw_only=True)
class RequestFacts:
    """The facts of a request for this robot and site.

    Attributes:
        request: The request.
        tokens: Tokens of the request: words, numbers and signs.
        nouns: Nouns of the robot's vocabulary by the index of their first token.
        amounts: Numbers with their quantities.
        zones: Mentioned zones and blocks of the site.
        attributes: Mentioned attribute values of the site's trees, each with the index of its token.
        levels: Level words such as "low" in conditions.
        known: Words known to this check.
        named: Indices of the tokens that belong to names and to words of this site and robot.
    """

    request: str
    tokens: tuple[Token, ...]
    nouns: dict[int, Noun]
    amounts: tuple[StatedAmount, ...]
    zones: frozenset[str]
    attributes: dict[str, int]
    levels: frozenset[str]
    known: frozenset[str]
    named: frozenset[int]

    @cached_property
    def text(self) -> str:
        """Return the words separated by single spaces."""
        return " ".join(token.text for token in self.tokens)

    @cached_property
    def words(self) -> frozenset[str]:
        """Return the set of words."""
        return frozenset(token.text for token in self.tokens)

    @cached_property
    def unknown(self) -> bool:
        """Return True if a word is unknown to this check, so that additions of the plan may come from it."""
        return any(t.text[0].isalpha() and t.text not in self.known for t in self.tokens)

    @cached_property
    def vague(self) -> bool:
        """Return True if a word such as "several" leaves a number open."""
        return bool(w.VAGUE.search(self.text))

    @cached_property
    def whole_numbers(self) -> frozenset[int]:
        """Return every whole number of the request, with ordinals, "twice" and all of a range."""
        found = {n for a in self.amounts for n in numbers_of(a)}
        return frozenset(found | {n for word, n in w.MULTIPLES.items() if word in self.words})

    @cached_property
    def sides(self) -> frozenset[Side]:
        """Return the sides of the compass that are mentioned."""
        return frozenset(side for word in self._compass_words for side in w.COMPASS[word])

    @cached_property
    def _compass_words(self) -> tuple[str, ...]:
        pairs = [f"{a.text}{b.text}" for a, b in zip(self.tokens, self.tokens[1:], strict=False)]
        split = [f"{a.text}{c.text}" for a, b, c in _windows(self.tokens) if b.text in ("-", "\u2013")]
        return tuple(x for x in (*(t.text for t in self.tokens if len(t.text) > 1), *pairs, *split) if x in w.COMPASS)

    def conditional(self, sentence: int) -> bool:
        """Return True if a sentence contains a condition; an indirect question ("check whether") does not count."""
        inside = [t.text for t in self.tokens if t.sentence == sentence]
        asked = re.search(r"\b(?:check|see|find out|tell me|know|report|look) (?:if|whether)\b|\bwhether\b", self.text)
        if asked and sum(t.text in w.CONDITIONAL for t in self.tokens) <= 1:
            return False
        return bool(w.CONDITIONAL.intersection(inside))

    def negated(self, index: int) -> bool:
        """Return True if the phrase at a token is negated."""
        before = [t for t in self.tokens[max(0, index - 8) : index] if t.sentence == self.tokens[index].sentence]
        return any(t.text in w.NEGATIONS for t in before)

    @cached_property
    def returns(self) -> str:
        """Return the marker to which the request returns at the end: ``start``, ``end``, or empty."""
        text = self.text
        home = re.search(
            rf"\b{_GOES_BACK}(?: \w+)?{_TO}{_START}\b(?! of| tree)|\b(?:go|come|return|drive|head) home\b", text
        )
        back = re.search(r"\bcome back (?:when|once|after)\b|\bcome back when\b|\breturn (?:when|once) done\b", text)
        to_end = re.search(rf"\b{_GOES_BACK}{_TO}{_END}\b(?! of| tree)", text)
        if bool(home or back) == bool(to_end):
            return ""
        return "end" if to_end else "start"

    @cached_property
    def spaced(self) -> bool:
        """Return True if the request asks for places a distance apart."""
        apart = re.search(r"\bapart\b|\b(?:from|between) (?:each|one|them|the next)\b", self.text)
        return bool(apart) and any(a.kind == "length" for a in self.amounts)

    @cached_property
    def as_many(self) -> bool:
        """Return True if the request asks for as many as possible."""
        return bool(re.search(r"\bas many (?:[\w%]+ ){0,6}?as (?:possible|(?:you|it|we|the robot) can)\b", self.text))


def request_facts(request: str, robot: RobotProfile, site: Site) -> RequestFacts:
    """Return the facts of a request."""
    tokens = w.tokens_of_request(request)
    names = _names(site)
    zones, covered = _named_zones(tokens, names, _other_names(site))
    attributes = {
        word: k
        for word, k in _phrases(tokens, _kinds(site))
        if not covered.intersection(range(k, k + len(word.split())))
    }
    taken = covered | {k + j for word, k in attributes.items() for j in range(len(word.split()))}
    nouns = {k: n for k, n in _nouns(tokens, robot, site).items() if k not in taken}
    units = frozenset(q.unit.lower() for q in robot.quantities)
    ids = _ids_with_dashes(tokens, site)
    found = tuple(
        replace(one, kind="name", compared="") if one.kind == "plain" and one.index in ids else one
        for one in amounts(tokens, nouns, units)
    )
    levels = {word for q in robot.quantities for word in q.levels}
    facts = RequestFacts(
        request=request,
        tokens=tokens,
        nouns=nouns,
        amounts=found,
        zones=frozenset(zones),
        attributes=attributes,
        levels=frozenset(),
        known=_known(robot, site, names),
        named=frozenset(taken | {k + j for k, noun in nouns.items() for j in range(noun.length)}),
    )
    spoken = {
        word for word, k in _phrases(tokens, levels) if facts.conditional(tokens[k].sentence) and not facts.negated(k)
    }
    return replace(facts, levels=frozenset(spoken))


def _windows(tokens: Sequence[Token]) -> Iterator[tuple[Token, Token, Token]]:
    return zip(tokens, tokens[1:], tokens[2:], strict=False)


def _norm(name: str) -> str:
    return " ".join(t.text for t in tokens(name.replace("_", " ")))


def _names(site: Site) -> set[str]:
    """Return the names of zones, blocks and rows as words."""
    blocks = [b.name for b in site.planting.blocks]
    rows = [r.name for b in site.planting.blocks for r in b.rows]
    named = {_norm(name) for name in (*(z.name for z in site.zones if z.name), *blocks, *rows)}
    return {name for name in named if not name.isdecimal() and len(name) > 1}


def _ids_with_dashes(tokens: Sequence[Token], site: Site) -> set[int]:
    """Return the tokens of ids such as "4-12", whose numbers count and compare nothing."""
    ids = {_norm(tree.place.id) for tree in site.trees if "-" in tree.place.id}
    return {k + j for name, k in _phrases(tokens, ids) for j in range(len(name.split()))}


def _kinds(site: Site) -> set[str]:
    """Return the attribute values of the site's trees ("yellow", "Carmel"), without names of trees."""
    words = {
        _norm(value)
        for values in site.attributes.values()
        if len(values) <= min(_MOST_KINDS, max(2, len(site.trees) // 2))
        for value in values
        if isinstance(value, str)
    }
    kinds = {word for word in words if len(word) > 2 and not any(c.isdecimal() for c in word)}
    return {word for word in kinds if not set(word.split()) <= w.PLAIN}


def _other_names(site: Site) -> set[str]:
    """Return the names of markers and gates of several words, in which the name of a zone may stand ("shed door")."""
    named = (*(name for _, name in site.marker_names), *(gate.place.id for gate in site.gates))
    return {name for name in map(_norm, named) if " " in name}


def _named_zones(tokens: Sequence[Token], names: set[str], others: set[str]) -> tuple[set[str], set[int]]:
    """Return the names in the request and their tokens; names of plain words only ("row", "end") do not count.

    Other names in which they stand do not count either.
    """
    found: set[str] = set()
    covered: set[int] = set()
    for name, k in _phrases(tokens, names | others):
        if name not in names:
            covered.update(range(k, k + len(name.split())))
            continue
        covered.update(range(k, k + len(name.split())))
        if len(name) > 3 and (len(name.split()) > 1 or name not in w.PLAIN):
            found.add(name)
    return found, covered


def _phrases(tokens: Sequence[Token], phrases: set[str]) -> Iterator[tuple[str, int]]:
    """Yield every phrase of a set that occurs, with its first token; the longest at each token."""
    longest = min(max((len(p.split()) for p in phrases), default=0), 8)
    for k in range(len(tokens)):
        for length in range(min(longest, len(tokens) - k), 0, -1):
            phrase = " ".join(t.text for t in tokens[k : k + length])
            if phrase in phrases:
                yield phrase, k
                break


def _nouns(tokens: Sequence[Token], robot: RobotProfile, site: Site) -> dict[int, Noun]:
    """Return the robot's nouns by token, the longest phrase at each."""
    actions = {_singular(word): word for a in robot.actions for word in (*a.words, *a.verbs)}
    of_attributes = {word for name in site.attributes for word in _norm(name).split()}
    found: dict[int, Noun] = {}
    k = 0
    while k < len(tokens):
        for length in range(min(5, len(tokens) - k), 0, -1):
            phrase = _stem(" ".join(t.text for t in tokens[k : k + length]))
            if phrase in actions and phrase not in of_attributes:
                found[k] = Noun(length=length, actions=_meant(actions[phrase], robot))
                k += length - 1
                break
        k += 1
    return found


def _singular(phrase: str) -> str:
    head, space, last = _norm(phrase).rpartition(" ")
    return f"{head}{space}{w.singular(last)}"


def _stem(phrase: str) -> str:
    """Return a phrase in the form of the profile: singular, and verbs without ending ("photographing")."""
    head, space, last = phrase.rpartition(" ")
    for ending in ("ing", "ed"):
        if not head and last.endswith(ending) and len(last) > len(ending) + 4:
            last = last.removesuffix(ending)
    return f"{head}{space}{w.singular(last)}"


def _meant(word: str, robot: RobotProfile) -> frozenset[str]:
    """Return the actions that a word may mean, by their own words or those of their quantities."""
    quantities = {q.name for q in robot.quantities if word in q.words}
    return frozenset(
        a.name for a in robot.actions if word in (*a.words, *a.verbs) or quantities.intersection(a.measures)
    )


def hints(action: Action, robot: RobotProfile) -> frozenset[str]:
    """Return every word that may refer to an action: from its names, verbs, description and quantities."""
    quantities = [robot.quantity[name] for name in action.measures if name in robot.quantity]
    phrases = [action.name, action.description, *action.words, *action.verbs, *(q.name for q in quantities)]
    phrases += [word for q in quantities for word in q.words]
    words = {w.singular(word) for phrase in phrases for word in _norm(phrase).split()}
    return frozenset(words - w.PLAIN)


def _known(robot: RobotProfile, site: Site, names: set[str]) -> frozenset[str]:
    """Return every word known to this check."""
    phrases = [word for a in robot.actions for word in (a.name, *a.words, *a.verbs)]
    phrases += [word for q in robot.quantities for word in (q.name, *q.words, *q.levels)]
    phrases += [*names, *_kinds(site), *site.attributes]
    own = {form for phrase in phrases for word in _norm(phrase).split() for form in (word, f"{word}s", f"{word}es")}
    own |= {f"{verb}ing" for a in robot.actions for verb in a.verbs} | {
        f"{v}ed" for a in robot.actions for v in a.verbs
    }
    tables = (w.NUMBERS, w.ORDINALS, w.MULTIPLES, w.LENGTHS, w.TIMES, w.COMPASS)
    shared = {word for table in tables for word in table}
    return frozenset(
        own | shared | w.PLAIN | w.AGES | w.DEGREES | w.CONDITIONAL | w.BELOW | w.ABOVE | w.NEGATIONS | w.TREES
        | {"hundred", "thousand", "st", "nd", "rd", "th"} | {q.unit.lower() for q in robot.quantities}
    )  # fmt: skip
