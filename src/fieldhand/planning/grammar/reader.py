"""Read a request with the grammar: its words, the chart, the dialogue, and the plan that comes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

from fieldhand.language import message
from fieldhand.planning.english.tokens import Word, words_of
from fieldhand.planning.english.wishes import says_start
from fieldhand.planning.grammar.alike import different_on_site
from fieldhand.planning.grammar.ambiguity import PlanQuestion, chosen_answer, not_an_answer, question_between
from fieldhand.planning.grammar.answer_places import different_places
from fieldhand.planning.grammar.assumptions import assumed_hands, assumed_qualities, assumed_ways, assumed_wholes
from fieldhand.planning.grammar.blocks import (
    exceptions_leave_out,
    in_each_block,
    leaves_block_open,
    rules_in_each_block,
)
from fieldhand.planning.grammar.chart import Chart, Grammar, PhraseEdge, tokens_of
from fieldhand.planning.grammar.dialogue import (
    DialogueState,
    Edits,
    NotComposed,
    OpenQuestion,
    Setting,
    read_in_each_way,
    whole_plan,
)
from fieldhand.planning.grammar.dialogue.energy import MeantRecharging, recharging_of
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.language import GrammarLanguage, Respelling
from fieldhand.planning.grammar.planned import NAME, LimitPhrase, Meant, planned_as
from fieldhand.planning.grammar.refusals import lost_reasons, unread_reasons
from fieldhand.planning.grammar.remarks import Remarks, keeps_asides, without_remarks
from fieldhand.planning.grammar.words import Phrases, edges_of, fillers_of, topic_edge
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.planning.selections import rows_of
from fieldhand.request_check import mismatches
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.earlier import uses_records
from fieldhand.task.plan import Span
from fieldhand.task.request_coverage import request_pieces
from fieldhand.task.timing import Timing

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
        corrected: Ranges of numbers that others behind them correct.
        timing: When the mission runs; None if it begins when it is started.
    """

    state: DialogueState
    cost: float
    skipped: tuple[Span, ...]
    remarks: tuple[Span, ...] = ()
    labels: tuple[Span, ...] = ()
    assumed: tuple[str, ...] = ()
    mended: tuple[str, ...] = ()
    corrected: tuple[Span, ...] = ()
    timing: Timing | None = None

    @property
    def edits(self) -> Edits:
        """The ranges of the request that corrections replace, with the words that stand there instead."""
        return (*self.state.edits, *((span, "") for span in self.corrected))


@dataclass(frozen=True, kw_only=True)
class ReadRequest:
    """The result of reading a request with the grammar.

    Attributes:
        readings: Ways to read it as a whole, cheapest first; empty if the grammar does not cover it.
        faults: What stopped the reading of clauses that the grammar covers.
        unread: The reasons for which it has no reading, if it has none.
    """

    readings: Sequence[RequestReading]
    faults: Sequence[NotComposed] = ()
    unread: tuple[Reason, ...] = ()


def read(
    request: str,
    site: Site,
    robot: RobotProfile,
    language: GrammarLanguage = ENGLISH,
    words: Sequence[Word] | None = None,
    *,
    past: bool = True,
) -> ReadRequest:
    """Return the ways to read a request as a whole.

    If it is not read as it is, misspelt words are mended; then what tells something is left out.

    Args:
        request: Request as typed.
        site, robot: Site and robot of the mission.
        language: Language of the request.
        words: Words of the request that are to be read; None for all.
        past: False to leave out "today" and the like as remarks where they may say when earlier work was done.
    """
    words = language.words_of(request) if words is None else words
    phrases = language.phrases(robot, site)

    def read_besides(remarks: Remarks) -> ReadRequest:
        return _read_words(request, remarks, phrases, site, robot, language)

    plain = without_remarks(words, edges_of(words, phrases), past=past)
    found = read_besides(plain)
    if found.readings or language.respelt is None or any(isinstance(one, OpenQuestion) for one in found.faults):
        return found
    mended = _mended(words, phrases, language.respelt)
    if mended.notes:
        respelt = read_besides(without_remarks(mended.words, edges_of(mended.words, phrases), past=past))
        if respelt.readings:
            return _with_notes(respelt, mended.notes)
    edges = edges_of(words, phrases, tells=True)
    likely = edges_of(mended.words, phrases)
    frames = language.frames(words) if language.frames is not None else ()
    aims = language.aims(words) if language.aims is not None else ()
    told = without_remarks(words, edges, tells=True, respelt=likely, frames=frames, aims=aims, past=past)
    if told == plain:
        return found
    bare = read_besides(told)
    rest = _mended(told.words, phrases, language.respelt)
    if bare.readings or not rest.notes:
        return bare
    respelt = read_besides(replace(told, words=tuple(rest.words)))
    return _with_notes(respelt, rest.notes) if respelt.readings else bare


@dataclass(frozen=True)
class _Mended:
    """Words with misspellings mended, and what was mended as sentences."""

    words: Sequence[Word]
    notes: tuple[str, ...]


def _mended(words: Sequence[Word], phrases: Phrases, respelt: Respelling) -> _Mended:
    """Return words with misspellings of unknown ones mended."""
    known = {token for edge in edges_of(words, phrases) for token in range(edge.start, edge.end)}
    strange = [token for token in range(len(words)) if token not in known]
    corrected, notes = respelt([words[token] for token in strange], phrases.lexicon) if strange else ([], [])
    meant = dict(zip(strange, corrected, strict=True))
    return _Mended([meant.get(token, word) for token, word in enumerate(words)], tuple(notes))


def _with_notes(found: ReadRequest, notes: tuple[str, ...]) -> ReadRequest:
    """Return a reading that says what was mended."""
    return replace(found, readings=[replace(reading, mended=notes) for reading in found.readings])


def _read_words(
    request: str, remarks: Remarks, phrases: Phrases, site: Site, robot: RobotProfile, language: GrammarLanguage
) -> ReadRequest:
    """Return the ways to read the words that remarks leave."""
    words = remarks.words
    edges = [*edges_of(words, phrases), *(topic_edge(words, k) for k in remarks.topics)]
    chart = _parsed(language.grammar(), words, edges, phrases, site, robot)
    setting = Setting(robot, site, lambda used: spans(words, used), request, names=_naming(chart))
    found: list[RequestReading] = []
    faults: list[NotComposed] = []
    sides = [(words[one.start].start, words[one.end - 1].end) for one in chart.of_category("DIR")]
    whole = chart.whole("request")
    for in_fragments in (False, True):
        for edge in whole:
            states, stopped = read_in_each_way(setting, edge.meaning, in_fragments=in_fragments)
            if edge.cost < whole[0].cost + _MARGIN and not in_fragments:
                faults += stopped
            readings = [
                RequestReading(
                    state=state,
                    cost=edge.cost,
                    skipped=_skipped(words, edge),
                    remarks=remarks.spans,
                    labels=remarks.labels,
                    corrected=remarks.corrected,
                    assumed=(
                        *assumed_ways(state.plan, request, sides, site),
                        *assumed_wholes(state.plan, request),
                        *assumed_hands(state.plan, request),
                        *assumed_qualities(state.plan, request),
                    ),
                )
                for state in states
            ]
            found += [one for one in readings if not in_fragments or _can_be_planned(one, request, site, robot)]
        if found:
            break
    unread: tuple[Reason, ...] = ()
    if not found:
        chart = _parsed(_with_impossible(language), words, edges, phrases, site, robot)
        unread = unread_reasons(request, words, edges, chart, faults, site, robot)
    return ReadRequest(readings=found, faults=faults, unread=unread)


def _naming(chart: Chart) -> Callable[[str, int], bool]:
    """Return the function that tells whether some tokens contain a phrase of a category."""

    def names(category: str, used: int) -> bool:
        return any(edge.used & ~used == 0 for edge in chart.of_category(category))

    return names


def _parsed(
    grammar: Grammar,
    words: Sequence[Word],
    edges: Sequence[PhraseEdge],
    phrases: Phrases,
    site: Site,
    robot: RobotProfile,
) -> Chart:
    """Return the chart over words."""
    chart = Chart(
        grammar, len(words), fillers_of(words, phrases), given={"site": site, "robot": robot}, predicted=PREDICTED
    )
    chart.parse(edges)
    return chart


@cache
def _with_impossible(language: GrammarLanguage) -> Grammar:
    """Return the constructions of a language with those of what cannot be planned."""
    from fieldhand.planning.grammar import impossible

    made = Grammar()
    made.include(language.grammar())
    made.include(impossible.GRAMMAR)
    return made


@dataclass(frozen=True, kw_only=True)
class _Candidate:
    """A reading with its plan.

    Attributes:
        reading: The reading.
        outcome: Its plan, or the reasons why it has none.
        lost: Ranges of the words that have no part in the plan.
    """

    reading: RequestReading
    outcome: Outcome
    lost: tuple[Span, ...]

    @property
    def plan(self) -> Planned | None:
        """The plan of the reading, if it has one."""
        return self.outcome if isinstance(self.outcome, Planned) else None


@dataclass(frozen=True, kw_only=True)
class _Besides:
    """Facts about a request besides the words that are read.

    Attributes:
        timing: When the mission runs.
        told: Ranges of words that ask for nothing.
        corrected: Ranges of words whose contradiction an answer has settled.
    """

    timing: Timing | None
    told: tuple[Span, ...]
    corrected: tuple[Span, ...]

    def added_to(self, reading: RequestReading) -> RequestReading:
        """Return a reading with all of it."""
        return replace(
            reading,
            timing=self.timing,
            remarks=(*reading.remarks, *self.told),
            corrected=(*reading.corrected, *self.corrected),
        )


def composed(
    request: str,
    site: Site,
    robot: RobotProfile,
    language: GrammarLanguage = ENGLISH,
    answers: tuple[Answer, ...] = (),
    *,
    words: Sequence[Word] | None = None,
    timing: Timing | None = None,
    told: tuple[Span, ...] = (),
    corrected: tuple[Span, ...] = (),
) -> Outcome:
    """Return the plan of a request that the grammar covers as a whole, or a question if there are several.

    A plan that says something else than the request, or leaves a word of it out, is none: the request is refused.

    Args:
        request: Request as typed.
        site, robot: Site and robot of the mission.
        language: Language of the request.
        answers: Answers to questions about it.
        words: Words of the request that are to be read; None for all.
        timing: When the mission runs, as the other words say.
        told: Ranges of words that are not read because they ask for nothing.
        corrected: Ranges of words whose contradiction an answer has settled.
    """
    besides = _Besides(timing=timing, told=told, corrected=corrected)
    outcome = _composed(request, site, robot, language, answers, words, besides, past=True)
    if not isinstance(outcome, Refused):
        return outcome
    read_words = language.words_of(request) if words is None else words
    if not keeps_asides(read_words, edges_of(read_words, language.phrases(robot, site))):
        return outcome
    without = _composed(request, site, robot, language, answers, words, besides, past=False)
    is_present = isinstance(without, Planned) and not uses_records(without.task)
    return without if is_present else outcome  # "the yellow trees are to be photographed today"


def _composed(
    request: str,
    site: Site,
    robot: RobotProfile,
    language: GrammarLanguage,
    answers: tuple[Answer, ...],
    words: Sequence[Word] | None,
    besides: _Besides,
    *,
    past: bool,
) -> Outcome:
    found = read(request, site, robot, language, words, past=past)
    readings = [besides.added_to(one) for one in found.readings]
    found = replace(found, readings=readings)
    if not found.readings:
        asked = next((fault.what for fault in found.faults if isinstance(fault, OpenQuestion)), None)
        if asked is not None:
            return Clarify(question=asked, planner=NAME)
        return Refused(reasons=found.unread, planner=NAME)
    likely = _likely(found.readings, request, site, robot)
    remarks = found.readings[0].remarks
    plans = [
        plan
        for candidate in likely
        if (plan := candidate.plan) is not None
        and (candidate.reading.cost == likely[0].reading.cost or _is_whole(plan, remarks, site, robot))
    ]
    plans = different_on_site(plans, site)
    return (
        _chosen(plans, likely[0].reading.edits, remarks, request, site, robot, answers) if plans else likely[0].outcome
    )


def _likely(found: Sequence[RequestReading], request: str, site: Site, robot: RobotProfile) -> Sequence[_Candidate]:
    """Return readings of different meaning that cost little more than the first one whose plan leaves no word out.

    If the plans of all readings leave words out, they are those that cost little more than the first one.
    """
    lossy: list[_Candidate] = []
    whole: list[_Candidate] = []
    known: list[Meant] = []
    for reading in found:
        if whole and reading.cost >= whole[0].reading.cost + _MARGIN:
            break
        meant = _meant(reading, request)
        if any(_same(one, meant) for one in known):
            continue
        candidates = _candidates(reading, meant, request, site, robot)
        if not all(one.lost for one in candidates):
            known.append(
                meant
            )  # a reading that leaves words out may be followed by one of the same meaning that has them
        for candidate in candidates:
            (lossy if candidate.lost and not whole else whole).append(candidate)
    return whole or [one for one in lossy if one.reading.cost < lossy[0].reading.cost + _MARGIN]


def _candidates(
    reading: RequestReading, meant: Meant, request: str, site: Site, robot: RobotProfile
) -> Sequence[_Candidate]:
    """Return a reading with its plan; with several plans if its rows may be those of several blocks."""
    plans = in_each_block(meant.plan, site)
    outcomes = {
        block: _outcome_of(
            replace(meant, plan=plan, ways=rules_in_each_block(meant.ways, plan, site)[0]), request, site, robot
        )
        for block, plan in plans.items()
    }
    planned = [block for block, outcome in outcomes.items() if isinstance(outcome, Planned)]
    if len(planned) > 1:
        planned = [block for block in planned if exceptions_leave_out(plans[block], site)] or planned
    if len(plans) > 1 and len(planned) == 1:  # "five Syrah vines in row 30", where only one block has Syrah
        (block,) = planned
        outcomes = {
            block: _outcome_of(_in_only(replace(meant, plan=plans[block]), block, request), request, site, robot)
        }
    found: list[_Candidate] = []
    further = [
        _outcome_of(replace(meant, plan=plan, ways=ways), request, site, robot)
        for plan in plans.values()
        for ways in rules_in_each_block(meant.ways, plan, site)[1:]
    ]
    for outcome in (*outcomes.values(), *further):
        lost = _lost_words(outcome, reading.remarks) if isinstance(outcome, Planned) else ()
        found.append(_Candidate(reading=reading, outcome=outcome, lost=lost))
    return [one for one in found if one.plan is not None] or found[:1]


def _in_only(meant: Meant, block: str, request: str) -> Meant:
    """Return a meaning whose rows can only be those of one block, and which says so."""
    sentence = message(
        "The rows are those of block {block}: in no other are there such trees.", context="assumption", block=block
    )
    read_as = f"{(meant.read_as or request).rstrip(' .')} (block {block})"
    return replace(meant, assumptions=(*meant.assumptions, sentence), read_as=read_as)


def _chosen(
    plans: Sequence[Planned],
    edits: Edits,
    remarks: Sequence[Span],
    request: str,
    site: Site,
    robot: RobotProfile,
    answers: tuple[Answer, ...],
) -> Outcome:
    """Return the plan that the answers choose, or the question that tells plans apart."""
    taken: tuple[tuple[Answer, Span], ...] = ()
    first = plans[0]
    while len(plans) > 1 and (question := question_between(plans, request, site, robot)) is not None:
        given = next((answer for answer in answers if answer.question == question.question), None)
        if given is None:
            left = _whole_answers(question, taken, edits, remarks, site, robot)
            if len(left) < 2:  # the others contradict the request
                plans = list(left.values())
                break
            places = different_places(list(left.values()), question.said, site, robot)
            return Clarify(question=question.question, choices=tuple(left), places=places, planner=NAME)
        chosen = chosen_answer(given.answer, tuple(question.plans))
        if chosen is None:
            return Refused(reasons=(not_an_answer(given, tuple(question.plans)),), planner=NAME)
        plans, taken = question.plans[chosen], (*taken, (replace(given, answer=chosen), question.said))
    plan = _answered(plans[0] if plans else first, taken, edits)
    if _is_whole(plan, remarks, site, robot):
        return plan
    lost = _lost_words(plan, remarks)
    return Refused(reasons=lost_reasons(plan, lost, request, site, robot), planner=NAME)


def _whole_answers(
    question: PlanQuestion,
    taken: Sequence[tuple[Answer, Span]],
    edits: Edits,
    remarks: Sequence[Span],
    site: Site,
    robot: RobotProfile,
) -> dict[str, Planned]:
    """Return the answers to a question with the first plan of each that says all of the request."""
    left: dict[str, Planned] = {}
    for text, plans in question.plans.items():
        answer = (Answer(question=question.question, answer=text), question.said)
        whole = (plan for plan in plans if _is_whole(_answered(plan, (*taken, answer), edits), remarks, site, robot))
        if (first := next(whole, None)) is not None:
            left[text] = first
    return left


def _answered(plan: Planned, taken: Sequence[tuple[Answer, Span]], edits: Edits) -> Planned:
    """Return a plan with the answers that chose it; its request is read with them in place of the words in question."""
    if not taken:
        return plan
    command = plan.task.command
    answered = tuple((said, answer.answer.rstrip(".")) for answer, said in taken)
    left = tuple(
        one for one in edits if not any(start <= one[0][0] and one[0][1] <= end for (start, end), _ in answered)
    )
    read_as = _edited(command.request, (*answered, *left))
    assumptions = (*(answer.sentence() for answer, _ in taken), *command.assumptions)
    return replace(plan, task=replace(plan.task, command=replace(command, read_as=read_as, assumptions=assumptions)))


def _is_whole(plan: Planned, remarks: Sequence[Span], site: Site, robot: RobotProfile) -> bool:
    """Return True if a plan leaves no word of its request out, and does not contradict it."""
    return not _lost_words(plan, remarks) and not mismatches(plan.task, site, robot)


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


def _can_be_planned(reading: RequestReading, request: str, site: Site, robot: RobotProfile) -> bool:
    """Return True if a reading has a plan or a question."""
    meant = _meant(reading, request)
    plans = in_each_block(meant.plan, site).values()
    outcomes = (_outcome_of(replace(meant, plan=plan), request, site, robot) for plan in plans)
    return any(
        isinstance(outcome, Clarify) or (isinstance(outcome, Planned) and not mismatches(outcome.task, site, robot))
        for outcome in outcomes
    )


def _outcome_of(meant: Meant, request: str, site: Site, robot: RobotProfile) -> Outcome:
    """Return the plan of a meaning, or its refusal."""
    if (odd := _odd_rows(meant.plan, site)) is not None:
        return Refused(reasons=(odd,), planner=NAME)
    for node in p.walk(meant.plan):
        if node.selector is not None and leaves_block_open(node.selector, site):
            said = request[node.said[0][0] : node.said[-1][1]] if node.said else request
            asked = message("'{said}': of which block?", context="question", said=said)
            return Clarify(question=asked, planner=NAME)
    return planned_as(meant, request, site, robot)


def _lost_words(plan: Planned, remarks: Sequence[Span]) -> tuple[Span, ...]:
    """Return the ranges of the request that have no counterpart in its plan and are no remarks."""
    found: list[Span] = []
    at = 0
    for piece in request_pieces(plan.task):
        start, at = at, at + len(piece.text)
        if piece.role == "nothing" and not any(first <= start and at <= last for first, last in remarks):
            found.append((start, at))
    return tuple(found)


def _meant(reading: RequestReading, request: str) -> Meant:
    state = reading.state
    plan, no_part = whole_plan(state.plan), [*reading.skipped, *reading.remarks]
    joints = (*reading.labels, *state.joints)
    if plan.is_series:
        plan = replace(plan, said=(*plan.said, *joints))
    else:
        no_part += joints
    limits = tuple(
        LimitPhrase(amount=one.amount.number, unit=one.amount.unit, keep=one.keep, said=(said[0][0], said[-1][1]))
        for one, said in zip(state.limits, state.limits_said, strict=True)
    )
    said = [request[start:end] for start, end in reading.remarks]
    starts = [text for text in said if says_start(words_of(text))]
    remarked = tuple(
        message("'{said}' is taken as a remark: the robot does nothing about it.", context="assumption", said=text)
        for text in said
        if text not in starts
    )
    to_confirm = tuple(
        message(
            "'{said}' is taken as a remark: the mission starts when it is approved.",
            context="assumption",
            said=text.rstrip(" ,"),
        )
        for text in starts
    )
    return Meant(
        plan=plan,
        limits=limits,
        speed_m_s=None if state.speed is None else state.speed.pace.speed,
        speed_said=() if state.speed is None else state.speed.said,
        ways=state.ways,
        recharging=recharging_of(state),
        nominal=state.nominal,
        nominal_said=state.nominal_said,
        no_part=tuple(no_part),
        assumptions=(*state.assumed, *reading.assumed, *remarked),
        warnings=(*reading.mended, *to_confirm),
        read_as=_edited(request, reading.edits) if reading.edits else "",
        timing=reading.timing,
        watches=state.watches,
    )


def _edited(request: str, edits: Edits) -> str:
    """Return a request with other words in some of its ranges."""
    read_as, before = request, len(request)
    for (start, end), words in sorted(edits, reverse=True):
        read_as = f"{read_as[:start]}{words}{read_as[min(end, before) :]}"
        before = start
    return read_as


def _same(one: Meant, other: Meant) -> bool:
    """Return True if two meanings differ only by the words that say them."""
    return (
        _unsaid(one.plan) == _unsaid(other.plan)
        and (one.nominal, one.speed_m_s) == (other.nominal, other.speed_m_s)
        and [(limit.amount, limit.unit, limit.keep) for limit in one.limits]
        == [(limit.amount, limit.unit, limit.keep) for limit in other.limits]
        and _rules(one) == _rules(other)
        and [replace(watch, said=()) for watch in one.watches] == [replace(watch, said=()) for watch in other.watches]
        and _without_said(one.recharging) == _without_said(other.recharging)
    )


def _rules(meant: Meant) -> list[object]:
    return [
        (rule.avoid, rule.gates, [(x.places, x.metres, x.pace and x.pace.speed) for x in rule.slow])
        for rule, _ in meant.ways
    ]


def _without_said(recharging: MeantRecharging | None) -> MeantRecharging | None:
    return None if recharging is None else replace(recharging, said=())


def _unsaid(node: p.Node) -> p.Node:
    """Return a plan without the spans of the request."""
    bare = replace(node, said=()) if node.act is None else replace(node.act, said=(), at_said=())
    return bare.with_children([_unsaid(child) for child in node.children])


def _odd_rows(plan: p.Node, site: Site) -> Reason | None:
    """Return the reason why even or odd rows mean nothing where the rows are not numbered one after the other."""
    if all(row.name == str(row.number) for row in site.planting.rows):
        return None
    for node in p.walk(plan):
        if node.selector is not None and any(rows.every > 1 and rows.first != "" for rows in rows_of(node.selector)):
            return Reason(
                what=message("the rows here are not numbered one after the other"),
                said=node.said,
                advice=message("name the rows"),
                final=True,
            )
    return None


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
