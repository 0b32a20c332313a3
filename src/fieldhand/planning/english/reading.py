"""The ways in which a request is read: by its gist, by its sentences, or clause by clause in plain words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count

from fieldhand.language import message
from fieldhand.planning.english.arrange import Arranged, Asked, arrange, without_filler
from fieldhand.planning.english.discourse import Discourse
from fieldhand.planning.english.draft import DraftCapture, Loop, shape, walk
from fieldhand.planning.english.faults import Question, Unclear
from fieldhand.planning.english.gist import gist, said_in_order
from fieldhand.planning.english.leaving import place_unsure
from fieldhand.planning.english.lexicon import Lexicon, lexicon_for
from fieldhand.planning.english.mending import mended
from fieldhand.planning.english.planned import NAME, planned
from fieldhand.planning.english.remarks import without_remarks
from fieldhand.planning.english.rewording import Worded, as_typed
from fieldhand.planning.english.sense import check_sense
from fieldhand.planning.english.spelling import respelt
from fieldhand.planning.english.steps import steps
from fieldhand.planning.english.syntax import NotParsed, parse
from fieldhand.planning.english.tokens import Term, Word
from fieldhand.planning.english.told import Told, settle
from fieldhand.planning.english.unknown import check_numbers, unknown_words
from fieldhand.planning.english.vocabulary import glue
from fieldhand.planning.english.wording import reworded
from fieldhand.planning.planner import Answer, Outcome, Planned, Reason, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import Span

#: What may stand between two parts and says nothing of their order.
_NO_WORDS = frozenset({"", ",", ":", ", and", "and", "but", ", but"})


@dataclass(frozen=True, kw_only=True)
class Reading:
    """A request as it is read once.

    Attributes:
        request: As it was typed.
        worded: With the words of the answers in place.
        taken: These answers.
        said: The words.
        words: The words after spelling and turns of phrase.
        terms: What these are to the lexicon.
        notes: How words were read that are not known as they are written, as sentences.
    """

    request: str
    worded: Worded
    taken: tuple[Answer, ...]
    robot: RobotProfile
    lexicon: Lexicon
    said: tuple[Word, ...]
    words: tuple[Word, ...]
    terms: tuple[Term, ...]
    notes: tuple[str, ...]

    def outcome(self) -> Outcome:
        """By its sentences; by its gist where that comes to something else; or else clause by clause.

        Raises:
            Unclear, Question: As the words are, they mean nothing here, or several things.
        """
        failed: Unclear | Question | None = None
        outcome: Outcome = refused(self.worded, ())
        told: Told | None = None
        try:
            outcome, told = self._by_sentences()
        except (Unclear, Question) as error:
            failed = error
        understood = isinstance(outcome, Planned) and told is not None
        whole = self._in_other_words(gist(self.terms, glue()))
        if whole is not None and not (understood and told is not None and shape(told.root) == shape(whole[1].root)):
            return whole[0]
        if understood:
            return outcome
        plain = None if isinstance(failed, Question) else self._in_other_words(steps(self.terms, glue()))
        if plain is not None:
            return plain[0]
        if failed is not None:
            raise failed
        return outcome

    @property
    def _site(self) -> Site:
        return self.lexicon.site

    def _by_sentences(self) -> tuple[Outcome, Told | None]:
        text = self.worded.text
        terms, aside, remarks = without_remarks(self.terms, text)
        asked = without_filler(terms, text)
        check_numbers(asked.terms)
        unknown = unknown_words(asked.terms, self.lexicon)
        if unknown:
            return refused(self.worded, unknown), None
        arranged = arrange(asked)
        filler = (*arranged.filler, *aside, *_turned(self.said, self.words))
        arranged = replace(arranged, filler=filler, remarks=tuple(remarks))
        _all_accounted(self.words, arranged)
        told = _told(arranged, text, self.robot, self._site)
        outcome = self._planned(told)
        if told.misfit is not None and isinstance(outcome, Planned) and self._is_doubted(outcome):
            return refused(self.worded, (told.misfit,)), None  # what came of an odd sentence is not what it says
        return outcome, told

    def _is_doubted(self, outcome: Planned) -> bool:
        return bool(mismatches(outcome.task, self._site, self.robot))

    def _planned(self, told: Told) -> Outcome:
        told.assumptions += [str(answer) for answer in self.taken]
        as_typed(told, self.worded)
        read_as = self.worded.text if self.taken else ""
        return planned(self.request, read_as, told, self._site, self.robot, warnings=self.notes)

    def _in_other_words(self, made: list[Term] | None) -> tuple[Planned, Told] | None:
        """The plan of what a request comes to; None if that is no plan, or not what the request says."""
        if made is None:
            return None
        spans = [t.span for t in made]
        rest = tuple((w.start, w.end) for w in self.said if not any(a <= w.start and w.end <= b for a, b in spans))
        try:
            arranged = arrange(Asked(terms=tuple(made), filler=rest))
            told = _told(arranged, self.worded.text, self.robot, self._site)
            meant = message("The request is read as '{meant}'.", context="assumption", meant=said_in_order(made))
            told.assumptions.append(meant)
            outcome = self._planned(told)
        except (Unclear, Question):
            return None
        idle = any(isinstance(step, Loop) and not step.body.steps for step, _ in walk(told.root))
        idle = idle or not any(isinstance(step, DraftCapture) for step, _ in walk(told.root))
        if idle or told.misfit is not None or not isinstance(outcome, Planned):
            return None
        return None if self._is_doubted(outcome) else (outcome, told)


def reading_of(
    request: str, worded: Worded, said: Sequence[Word], taken: tuple[Answer, ...], site: Site, robot: RobotProfile
) -> Reading:
    """A request ready to be read.

    Args:
        said: Its words, with those of the answers.
    """
    lexicon = lexicon_for(robot, site)
    words, notes = respelt(reworded([_of_the_robot(word, robot) for word in said]), lexicon)
    return Reading(
        request=request,
        worded=worded,
        taken=taken,
        robot=robot,
        lexicon=lexicon,
        said=tuple(said),
        words=tuple(words),
        terms=tuple(_with_seeds(lexicon.terms(words))),
        notes=tuple(notes),
    )


def _with_seeds(terms: Sequence[Term]) -> Iterator[Term]:
    """Yield the terms, each draw at random with a seed of its own, so that two draws of a request are independent."""
    draws = count()
    for term in terms:
        yield replace(term, value=next(draws)) if term.kind == "RANDOM" else term


def _of_the_robot(word: Word, robot: RobotProfile) -> Word:
    """A word; the name of the robot as "robot"."""
    return replace(word, norm="robot") if word.norm == robot.name.lower() else word


def refused(worded: Worded, reasons: tuple[Reason, ...]) -> Refused:
    """A refusal, its reasons said of the request as it was typed."""
    return Refused(reasons=tuple(replace(r, said=worded.spans(r.said)) for r in reasons), planner=NAME)


def _turned(said: Sequence[Word], words: Sequence[Word]) -> list[Span]:
    """The words that a turn of phrase has in excess: none of the words that it was put into stands for them."""
    kept = [(w.start, w.end) for w in words]
    return [(w.start, w.end) for w in said if not any(start <= w.start and w.end <= end for start, end in kept)]


def _all_accounted(words: Sequence[Word], arranged: Arranged) -> None:
    """Every word has to stand in a sentence, or among those that are known to mean nothing.

    Raises:
        Unclear: One does not: it would be dropped in silence.
    """
    spans = [*arranged.filler, *(t.span for s in arranged.sentences for t in s.terms)]
    lost = [w for w in words if not any(start <= w.start and w.end <= end for start, end in spans)]
    if lost:
        text = " ".join(w.text for w in lost)
        raise Unclear(
            Reason(
                what=message("'{said}' could not be interpreted", said=text), said=tuple((w.start, w.end) for w in lost)
            )
        )


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
            message("'{said}': where, if what comes before it is left out?", context="question", said=said),
            (
                message("only if that is done, at its place", context="answer"),
                message("at a tree that you name", context="answer"),
            ),
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
            message(
                "'{said}' is taken as a remark: the robot does nothing about it.", context="assumption", said=remark
            )
        )
    return discourse.told


def _says_more(link: Term) -> bool:
    """Whether what stands between two parts says something of their order, or stands for a whole turn of phrase."""
    return link.text.lower() not in _NO_WORDS or link.end - link.start > len(link.text) + 2


def _misfit(wrong: NotParsed, request: str) -> Reason:
    start, end = wrong.said
    sentence = request[start:end]
    short = sentence if len(sentence) <= 120 else sentence[:117] + "..."
    advice = message("say it in shorter sentences, one thing after the other")
    if wrong.term.kind in ("WITHOUT", "NOT", "ISNOT"):
        advice = message("the robot does only what is asked of it: leave out what it is not to do, or say 'except'")
    what = message("'{said}' does not fit at this point in '{short}'", said=wrong.term.text, short=short)
    return Reason(what=what, said=(wrong.term.span,), advice=advice)
