"""The English planner: words, terms, parts, plan. No model, no network; what it does not understand it says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.errors import RequestError
from fieldhand.language import Number, message
from fieldhand.planning.english.lexicon import lexicon_for
from fieldhand.planning.english.missing_blocks import missing_blocks
from fieldhand.planning.english.tokens import Word, words_of
from fieldhand.planning.english.watching_over import watched_over
from fieldhand.planning.english.wishes import Wish, early_wishes
from fieldhand.planning.grammar.planned import NAME
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.request_check.others_work import work_of_others
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.codec_text import hidden_character
from fieldhand.task.plan import Span, Wait, walk
from fieldhand.task.timing import Schedule

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
        if isinstance(outcome, Planned) and (said := watched_over(words_of(request))) and not _recurs(outcome):
            how_often = message(
                "'{said}': how often, and until when? Say it so: 'every 30 minutes from 9 to 12'.", said=said
            )
            return Clarify(question=how_often, planner=NAME)
        if not isinstance(outcome, Refused) or not self._suggests:
            return outcome
        from fieldhand.planning.refusals.same_as_earlier import asked_what_was_done

        if (asked := asked_what_was_done(request, outcome, robot)) is not None:
            return asked
        from fieldhand.planning.refusals.helping import helpful
        from fieldhand.planning.refusals.leaving_out import asked_to_leave_out
        from fieldhand.planning.refusals.understood import parse_parts

        refused = helpful(outcome, parse_parts(request, site, robot), lambda text: self._plain(text, site, robot))
        once = {reason.what: reason for reason in reversed(refused.reasons)}
        refused = replace(refused, reasons=tuple(reversed(once.values())))
        return asked_to_leave_out(
            request, refused, lambda told: self._plain(request, site, robot, answers, (told,)), answers, site, robot
        )

    def _plain(
        self,
        request: str,
        site: Site,
        robot: RobotProfile,
        answers: tuple[Answer, ...] = (),
        told: tuple[Span, ...] = (),
    ) -> Outcome:
        """Plan a request, without the words in some ranges, and without help if it is refused."""
        check_request(request)
        told = (*told, *_of_others(words_of(request)))
        words = [word for word in words_of(request) if not any(s <= word.start and word.end <= e for s, e in told)]
        earlier = _earlier(words, site, robot)
        if (timed := self._timed(request, words, site, robot, answers, told)) is not None:
            return timed
        if found := _unplanned(early_wishes(words, lexicon_for(robot, site)), words, robot, earlier):
            from fieldhand.planning.refusals.helping import wish_reasons

            wishes = _without_known_times(found, words, earlier)
            return Refused(reasons=tuple(wish_reasons(wishes, request, words, site, robot)), planner=NAME)
        if missing := tuple(missing_blocks(words, site)):
            return Refused(reasons=missing, planner=NAME)
        from fieldhand.planning.grammar.reader import composed

        return composed(request, site, robot, answers=answers, words=words if told else None, told=told)

    def _timed(
        self,
        request: str,
        words: Sequence[Word],
        site: Site,
        robot: RobotProfile,
        answers: tuple[Answer, ...],
        told: tuple[Span, ...],
    ) -> Outcome | None:
        """Plan a request that says when the mission runs; None if it says no such time."""
        from fieldhand.planning.grammar.reader import composed
        from fieldhand.planning.grammar.times import (
            asked_time,
            assumed_times,
            warned_times,
            with_answers,
            without_times,
        )

        times = without_times(words, _earlier(words, site, robot))
        if times is None:
            return None
        earlier = _earlier(times.words, site, robot)
        if _unplanned(early_wishes(times.words, lexicon_for(robot, site)), times.words, robot, earlier) or tuple(
            missing_blocks(times.words, site)
        ):
            return None
        open_rhythm = times.part.repeats and not times.part.says_how_often and bool(watched_over(words))
        said_part = replace(times.part, vague=times.part.vague or open_rhythm)
        part, given = with_answers(said_part, answers)
        asked = asked_time(part)
        provisional = part if asked is None else asked.choices[0][1]
        timing = provisional.timing(times.said, zone="")
        if timing is None:
            return None
        settled = times.said if times.part.disputed and asked is None else ()
        outcome = composed(
            request, site, robot, answers=answers, words=times.words, timing=timing, corrected=settled, told=told
        )
        if not isinstance(outcome, Planned):
            return outcome
        if times.beside_any(outcome.task.command.no_part):  # "the crew arrives at 7 am" is told of the crew
            return None
        steps = tuple(walk(outcome.task.composition.plan))
        if part.awaits and not any(step.act is not None or step.work is not None for step in steps):
            return None  # "wait there until 6 pm and come back"
        if _waits_longer_than_interval(outcome):
            return None  # "wait an hour there and read CO2 every ten minutes" is one mission
        if asked is not None:
            choices = tuple(said for said, _ in asked.choices)
            return Clarify(question=asked.question, choices=choices, planner=NAME, free=True)
        assumed, warned = assumed_times(part), warned_times(part)
        if not given and not assumed and not warned:
            return outcome
        command = outcome.task.command
        said = (*(answer.sentence() for answer in given), *assumed)
        warnings = (*command.warnings, *warned)
        stated = replace(command, assumptions=(*said, *command.assumptions), warnings=warnings)
        return replace(outcome, task=replace(outcome.task, command=stated))


def _of_others(words: Sequence[Word]) -> tuple[Span, ...]:
    """Return the character ranges of what somebody else does with the rest ("I'll do the rest on Friday")."""
    found: list[Span] = []
    begin = 0
    for end in (*(k for k, word in enumerate(words) if word.kind == "stop"), len(words)):
        told = work_of_others(["," if word.kind == "comma" else word.norm for word in words[begin:end]])
        if told and len(told) + 1 < len(words):
            found.append((words[begin + told[0]].start, words[begin + told[-1]].end))
        begin = end + 1
    return tuple(found)


def _waits_longer_than_interval(planned: Planned) -> bool:
    """Return True for runs so close that the waits of one last until the next."""
    schedule = planned.task.timing
    if not isinstance(schedule, Schedule) or not schedule.every_min:
        return False
    waits = sum(node.seconds for node in walk(planned.task.composition.plan) if isinstance(node, Wait))
    return waits >= 60.0 * schedule.every_min


def _recurs(planned: Planned) -> bool:
    """Return True for a mission that runs again and again, or waits between what it does."""
    waits = any(isinstance(node, Wait) for node in walk(planned.task.composition.plan))
    return waits or isinstance(planned.task.timing, Schedule)


def _earlier(words: Sequence[Word], site: Site, robot: RobotProfile) -> frozenset[int]:
    """Return the numbers of the words that state a time of earlier missions, or when plants were sown."""
    from fieldhand.planning.grammar.earlier.past_words import past_words
    from fieldhand.planning.grammar.english import camera_of
    from fieldhand.planning.grammar.planting_words import planting_words

    return past_words(words, lexicon_for(robot, site), camera_of(robot)) | planting_words(words, site)


def _without_known_times(found: Sequence[Wish], words: Sequence[Word], earlier: frozenset[int]) -> Sequence[Wish]:
    """Return wishes without the times that could be planned: "turn the hay this afternoon" lacks an action only."""
    from fieldhand.planning.grammar.times import without_times

    times = without_times(words, earlier)
    said = () if times is None or times.timing("") is None else times.said
    rest = []
    for wish in found:
        first, last = wish.span(words)
        if not wish.kind.now and not any(start <= first and last <= end for start, end in said):
            rest.append(wish)
    return rest or found


def _unplanned(
    wished: Sequence[Wish], words: Sequence[Word], robot: RobotProfile, earlier: frozenset[int]
) -> list[Wish]:
    """Return wishes without those that are of earlier missions, that an event of the robot explains, and to wait.

    A wait in a sentence about an event is one of those that the event explains.
    """
    wished = [wish for wish in wished if not {*range(wish.first, wish.last)} <= earlier]
    if not wished or not robot.events:
        return list(wished)
    from fieldhand.planning.grammar.event_words import EventPatterns, in_event_sentences

    about = in_event_sentences(words, robot)
    named = {k for one in EventPatterns.of(robot).mentions(words) for k in range(one.start, one.end)}
    return [wish for wish in wished if not {*range(wish.first, wish.last)} <= (about if wish.kind.waits else named)]


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
