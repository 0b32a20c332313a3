"""The English planner: words, terms, parts, plan. No model, no network; what it does not understand it says."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.errors import RequestError
from fieldhand.language import Number, joined, message
from fieldhand.planning.english.faults import Question, Unclear
from fieldhand.planning.english.leading import outcomes_of_choices, places_of_choices
from fieldhand.planning.english.missing_blocks import missing_blocks
from fieldhand.planning.english.planned import NAME
from fieldhand.planning.english.reading import reading_of, refused
from fieldhand.planning.english.rewording import Worded
from fieldhand.planning.english.tokens import Word, words_of
from fieldhand.planning.english.wishes import early_wishes
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.codec_text import hidden_character

#: A request longer than this is no request. Nothing but reading it takes time, and that grows with its length.
LONGEST_REQUEST = 8_000
#: Words and signs of one. So many characters of prose have 1,500; a flood of signs would take seconds to look at.
MOST_WORDS = 2_000


class EnglishPlanner:
    """A planner with a grammar and a lexicon.

    Every word of a request is used, is known to mean nothing to a plan, or is reported: nothing is dropped in silence.

    Args:
        suggests: A refusal says what was understood and suggests a request that can be planned, which takes as long as
            planning several requests.
    """

    def __init__(self, *, suggests: bool = True) -> None:
        self._suggests = suggests

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan a request. Each answer is read in place of the words that its question was about.

        The grammar of constructions plans a request if it covers every word. What it does not plan is read by the
        rules; if they do not plan it either, the grammar's question comes before theirs.

        Raises:
            RequestError: The request is empty, too long, or holds characters that no document can hold.
        """
        outcome = self._plain(request, site, robot, answers)
        if not isinstance(outcome, Refused) or not self._suggests:
            return outcome
        from fieldhand.planning.refusals.helping import helpful
        from fieldhand.planning.refusals.understood import parse_parts

        return helpful(outcome, parse_parts(request, site, robot), lambda text: self._plain(text, site, robot))

    def _plain(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan a request without help if it is refused."""
        check_request(request)
        found = _by_grammar(request, site, robot, answers)
        if isinstance(found, Planned):
            return found
        by_rules = self._by_rules(request, site, robot, answers)
        if isinstance(by_rules, Planned) or found is None:
            return by_rules
        if answers and isinstance(found, Refused):
            return found  # the answer is none of the choices
        if isinstance(by_rules, Refused) and any(reason.final for reason in by_rules.reasons):
            return by_rules  # the rules know the words, and that nothing helps
        if isinstance(found, Refused) and not _is_unknown(by_rules):
            return by_rules  # the rules know the words, and say more of what is wrong
        return found

    def _by_rules(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...]) -> Outcome:
        def read(worded: Worded, taken: tuple[Answer, ...]) -> Outcome:
            said = words_of(worded.text)
            _check_length(said)
            if found := early_wishes(said):
                from fieldhand.planning.refusals.helping import wish_reasons

                return refused(worded, tuple(wish_reasons(found, worded.text, said, site, robot)))
            if missing := tuple(missing_blocks(said, site)):
                return refused(worded, missing)
            return reading_of(request, worded, said, taken, site, robot).outcome()

        _check_text(request)
        worded = Worded.typed(request)
        taken: tuple[Answer, ...] = ()
        while True:
            try:
                return read(worded, taken)
            except Unclear as unclear:
                return refused(worded, (unclear.reason,))
            except Question as question:
                given = next((a for a in answers if a.question == question.question and a not in taken), None)
                if given is None:
                    outcomes = outcomes_of_choices(question, worded, taken, read)
                    impossible = _impossible(outcomes)
                    if impossible is not None:
                        return impossible
                    places = places_of_choices(question, worded, outcomes, site, robot)
                    return Clarify(question=question.question, choices=question.choices, places=places, planner=NAME)
                words = question.words_of(given.answer)
                if not words:
                    return refused(worded, (_unanswered(question, given, known=words is not None),))
                worded, taken = worded.with_words(question.said, words), (*taken, given)


def _by_grammar(request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...]) -> Outcome | None:
    """Return the outcome of the grammar; None if it does not cover the request, or what is said cannot be done."""
    words = words_of(request)
    if early_wishes(words) or any(missing_blocks(words, site)):
        return None
    from fieldhand.planning.grammar.reader import composed

    return composed(request, site, robot, answers=answers)


def _is_unknown(outcome: Outcome) -> bool:
    """Return True if a request is refused for words that are not known."""
    return isinstance(outcome, Refused) and any(reason.unknown for reason in outcome.reasons)


def _impossible(outcomes: Sequence[Outcome | None]) -> Refused | None:
    """Return the refusal to which every choice of a question leads; None if a choice leads to something else."""
    refusals = [outcome for outcome in outcomes if isinstance(outcome, Refused)]
    what = {reason.what for refusal in refusals for reason in refusal.reasons}
    return refusals[0] if refusals and len(refusals) == len(outcomes) and len(what) == 1 else None


def _unanswered(question: Question, given: Answer, *, known: bool) -> Reason:
    """Why an answer does not help: it is none of the choices, or nobody knows where its words would stand."""
    if known:
        return Reason(
            what=message("'{answer}' has to be part of the request", answer=given.answer),
            advice=message("write it there, and plan again"),
        )
    what = message("'{answer}' does not answer '{question}'", answer=given.answer, question=question.question)
    if not question.choices:
        return Reason(what=what, advice=message("write it in the request, and plan again"))
    choices = joined(", ", (message("'{said}'", said=choice) for choice in question.choices))
    return Reason(what=what, advice=message("choose: {choices}", choices=choices))


def check_request(request: str) -> None:
    """Raise an error for a text that cannot be a request.

    Raises:
        RequestError: The request is empty, too long, or contains characters that no document can contain.
    """
    _check_text(request)
    _check_length(words_of(request))


def _check_text(request: str) -> None:
    if not request.strip():
        raise RequestError(
            message("the request is empty"), advice=message("say what the robot should do, and at which trees")
        )
    if len(request) > LONGEST_REQUEST:
        raise RequestError(
            message(
                "the request has {count} characters, more than {most}",
                count=Number(f"{len(request):,}"),
                most=Number(f"{LONGEST_REQUEST:,}"),
            ),
            advice=message("say it shorter, or split it into missions"),
        )
    odd = hidden_character(request, lines=True)
    if odd is not None:
        raise RequestError(
            message("the request contains the invisible character {odd}", odd=odd),
            advice=message("leave it out"),
        )


def _check_length(words: Sequence[Word]) -> None:
    if len(words) > MOST_WORDS:
        raise RequestError(
            message(
                "the request has {count} words and punctuation marks, more than {most}",
                count=Number(f"{len(words):,}"),
                most=Number(f"{MOST_WORDS:,}"),
            ),
            advice=message("say it shorter, or split it into missions"),
        )
