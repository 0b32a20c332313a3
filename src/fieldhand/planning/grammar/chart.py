"""A weighted chart parser: constructions combine the meanings of neighbouring phrases.

A construction is a pattern of categories with a function that composes their meanings. The parser works bottom-up and
from left to right, keeps for each category and range of tokens the cheapest edges of different meaning, and may skip
fillers at a price. Nothing in it knows a language or a farm.
"""

from __future__ import annotations

import heapq
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, NamedTuple, TypeVar

#: Maximum number of edges with different meanings for one category and range of tokens.
_BEAM = 8
#: Price of a skipped filler. It only decides between parses that are equal otherwise.
_FILLER_COST = 0.05
#: Maximum number of successive fillers that are skipped.
_LONGEST_GAP = 8
#: Maximum number of combinations of phrases that are tried; requests of everyday length take 300 to 10,000.
MOST_COMBINATIONS = 60_000

F = TypeVar("F", bound=Callable[..., Any])


_SYMBOL = re.compile(r"(\[)?(?:(\w+)=)?(\w+)(\])?")


@dataclass(frozen=True, slots=True)
class PhraseEdge:
    """A phrase that was recognised.

    Attributes:
        category: Category of the phrase.
        start, end: Range of its tokens, the end excluded.
        meaning: Hashable meaning.
        cost: Sum of the costs of its words, constructions and skipped fillers.
        used: Bit mask of the tokens that are part of the phrase; fillers inside it that were skipped are not.
    """

    category: str
    start: int
    end: int
    meaning: Any
    cost: float
    used: int


@dataclass(frozen=True, slots=True)
class Construction:
    """A pattern without optional parts.

    Attributes:
        result: Category of the phrase.
        symbols: Categories of its parts.
        names: Name under which each part's meaning is passed to ``compose``; empty if it is not passed.
        compose: Returns the meaning of the phrase, a list of possible meanings, or None if the parts do not fit.
        takes_range: True if ``compose`` takes the tokens of the phrase as ``used``.
        given: Names of what ``compose`` takes beside its parts, from what the chart was given.
        cost: Cost of the construction.
    """

    result: str
    symbols: tuple[str, ...]
    names: tuple[str, ...]
    compose: Callable[..., Any]
    takes_range: bool
    given: tuple[str, ...]
    cost: float


class Grammar:
    """A set of constructions, which register by decorators (:meth:`construction`)."""

    def __init__(self) -> None:
        self.by_first: dict[str, list[Construction]] = defaultdict(list)
        self._begins: tuple[int, Mapping[str, frozenset[str]]] = (0, {})

    def construction(self, *patterns: str, cost: float = 1.0, given: tuple[str, ...] = ()) -> Callable[[F], F]:
        """Register a function that composes the meanings of the parts of each pattern.

        A pattern reads ``result: part name=part [optional] [name=optional]``. Named parts are passed by name.

        Args:
            patterns: Patterns that the function composes.
            cost: Cost of the construction.
            given: Names of what the function takes from what the chart is given, beside the parts.
        """

        def register(compose: F) -> F:
            takes_range = "used" in _parameter_names(compose)
            for pattern in patterns:
                result, _, right = pattern.partition(":")
                parts = [found.groups() for found in _SYMBOL.finditer(right)]
                for present in product(*([(True, False) if bracket else (True,) for bracket, *_ in parts])):
                    kept = [part for part, there in zip(parts, present, strict=True) if there]
                    if not kept:
                        continue
                    made = Construction(
                        result=result.strip(),
                        symbols=tuple(category for _, _, category, _ in kept),
                        names=tuple(name or "" for _, name, _, _ in kept),
                        compose=compose,
                        takes_range=takes_range,
                        given=given,
                        cost=cost,
                    )
                    self.by_first[made.symbols[0]].append(made)
            return compose

        return register

    def include(self, other: Grammar, without: Iterable[Callable[..., Any]] = ()) -> None:
        """Add the constructions of another grammar, except those with one of some functions."""
        left_out = tuple(without)
        for first, constructions in other.by_first.items():
            self.by_first[first].extend(one for one in constructions if one.compose not in left_out)

    def beginnings(self) -> Mapping[str, frozenset[str]]:
        """Return the categories with which a phrase of each category can begin, its own among them."""
        count = sum(map(len, self.by_first.values()))
        if self._begins[0] == count:
            return self._begins[1]
        begins: dict[str, set[str]] = defaultdict(set)
        for first, constructions in self.by_first.items():
            for one in constructions:
                begins[one.result].add(first)
                for symbol in one.symbols:
                    begins[symbol].add(symbol)
        grown = True
        while grown:
            grown = False
            for found in begins.values():
                more = set[str]().union(*(begins[category] for category in found))
                grown = grown or not more <= found
                found |= more
        self._begins = (count, {category: frozenset(found) for category, found in begins.items()})
        return self._begins[1]


class _Partial(NamedTuple):
    """A construction of which the first parts were recognised."""

    construction: Construction
    start: int
    meanings: tuple[Any, ...]
    cost: float
    used: int


@dataclass
class Chart:
    """The edges over a sequence of tokens.

    Args:
        grammar: Constructions.
        length: Number of tokens.
        fillers: Tokens that may be skipped.
        most: Maximum number of combinations of phrases that are tried; a text that takes more has no reading, since
            their number grows with the third power of its length.
        predicted: Categories whose phrases are only made at the beginning, and where another phrase awaits them.
        given: What constructions may take beside their parts, by name.

    Attributes:
        combinations: Number of combinations that were tried.
    """

    grammar: Grammar
    length: int
    fillers: frozenset[int]
    most: int = MOST_COMBINATIONS
    predicted: frozenset[str] = frozenset()
    given: Mapping[str, Any] = field(default_factory=dict)
    combinations: int = 0
    _best: dict[tuple[str, int, int], dict[Any, PhraseEdge]] = field(default_factory=dict)
    _partial: list[dict[str, list[_Partial]]] = field(default_factory=list)
    _agenda: list[tuple[float, int, PhraseEdge]] = field(default_factory=list)
    _added: int = 0
    _begins: Mapping[str, frozenset[str]] = field(default_factory=dict)
    _words_from: list[set[str]] = field(default_factory=list)

    def parse(self, words: Iterable[PhraseEdge]) -> None:
        """Fill the chart from the edges of words and fixed phrases."""
        by_end: Mapping[int, list[PhraseEdge]] = defaultdict(list)
        for word in words:
            by_end[word.end].append(word)
        self._partial = [defaultdict(list) for _ in range(self.length + 1)]
        self._begins = self.grammar.beginnings()
        self._words_from = self._words_at(by_end)
        for end in range(1, self.length + 1):
            for word in by_end[end]:
                self._add(word)
            while self._agenda and self.combinations <= self.most:
                self._use(heapq.heappop(self._agenda)[2])

    def _words_at(self, by_end: Mapping[int, list[PhraseEdge]]) -> list[set[str]]:
        """Return the categories of the words from each position on, with those behind fillers there."""
        found: list[set[str]] = [set() for _ in range(self.length + 1)]
        for words in by_end.values():
            for word in words:
                found[word.start].add(word.category)
        for position in range(self.length - 1, -1, -1):
            if position in self.fillers:
                found[position] |= found[position + 1]
        return found

    def edges(self, category: str, start: int, end: int) -> list[PhraseEdge]:
        """Return the edges of a category over exactly these tokens, cheapest first."""
        found = self._best.get((category, start, end), {})
        return sorted(found.values(), key=lambda edge: edge.cost)

    def all_edges(self) -> Iterator[PhraseEdge]:
        """Yield the edges of words and phrases."""
        for found in self._best.values():
            yield from found.values()

    def of_category(self, category: str) -> list[PhraseEdge]:
        """Return the cheapest edge of a category over each range of tokens."""
        return [
            min(found.values(), key=lambda edge: edge.cost)
            for (known, *_), found in self._best.items()
            if known == category
        ]

    def whole(self, category: str) -> list[PhraseEdge]:
        """Return the edges of a category over all tokens but fillers at either end, cheapest first."""
        found: list[PhraseEdge] = []
        if self.combinations > self.most:
            return found
        for start in self._before(0):
            for end in self._after(self.length):
                found += self.edges(category, start, end)
        return sorted(found, key=lambda edge: edge.cost)

    def furthest(self, category: str) -> int:
        """Return the end of the longest edge of a category from the first token on, fillers before it skipped."""
        starts = set(self._before(0))
        return max((end for name, start, end in self._best if name == category and start in starts), default=0)

    def _before(self, start: int) -> Iterator[int]:
        """Yield the positions that are reached from ``start`` by skipping fillers."""
        yield start
        while start in self.fillers:
            start += 1
            yield start

    def _after(self, end: int) -> Iterator[int]:
        yield end
        while end - 1 in self.fillers:
            end -= 1
            yield end

    def _add(self, edge: PhraseEdge) -> None:
        known = self._best.setdefault((edge.category, edge.start, edge.end), {})
        same = known.get(edge.meaning)
        if same is not None and same.cost <= edge.cost:
            return
        if same is None and len(known) >= _BEAM and edge.cost >= max(other.cost for other in known.values()):
            return
        known[edge.meaning] = edge
        self._added += 1
        heapq.heappush(self._agenda, (edge.cost, self._added, edge))

    def _use(self, edge: PhraseEdge) -> None:
        """Begin constructions with an edge, and continue those that wait for it."""
        for construction in self.grammar.by_first.get(edge.category, ()):
            if construction.result in self.predicted and not self._awaits(construction.result, edge):
                continue
            if len(construction.symbols) == 1 or self._may_begin(construction.symbols[1], edge.end):
                self._advance(_Partial(construction, edge.start, (), construction.cost, 0), edge, 0.0)
        position, skipped = edge.start, 0.0
        for _ in range(_LONGEST_GAP):
            for partial in self._partial[position].get(edge.category, ()):
                self._advance(partial, edge, skipped)
            if position - 1 not in self.fillers:
                break
            position, skipped = position - 1, skipped + _FILLER_COST

    def _may_begin(self, category: str, position: int) -> bool:
        """Return True if a phrase of a category may begin at a position, by the words there."""
        return not self._begins[category].isdisjoint(self._words_from[position])

    def _awaits(self, category: str, edge: PhraseEdge) -> bool:
        """Return True if a phrase of a category is expected where an edge starts: at the beginning, or by another."""
        if edge.category == category:
            return True
        position = edge.start
        while position > 0 and category not in self._partial[position]:
            if position - 1 not in self.fillers:
                return False
            position -= 1
        return True

    def _advance(self, partial: _Partial, edge: PhraseEdge, skipped: float) -> None:
        self.combinations += 1
        construction = partial.construction
        meanings = (*partial.meanings, edge.meaning)
        cost = partial.cost + edge.cost + skipped
        used = partial.used | edge.used
        if len(meanings) < len(construction.symbols):
            awaited = construction.symbols[len(meanings)]
            if self._may_begin(awaited, edge.end):
                waiting = _Partial(construction, partial.start, meanings, cost, used)
                self._partial[edge.end][awaited].append(waiting)
            return
        named = {name: meaning for name, meaning in zip(construction.names, meanings, strict=True) if name}
        if construction.takes_range:
            named["used"] = used
        named |= {name: self.given[name] for name in construction.given}
        composed = construction.compose(**named)
        for meaning in composed if isinstance(composed, list) else () if composed is None else (composed,):
            located = getattr(meaning, "with_tokens", None)  # a meaning that knows the tokens of its phrase
            said = meaning if located is None else located(used)
            self._add(PhraseEdge(construction.result, partial.start, edge.end, said, cost, used))


def _parameter_names(function: Any) -> tuple[str, ...]:
    """Return the names of a function's parameters, in a tenth of the time that :mod:`inspect` takes."""
    code = function.__code__
    names: tuple[str, ...] = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    return names


def tokens_of(used: int) -> Sequence[int]:
    """Return the numbers of the tokens in a bit mask."""
    return [k for k in range(used.bit_length()) if used >> k & 1]
