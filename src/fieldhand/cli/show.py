"""Output of results to the terminal and as JSON; text from outside is never interpreted as markup."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from rich.text import Text

from fieldhand.cli.console import Words
from fieldhand.cli.console import err as err
from fieldhand.cli.console import out as out
from fieldhand.hidden_characters import json_text, visible
from fieldhand.language import ENGLISH, Language, joined, message
from fieldhand.language.words import say_count, say_place
from fieldhand.planning.planner import Clarify, Planned, Reason, Refused
from fieldhand.task.request_coverage import ROLE_NAMES, Piece, WordRole, has_ranges, request_pieces

if TYPE_CHECKING:
    from fieldhand.mission import Assessment, Review
    from fieldhand.site.model import Place
    from fieldhand.task.frames import Task
    from fieldhand.task.results import Ended


#: Styles of words by their role, which differ in brightness and form, too, not only in red and green.
WORDS: dict[WordRole, str] = {
    "action": "bold blue",
    "place": "cyan",
    "condition": "yellow",
    "limit": "magenta",
    "order": "italic",
    "end": "bold",
    "time": "bold magenta",
    "no_part": "dim",
    "nothing": "bold reverse",
}
MARK = {"success": ("✓", "green"), "failure": ("✗", "red"), "indeterminate": ("?", "yellow")}


def heading(text: str) -> None:
    """Print a heading after an empty line."""
    out.print()
    out.print(Words(text, style="bold"))


def note(text: str, language: Language = ENGLISH) -> None:
    """Print a note on standard error, apart from the results."""
    err.print(Words(language.say(message("note: ")), style="yellow") + Words(language.say(text)))


def print_json(value: Any) -> None:
    """Print a JSON value on standard output."""
    sys.stdout.write(json_text(value, indent=2) + "\n")


def fail_outcome(request: str, outcome: Clarify | Refused, language: Language = ENGLISH) -> NoReturn:
    """Print the refusal or the question of a planner, and end the program with status 2."""
    if isinstance(outcome, Clarify):
        show_question(outcome, language)
        err.print(language.say(message("Write it in the request and plan again, or give --answer.")))
        raise SystemExit(2)
    spans = [span for reason in outcome.reasons for span in reason.said]
    if spans:
        err.print(underlined(request, spans))
    for reason in outcome.reasons:
        err.print(Words("fieldhand: ", style="bold") + Words(sentence(reason, language)))
    if outcome.understood:
        parts = message("understood: {parts}", parts=joined("; ", outcome.understood))
        err.print(Words(language.say(parts), style="dim"))
    if outcome.example:
        err.print(Words(language.say(message("can be planned: '{example}'", example=outcome.example))))
    raise SystemExit(2)


def show_question(asked: Clarify, language: Language = ENGLISH) -> None:
    """Print a question with its choices and their places."""
    say = language.say
    err.print(Words(say(message("A question first: ")), style="bold") + Words(say(asked.question)))
    led = asked.places or tuple(() for _ in asked.choices)
    for number, (choice, places) in enumerate(zip(asked.choices, led, strict=True), start=1):
        err.print(Words(f"  {number}. {say(choice)}") + Words(_where(places, say), style="dim"))


def _where(places: Sequence[Place], say: Callable[[str], str]) -> str:
    """Return the places of a choice in a few words."""
    if not places:
        return ""
    if len(places) == 1:
        return f" ({say(say_place(places[0].kind, places[0].id))})"
    trees = all(place.kind == "tree" for place in places)
    return f" ({say(say_count(len(places), 'tree' if trees else 'place'))})"


def sentence(reason: Reason, language: Language = ENGLISH) -> str:
    """Return a reason with its advice as one line."""
    return language.say(reason.what) + (f"; {language.say(reason.advice)}" if reason.advice else "")


def underlined(request: str, spans: Sequence[tuple[int, int]]) -> Text:
    """Return the request with the words in question in red and underlined."""
    text = Words(request)
    for start, end in spans:
        text.stylize("bold underline red", start, end)
    return text


def outcome_record(outcome: Planned | Clarify | Refused) -> dict[str, Any]:
    """Return the outcome of a planner as JSON."""
    match outcome:
        case Planned():
            return {"outcome": "planned", "planner": outcome.planner}
        case Clarify():
            places = [[place.id for place in one] for one in outcome.places]
            return {
                "outcome": "clarify", "question": outcome.question, "choices": list(outcome.choices), "places": places,
            }  # fmt: skip
        case Refused():
            reasons = [{"what": r.what, "said": r.said, "advice": r.advice} for r in outcome.reasons]
            return {
                "outcome": "refused", "reasons": reasons, "understood": list(outcome.understood),
                "example": outcome.example,
            }  # fmt: skip


def review_record(review: Review, language: Language = ENGLISH, *, every: bool = False) -> dict[str, Any]:
    """Return a review as JSON in a language; with ``every``, the figures of all branches are included."""
    words = review.read_back
    return {
        "task": review.task.id,
        "language": language.code,
        "problems": [
            {
                "severity": p.severity,
                "node": p.node,
                "where": language.say(p.where),
                "words": p.words,
                "place": language.say(p.place),
                "what": language.say(p.what),
                "advice": language.say(p.advice),
            }
            for p in review.problems
        ],
        "warnings": list(language.read(review.warnings)),
        "read_back": [] if words is None else list(language.read(words.text_lines())),
        "estimate": None if review.estimate is None else review.estimate.as_record(every=every),
    }


def mission_record(
    task: Task, planner: str, ended: Ended | None, assessment: Assessment, files: Sequence[Path]
) -> dict[str, Any]:
    """Return the result of a mission as JSON."""
    return {
        "task": task.id,
        "planner": planner,
        "status": assessment.status,
        "reason": assessment.reason,
        "success": assessment.success,
        "travelled_m": None if ended is None else ended.travelled_m,
        "seconds": None if ended is None else ended.t,
        "charge_percent": None if ended is None else ended.charge_percent,
        "exceeded": [asdict(one) for one in assessment.exceeded],
        "goals": [asdict(outcome) for outcome in assessment.outcomes],
        "files": [str(path) for path in files],
    }


def show_request(task: Task, language: Language = ENGLISH) -> None:
    """Print the request with the role of its words: in colour, else as a list."""
    pieces = [piece for piece in request_pieces(task) if piece.text.strip()]
    if not pieces:
        return
    heading(language.say(message("The request")))
    coloured = has_ranges(task) and out.color_system is not None and not out.no_color
    request = Text()
    for piece in request_pieces(task) if coloured else [Piece(text=task.command.request, role="between")]:
        request.append(visible(piece.text, lines=True).expandtabs(4), style=WORDS.get(piece.role, ""))
    with out.behind():
        for line in request.split("\n"):
            out.print(Text("  ") + line)
    if coloured:
        used = [role for role in WORDS if any(piece.role == role for piece in pieces)]
        out.print(
            Text("  ") + Text("  ").join(Words(language.say(ROLE_NAMES[role]), style=WORDS[role]) for role in used)
        )
    elif has_ranges(task):
        named = [
            f"{language.say(ROLE_NAMES[p.role])}: {' '.join(p.text.split())}" for p in pieces if p.role in ROLE_NAMES
        ]
        out.print(f"  ({'; '.join(named)})")


def show_review(review: Review, language: Language = ENGLISH, *, usual: bool = True) -> None:
    """Print the request, the plan in words, and every problem on its own line.

    Args:
        review: The review.
        language: Language of the output.
        usual: Print the limits and exits, too, that all Tasks have by default.
    """
    show_request(review.task, language)
    if review.read_back is not None:
        heading(language.say(message("What will be done")))
        with out.behind():
            for line in language.read(review.read_back.text_lines(usual=usual)):
                out.print(line)
    show_problems(review, language)


def show_problems(review: Review, language: Language = ENGLISH) -> None:
    """Print every problem on its own line, errors first."""
    if review.problems:
        heading(language.say(message("Problems")))
    for problem in sorted(review.problems, key=lambda p: p.severity != "error"):
        style = "red" if problem.severity == "error" else "yellow"
        kind = message("error: ") if problem.severity == "error" else message("warning: ")
        with out.behind():
            out.print(Words(language.say(kind), style=style) + Words(language.say(problem.line())))


def show_outcomes(assessment: Assessment, name: Callable[[str], str], language: Language = ENGLISH) -> None:
    """Print the outcome of each goal, and each exceeded limit; ``name`` returns the words for a goal's id."""
    say = language.say
    heading(say(message("Result")))
    for outcome in assessment.outcomes:
        mark, style = MARK[outcome.outcome]
        out.print(Words(f"  {mark} ", style=style) + Words(f"{say(name(outcome.goal))}: {say(outcome.why)}"))
    for one in assessment.exceeded:
        mark, style = MARK["failure"]
        out.print(Words(f"  {mark} ", style=style) + Words(say(one.why)))
