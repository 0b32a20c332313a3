"""Ask whether a clause that is not understood may be left out, where everything else of a request can be planned."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from itertools import islice

from fieldhand.language import joined, message
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.ambiguity import chosen_answer
from fieldhand.planning.grammar.english import ENGLISH
from fieldhand.planning.grammar.planned import NAME
from fieldhand.planning.grammar.remarks import RESTRICTING
from fieldhand.planning.grammar.words import edges_of
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Reason, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import Span
from fieldhand.wording.steps import write_lines

#: Plans the request without the words of a range.
PlanWithout = Callable[[Span], Outcome]

#: Maximum number of clauses that are tried, and of words of a request in which they are sought.
_MOST_TRIES, _MOST_WORDS = 6, 150
#: Words with which a clause begins that stands beside a command.
_SUBORDINATING = frozenset({"after", "as", "because", "before", "once", "since", "so", "though", "although", "while"})
_ASKING = frozenset({"how", "what", "which", "who", "why"})
#: Words that join a clause to what stands before it.
_JOINING = frozenset({"and", "but", "so"})
#: Categories of the words with which a statement begins.
_SUBJECTS = frozenset({"DET", "IMPERSONAL", "OWNER", "PEOPLE", "POINTING", "TELLS"})
#: Categories of the verbs of statements.
_VERBS = frozenset({"AUXILIARY", "IS", "STATES"})
#: Categories of the verbs of commands.
_COMMANDS = frozenset({"ACTV", "GO", "GOHOME", "MEASURE", "REPEAT", "RETURN", "STOP", "TAKE", "USE", "VISIT"})


def asked_to_leave_out(
    request: str,
    refused: Refused,
    plan: PlanWithout,
    answers: Sequence[Answer],
    site: Site,
    robot: RobotProfile,
) -> Outcome:
    """Return the question whether a clause may be left out, what its answer leads to, or the refusal as it is.

    Only a clause that tells something is asked about: one with a command, a condition, a limit or a prohibition is
    never left out, and neither is one that the robot or the site makes impossible.

    Args:
        request: Request as typed.
        refused: Its refusal.
        plan: Plans the request without the words of a range.
        answers: Answers to questions about the request.
        site, robot: Site and robot of the mission.
    """
    if any(reason.final for reason in refused.reasons):
        return refused
    words = ENGLISH.words_of(request)
    if len(words) > _MOST_WORDS:
        return refused
    stuck = sorted({k for reason in refused.reasons for k in _numbers(reason, words)})
    for clause in islice(_clauses_with(stuck, words, site, robot), _MOST_TRIES):
        span = (words[clause[0]].start, words[clause[-1]].end)
        outcome = plan(span)
        if isinstance(outcome, Refused):
            continue
        told = _stated(clause, words)
        question = message(
            "'{said}' is not understood. May it be left out?",
            context="question",
            said=request[words[told[0]].start : words[told[-1]].end],
        )
        choices = (_without(outcome, site, robot),)
        given = next((answer for answer in answers if answer.question == question), None)
        if given is None or chosen_answer(given.answer, choices) is None:
            return Clarify(question=question, choices=choices, planner=NAME, otherwise=refused)
        return _told(outcome, given) if isinstance(outcome, Planned) else outcome
    return refused


def _told(planned: Planned, given: Answer) -> Planned:
    """Return a plan that states the answer which allowed to leave words out."""
    command = planned.task.command
    command = replace(command, assumptions=(given.sentence(), *command.assumptions))
    return replace(planned, task=replace(planned.task, command=command))


def _numbers(reason: Reason, words: Sequence[Word]) -> Sequence[int]:
    """Return the numbers of the unknown words that a reason is about, or of the word at which reading stopped."""
    found = [k for k, word in enumerate(words) if any(s < word.end and word.start < e for s, e in reason.said)]
    return found if reason.unknown else found[:1]


def _without(outcome: Outcome, site: Site, robot: RobotProfile) -> str:
    """Return the answer that leaves a clause out, with the steps that are left."""
    if not isinstance(outcome, Planned):
        return message("Leave it out.")
    steps = joined(" ", [line.text for line in write_lines(outcome.task, site, robot, {})])
    return message("Leave it out: {steps}", steps=steps)


def _clauses_with(
    stuck: Sequence[int], words: Sequence[Word], site: Site, robot: RobotProfile
) -> Iterator[Sequence[int]]:
    """Yield the clauses that contain all words which are not understood and only tell something, shortest first.

    Each is given with the comma and the conjunction that join it to the rest.
    """
    if not stuck:
        return
    kinds: list[set[str]] = [set() for _ in words]
    for edge in edges_of(words, ENGLISH.phrases(robot, site), tells=True):
        for k in range(edge.start, edge.end):
            kinds[k].add(edge.category)
    found = {
        (start, end)
        for start in _beginnings(words)
        if start <= stuck[0]
        for end in _ends(words, start)
        if end > stuck[0] and end - start < len(words)
    }
    for start, end in sorted(found, key=lambda one: one[1] - one[0]):
        # An unknown word is the place at which reading stopped; known words behind it may be read without the clause.
        unknown = [k for k in stuck if not kinds[k]]
        if all(start <= k < end for k in unknown) and _only_tells(range(start, end), words, kinds):
            yield range(start, end)


def _beginnings(words: Sequence[Word]) -> Iterator[int]:
    """Yield the numbers of the words with which a clause may begin, a comma or conjunction before it included."""
    for k, word in enumerate(words):
        if k == 0 or words[k - 1].kind == "stop" or word.kind == "comma" or word.norm in _JOINING | _SUBORDINATING:
            yield k


def _ends(words: Sequence[Word], start: int) -> Iterator[int]:
    """Yield the numbers behind the last words with which a clause may end: at a comma, or with its sentence."""
    opens = start == 0 or words[start - 1].kind == "stop"
    for k in range(start + 1, len(words)):
        if words[k].kind == "stop":
            yield k + 1 if opens else k
            return
        if words[k].kind == "comma":
            yield k + 1 if opens else k
    yield len(words)


def _stated(clause: Sequence[int], words: Sequence[Word]) -> Sequence[int]:
    """Return a clause without what joins it to the rest."""
    begin, end = 0, len(clause)
    while begin < end - 1 and (words[clause[begin]].kind == "comma" or words[clause[begin]].norm in ("and", "but")):
        begin += 1
    while end > begin + 1 and words[clause[end - 1]].kind in ("comma", "stop"):
        end -= 1
    return clause[begin:end]


def _only_tells(clause: Sequence[int], words: Sequence[Word], kinds: Sequence[AbstractSet[str]]) -> bool:
    """Return True for a clause that tells or asks something, and neither commands, restricts nor forbids anything."""
    said = _stated(clause, words)
    if len(said) < 3:
        return False
    first, *others = said
    subordinate = words[first].norm in _SUBORDINATING
    for k in others if subordinate else said:
        if kinds[k] & RESTRICTING or words[k].kind in ("number", "rank", "unit") or words[k].norm.endswith("n't"):
            return False
    if subordinate:
        subject, *rest = (kinds[k] for k in others)
        verb = any(one & (_VERBS | _COMMANDS) for one in rest) or ("DET" not in subject and not rest[0])
        return bool(subject & _SUBJECTS) and verb  # "before the flurb" names a place
    if not _is_sentence(clause, words) or any(kinds[k] & _COMMANDS and not kinds[k] & _VERBS for k in said):
        return False  # beside a command, words without a conjunction may be an item of its list
    states = bool(kinds[first]) and any(kinds[k] & _VERBS for k in others[:3])
    return states or words[first].norm in _ASKING or bool(kinds[first] & _SUBJECTS)


def _is_sentence(clause: Sequence[int], words: Sequence[Word]) -> bool:
    """Return True for a clause that is a sentence by itself."""
    begins = clause[0] == 0 or words[clause[0] - 1].kind == "stop"
    return begins and (clause[-1] == len(words) - 1 or words[clause[-1]].kind == "stop")
