"""Make a refusal helpful: list what cannot be planned, what was understood, and what can be planned instead."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.english.inflection import base_form
from fieldhand.planning.english.lacking import lacked_actions, say_lacking
from fieldhand.planning.english.lexicon import lexicon_for
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.wishes import Wish, wishes
from fieldhand.planning.grammar.event_words import EventPatterns, in_event_sentences
from fieldhand.planning.grammar.refusals import PLAINLY
from fieldhand.planning.grammar.times import without_times
from fieldhand.planning.planner import Reason, Refused
from fieldhand.planning.refusals.examples import PlanRequest, examples, first_planned, tidy
from fieldhand.planning.refusals.offers import say_offers
from fieldhand.planning.refusals.understood import ParsedRequest, say_understood, understood_parts
from fieldhand.planning.refusals.unknown_words import UnknownWords, corrected, reasons_of_unknown
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Signs and words at which a clause ends.
_ENDS = frozenset({"stop", "comma"})
_JOINTS = frozenset({"and", "but", "then", "or"})
#: Words that join nothing once a wish is left out.
_LOOSE = (
    re.compile(r"(?:^|(?<=[.;!?]))(?:\s|,|:|\b(?:and|then|but|or)\b)+", re.IGNORECASE),
    re.compile(r"(?:\s|,|:|\b(?:and|then|but|or)\b)+(?=\s*(?:[.;!?]|$))", re.IGNORECASE),
    re.compile(r",(?=\s*,)"),
)
#: Categories of words with which a further command begins.
_COMMANDS = frozenset({"TAKE", "MEASURE", "ACTV", "GO", "VISIT", "RETURN", "GOHOME"})


def helpful(refused: Refused, parsed: ParsedRequest, plan: PlanRequest) -> Refused:
    """Return a refusal that lists what cannot be planned, what was understood, and what can be planned instead.

    Args:
        refused: Refusal of the request.
        parsed: The request.
        plan: Plans another request on the same site with the same robot.
    """
    words, lexicon = parsed.words, lexicon_for(parsed.robot, parsed.site)
    commands = parsed.begins(_COMMANDS)
    known = _without_times(_besides_events(wishes(words, lexicon), parsed), words)
    early = [wish for wish in known if wish.kind.early]
    reasons = (*refused.reasons, *(_reasons_besides(early, parsed, plan) if early else ()))
    unsettled = {k for reason in reasons if not reason.final for k in _words_in(reason, words)}
    # A reason that says what to do is left as it is, whatever the words look like.
    wished = [wish for wish in known if wish.kind.early or unsettled & _owned(wish, words, commands)]
    owned = {k for wish in wished for k in _owned(wish, words, commands)}
    strange = {k for reason in reasons if reason.unknown for k in _words_in(reason, words)}
    numbers = tuple(sorted(strange - owned - parsed.known()))
    unknown = UnknownWords(numbers=numbers, parsed=parsed, lexicon=lexicon)
    fixed = None if wished else corrected(unknown, plan)
    parts = understood_parts(parsed, {*_blocked(wished, words), *numbers})
    topic = next((wish.kind.offers for wish in known if wish.kind.offers), unknown.topic)
    whole = _whole(reasons, wished, unknown, parsed)
    suggestions = examples(parts, parsed, whole=whole, topic=topic, measured=bool(known))
    example = (fixed.example if fixed is not None else "") or first_planned(suggestions, plan)
    kept = [
        *wish_reasons(wished, parsed.request, words, parsed.site, parsed.robot),
        *(r for r in reasons if not r.unknown and _stands(r, bool(wished), owned, words)),
        *reasons_of_unknown(unknown, fixed),
    ]
    return replace(
        refused,
        reasons=_without_repetitions(kept) or (_not_together(reasons),),
        understood=say_understood(parts, parsed),
        example=_with_reserve(example, wished, plan),
    )


def _without_times(known: Sequence[Wish], words: Sequence[Word]) -> list[Wish]:
    """Return the wishes without those that a plan can express as times of the mission."""
    times = without_times(words)
    if times is None:
        return list(known)

    def is_time(wish: Wish) -> bool:
        start, end = wish.span(words)
        return any(first <= start and end <= last for first, last in times.said)

    return [wish for wish in known if not is_time(wish)]


def _besides_events(wished: Sequence[Wish], parsed: ParsedRequest) -> list[Wish]:
    """Return wishes without those for an event that the robot detects."""
    mentions = list(EventPatterns.of(parsed.robot).mentions(parsed.words))
    about = in_event_sentences(parsed.words, parsed.robot) if mentions else frozenset[int]()
    return [
        wish
        for wish in wished
        if not any(wish.first < one.end and one.start < wish.last for one in mentions)
        and not (wish.kind.waits and about.issuperset(range(wish.first, wish.last)))
    ]


def _whole(reasons: Sequence[Reason], wished: Sequence[Wish], unknown: UnknownWords, parsed: ParsedRequest) -> str:
    """Return the request without its wishes, or with names of the site in place of others; empty if neither helps."""
    renamed = [reason for reason in reasons if reason.instead]
    if renamed:
        return _with_names(renamed, parsed.request)
    alone = wished and not unknown.numbers and all(wish.kind.aside for wish in wished)
    return tidy(_besides(wished, parsed)) if alone else ""


def _with_names(reasons: Sequence[Reason], request: str) -> str:
    """Return a request with names of the site in place of those that the site does not have."""
    for reason in sorted(reasons, key=lambda reason: reason.said, reverse=True):
        start, end = reason.said[0]
        request = request[:start] + reason.instead + request[end:]
    return request


def _not_together(reasons: Sequence[Reason]) -> Reason:
    """Return the reason for a request whose words are all known, if not to the planner that gave the reasons."""
    said = tuple(span for reason in reasons for span in reason.said)
    return Reason(what=message("each word is known, but not what they say together"), said=said, advice=PLAINLY)


def _reasons_besides(early: Sequence[Wish], parsed: ParsedRequest, plan: PlanRequest) -> tuple[Reason, ...]:
    """Return the reasons for which a request would be refused without its early wishes."""
    outcome = plan(_besides(early, parsed))
    reasons = outcome.reasons if isinstance(outcome, Refused) else ()
    return tuple(reason for reason in reasons if reason.unknown or reason.final)


def _besides(wished: Sequence[Wish], parsed: ParsedRequest) -> str:
    """Return a request with spaces in place of wishes and of what joins them to the rest."""
    text = parsed.request
    for wish in wished:
        start, end = wish.span(parsed.words)
        text = text[:start] + " " * (end - start) + text[end:]
    for pattern in _LOOSE:
        text = pattern.sub(lambda match: re.sub(r"\w|[,:]", " ", match[0]), text)
    return text


def _with_reserve(example: str, wished: Sequence[Wish], plan: PlanRequest) -> str:
    """Return an example in the form that a wish suggests: "with at least 50 % battery left, ..."."""
    form = next((wish.kind.example for wish in wished if wish.kind.example), "")
    if not form or not example:
        return example
    return first_planned([form.format(request=example[0].lower() + example[1:]), example], plan)


def wish_reasons(
    wished: Sequence[Wish], request: str, words: Sequence[Word], site: Site, robot: RobotProfile
) -> list[Reason]:
    """Return a reason for each kind of wishes: what it asks for, and what is possible instead.

    Args:
        wished: Wishes of a request.
        request: Request as typed.
        words: Its words.
        site, robot: Site and robot of the mission.
    """
    found: dict[str, tuple[str, list[Wish]]] = {}
    for wish in wished:
        start, end = wish.span(words)
        what = _say_wish(wish, request[start:end], words, robot)
        kind = what if wish.kind.lacks_action else wish.kind.what
        found.setdefault(kind, (what, []))[1].append(wish)
    reasons: list[Reason] = []
    for what, alike in found.values():
        spans = tuple(wish.span(words) for wish in alike)
        first = alike[0]
        reasons.append(
            Reason(
                what=what,
                said=spans,
                advice=first.advise(robot.name, say_offers(first.kind.offers, site, robot)),
                final=True,
            )
        )
    return reasons


def _say_wish(wish: Wish, said: str, words: Sequence[Word], robot: RobotProfile) -> str:
    """Return what the words of a wish ask for, by the action that the robot lacks if they name one."""
    if not wish.kind.lacks_action:
        return wish.say(said, robot.name)
    lacked = next(lacked_actions(words[: wish.last], frozenset(range(wish.first, wish.last)), robot), None)
    if lacked is not None:
        return lacked.say(robot)
    verb = base_form(words[wish.first].norm) if wish.kind.work and wish.last == wish.first + 1 else ""
    return say_lacking(verb, verb, robot) if verb else wish.say(said, robot.name)


def _owned(wish: Wish, words: Sequence[Word], commands: Collection[int]) -> set[int]:
    """Return the numbers of the words that a wish explains: its own, and those of its clause that belong to it."""
    found = set(range(wish.first, wish.last))
    if wish.kind.rest:
        found |= set(range(wish.last, _end_of_clause(wish.last, words)))
    if wish.kind.clause:
        for step, at in ((1, wish.last), (-1, wish.first - 1)):
            while 0 <= at < len(words) and words[at].kind not in _ENDS and at not in commands:
                found.add(at)
                at += step
    return found


def _blocked(wished: Sequence[Wish], words: Sequence[Word]) -> Iterator[int]:
    """Yield the numbers of the words that have no reading by themselves."""
    for wish in wished:
        yield from range(wish.first, _end_of_clause(wish.last, words) if wish.kind.rest else wish.last)


def _end_of_clause(at: int, words: Sequence[Word]) -> int:
    while at < len(words) and words[at].kind not in _ENDS and words[at].norm not in _JOINTS:
        at += 1
    return at


def _words_in(reason: Reason, words: Sequence[Word]) -> Iterator[int]:
    """Yield the numbers of the words that a reason is about."""
    for k, word in enumerate(words):
        if any(start < word.end and word.start < end for start, end in reason.said):
            yield k


def _stands(reason: Reason, wished: bool, owned: Collection[int], words: Sequence[Word]) -> bool:
    """Return True if a reason is independent of the wishes: it concerns other words, and no wording would help."""
    return not wished or (reason.final and not any(k in owned for k in _words_in(reason, words)))


def _without_repetitions(reasons: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return the reasons, each advice once: at the last reason that gives it."""
    later = [reason.advice for reason in reasons]
    return tuple(
        replace(reason, advice="") if reason.advice in later[k + 1 :] else reason for k, reason in enumerate(reasons)
    )
