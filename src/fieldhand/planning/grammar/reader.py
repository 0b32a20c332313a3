"""Read a request with the grammar: its words, the chart, the dialogue, and the plan that comes of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.language import message
from fieldhand.planning.english.faults import Unclear
from fieldhand.planning.english.limits import LimitPhrase
from fieldhand.planning.english.planned import Meant, planned_as
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import Chart, PhraseEdge, tokens_of
from fieldhand.planning.grammar.dialogue import DialogueState, NotComposed, Setting, read_clauses, whole_plan
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.language import GrammarLanguage
from fieldhand.planning.grammar.remarks import without_remarks
from fieldhand.planning.grammar.words import Phrases, edges_of, fillers_of
from fieldhand.planning.planner import Outcome, Planned, Refused
from fieldhand.planning.selections import is_in_block, rows_of
from fieldhand.request_check import mismatches
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.plan import Span
from fieldhand.task.request_coverage import request_pieces

#: Two readings whose costs differ by less are equally likely.
_MARGIN = 0.5
#: Sequences of commands begin where the request begins; without this they would be made from every command on.
PREDICTED = frozenset({"said"})


@dataclass(frozen=True, kw_only=True)
class RequestReading:
    """One way to read a request.

    Attributes:
        state: State of the dialogue at its end.
        cost: Cost of its parse.
        skipped: Fillers that were skipped.
        remarks: What asks for nothing.
        mended: What was read as another word, as sentences.
    """

    state: DialogueState
    cost: float
    skipped: tuple[Span, ...]
    remarks: tuple[Span, ...] = ()
    mended: tuple[str, ...] = ()


def readings(
    request: str, site: Site, robot: RobotProfile, language: GrammarLanguage = ENGLISH
) -> list[RequestReading]:
    """Return the ways to read a request as a whole, cheapest first; empty if the grammar does not cover it."""
    words, phrases = language.words_of(request), language.phrases(robot, site)
    found = _readings_of(words, phrases, site, robot, language)
    if found or language.respelt is None:
        return found
    known = {token for edge in edges_of(words, phrases) for token in range(edge.start, edge.end)}
    mended: list[str] = []
    for token, word in enumerate(words):
        if token not in known:
            (words[token],), notes = language.respelt([word], phrases.lexicon)
            mended += notes
    if not mended:
        return found
    found = _readings_of(words, phrases, site, robot, language)
    return [replace(reading, mended=tuple(mended)) for reading in found]


def _readings_of(
    words: Sequence[Word], phrases: Phrases, site: Site, robot: RobotProfile, language: GrammarLanguage
) -> list[RequestReading]:
    """Return the ways to read words, cheapest first."""
    remarks = without_remarks(words, edges_of(words, phrases))
    words = remarks.words
    chart = Chart(language.grammar(), len(words), fillers_of(words, phrases), given={"site": site}, predicted=PREDICTED)
    chart.parse(edges_of(words, phrases))
    setting = Setting(robot, site, lambda used: spans(words, used))
    found: list[RequestReading] = []
    for edge in chart.whole("request"):
        try:
            state = read_clauses(setting, edge.meaning)
        except NotComposed:
            continue
        found.append(RequestReading(state=state, cost=edge.cost, skipped=_skipped(words, edge), remarks=remarks.spans))
    return found


def composed(
    request: str, site: Site, robot: RobotProfile, language: GrammarLanguage = ENGLISH
) -> Planned | Refused | None:
    """Return the plan of a request that the grammar covers as a whole and in one way; None otherwise.

    A plan that says something else than the request, or leaves a word of it out, is none. A request that is understood
    and names a place that the site does not have is refused.
    """
    found = readings(request, site, robot, language)
    if not found:
        return None
    found = _without_lost_words(found, request, site, robot)
    best, *others = found
    meant = _meant(best, request)
    if any(other.cost < best.cost + _MARGIN and not _same(_meant(other, request), meant) for other in others):
        return None
    outcome = _outcome_of(meant, request, site, robot)
    if isinstance(outcome, Refused):
        return outcome
    if (
        not isinstance(outcome, Planned)
        or _leaves_words(outcome, best.remarks)
        or mismatches(outcome.task, site, robot)
    ):
        return None
    return outcome


def _without_lost_words(
    found: list[RequestReading], request: str, site: Site, robot: RobotProfile
) -> list[RequestReading]:
    """Return readings without the first ones, as far as they skip words that ask for something; all if all do."""
    for number, reading in enumerate(found):
        outcome = _outcome_of(_meant(reading, request), request, site, robot)
        if not isinstance(outcome, Planned) or not _leaves_words(outcome, reading.remarks):
            return found[number:]
    return found


def planned_clauses(
    phrase: PhraseEdge, words: Sequence[Word], request: str, site: Site, robot: RobotProfile
) -> Planned | None:
    """Return the plan of some clauses of a request by themselves; None if they are no request.

    Args:
        phrase: The clauses, as the chart over the words has them.
        words: Words of the request.
        request: Request as typed.
        site, robot: Site and robot of the mission.
    """
    try:
        state = read_clauses(Setting(robot, site, lambda used: spans(words, used)), phrase.meaning)
    except NotComposed:
        return None
    meant = _meant(RequestReading(state=state, cost=phrase.cost, skipped=()), request)
    outcome = _outcome_of(meant, request, site, robot)
    return outcome if isinstance(outcome, Planned) else None


def _outcome_of(meant: Meant, request: str, site: Site, robot: RobotProfile) -> Outcome | None:
    """Return the plan of a meaning, or its refusal; None if a row or a limit is left open."""
    if _leaves_block_open(meant.plan, site) or _counts_unnumbered_rows(meant.plan, site):
        return None
    try:
        return planned_as(meant, request, site, robot)
    except Unclear:
        return None


def _leaves_words(outcome: Planned, remarks: Sequence[Span]) -> bool:
    """Return True if a word of the request has no counterpart in the plan and is no remark."""
    at = 0
    for piece in request_pieces(outcome.task):
        start, at = at, at + len(piece.text)
        if piece.role == "nothing" and not any(first <= start and at <= last for first, last in remarks):
            return True
    return False


def _meant(reading: RequestReading, request: str) -> Meant:
    state = reading.state
    plan, no_part = whole_plan(state.plan), [*reading.skipped, *reading.remarks]
    if plan.is_series:
        plan = replace(plan, said=state.joints)
    else:
        no_part += state.joints
    limits = tuple(
        LimitPhrase(amount=one.amount.number, unit=one.amount.unit, keep=one.keep, said=(said[0][0], said[-1][1]))
        for one, said in zip(state.limits, state.limits_said, strict=True)
    )
    remarked = tuple(
        message(
            "'{said}' is taken as a remark: the robot does nothing about it.",
            context="assumption",
            said=request[start:end],
        )
        for start, end in reading.remarks
    )
    return Meant(
        plan=plan,
        limits=limits,
        nominal=state.nominal,
        nominal_said=state.nominal_said,
        no_part=tuple(no_part),
        assumptions=(*reading.mended, *remarked),
    )


def _same(one: Meant, other: Meant) -> bool:
    """Return True if two meanings differ only by the words that say them."""
    return (
        _unsaid(one.plan) == _unsaid(other.plan)
        and one.nominal == other.nominal
        and [(limit.amount, limit.unit, limit.keep) for limit in one.limits]
        == [(limit.amount, limit.unit, limit.keep) for limit in other.limits]
    )


def _unsaid(node: p.Node) -> p.Node:
    """Return a plan without the spans of the request."""
    bare = replace(node, said=()) if node.act is None else replace(node.act, said=(), at_said=())
    return bare.with_children([_unsaid(child) for child in node.children])


def _leaves_block_open(plan: p.Node, site: Site) -> bool:
    """Return True if a row is named on a site of several blocks without its block."""
    if len(site.planting.blocks) < 2:
        return False
    for node in p.walk(plan):
        for rows in () if node.selector is None else rows_of(node.selector):
            if not is_in_block(rows.of):
                return True
    return False


def _counts_unnumbered_rows(plan: p.Node, site: Site) -> bool:
    """Return True if even or odd rows are named where the rows are not numbered one after the other."""
    if all(row.name == str(row.number) for row in site.planting.rows):
        return False
    named = [rows for node in p.walk(plan) if node.selector is not None for rows in rows_of(node.selector)]
    return any(rows.every > 1 and rows.first != "" for rows in named)


def spans(words: Sequence[Word], used: int) -> tuple[Span, ...]:
    """Return the character ranges of the words in a bit mask, neighbours joined."""
    found: list[Span] = []
    last = -2
    for k in tokens_of(used):
        if k == last + 1:
            found[-1] = (found[-1][0], words[k].end)
        else:
            found.append((words[k].start, words[k].end))
        last = k
    return tuple(found)


def _skipped(words: Sequence[Word], edge: PhraseEdge) -> tuple[Span, ...]:
    every = (1 << len(words)) - 1
    return spans(words, every & ~edge.used)
