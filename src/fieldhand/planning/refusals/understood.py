"""The parts of a refused request that the grammar understands: clauses, places and captures of its chart."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import joined
from fieldhand.language.words import say_action
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import Trees
from fieldhand.places.wording import say_selector
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import Chart, PhraseEdge, tokens_of
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.meaning import UNKNOWN_THINGS, PlaceMeaning, Said, Thing
from fieldhand.planning.grammar.reader import planned_clauses
from fieldhand.planning.grammar.words import edges_of, fillers_of
from fieldhand.planning.planner import Planned
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import walk
from fieldhand.wording.steps import write_lines

#: Cost of a part, in words: one long part says more than several short ones.
_COST = 0.4
#: Worth of a word by the category of the part that it is in.
_WORTH = {"said": 1.0, "place": 0.8, "things": 0.8}
#: Maximum number of covers that are tried; phrases that mean nothing by themselves are left out of the next one.
_MOST_COVERS = 16
#: Places that mean nothing by themselves.
_RELATIVE = frozenset({"here", "those", "nearby", "step"})


def _worth(part: PhraseEdge) -> float:
    """Return the worth of a part of a request: its words by its category, less the cost of a part."""
    return _WORTH[part.category] * part.used.bit_count() - _COST


@dataclass(frozen=True, kw_only=True)
class ParsedRequest:
    """The words of a request with the phrases that the grammar finds anywhere in them.

    Attributes:
        request: Request as typed.
        words: Its words.
        chart: Phrases over the words.
        site, robot: Site and robot of the mission.
    """

    request: str
    words: Sequence[Word]
    chart: Chart
    site: Site
    robot: RobotProfile

    def begins(self, categories: Collection[str]) -> set[int]:
        """Return the numbers of the words with which a phrase of one of some categories begins."""
        return {edge.start for edge in self.chart.all_edges() if edge.category in categories}

    def ends(self, categories: Collection[str]) -> set[int]:
        """Return the numbers of the words with which a phrase of one of some categories ends."""
        return {edge.end - 1 for edge in self.chart.all_edges() if edge.category in categories}

    def known(self) -> set[int]:
        """Return the numbers of the words that are part of a phrase."""
        return {k for edge in self.chart.all_edges() for k in tokens_of(edge.used)}


def parse_parts(request: str, site: Site, robot: RobotProfile) -> ParsedRequest:
    """Find the phrases of a request, whether or not they make one request together."""
    words = ENGLISH.words_of(request)
    phrases = ENGLISH.phrases(robot, site)
    chart = Chart(ENGLISH.grammar(), len(words), fillers_of(words, phrases), given={"site": site, "robot": robot})
    chart.parse(edges_of(words, phrases))
    return ParsedRequest(request=request, words=words, chart=chart, site=site, robot=robot)


@dataclass(frozen=True, kw_only=True)
class UnderstoodPart:
    """A part of a request that was understood.

    Attributes:
        text: Its words as typed.
        planned: Its plan, if it is a request by itself.
        place: The place that it names otherwise.
        things: What it captures otherwise.
    """

    text: str
    planned: Planned | None = None
    place: PlaceMeaning | None = None
    things: tuple[Thing, ...] = ()


def understood_parts(parsed: ParsedRequest, besides: Collection[int]) -> list[UnderstoodPart]:
    """Return the parts of a request that are understood, in order.

    Args:
        parsed: The request.
        besides: Numbers of the words that cannot be part of them.
    """
    edges = [edge for category in _WORTH for edge in parsed.chart.of_category(category)]
    edges = [edge for edge in edges if not _meets(edge, besides)]
    for attempt in range(_MOST_COVERS):
        if attempt == _MOST_COVERS - 1:
            edges = [edge for edge in edges if edge.category != "said"]
        chosen = _cover(edges, len(parsed.words))
        parts = [_part(parsed, edge) for edge in chosen]
        wrong = {id(edge) for edge, part in zip(chosen, parts, strict=True) if part is None}
        if not wrong:
            break
        edges = [edge for edge in edges if id(edge) not in wrong]
    return [part for part in parts if part is not None]


def say_understood(parts: Sequence[UnderstoodPart], parsed: ParsedRequest) -> tuple[str, ...]:
    """Return the parts in the words of the read-back."""
    return tuple(_say(part, parsed) for part in parts)


def _say(part: UnderstoodPart, parsed: ParsedRequest) -> str:
    if part.planned is not None:
        *lines, _ = write_lines(part.planned.task, parsed.site, parsed.robot, {})
        return joined(" ", [line.text for line in lines])
    if part.place is not None:
        return say_selector(part.place.selector)
    return joined(", ", [say_action(thing.action, thing.count or 1) for thing in part.things])


def _part(parsed: ParsedRequest, edge: PhraseEdge) -> UnderstoodPart | None:
    """Return a phrase as a part; None if it means nothing by itself."""
    meaning = edge.meaning
    if isinstance(meaning, Said):
        planned = planned_clauses(edge, parsed.words, parsed.request, parsed.site, parsed.robot)
        if planned is None or _is_everywhere(planned):
            return None
        return UnderstoodPart(text=_text(parsed, edge), planned=planned)
    if isinstance(meaning, PlaceMeaning):
        known = meaning.shape not in _RELATIVE and meaning.selector != Trees()
        return UnderstoodPart(text=_text(parsed, edge), place=meaning) if known and _exists(meaning, parsed) else None
    if any(thing.action in UNKNOWN_THINGS for thing in meaning):
        return None
    return UnderstoodPart(text=_text(parsed, edge), things=meaning)


def _is_everywhere(planned: Planned) -> bool:
    """Return True if a plan visits every tree of the site: more likely, the words that say which are not understood."""
    return any(node.visits_each and node.selector == Trees() for node in walk(planned.task.composition.plan))


def _exists(place: PlaceMeaning, parsed: ParsedRequest) -> bool:
    """Return True if the site has the places."""
    try:
        return bool(resolve(place.selector, parsed.site, Context(here=parsed.site.start)))
    except (PlaceError, TaskError):
        return False


def _text(parsed: ParsedRequest, edge: PhraseEdge) -> str:
    used = tokens_of(edge.used)
    return parsed.request[parsed.words[used[0]].start : parsed.words[used[-1]].end]


def _meets(edge: PhraseEdge, words: Collection[int]) -> bool:
    return any(edge.start <= k < edge.end for k in words)


def _cover(edges: Sequence[PhraseEdge], length: int) -> list[PhraseEdge]:
    """Return the edges that do not overlap and are worth most together, in order."""
    by_end: list[list[PhraseEdge]] = [[] for _ in range(length + 1)]
    for edge in edges:
        by_end[edge.end].append(edge)
    best: list[tuple[float, float, tuple[PhraseEdge, ...]]] = [(0.0, 0.0, ())]
    for end in range(1, length + 1):
        choices = [best[end - 1]]
        for edge in by_end[end]:
            score, cost, chosen = best[edge.start]
            choices.append((score + _worth(edge), cost - edge.cost, (*chosen, edge)))
        best.append(max(choices, key=lambda choice: choice[:2]))
    return list(best[length][2])
