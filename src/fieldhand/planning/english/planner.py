"""The English planner: words, terms, parts, plan. No model, no network; what it does not understand it says."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

from fieldhand.errors import PlaceError, RequestError, TaskError
from fieldhand.facts import mismatches
from fieldhand.language import message
from fieldhand.planning.english.arrange import Arranged, arrange, without_filler
from fieldhand.planning.english.discourse import Discourse
from fieldhand.planning.english.draft import Halt, node_of
from fieldhand.planning.english.faults import Question, Unclear
from fieldhand.planning.english.homeward import exit_of, stays_if_home_is_far
from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.leading import places_of_choices
from fieldhand.planning.english.leaving import place_unsure
from fieldhand.planning.english.lexicon import Lexicon, lexicon_for
from fieldhand.planning.english.limits import Limit
from fieldhand.planning.english.mending import mended
from fieldhand.planning.english.remarks import without_remarks
from fieldhand.planning.english.rewording import Worded, as_typed
from fieldhand.planning.english.sense import check_sense
from fieldhand.planning.english.spelling import respelt
from fieldhand.planning.english.syntax import NotParsed, parse
from fieldhand.planning.english.tokens import Term, Word, words_of
from fieldhand.planning.english.told import Told, settle
from fieldhand.planning.english.wording import reworded
from fieldhand.planning.foreseen import foreseeable
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Site
from fieldhand.site.places import resolve
from fieldhand.task import plan as p
from fieldhand.task.build import FAULTED_EXITS, make_task
from fieldhand.task.codec_text import unwritable_character
from fieldhand.task.frames import Budget, BudgetKind, Constraints, FaultedExit, Resource, Then

NAME = "english"
#: A request longer than this is no request. Nothing but reading it takes time, and that grows with its length.
LONGEST_REQUEST = 8_000
#: What may stand between two parts and says nothing of their order.
_NO_WORDS = frozenset({"", ",", ":", ", and", "and", "but", ", but"})
#: Words and signs of one. So many characters of prose have 1,500; a flood of signs would take seconds to look at.
MOST_WORDS = 2_000
KINDS: dict[str, BudgetKind] = {"metres": "distance_m", "seconds": "duration_s", "percent": "energy_percent"}


class EnglishPlanner:
    """A planner with a grammar and a lexicon.

    Every word of a request is used, is known to mean nothing to a plan, or is reported: nothing is dropped in silence.
    """

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan a request. Each answer is read in place of the words that its question was about.

        Raises:
            RequestError: The request is empty, too long, or holds characters that no document can hold.
        """

        def read(worded: Worded, taken: tuple[Answer, ...]) -> Outcome:
            return _read(request, worded, taken, site, robot)

        _check_text(request)
        worded = Worded.typed(request)
        taken: tuple[Answer, ...] = ()
        while True:
            try:
                return read(worded, taken)
            except Unclear as unclear:
                return _refused(worded, (unclear.reason,))
            except Question as question:
                given = next((a for a in answers if a.question == question.question and a not in taken), None)
                if given is None:
                    places = places_of_choices(question, worded, taken, read, site, robot)
                    return Clarify(question=question.question, choices=question.choices, places=places, planner=NAME)
                words = question.words_of(given.answer)
                if not words:
                    return _refused(worded, (_unanswered(question, given, known=words is not None),))
                worded, taken = worded.with_words(question.said, words), (*taken, given)


def _read(request: str, worded: Worded, taken: tuple[Answer, ...], site: Site, robot: RobotProfile) -> Outcome:
    """Plan a request with the words of the answers that were taken.

    Raises:
        Unclear, Question: As the words are, they mean nothing here, or several things.
    """
    lexicon = lexicon_for(robot, site)
    said = words_of(worded.text)
    _check_length(said)
    words, notes = respelt(reworded(said), lexicon)
    terms, aside, remarks = without_remarks(lexicon.terms(words), worded.text)
    aside = [*aside, *_turned(said, words)]
    asked = without_filler(terms, worded.text)
    unknown = _unknown(asked.terms, lexicon)
    if unknown:
        return _refused(worded, unknown)
    arranged = arrange(asked)
    arranged = replace(arranged, filler=(*arranged.filler, *aside), remarks=tuple(remarks), notes=tuple(notes))
    _all_accounted(words, arranged)
    told = _told(arranged, worded.text, robot, site)
    told.assumptions += [str(answer) for answer in taken]
    as_typed(told, worded)
    outcome = _planned(request, worded.text if taken else "", told, site, robot)
    if told.misfit is not None and isinstance(outcome, Planned) and mismatches(outcome.task, site, robot):
        return _refused(worded, (told.misfit,))  # what was made of an odd sentence is not what it says
    return outcome


def _turned(said: Sequence[Word], words: Sequence[Word]) -> list[p.Span]:
    """The words that a turn of phrase has in excess: none of the words that it was put into stands for them."""
    kept = [(w.start, w.end) for w in words]
    return [(w.start, w.end) for w in said if not any(start <= w.start and w.end <= end for start, end in kept)]


def _refused(worded: Worded, reasons: tuple[Reason, ...]) -> Refused:
    return Refused(reasons=tuple(replace(r, said=worded.spans(r.said)) for r in reasons), planner=NAME)


def _unanswered(question: Question, given: Answer, *, known: bool) -> Reason:
    """Why an answer does not help: it is none of the choices, or nobody knows where its words would stand."""
    if known:
        return Reason(what=f"'{given.answer}' has to be said in the request", advice="say it there, and plan again")
    choices = ", ".join(f"'{choice}'" for choice in question.choices) or "say it in the request, and plan again"
    return Reason(what=f"'{given.answer}' does not answer '{question.question}'", advice=f"choose: {choices}")


def _check_text(request: str) -> None:
    if not request.strip():
        raise RequestError("the request is empty", advice="say what the robot should do, and at which trees")
    if len(request) > LONGEST_REQUEST:
        raise RequestError(
            f"the request has {len(request):,} characters, at most {LONGEST_REQUEST:,} are read",
            advice="say it shorter, or split it into missions",
        )
    odd = unwritable_character(request)
    if odd is not None:
        raise RequestError(
            f"the request holds the character {odd!r}, which no document can hold", advice="leave it out"
        )


def _check_length(words: Sequence[Word]) -> None:
    if len(words) > MOST_WORDS:
        raise RequestError(
            f"the request has {len(words):,} words and signs, at most {MOST_WORDS:,} are read",
            advice="say it shorter, or split it into missions",
        )


def _unknown(terms: Sequence[Term], lexicon: Lexicon) -> tuple[Reason, ...]:
    """A reason for each word that is not known, and for what is known but cannot be done yet."""
    known = [t for t in terms if t.kind == "NOTYET"]
    reasons = [Reason(what=f"'{t.text}' is not possible yet", said=(t.span,), advice=str(t.value)) for t in known]
    nameless = [t for k, t in enumerate(terms) if t.kind == "UNKNOWN" and k and _called(terms[k - 1])]
    reasons += [_no_such(terms[terms.index(t) - 1], t, lexicon) for t in nameless]
    strange = [t for t in terms if t.kind == "UNKNOWN" and t not in nameless]
    if strange:
        words = ", ".join(f"'{t.text}'" for t in strange[:12])
        more = f" and {len(strange) - 12} more" if len(strange) > 12 else ""
        near = [f"'{n[0]}' for '{t.text}'" for t in strange[:12] if (n := lexicon.nearest(t.text))]
        advice = f"did you mean {', '.join(near)}?" if near else "say it in other words"
        if language := language_of(t.text for t in strange):
            advice = (
                f"this seems to be {language}, and only English is understood: say it in English, or plan it with a "
            )
            advice += "language model (--planner llm)"
        reasons.append(
            Reason(what=f"not understood: {words}{more}", said=tuple(t.span for t in strange), advice=advice)
        )
    return tuple(reasons)


def _called(term: Term) -> str:
    """What a name is expected behind: a row or a block; nothing else is called by names of its own."""
    return "row" if term.kind == "ROW" else "block" if term.text.lower() in ("block", "blocks") else ""


def _no_such(head: Term, name: Term, lexicon: Lexicon) -> Reason:
    """A row or a block that the site does not have."""
    planting, kind = lexicon.site.planting, _called(head)
    names = list(dict.fromkeys(one.name for one in (planting.rows if kind == "row" else planting.blocks)))
    there = f"{', '.join(names[:6])}{' and more' if len(names) > 6 else ''}"
    advice = f"this site has {kind} {there}" if names else "no rows are known on this site"
    return Reason(what=f"there is no {kind} '{name.text}'", said=(name.span,), advice=advice)


def _all_accounted(words: Sequence[Word], arranged: Arranged) -> None:
    """Every word has to stand in a sentence, or among those that are known to mean nothing.

    Raises:
        Unclear: One does not: it would be dropped in silence.
    """
    spans = [*arranged.filler, *(t.span for s in arranged.sentences for t in s.terms)]
    lost = [w for w in words if not any(start <= w.start and w.end <= end for start, end in spans)]
    if lost:
        text = " ".join(w.text for w in lost)
        raise Unclear(Reason(what=f"'{text}' could not be placed", said=tuple((w.start, w.end) for w in lost)))


def _told(arranged: Arranged, request: str, robot: RobotProfile, site: Site) -> Told:
    discourse = Discourse(robot, site)
    discourse.told.no_part += arranged.filler
    for sentence in arranged.sentences:
        discourse.told.joints += [t.span for t in sentence.terms if t.kind == "SEP" and _says_more(t)]
        parts = parse(sentence)
        if isinstance(parts, NotParsed):
            misfit, whole = _misfit(parts, request), mended(sentence)
            if whole is None:
                raise Unclear(misfit)
            discourse.told.misfit = discourse.told.misfit or misfit
            discourse.told.no_part += [t.span for t in whole.left_out]
            parts = whole.parts
        try:
            discourse.read(parts)
        except (Unclear, Question):
            if discourse.told.misfit is not None:
                raise Unclear(discourse.told.misfit) from None
            raise
    unsure = place_unsure(discourse.told.root)
    if unsure is not None:
        said = " ".join(request[start:end] for start, end in unsure.said)
        raise Question(
            f"'{said}': where, if what comes before it is left out?",
            ("only if that is done, at its place", "at a tree that you name"),
        )
    settle(discourse.told)
    try:
        check_sense(discourse.told.root, request)
    except (Unclear, Question):
        if discourse.told.misfit is not None:
            raise Unclear(discourse.told.misfit) from None
        raise
    for reason in arranged.reasons:
        discourse.told.assumptions.append(
            message("'{said}' is taken as a reason, not as something to do.", context="assumption", said=reason)
        )
    for remark in arranged.remarks:
        discourse.told.assumptions.append(
            message("'{said}' is taken as a remark: nothing is done about it.", context="assumption", said=remark)
        )
    discourse.told.assumptions.extend(arranged.notes)
    return discourse.told


def _says_more(link: Term) -> bool:
    """Whether what stands between two parts says something of their order, or stands for a whole turn of phrase."""
    return link.text.lower() not in _NO_WORDS or link.end - link.start > len(link.text) + 2


def _misfit(wrong: NotParsed, request: str) -> Reason:
    start, end = wrong.said
    sentence = request[start:end]
    short = sentence if len(sentence) <= 120 else sentence[:117] + "..."
    advice = "say it in shorter sentences, one thing after the other"
    if wrong.term.kind in ("WITHOUT", "NOT", "ISNOT"):
        advice = "the robot does only what is asked of it: leave out what it is not to do, or say 'except'"
    what = f"'{wrong.term.text}' does not fit where it stands in '{short}'"
    return Reason(what=what, said=(wrong.term.span,), advice=advice)


def _planned(request: str, read_as: str, told: Told, site: Site, robot: RobotProfile) -> Outcome:
    if all(isinstance(step, Halt) for step in told.root.steps):
        reason = Reason(
            what="the request asks for nothing to be done", advice="say what to take or measure, and at which trees"
        )
        return Refused(reasons=(reason,), planner=NAME)
    nominal, assumptions = exit_of(told, site)
    plan = node_of(told.root)
    if isinstance(plan, p.Sequence):
        plan = replace(plan, said=tuple(told.joints))
    else:
        told.no_part += told.joints  # there is nothing that they could put in order
    task = make_task(
        request=request,
        plan=plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=_constraints(told.limits),
        nominal=nominal,
        nominal_said=tuple(told.nominal_said),
        no_part=tuple((start, end) for start, end in told.no_part if re.search(r"\w", request[start:end])),
        faulted=_faulted(nominal),
        read_as=read_as,
        assumptions=tuple(dict.fromkeys([*told.assumptions, *assumptions])),
    )
    problems = tuple(_impossible(task.composition.plan, site))
    if problems:
        return Refused(reasons=problems, planner=NAME)
    if told.nominal is None:
        task = stays_if_home_is_far(task, site, robot)
    return Planned(task=task, planner=NAME)


def _faulted(nominal: Then) -> tuple[FaultedExit, ...]:
    """What every mission does about faults; one that is to return to the start goes there when little is left, too."""
    if nominal != "return_to_start":
        return FAULTED_EXITS
    return tuple(replace(e, then=nominal) if e.fault == "low_budget" else e for e in FAULTED_EXITS)


def _constraints(limits: Iterable[Limit]) -> Constraints:
    budgets: dict[BudgetKind, Budget] = {}
    reserve: float | None = None
    reserve_said: tuple[p.Span, ...] = ()
    for limit in limits:
        _check(limit)
        if limit.keep:
            reserve = max(limit.amount, reserve or 0.0)
            reserve_said = (*reserve_said, limit.said)
        else:
            kind = KINDS[limit.unit]
            known = budgets.get(kind, Budget(kind=kind, limit=limit.amount))
            budgets[kind] = replace(known, limit=min(limit.amount, known.limit), said=(*known.said, limit.said))
    return Constraints(budgets=tuple(budgets.values()), reserve_percent=reserve, reserve_said=reserve_said)


def _check(limit: Limit) -> None:
    most = 100.0 if limit.unit == "percent" else math.inf
    if not 0.0 < limit.amount <= most:
        what = f"a limit of {limit.amount:g} {limit.unit} cannot be kept"
        raise Unclear(Reason(what=what, advice="say a number above 0, at most 100 for percent of the battery"))


def _impossible(plan: p.Node, site: Site) -> Iterable[Reason]:
    """Places that this site does not have, as far as it can be told before the robot drives."""
    for node in p.walk(plan):
        selector = p.selector_of(node)
        for part in () if selector is None else foreseeable(selector):
            try:
                resolve(part, site, Context(here=site.start))
            except (PlaceError, TaskError) as error:
                yield Reason(what=error.what, said=node.said, advice=error.advice)
                break
