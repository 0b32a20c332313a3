"""Read a request with the grammar: its words, the chart, the dialogue, and the plan that comes of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.language import message
from fieldhand.planning.english.faults import Unclear
from fieldhand.planning.english.leading import different_places
from fieldhand.planning.english.limits import LimitPhrase
from fieldhand.planning.english.planned import NAME, Meant, planned_as
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.ambiguity import PlanQuestion, chosen_answer, not_an_answer, question_between
from fieldhand.planning.grammar.assumptions import assumed_ways, assumed_wholes
from fieldhand.planning.grammar.chart import Chart, PhraseEdge, tokens_of
from fieldhand.planning.grammar.dialogue import DialogueState, Setting, read_in_each_way, whole_plan
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.language import GrammarLanguage
from fieldhand.planning.grammar.remarks import without_remarks
from fieldhand.planning.grammar.words import Phrases, edges_of, fillers_of
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
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
        labels: Labels of steps, which say an order.
        assumed: What was assumed, as sentences.
        mended: What was read as another word, as sentences.
    """

    state: DialogueState
    cost: float
    skipped: tuple[Span, ...]
    remarks: tuple[Span, ...] = ()
    labels: tuple[Span, ...] = ()
    assumed: tuple[str, ...] = ()
    mended: tuple[str, ...] = ()


def readings(
    request: str, site: Site, robot: RobotProfile, language: GrammarLanguage = ENGLISH
) -> list[RequestReading]:
    """Return the ways to read a request as a whole, cheapest first; empty if the grammar does not cover it."""
    return read(request, site, robot, language)[0]


def read(
    request: str, site: Site, robot: RobotProfile, language: GrammarLanguage = ENGLISH
) -> tuple[list[RequestReading], list[str]]:
    """Return the ways to read a request as a whole, cheapest first, and what readings that lack something ask."""
    words, phrases = language.words_of(request), language.phrases(robot, site)
    found, asked = _readings_of(request, words, phrases, site, robot, language)
    if found or language.respelt is None:
        return found, asked
    known = {token for edge in edges_of(words, phrases) for token in range(edge.start, edge.end)}
    mended: list[str] = []
    for token, word in enumerate(words):
        if token not in known:
            (words[token],), notes = language.respelt([word], phrases.lexicon)
            mended += notes
    if not mended:
        return found, asked
    found, asked = _readings_of(request, words, phrases, site, robot, language)
    return [replace(reading, mended=tuple(mended)) for reading in found], asked


def _readings_of(
    request: str, words: Sequence[Word], phrases: Phrases, site: Site, robot: RobotProfile, language: GrammarLanguage
) -> tuple[list[RequestReading], list[str]]:
    """Return the ways to read words, cheapest first, and what readings that lack something ask."""
    remarks = without_remarks(words, edges_of(words, phrases))
    words = remarks.words
    chart = Chart(language.grammar(), len(words), fillers_of(words, phrases), given={"site": site}, predicted=PREDICTED)
    chart.parse(edges_of(words, phrases))
    setting = Setting(robot, site, lambda used: spans(words, used), request)
    found: list[RequestReading] = []
    asked: list[str] = []
    sides = [(words[one.start].start, words[one.end - 1].end) for one in chart.of_category("DIR")]
    edges = chart.whole("request")
    for edge in edges:
        states, questions = read_in_each_way(setting, edge.meaning)
        if edge.cost < edges[0].cost + _MARGIN:
            asked += [question.question for question in questions]
        found += [
            RequestReading(
                state=state,
                cost=edge.cost,
                skipped=_skipped(words, edge),
                remarks=remarks.spans,
                labels=remarks.labels,
                assumed=(*assumed_ways(state.plan, request, sides, site), *assumed_wholes(state.plan, request)),
            )
            for state in states
        ]
    return found, asked


def composed(
    request: str,
    site: Site,
    robot: RobotProfile,
    language: GrammarLanguage = ENGLISH,
    answers: tuple[Answer, ...] = (),
) -> Outcome | None:
    """Return the plan of a request that the grammar covers as a whole, or a question if there are several.

    A plan that says something else than the request, or leaves a word of it out, is none. A request that is understood
    and names a place that the site does not have is refused.

    Args:
        request: Request as typed.
        site, robot: Site and robot of the mission.
        language: Language of the request.
        answers: Answers to questions about it.

    Returns:
        None if the grammar does not cover the request.
    """
    found, asked = read(request, site, robot, language)
    if not found:
        return Clarify(question=asked[0], planner=NAME) if asked else None
    found = _without_lost_words(found, request, site, robot)
    likely: list[RequestReading] = []
    for reading in found:
        meant = _meant(reading, request)
        if reading.cost < found[0].cost + _MARGIN and not any(_same(_meant(one, request), meant) for one in likely):
            likely.append(reading)
    outcomes = [_outcome_of(_meant(reading, request), request, site, robot) for reading in likely]
    if len(likely) == 1:
        outcome = outcomes[0]
        whole = isinstance(outcome, Planned) and _is_whole(outcome, found[0].remarks, site, robot)
        return outcome if whole or isinstance(outcome, Refused) else None
    if any(outcome is None for outcome in outcomes):
        return None
    plans = [
        outcome
        for reading, outcome in zip(likely, outcomes, strict=True)
        if isinstance(outcome, Planned)
        and (reading.cost == likely[0].cost or _is_whole(outcome, found[0].remarks, site, robot))
    ]
    return _chosen(plans, found[0].remarks, request, site, robot, answers) if plans else outcomes[0]


def _chosen(
    plans: Sequence[Planned],
    remarks: Sequence[Span],
    request: str,
    site: Site,
    robot: RobotProfile,
    answers: tuple[Answer, ...],
) -> Outcome | None:
    """Return the plan that the answers choose, or the question that tells plans apart."""
    taken: tuple[tuple[Answer, Span], ...] = ()
    while len(plans) > 1 and (question := question_between(plans, request, site, robot)) is not None:
        given = next((answer for answer in answers if answer.question == question.question), None)
        if given is None:
            left = _whole_answers(question, taken, remarks, site, robot)
            if len(left) < 2:  # the others contradict the request
                plans = list(left.values())
                break
            places = different_places(list(left.values()), question.said, site, robot)
            return Clarify(question=question.question, choices=tuple(left), places=places, planner=NAME)
        chosen = chosen_answer(given.answer, tuple(question.plans))
        if chosen is None:
            return Refused(reasons=(not_an_answer(given, tuple(question.plans)),), planner=NAME)
        plans, taken = question.plans[chosen], (*taken, (replace(given, answer=chosen), question.said))
    if not plans:
        return None
    plan = _answered(plans[0], taken)
    return plan if _is_whole(plan, remarks, site, robot) else None


def _whole_answers(
    question: PlanQuestion,
    taken: Sequence[tuple[Answer, Span]],
    remarks: Sequence[Span],
    site: Site,
    robot: RobotProfile,
) -> dict[str, Planned]:
    """Return the answers to a question with the first plan of each that says all of the request."""
    left: dict[str, Planned] = {}
    for text, plans in question.plans.items():
        answer = (Answer(question=question.question, answer=text), question.said)
        whole = (plan for plan in plans if _is_whole(_answered(plan, (*taken, answer)), remarks, site, robot))
        if (first := next(whole, None)) is not None:
            left[text] = first
    return left


def _answered(plan: Planned, taken: Sequence[tuple[Answer, Span]]) -> Planned:
    """Return a plan with the answers that chose it; its request is read with them in place of the words in question."""
    if not taken:
        return plan
    command = plan.task.command
    read_as, before = command.request, len(command.request)
    for answer, (start, end) in sorted(taken, key=lambda one: one[1], reverse=True):
        read_as = f"{read_as[:start]}{answer.answer.rstrip('.')}{read_as[min(end, before) :]}"
        before = start
    assumptions = (*(answer.sentence() for answer, _ in taken), *command.assumptions)
    return replace(plan, task=replace(plan.task, command=replace(command, read_as=read_as, assumptions=assumptions)))


def _is_whole(plan: Planned, remarks: Sequence[Span], site: Site, robot: RobotProfile) -> bool:
    """Return True if a plan leaves no word of its request out, and does not contradict it."""
    return not _leaves_words(plan, remarks) and not mismatches(plan.task, site, robot)


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
    states, _ = read_in_each_way(Setting(robot, site, lambda used: spans(words, used), request), phrase.meaning)
    if len(states) != 1:
        return None
    (state,) = states
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
    joints = (*reading.labels, *state.joints)
    if plan.is_series:
        plan = replace(plan, said=joints)
    else:
        no_part += joints
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
        assumptions=(*reading.assumed, *remarked),
        warnings=reading.mended,
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
