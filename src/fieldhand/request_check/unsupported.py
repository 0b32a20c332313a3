"""Report parts of a request that no plan can express, such as past days, and times that this one does not.

They are recognized by words alone; names of the site ("the Sunday block") do not count.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from fieldhand.language import message
from fieldhand.places.earlier.period import Period
from fieldhand.request_check import words as w
from fieldhand.request_check.earlier import states
from fieldhand.request_check.mismatch import PlanMismatch
from fieldhand.request_check.others_work import work_of_others
from fieldhand.request_check.request_facts import RequestFacts

_PARTS = "morning|afternoon|evening|night|midnight|noon|midday|lunch|lunchtime|dawn|dusk|sunrise|sunset|nightfall"
_UNITS_S = {"minute": 60.0, "hour": 3600.0}
_UNITS = "day|night|week|weekend|fortnight|month|year|season|hour|minute"
_DAYS = "monday|tuesday|wednesday|thursday|friday|saturday|sunday|weekday|weekend|workday"
_MONTHS = "january|february|march|april|may|june|july|august|september|october|november|december"
_SEASONS = "spring|summer|autumn|fall|winter"
_AMOUNT = rf"(?:\d+|{'|'.join((*w.NUMBERS, *w.ORDINALS, 'a', 'an', 'few', 'couple of', 'other', 'single', 'second'))})"

_SCHEDULES = (
    rf"(?:every|each|any|per) (?:{_AMOUNT} )?(?:{_PARTS}|{_UNITS}|{_DAYS})s?",
    rf"(?:once|twice|thrice|{_AMOUNT} times|times) (?:a|an|per|every|each) (?:{_UNITS})",
    r"daily|hourly|nightly|weekly|fortnightly|monthly|yearly|annually|overnight|regularly|periodically|from now on",
    rf"(?:tomorrow|tonight)(?: (?:{_PARTS}))?",
    rf"(?:this|next) (?:(?:{_PARTS}|week|weekend|month|year|season)(?! to\b)|{_DAYS})|next time(?! to\b)",
    rf"(?:in|during|until|till) the (?:{_PARTS})s?",
    rf"(?:at|by|before|after|until|till|around|from|since|towards?) (?:the )?(?:{_PARTS}|dark|daylight|daybreak)",
    rf"(?:on|every|next|each|only|until|by|from) (?:the )?(?:{_DAYS})s?|(?:{_DAYS})s",
    rf"in (?:the )?(?:{_MONTHS}|{_SEASONS})",
    r"\d{1,2}(?: : \d\d)? (?:am|pm|a \. m|p \. m|o'clock)|(?:at|by|before|after|until|till|from) \d{1,2} : \d\d",
    r"(?:at|by|before|until|till|after) \w+ o'clock",
    rf"in {_AMOUNT} (?:days?|weeks?|months?)|{_AMOUNT} (?:minutes?|hours?|days?|weeks?) (?:from now|later)",
)
_WORKED = (
    "done|visited|measured|photographed|pictured|imaged|sampled|covered|checked|sprayed|mowed|mown|inspected|scouted"
)
_MISSIONS = "mission|run|round|trip|survey|visit|outing|flight|inspection"
_PAST = (
    rf"yesterday(?: (?:{_PARTS}))?|(?:last|previous) (?:{_PARTS}|{_DAYS}|week|month|year|time|season|{_MISSIONS})",
    rf"(?:last|past|previous) {_AMOUNT} (?:hours?|days?|weeks?|months?|years?|(?:{_MISSIONS})s?)",
    rf"since (?:last )?(?:{_DAYS}|{_MONTHS})",
    rf"{_AMOUNT} (?:hours?|days?|weeks?|months?) ago|earlier today",
)


def _pattern(forms: tuple[str, ...]) -> re.Pattern[str]:
    return re.compile(rf"(?<!\S)(?:{'|'.join(forms)})(?!\S)")


_WITHOUT = message("no place of the plan depends on that")
_KINDS = (
    (_pattern(_SCHEDULES), message("the plan says nothing of it, or another time")),
    (_pattern(_PAST), _WITHOUT),
)
#: References to earlier work, which demand places that depend on it.
_DONE = _pattern(
    (
        rf"already (?:been )?(?:{_WORKED})|(?:have|has|had) (?:not|never) been (?:{_WORKED})",
        rf"never (?:been )?(?:{_WORKED})",
        rf"(?:not|never) (?:yet )?(?:{_WORKED}) yet",
    )
)
#: Times at which a mission may be to start anyway, if they are all that a request says of time.
_START = _pattern((r"this (?:morning|afternoon|evening)", r"(?:before|after|by) (?:lunch|lunchtime)"))
#: A period in which something is, and the beginning of a clause that says so ("the aphids are bad this year").
_NOW = _pattern((r"this (?:week|month|year|season)",))
_STATES = re.compile(r"(?:because )?(?:the|our|my|it|they|there|these|those)\b.*\b(?:is|are|was|were|looks?|seems?)\b")
#: Words for other times, which leave open what a time is the time of.
_OTHER_TIMES = frozenset({"again", "later", "now", "then", "afterwards"})
#: Words between which and a time something earlier is told of.
_OF_EARLIER = frozenset({"from", "of", "since", "until"})
#: Words with which a reason begins that may tell of the past ("because we did that row yesterday").
_REASON = _pattern((r"because", r"since (?:we|i|it|they|he|she|the|my|our|row|tree)"))
#: What tells that something was done: the beginning of a sentence ("I photographed row 1 yesterday"), and words before
#: a time ("rows 1 and 2 were done this morning"), which describe no places ("that were done").
_DID = re.compile(
    r"(?:i|we|they|he|she|somebody|someone)(?:'ve|'s)?(?: have| has| had| already| just)* (?:did|done|\w+ed)\b"
)
_WAS_DONE = re.compile(
    r"(?<!that )(?<!which )(?<!who )(?<!where )(?<!whatever )(?<!what )(?<!those )(?<!\S)(?:is|are|was|were|been|got)"
    rf"(?: already| all)* (?:{_WORKED}|finished|completed)(?: already| earlier)?$"
)


def unsupported_words(
    facts: RequestFacts,
    periods: Collection[Period] = (),
    waits: frozenset[float] = frozenset(),
    *,
    by_records: bool = False,
) -> Iterator[PlanMismatch]:
    """Yield a contradiction for each part of the request that no plan can express, and for times that it lacks.

    Args:
        facts: Facts of the request, without the times and periods that the plan holds.
        periods: Periods of earlier missions that the plan holds.
        waits: Seconds of the waits of the plan, by which it may repeat something ("every ten minutes, six times").
        by_records: True if the plan selects places by what earlier missions, or this one so far, did.
    """
    starts: dict[int, int] = {}
    at = 0
    for k, token in enumerate(facts.tokens):
        starts[at] = k
        at += len(token.text) + 1
    kinds = _KINDS if by_records else (*_KINDS, (_DONE, _WITHOUT))
    for pattern, why in kinds:
        for match in pattern.finditer(facts.text):
            first = starts[match.start()]
            sentence = facts.tokens[first].sentence
            past = why is _WITHOUT  # harmless in a sentence without a request ("We had a leak last week.")
            remark = past and not any(facts.tokens[k].sentence == sentence for k in facts.nouns)
            speed = first and facts.tokens[first - 1].text in w.LENGTHS and match[0].startswith(("per ", "a ", "an "))
            told = _is_told(match, facts, sentence, first, last := first + len(match[0].split()), past=past)
            own = pattern is not _DONE and not facts.named.isdisjoint(range(first, last))
            held = any(states(match[0], period) for period in periods)
            stated = [one for one in facts.amounts if first - 1 <= one.index < last and one.kind == "time"]
            rests = any(waits & {*one.values} for one in stated) or bool(
                waits & {_UNITS_S.get(word) for word in match[0].split()}
            )
            if not (told or remark or speed or own or held or rests):
                words = w.quoted(facts.tokens[first:last])
                yield PlanMismatch(
                    kind="unheld", what=message("the request says '{words}', and {why}", words=words, why=why)
                )


def _is_told(match: re.Match[str], facts: RequestFacts, sentence: int, first: int, last: int, *, past: bool) -> bool:
    """Return True for a time that asks for nothing: past and in a reason, or the start of the whole mission."""
    said = [k for k, token in enumerate(facts.tokens) if token.sentence == sentence]
    before, after = (
        [facts.tokens[k].text for k in said if k < first],
        [facts.tokens[k].text for k in said if k >= last],
    )
    if _WAS_DONE.search(" ".join(before)) is not None:
        return True
    if said and first - said[0] in work_of_others([facts.tokens[k].text for k in said]):
        return True
    clause = " ".join(before).rpartition(" , ")[2]
    if _NOW.fullmatch(match[0]) is not None and _STATES.match(clause) is not None:
        return not [text for text in after if text not in (".", "!", ",")]
    if past:
        told = " ".join(before)
        return _REASON.search(told) is not None or _DID.match(f"{told} {match[0]}".strip()) is not None
    if _START.fullmatch(match[0]) is None or len(_START.findall(facts.text)) > 1:
        return False
    other = _OTHER_TIMES & {*before, *after} or _OF_EARLIER & {*before[-1:]}
    return not other and (not before or not [text for text in after if text not in (".", "!", ",", "please", "thanks")])
