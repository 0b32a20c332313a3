"""Take the times out of a request: what is left is read as a request without them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

from fieldhand.language import message
from fieldhand.language.words import listed
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.planning.grammar.chart import Chart, PhraseEdge
from fieldhand.planning.grammar.times.constructions import GRAMMAR
from fieldhand.planning.grammar.times.lexicon import time_edges
from fieldhand.planning.grammar.times.meaning import TimePart
from fieldhand.planning.grammar.times.waiting import AwaitedTime, awaited, between_runs, waits_between
from fieldhand.planning.grammar.times.windows import without_a_time
from fieldhand.planning.planner import Answer
from fieldhand.task.plan import Span
from fieldhand.task.timing import Timing
from fieldhand.wording.timing import say_day_time

#: Words before which a time belongs to what is told or tested, not to the mission.
_OF_SOMETHING_ELSE = frozenset(
    {"if", "when", "whenever", "unless", "once", "while", "until", "till", "since", "than", "was", "were", "been", "is"}
    | {"are", "had", "has", "have", "did", "wait", "waits", "waiting", "of", "taken", "seen", "before", "after", "not"}
    | {"from", "by", "done", "made", "shot", "found", "left", "mown", "cut", "driven", "gone", "went", "already"}
)
#: Words that part a request into steps, of which a single time can begin only the first.
_PARTING = frozenset(
    {"then", "afterwards", "afterward", "next", "later", "finally", "again", "now", "immediately", "meanwhile"}
)

#: Words that end as verbs in the past do.
_NOUNS_IN_ED = frozenset({"need", "bed", "seedbed", "shed", "seed", "weed", "reed", "feed", "red"})
#: Words beside a time that belong to no clause that tells something.
_JOINING = frozenset({"please", "and", "but", "then"})
_DAY_MIN = 24 * 60

#: Participles that do not end as other verbs do.
_PARTICIPLES = frozenset({"taken", "seen", "done", "made", "shot", "found", "mown", "cut", "driven", "read"})
#: Words of clauses that want something done, and of those that tell of something that was done.
_WANTING = frozenset({"want", "wants", "need", "needs", "like", "should", "must", "get", "gets", "let"})
_TELLING = frozenset({"was", "were", "been", "had", "has", "have", "which", "that", "who", "we", "they", "not"})

#: Words behind which a part of this day may be past.
_PAST = frozenset({"was", "were", "had", "did", "got", "been", "has", "have", "already"})


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
    times = frozenset(token for phrase in phrases for token in range(phrase.start, phrase.end))
    if any(waits_between(phrase, words, times) for phrase in phrases):
        return None
    waits = {phrase.start: wait for phrase in phrases if (wait := awaited(phrase, words, times)) is not None}
    phrases = [replace(one, meaning=waits[one.start].part) if one.start in waits else one for one in phrases]
    part: TimePart | None = TimePart()
    for phrase in phrases:
        if phrase.meaning.further and not _ends_clause(phrase, words):
            return None  # "at 7 am read CO2, and again at 2 pm photograph row 3"
        part = None if part is None else part & phrase.meaning
    if part is None or not phrases or (part.awaits and part.repeats):
        return None
    if part.every_min and not part.last_day and (_says_how_often(words) or _says_how_long(words, part.every_min)):
        return None  # "every ten minutes, six times" and "every ten minutes for an hour" are one mission
    if sum(phrase.meaning.says_how_often for phrase in phrases) > 1:
        return None  # "photograph row 3 every day, and row 4 every Monday"
    between = between_runs(words, times) if part.every_min else None
    moved = (*waits.values(), *(() if between is None else (between,)))
    taken = times | {token for wait in moved for token in wait.dropped}
    instead = {token: word for wait in moved for token, word in wait.instead.items()}
    single = not part.repeats and len(part.weekdays) < 2
    if single and not all(_is_of_beginning(one, words, taken) for one in phrases):
        return None
    marks = {mark for phrase in phrases for mark in _marks_of(phrase, words)}
    return RequestTimes(
        words=tuple(instead.get(token, word) for token, word in enumerate(words) if token not in taken | marks),
        said=(
            *((words[_first(one, waits)].start, words[one.end - 1].end) for one in phrases),
            *(() if between is None else ((words[k].start, words[k].end) for k in sorted(between.dropped))),
        ),
        part=part,
        beside=tuple(span for phrase in phrases for span in _beside(phrase, words)),
    )


def _first(phrase: PhraseEdge, waits: Mapping[int, AwaitedTime]) -> int:
    """Return the number of the first word that says a time, or a wait for it."""
    return waits[phrase.start].first if phrase.start in waits else phrase.start


def _says_how_often(words: Sequence[Word]) -> bool:
    """Return True if words say how often something is done: "six times", "twice"."""
    texts = [word.norm for word in words]
    counts = {"twice", "thrice"} & {*texts}
    return bool(counts) or any(
        texts[k + 1] == "times" and (texts[k] in vocabulary()["numbers"] or texts[k].isdecimal())
        for k in range(len(texts) - 1)
    )


def _says_how_long(words: Sequence[Word], every_min: int) -> bool:
    """Return True if words say a time of several intervals for which something is done: "for an hour"."""
    chart = Chart(GRAMMAR, len(words), frozenset(), given={})
    chart.parse(time_edges(words))
    return any(every_min <= edge.meaning < _DAY_MIN for edge in chart.of_category("lasting"))


@dataclass(frozen=True, kw_only=True)
class TimeQuestion:
    """A question about the times of a request.

    Attributes:
        question: The question.
        choices: Answers to choose from, with the times that they lead to.
    """

    question: str
    choices: tuple[tuple[str, TimePart], ...]


def asked_time(part: TimePart) -> TimeQuestion | None:
    """Return the question for the time of day, or for the days of several times; None if they are said."""
    if part.vague and not part.every_min:
        often = [
            (message("every 30 minutes", context="answer"), replace(part, every_min=30, vague=False)),
            (message("every hour", context="answer"), replace(part, every_min=60, vague=False)),
            (message("every 2 hours", context="answer"), replace(part, every_min=120, vague=False)),
        ]
        return TimeQuestion(question=message("How often?", context="question"), choices=tuple(often))
    if part.disputed and part.window is not None:
        at = listed([say_day_time(one) for one in part.at])
        choices = [
            (message("at {time}", time=at), replace(part, disputed=False, window=None, half="")),
            (part.window.choice, replace(part, disputed=False, at=(), late_min=0)),
        ]
        return TimeQuestion(question=message("At what time of the day?", context="question"), choices=tuple(choices))
    if len(part.at) > 1 and not (part.repeats or part.weekdays or part.day):
        days = [
            (message("every day", context="answer"), replace(part, repeats=True, every_days=1)),
            (message("today", context="answer"), replace(part, day="today")),
            (message("tomorrow", context="answer"), replace(part, day="tomorrow")),
        ]
        return TimeQuestion(question=message("On which days?", context="question"), choices=tuple(days))
    times = [(message("at {time}", time=say_day_time(at)), part.answered(at)) for at in part.asks]
    if not times:
        return None
    return TimeQuestion(question=message("At what time of the day?", context="question"), choices=tuple(times))


def assumed_times(part: TimePart) -> tuple[str, ...]:
    """Return what is assumed of an hour or a day that leaves its time open, as sentences."""
    if (at := part.assumed_half) is not None:
        return (message("The hour is taken as {time}.", context="assumption", time=say_day_time(at)),)
    if (window := part.takes) is not None:
        return (window.assumption if part.window is not None else without_a_time(),)
    return ()


def warned_times(part: TimePart) -> tuple[str, ...]:
    """Return what must be confirmed of a time for which the request says that the robot waits, as sentences."""
    if not part.awaits or part.not_before is None:
        return ()
    at = say_day_time(part.not_before)
    return (
        message(
            "The robot does not drive first and then wait for a time of the clock: the mission begins at {time}, with"
            " the drive there.",
            context="assumption",
            time=at,
        ),
    )


def with_answers(part: TimePart, answers: Sequence[Answer]) -> tuple[TimePart, tuple[Answer, ...]]:
    """Return the part with the times that answers name, and these answers: one may lead to the next question."""
    given: tuple[Answer, ...] = ()
    while len(given) < len(answers) and (found := with_answer(part, answers)) is not None:
        part, given = found[0], (*given, found[1])
    return part, given


def with_answer(part: TimePart, answers: Sequence[Answer]) -> tuple[TimePart, Answer] | None:
    """Return the part with the time that an answer names, and the answer; None without an answer that names one."""
    asked = asked_time(part)
    if asked is None:
        return None
    for answer in answers:
        if answer.question != asked.question:
            continue
        if (chosen := dict(asked.choices).get(answer.answer)) is not None:
            return chosen, answer
        from fieldhand.planning.english.tokens import words_of

        given = list(_phrases(words_of(answer.answer)))
        open_part = replace(
            part, disputed=False, vague=False, choices=(), window=None, half="", at=() if part.disputed else part.at
        )
        joined = open_part & given[0].meaning if len(given) == 1 else None
        following = None if joined is None else asked_time(joined)
        if joined is not None and (following is None or following.question != asked.question):
            return joined, answer
    return None


def _phrases(words: Sequence[Word]) -> Iterator[PhraseEdge]:
    """Yield the phrases that say a time, from left to right, each as long as it can be."""
    chart = Chart(GRAMMAR, len(words), frozenset(), given={})
    chart.parse(time_edges(words))
    best: dict[int, list[PhraseEdge]] = {}
    for edge in (edge for edge in chart.all_edges() if edge.category == "part" and not _is_number_of(edge, words)):
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


def _is_number_of(edge: PhraseEdge, words: Sequence[Word]) -> bool:
    """Return True if a phrase begins with the number of a plant: "tree 4 in the morning", "rows 3 and 4 at noon"."""
    if edge.start == 0 or not _is_number(words[edge.start]):
        return False
    before = words[edge.start - 1]
    if before.kind == "comma" or before.norm in ("and", "or", "to", "-", "&"):
        return edge.start > 1 and _is_number(words[edge.start - 2])
    return before.norm in _numbered_nouns()


def _is_number(word: Word) -> bool:
    return word.kind == "number" or word.norm in vocabulary()["numbers"]


@cache
def _numbered_nouns() -> frozenset[str]:
    """Return the words for what has numbers, in both numbers."""
    from fieldhand.planning.english.inflection import plural_of

    nouns = [noun for kind in ("TREE", "PLOT", "ROW", "AISLE") for noun in vocabulary()["nouns"][kind]]
    return frozenset(form.split()[-1] for noun in (*nouns, "bed", "number", "zone") for form in (noun, plural_of(noun)))


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
    past = before.norm in _PARTICIPLES or (before.norm.endswith("ed") and before.norm not in _NOUNS_IN_ED)
    if past:
        return _is_wanted(words[: phrase.start - 1])
    return before.norm not in _OF_SOMETHING_ELSE


def _is_wanted(before: Sequence[Word]) -> bool:
    """Return True if a participle behind some words of a clause is one of what is to be done: "has to be mown"."""
    clause = [word.norm for word in before]
    for k in range(len(before) - 1, -1, -1):
        if before[k].kind in ("comma", "stop"):
            clause = clause[k + 1 :]
            break
    if clause[-2:] == ["to", "be"]:
        return {"had", "was", "were"}.isdisjoint(clause)  # "has to be mown"
    wanted = not _WANTING.isdisjoint(clause) or clause[-1:] == ["be"]
    return wanted and _TELLING.isdisjoint(clause)


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
    past = any(
        word.norm in _PAST and (at + 1 == len(before) or before[at + 1].norm != "to") for at, word in enumerate(before)
    )  # but for "has to be mown"
    if phrase.meaning.day == "today" and phrase.meaning.takes is not None and past:
        return False  # "the trees that were dry this morning"
    return not sentences and not any(_parts(before, k) for k in range(len(before)))


def _ends_clause(phrase: PhraseEdge, words: Sequence[Word]) -> bool:
    """Return True if no command follows a time in its sentence."""
    return phrase.end == len(words) or words[phrase.end].kind == "stop"


def _parts(words: Sequence[Word], k: int) -> bool:
    """Return True if a word parts a request into steps: "then", "after that", and "first" of a step."""
    behind = words[k + 1].norm if k + 1 < len(words) else ""
    if words[k].norm == "first":
        return behind in ("and", ",", "")
    return words[k].norm in _PARTING or (words[k].norm == "after" and behind in ("that", "this", "it", "which"))


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
    """Return the ranges of the words directly before and behind a time that belong to the same clause."""
    near = (phrase.start - 1, phrase.end)
    return tuple(
        (words[token].start, words[token].end)
        for token in near
        if 0 <= token < len(words) and words[token].kind not in ("stop", "comma") and words[token].norm not in _JOINING
    )
