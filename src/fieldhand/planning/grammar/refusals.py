"""The reasons for which the grammar does not plan a request, for languages that have no other planner."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.language import joined, message
from fieldhand.language.words import some_names
from fieldhand.planning.english.faults import PLAINLY
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import Chart
from fieldhand.planning.grammar.language import GrammarLanguage
from fieldhand.planning.grammar.reader import PREDICTED, readings
from fieldhand.planning.grammar.words import edges_of, fillers_of
from fieldhand.planning.planner import Reason
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Maximum number of words that a reason quotes.
_MOST_QUOTED = 12


def refusal_reasons(request: str, site: Site, robot: RobotProfile, language: GrammarLanguage) -> tuple[Reason, ...]:
    """Return the reasons for which a request has no plan: unknown words, else the words at which the parse ends."""
    words = language.words_of(request)
    phrases = language.phrases(robot, site)
    edges = list(edges_of(words, phrases))
    fillers = fillers_of(words, phrases)
    known = {k for edge in edges for k in range(edge.start, edge.end)} | fillers
    if unknown := [word for k, word in enumerate(words) if k not in known]:
        return (_unknown(unknown),)
    chart = Chart(language.grammar(), len(words), fillers, given={"site": site}, predicted=PREDICTED)
    chart.parse(edges)
    if not chart.whole("request"):
        return (_stuck(request, words, chart.furthest("said")),)
    if not readings(request, site, robot, language):
        what = message("every word is known, but not what the sentences mean together")
        return (Reason(what=what, said=((0, len(request)),), advice=_COMPLETELY, unknown=True),)
    what = message("the request can be read in more than one way")
    return (Reason(what=what, said=((0, len(request)),), advice=_COMPLETELY, unknown=True),)


_COMPLETELY = message("say what to take or measure, at which trees and how many, in short sentences")


def _unknown(words: Sequence[Word]) -> Reason:
    """Return a reason for words that the language does not have."""
    quoted = some_names([message("'{said}'", said=word.text) for word in words], _MOST_QUOTED)
    return Reason(
        what=message("not understood: {words}", words=quoted),
        said=tuple((word.start, word.end) for word in words),
        advice=PLAINLY,
        unknown=True,
    )


def _stuck(request: str, words: Sequence[Word], at: int) -> Reason:
    """Return a reason for the words from which on the request could not be parsed."""
    rest = [word for word in words[at:] if word.kind not in ("comma", "stop")] or words[-1:]
    start, end = rest[0].start, rest[: _MOST_QUOTED // 3][-1].end
    what = message("not understood: {words}", words=joined("", [message("'{said}'", said=request[start:end])]))
    return Reason(what=what, said=((start, end),), advice=_COMPLETELY, unknown=True)
