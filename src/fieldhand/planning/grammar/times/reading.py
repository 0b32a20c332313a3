"""Take the times out of a request: what is left is read as a request without them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from fieldhand.language import message
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.grammar.chart import Chart, PhraseEdge
from fieldhand.planning.grammar.times.constructions import GRAMMAR
from fieldhand.planning.grammar.times.lexicon import time_edges
from fieldhand.planning.grammar.times.meaning import TimePart
from fieldhand.planning.planner import Answer
from fieldhand.task.plan import Span
from fieldhand.task.timing import Timing
from fieldhand.wording.timing import say_day_time

#: Words before which a time belongs to what is told or tested, not to the mission.
_OF_SOMETHING_ELSE = frozenset(
    {"if", "when", "whenever", "unless", "once", "while", "until", "till", "since", "than", "was", "were", "been", "is"}
    | {"are", "had", "has", "have", "did", "wait", "waits", "waiting", "of", "taken", "seen", "before", "after", "not"}
)
#: Words that part a request into steps, of which a single time can begin only the first.
_PARTING = frozenset({"then", "afterwards", "afterward", "next", "later", "finally", "again"})


@dataclass(frozen=True, kw_only=True)
class RequestTimes:
    """The times of a request.

    Attributes:
        words: Words that are left.
        said: Character ranges of the times.
        part: What they say together.
        beside: Character ranges of the words directly before and behind a time.
    """

    words: tuple[Word, ...]
    said: tuple[Span, ...]
    part: TimePart
    beside: tuple[Span, ...]

    def beside_any(self, spans: Sequence[Span]) -> bool:
        """Return True if a time stands directly beside one of some ranges."""
        return any(start <= first and last <= end for start, end in spans for first, last in self.beside)

    def timing(self, zone: str) -> Timing | None:
        """Return the timing that they say; None if it is none that a Task can hold."""
        return self.part.timing(self.said, zone)


def without_times(words: Sequence[Word], earlier: frozenset[int] = frozenset()) -> RequestTimes | None:
    """Return the times of a request and the words without them; None if it says none, or several that contradict.

    Args:
        words: Words of the request.
        earlier: Numbers of the words that state a time of earlier missions.
    """
    phrases = [
        phrase
        for phrase in _phrases(words)
        if _is_of_mission(phrase, words) and earlier.isdisjoint(range(phrase.start, phrase.end))
    ]
    part: TimePart | None = TimePart()
    for phrase in phrases:
        part = None if part is None else part & phrase.meaning
    if part is None or not phrases:
        return None
    if part.every_min and not part.last_day and _says_how_often(words):
        return None  # "every ten minutes, six times" is one mission
    taken = frozenset(token for phrase in phrases for token in range(phrase.start, phrase.end))
    single = not part.repeats and len(part.weekdays) < 2
    if single and not all(_is_of_beginning(one, words, taken) for one in phrases):
        return None
    marks = {mark for phrase in phrases for mark in _marks_of(phrase, words)}
    return RequestTimes(
        words=tuple(word for token, word in enumerate(words) if token not in taken | marks),
        said=tuple((words[one.start].start, words[one.end - 1].end) for one in phrases),
        part=part,
        beside=tuple(span for phrase in phrases for span in _beside(phrase, words)),
    )


def _says_how_often(words: Sequence[Word]) -> bool:
    """Return True if words say how often something is done: "six times", "twice"."""
    texts = [word.norm for word in words]
    counts = {"twice", "thrice"} & {*texts}
    return bool(counts) or any(
        texts[k + 1] == "times" and (texts[k] in vocabulary()["numbers"] or texts[k].isdecimal())
        for k in range(len(texts) - 1)
    )


def asked_time(part: TimePart) -> tuple[str, tuple[str, ...]] | None:
    """Return the question for the time of day and its choices; None if it is said."""
    times = part.asks
    if not times:
        return None
    choices = tuple(message("at {time}", time=say_day_time(at)) for at in times)
    return message("At what time of the day?", context="question"), choices


def assumed_times(part: TimePart) -> tuple[str, ...]:
    """Return what is assumed of an hour of which nothing says whether it is in the morning or later, as sentences."""
    at = part.assumed_half
    if at is None:
        return ()
    return (message("The hour is taken as {time}.", context="assumption", time=say_day_time(at)),)


def with_answer(part: TimePart, answers: Sequence[Answer]) -> tuple[TimePart, Answer] | None:
    """Return the part with the time that an answer names, and the answer; None without an answer that names one."""
    asked = asked_time(part)
    if asked is None:
        return None
    question, choices = asked
    for answer in answers:
        if answer.question != question:
            continue
        if answer.answer in choices:
            return part.answered(part.asks[choices.index(answer.answer)]), answer
        from fieldhand.planning.english.tokens import words_of

        given = list(_phrases(words_of(answer.answer)))
        joined = replace(part, choices=(), half="") & given[0].meaning if len(given) == 1 else None
        if joined is not None and not joined.asks:
            return joined, answer
    return None


def _phrases(words: Sequence[Word]) -> Iterator[PhraseEdge]:
    """Yield the phrases that say a time, from left to right, each as long as it can be."""
    chart = Chart(GRAMMAR, len(words), frozenset(), given={})
    chart.parse(time_edges(words))
    best: dict[int, list[PhraseEdge]] = {}
    for edge in (edge for edge in chart.all_edges() if edge.category == "part"):
        known = best.get(edge.start)
        if known is None or (-edge.end, edge.cost) < (-known[0].end, known[0].cost):
            best[edge.start] = [edge]
        elif (edge.end, edge.cost) == (known[0].end, known[0].cost):
            known.append(edge)
    at = 0
    for start in sorted(best):
        if start >= at:
            yield _either(best[start])
            at = best[start][0].end


def _either(edges: Sequence[PhraseEdge]) -> PhraseEdge:
    """Return a phrase with the times of all its readings to choose from ("at 6 o'clock")."""
    times = tuple(dict.fromkeys(at for edge in edges for at in edge.meaning.at))
    if len(edges) == 1 or len({replace(edge.meaning, at=()) for edge in edges}) > 1:
        return edges[0]
    return replace(edges[0], meaning=replace(edges[0].meaning, at=(), choices=times))


def _is_of_mission(phrase: PhraseEdge, words: Sequence[Word]) -> bool:
    """Return True if a time is that of the mission, not of something that is told or tested."""
    before = words[phrase.start - 1] if phrase.start else None
    if before is None or before.kind in ("stop", "comma"):
        return True
    return before.norm not in _OF_SOMETHING_ELSE and not (before.norm.endswith("ed") and before.norm != "need")


def _is_of_beginning(phrase: PhraseEdge, words: Sequence[Word], taken: frozenset[int]) -> bool:
    """Return True if a single time can be that of the whole mission: at its first step, or a sentence of its own."""
    ends_request = all(word.kind == "stop" for word in words[phrase.end :])
    if ends_request and phrase.meaning == TimePart(done_by=phrase.meaning.done_by):
        return True
    before = [word for token, word in enumerate(words[: phrase.start]) if token not in taken]
    if words[phrase.start - 1 : phrase.start] and words[phrase.start - 1].kind == "stop":
        alone = phrase.end == len(words) or words[phrase.end].kind == "stop"
        return alone or not any(word.kind == "word" for word in before)
    sentences = [word for word in before if word.kind == "stop"]
    return not sentences and not any(word.norm in _PARTING for word in before)


def _marks_of(phrase: PhraseEdge, words: Sequence[Word]) -> Iterator[int]:
    """Yield the commas, and the end of a sentence, that only set a time apart."""
    first = phrase.start == 0 or words[phrase.start - 1].kind == "stop"
    last = phrase.end == len(words) or words[phrase.end].kind == "stop"
    joined = first and phrase.end < len(words) and words[phrase.end].norm == "and"  # "start at 6 am and ..."
    if joined or (first and phrase.end < len(words) and words[phrase.end].kind in ("comma", "stop")):
        yield phrase.end
    if not first and words[phrase.start - 1].kind == "comma" and (last or words[phrase.end].kind == "comma"):
        yield phrase.start - 1


def _beside(phrase: PhraseEdge, words: Sequence[Word]) -> tuple[Span, ...]:
    """Return the ranges of the words directly before and behind a time."""
    near = (phrase.start - 1, phrase.end)
    return tuple(
        (words[token].start, words[token].end)
        for token in near
        if 0 <= token < len(words) and words[token].kind not in ("stop", "comma")
    )
