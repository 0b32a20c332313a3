"""The English planner: words, terms, parts, plan. No model, no network; what it does not understand it says."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.errors import RequestError
from fieldhand.language import Number, message
from fieldhand.planning.english.lexicon import lexicon_for
from fieldhand.planning.english.missing_blocks import missing_blocks
from fieldhand.planning.english.tokens import Word, words_of
from fieldhand.planning.english.wishes import early_wishes
from fieldhand.planning.grammar.planned import NAME
from fieldhand.planning.planner import Answer, Outcome, Refused
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
        words = words_of(request)
        if found := early_wishes(words, lexicon_for(robot, site)):
            from fieldhand.planning.refusals.helping import wish_reasons

            return Refused(reasons=tuple(wish_reasons(found, request, words, site, robot)), planner=NAME)
        if missing := tuple(missing_blocks(words, site)):
            return Refused(reasons=missing, planner=NAME)
        from fieldhand.planning.grammar.reader import composed

        return composed(request, site, robot, answers=answers)


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
