"""The reasons for which the grammar does not plan a request."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from fieldhand.language import message, named
from fieldhand.language.words import listed, say_action, say_unit, some_names
from fieldhand.places.place_errors import no_such_tree
from fieldhand.planning.english.lacking import lacked_actions, measured_units
from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.plant_words import absent_plant, kinds_of_plants
from fieldhand.planning.english.tokens import Word, words_of
from fieldhand.planning.grammar.chart import Chart, PhraseEdge, tokens_of
from fieldhand.planning.grammar.dialogue import NotComposed
from fieldhand.planning.grammar.english import more_words
from fieldhand.planning.grammar.impossible import IMPOSSIBLE
from fieldhand.planning.grammar.words import LACKING
from fieldhand.planning.planner import Planned, Reason
from fieldhand.request_check import mismatches
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import Span

#: Advice where nothing better is known.
PLAINLY = message("say it in other words")
#: Categories of phrases of which a phrase that cannot be planned may be a part.
_COMPLETE = frozenset({"place", "rows", "region", "said"})
#: Categories of the words for what is done.
_COMMANDS = frozenset({"TAKE", "MEASURE", "ACTV", "NOUN", "GO", "VISIT", "RETURN", "GOHOME", "REPEAT", "STOP"})
#: Kind of the words that are known, and that no plan can express yet.
_NOT_YET = "NOTYET"
#: Category of "instead of", which is read before a marker only.
_OF_MARKERS = "RATHERTHAN"
#: Maximum number of words of a reason that are quoted, and of characters of a sentence.
_MOST_WORDS, _MOST_CHARACTERS = 4, 120
#: Units in which limits of a mission are said as well.
_UNITS_OF_LIMITS = frozenset({"percent", "m", "s", "J"})
_SAY_WHAT = message("say what to take or measure, and at which trees")
_SHORTER = message("say it in shorter sentences, one thing after the other")


def unread_reasons(
    request: str,
    words: Sequence[Word],
    edges: Sequence[PhraseEdge],
    chart: Chart,
    faults: Sequence[NotComposed],
    site: Site,
    robot: RobotProfile,
) -> tuple[Reason, ...]:
    """Return the reasons for which a request has no reading, the plainest ones only.

    Args:
        request: Request as typed.
        words: Its words.
        edges: What the words are by themselves.
        chart: Phrases over the words, those that cannot be planned among them.
        faults: What stopped the reading of its clauses, most likely reading first.
        site, robot: Site and robot of the mission.
    """
    unknown = _unknown(words, edges, chart.fillers, site, robot)
    found = (*_not_yet(words, edges), *_lacking(words, edges, site), *unknown)
    if found:
        return found
    missing = _missing_block(words, edges, site)
    if missing is not None:
        return (missing,)
    if unmeasured := tuple(_unmeasured(words, edges, robot)):
        return unmeasured
    if faults:
        return (_fault(faults[0], words, request),)
    if impossible := tuple(_impossible(words, chart, request)):
        return impossible
    if not words or not any(edge.category in _COMMANDS for edge in edges):
        return (_nothing_asked(words),)
    return (_stuck(words, chart, request),)


def _nothing_asked(words: Sequence[Word]) -> Reason:
    """Return the reason for a request without a word for something that is done."""
    said = ((words[0].start, words[-1].end),) if words else ()
    what = message("the request asks for nothing to be done")
    return Reason(what=what, said=said, advice=_SAY_WHAT)


def _impossible(words: Sequence[Word], chart: Chart, request: str) -> Iterator[Reason]:
    """Yield a reason for each phrase that cannot be planned, unless it is part of a longer one that can be."""
    others = [edge for edge in chart.all_edges() if edge.category in _COMPLETE]
    phrases = sorted(chart.of_category(IMPOSSIBLE), key=lambda edge: edge.start - edge.end)
    taken: list[PhraseEdge] = []
    for edge in phrases:
        within = [one for one in others if one.start <= edge.start and edge.end <= one.end]
        if any(one.end - one.start > edge.end - edge.start for one in within):
            continue
        if any(one.start < edge.end and edge.start < one.end for one in taken):
            continue
        taken.append(edge)
        said = (words[edge.start].start, words[edge.end - 1].end)
        quoted = request[said[0] : said[1]]
        what = message("'{said}': {what}", said=quoted, what=edge.meaning.what)
        yield Reason(what=what, said=(said,), advice=edge.meaning.advice, final=True)


def _not_yet(words: Sequence[Word], edges: Sequence[PhraseEdge]) -> Iterator[Reason]:
    """Yield a reason for each phrase that no plan can express yet, if its words are nothing else."""
    others = [edge for edge in edges if edge.category not in (_NOT_YET, _OF_MARKERS)]
    for edge in edges:
        if edge.category != _NOT_YET or any(_explains(one, edge) for one in others):
            continue
        said = " ".join(word.text for word in words[edge.start : edge.end])
        yield Reason(
            what=message("'{said}' is not possible yet", said=said),
            said=((words[edge.start].start, words[edge.end - 1].end),),
            advice=named(str(edge.meaning.value), "advice"),
            final=True,
        )


def _explains(other: PhraseEdge, edge: PhraseEdge) -> bool:
    """Return True if the words of a phrase are part of another one, or its first word is the end of one ("half an")."""
    return other.start <= edge.start and (edge.end <= other.end or other.start < edge.start < other.end)


def _lacking(words: Sequence[Word], edges: Sequence[PhraseEdge], site: Site) -> Iterator[Reason]:
    """Yield a reason for each phrase that hints at an attribute which the site does not record."""
    others = [edge for edge in edges if edge.category != LACKING]
    for edge in edges:
        if edge.category != LACKING or any(one.start <= edge.start and edge.end <= one.end for one in others):
            continue
        what = message("this site records no {hint} of its trees", hint=named(edge.meaning.value, "attribute hint"))
        recorded = some_names(list(site.attributes), 8) if site.attributes else message("none")
        yield Reason(
            what=message("'{said}': {what}", said=edge.meaning.text, what=what),
            said=((words[edge.start].start, words[edge.end - 1].end),),
            advice=message("it records: {known}", known=recorded),
            final=True,
        )


def _unknown(
    words: Sequence[Word], edges: Sequence[PhraseEdge], fillers: frozenset[int], site: Site, robot: RobotProfile
) -> Iterator[Reason]:
    """Yield reasons for words that are not known: what the site or the robot lacks, and the others together."""
    known = {k for edge in edges for k in range(edge.start, edge.end)} | fillers
    rows = {edge.end for edge in edges if edge.category == "ROW"}
    strange: list[int] = []
    unknown = frozenset(range(len(words))) - known
    measured = {k for one in lacked_actions(words, unknown, robot) for k in range(one.first, one.last)}
    for k, word in enumerate(words):
        if k in known or word.kind == "stop":
            continue
        block = k > 0 and words[k - 1].norm in ("block", "blocks")
        if k in rows or block:
            yield _no_such(word, site, block=block)
        elif k not in measured and (code := _code_of_tree(words, k, site)) is not None:
            yield code
        else:
            strange.append(k)
    plants = [(k, name) for k in strange if (name := absent_plant([word.norm for word in words[k:]], site))]
    plants = [
        one for at, one in enumerate(plants) if not at or plants[at - 1][0] + len(plants[at - 1][1].split()) <= one[0]
    ]
    for k, name in plants:
        end = k + len(name.split())
        yield Reason(
            what=message("'{said}': none of the plants here is of this kind", said=name),
            said=((words[k].start, words[end - 1].end),),
            advice=message("here grow {kinds}", kinds=some_names(kinds_of_plants(site), 12)),
            final=True,
        )
    strange = [k for k in strange if not any(at <= k < at + len(name.split()) for at, name in plants)]
    lacked = list(lacked_actions(words, frozenset(strange), robot))
    for name in dict.fromkeys(one.name for one in lacked):
        alike = [one for one in lacked if one.name == name]
        said = tuple((words[one.first].start, words[one.last - 1].end) for one in alike)
        yield Reason(what=alike[0].say(robot), said=said, advice=can_instead(robot), final=True)
    named = {k for one in lacked for k in range(one.first, one.last)}
    if rest := [words[k] for k in strange if k not in named]:
        yield not_understood(rest)


def _code_of_tree(words: Sequence[Word], k: int, site: Site) -> Reason | None:
    """Return the reason for a word that is written like the ids of the site's trees ("G9-04") and is none of them."""
    last = k
    while last + 1 < len(words) and words[last + 1].start == words[last].end and words[last + 1].kind != "stop":
        last += 1
    code = "".join(word.text for word in words[k : last + 1]).rstrip(",;:")
    if not any(sign.isdigit() for sign in code) or code in site.by_id:
        return None
    if _shape_of(code) not in {_shape_of(tree.place.id) for tree in site.trees}:
        return None
    error = no_such_tree(site, code)
    said = ((words[k].start, words[k].start + len(code)),)
    return Reason(what=error.what, said=said, advice=error.advice, final=True)


def _shape_of(code: str) -> str:
    """Return how a code is written: its signs, "0" for digits and "a" for letters."""
    return re.sub(r"[^\W\d_]+", "a", re.sub(r"\d+", "0", code))


def _unmeasured(words: Sequence[Word], edges: Sequence[PhraseEdge], robot: RobotProfile) -> Iterator[Reason]:
    """Yield a reason for each unit in which the robot measures nothing ("hotter than 36 degrees")."""
    own = {quantity.unit for quantity in robot.quantities} | {event.unit for event in robot.events}
    for edge in edges:
        unit = edge.meaning.value[0] if edge.category == "UNIT" else ""
        if unit not in measured_units() or unit in own | _UNITS_OF_LIMITS:
            continue
        start, end = words[edge.start].start, words[edge.end - 1].end
        what = message("{robot} measures nothing in {unit}", robot=robot.name, unit=say_unit(unit))
        yield Reason(what=what, said=((start, end),), advice=can_instead(robot), final=True)
        return


def can_instead(robot: RobotProfile) -> str:
    """Return what a robot can do."""
    offers = listed([say_action(action.name) for action in robot.actions], "or")
    return message("{robot} can {offers}", robot=robot.name, offers=offers)


def not_understood(words: Sequence[Word], advice: str = PLAINLY) -> Reason:
    """Return a reason for unknown words, which names their language if it is another one.

    Args:
        words: Unknown words, at least one.
        advice: What to do if they are English.
    """
    texts = [word.text for word in words]
    if language := language_of(texts):
        advice = message(
            "this seems to be {language}, and only English and Spanish are understood: say it in English, or plan it"
            " with a language model (--planner llm)",
            language=named(language, "language"),
        )
    quoted = some_names([message("'{said}'", said=text) for text in texts], 12)
    return Reason(
        what=message("not understood: {words}", words=quoted),
        said=tuple((word.start, word.end) for word in words),
        advice=advice,
        unknown=True,
    )


def _missing_block(words: Sequence[Word], edges: Sequence[PhraseEdge], site: Site) -> Reason | None:
    """Return the reason for the name of a block that the site lacks, where it is a word that is known otherwise."""
    named = {k for edge in edges if edge.category == "BLOCKNAME" for k in range(edge.start, edge.end)}
    for edge in edges:
        if edge.category != "PLOT" or "block" not in edge.meaning.features or edge.start - 1 in named:
            continue
        word = words[edge.end] if edge.end < len(words) and edge.end not in named else None
        if word is not None and (word.text.isdigit() or (len(word.text) == 1 and word.text.isupper())):
            return _no_such(word, site, block=True)
    return None


def _no_such(word: Word, site: Site, *, block: bool) -> Reason:
    """Return the reason for a row or a block that the site does not have."""
    planting = site.planting
    names = list(dict.fromkeys(one.name for one in (planting.blocks if block else planting.rows)))
    there = some_names(names, 6)
    if block:
        what = message("there is no block '{said}'", said=word.text)
        has = message("this site has block {there}", there=there)
    else:
        what = message("there is no row '{said}'", said=word.text)
        has = message("this site has row {there}", there=there)
    return Reason(
        what=what,
        said=((word.start, word.end),),
        advice=has if names else message("no rows were found on this site"),
        final=True,
        instead=names[0] if names else "",
    )


def _fault(fault: NotComposed, words: Sequence[Word], request: str) -> Reason:
    """Return the reason for clauses that do not fit together."""
    used = tokens_of(fault.used)
    start, end = (words[used[0]].start, words[used[-1]].end) if used else (0, len(request.rstrip()))
    said = request[start:end].rstrip(" .")
    return Reason(
        what=message("'{said}': {what}", said=_short(said), what=fault.what),
        said=((start, end),),
        advice=fault.advice or (PLAINLY if used else _SAY_WHAT),
        final=bool(fault.advice),
    )


def _stuck(words: Sequence[Word], chart: Chart, request: str) -> Reason:
    """Return the reason for the words from which on a request could not be parsed."""
    at = chart.furthest("said")
    rest = [word for word in words[at:] if word.kind not in ("comma", "stop")] or words[-1:]
    said = rest[:_MOST_WORDS]
    start, end = said[0].start, said[-1].end
    sentence = _sentence(words, start, request)
    if at == 0 or request[start:end] == sentence:
        what = message("each word is known, but not what they say together")
        return Reason(what=what, said=((start, end),), advice=_SHORTER)
    what = message("'{said}' does not fit at this point in '{short}'", said=request[start:end], short=_short(sentence))
    return Reason(what=what, said=((start, end),), advice=_SHORTER)


def _sentence(words: Sequence[Word], at: int, request: str) -> str:
    """Return the sentence around a character."""
    stops = [word for word in words if word.kind == "stop"]
    start = max((word.end for word in stops if word.end <= at), default=0)
    end = min((word.start for word in stops if word.start > at), default=len(request))
    return request[start:end].strip()


def _short(said: str) -> str:
    return said if len(said) <= _MOST_CHARACTERS else f"{said[: _MOST_CHARACTERS - 3]}..."


def lost_reasons(
    plan: Planned, lost: Sequence[Span], request: str, site: Site, robot: RobotProfile
) -> tuple[Reason, ...]:
    """Return the reasons why a plan is not what its request says: words without a part in it, and contradictions.

    Args:
        plan: Plan of the request.
        lost: Ranges of the words that have no part in it.
        request: Request as typed.
        site, robot: Site and robot of the mission.
    """
    parts = [
        Reason(
            what=message("'{said}' has no part in the plan", said=request[start:end]),
            said=((start, end),),
            advice=PLAINLY,
        )
        for start, end in lost
    ]
    wrong = [Reason(what=one.what, advice=PLAINLY) for one in mismatches(plan.task, site, robot)]
    vague = () if parts or not wrong else tuple(_vague(request))
    return vague or (*parts, *wrong)


def _vague(request: str) -> Iterator[Reason]:
    """Yield the reason for an adjective without a value ("weak vines") of which only one value fits the place."""
    words = words_of(request)
    for word in words:
        if any(entry.kind == "VAGUEADJ" for entry in more_words().get((word.norm,), ())):
            yield Reason(
                what=message("'{said}': {what}", said=word.text, what=message("it does not say from which value on")),
                said=((word.start, word.end),),
                advice=message("say 'older than 8 years', or 'the ten oldest trees'"),
                final=True,
            )
            return
