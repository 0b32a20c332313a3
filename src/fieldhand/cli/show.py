"""How results look in a terminal. Text that came from outside is never read as markup."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from rich.console import Console
from rich.text import Text

from fieldhand.language import ENGLISH, Language, message
from fieldhand.planning.planner import Clarify, Planned, Reason, Refused
from fieldhand.task.account import NAMES, Role, account, has_ranges

if TYPE_CHECKING:
    from fieldhand.mission import Review
    from fieldhand.site.model import Place
    from fieldhand.task.frames import Task
    from fieldhand.task.results import Ended, GoalOutcome


class _Terminal(Console):
    """A console that nobody may be reading any more: that is no reason to end a mission."""

    def on_broken_pipe(self) -> None:
        self.quiet = True
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


out = _Terminal(highlight=False, markup=False, soft_wrap=True)
err = _Terminal(stderr=True, highlight=False, markup=False, soft_wrap=True)

#: How words look by what became of them: told apart by brightness and form, too, not by red and green.
WORDS: dict[Role, str] = {
    "action": "bold blue",
    "place": "cyan",
    "condition": "yellow",
    "limit": "magenta",
    "order": "italic",
    "end": "bold",
    "no_part": "dim",
    "nothing": "bold reverse",
}
MARK = {"success": ("✓", "green"), "failure": ("✗", "red"), "indeterminate": ("?", "yellow")}


def heading(text: str) -> None:
    """A heading with an empty line before it."""
    out.print()
    out.print(Text(text, style="bold"))


def note(text: str) -> None:
    """Something that the user should know, on standard error so that it never mixes with results."""
    err.print(Text("note: ", style="yellow") + Text(text))


def print_json(value: Any) -> None:
    """One JSON object on standard output."""
    sys.stdout.write(json.dumps(value, ensure_ascii=False, indent=2, default=str) + "\n")


def fail_outcome(request: str, outcome: Clarify | Refused) -> NoReturn:
    """Say what was not understood or what is asked back, and end the program with status 2."""
    if isinstance(outcome, Clarify):
        show_question(outcome)
        err.print("Say it in the request and plan again, or give --answer.")
        raise SystemExit(2)
    spans = [span for reason in outcome.reasons for span in reason.said]
    if spans:
        err.print(underlined(request, spans))
    for reason in outcome.reasons:
        err.print(Text("fieldhand: ", style="bold") + Text(sentence(reason)))
    raise SystemExit(2)


def show_question(asked: Clarify) -> None:
    """A question with its choices, and where each of them leads."""
    err.print(Text("A question first: ", style="bold") + Text(asked.question))
    led = asked.places or tuple(() for _ in asked.choices)
    for number, (choice, places) in enumerate(zip(asked.choices, led, strict=True), start=1):
        err.print(Text(f"  {number}. {choice}") + Text(_where(places), style="dim"))


def _where(places: Sequence[Place]) -> str:
    """Places in a few words, behind a choice."""
    if len(places) == 1:
        return f" ({places[0].kind} {places[0].id})"
    return f" ({len(places)} {'trees' if all(p.kind == 'tree' for p in places) else 'places'})" if places else ""


def sentence(reason: Reason) -> str:
    """A reason with its advice as one line."""
    return reason.what + (f"; {reason.advice}" if reason.advice else "")


def underlined(request: str, spans: Sequence[tuple[int, int]]) -> Text:
    """The request with the words in question in red and underlined."""
    text = Text(request)
    for start, end in spans:
        text.stylize("bold underline red", start, end)
    return text


def outcome_record(outcome: Planned | Clarify | Refused) -> dict[str, Any]:
    """A planner's answer as JSON."""
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
            return {"outcome": "refused", "reasons": reasons}


def review_record(review: Review, language: Language = ENGLISH, *, every: bool = False) -> dict[str, Any]:
    """A review as JSON, its words in that language; ``every``: with the figures of every branch."""
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
    task: Task, planner: str, ended: Ended | None, outcomes: Sequence[GoalOutcome], files: Sequence[Path]
) -> dict[str, Any]:
    """What came of a mission as JSON."""
    return {
        "task": task.id,
        "planner": planner,
        "status": None if ended is None else ended.status,
        "reason": "" if ended is None else ended.reason,
        "travelled_m": None if ended is None else ended.travelled_m,
        "seconds": None if ended is None else ended.t,
        "charge_percent": None if ended is None else ended.charge_percent,
        "goals": [asdict(outcome) for outcome in outcomes],
        "files": [str(path) for path in files],
    }


def show_request(task: Task, language: Language = ENGLISH) -> None:
    """The request with what became of its words: in colour, or else word by word behind it."""
    pieces = [piece for piece in account(task) if piece.text.strip()]
    if not pieces:
        return
    heading(language.say(message("The request")))
    if not has_ranges(task):
        out.print(Text(f"  {task.command.request}"))
        return
    if out.color_system is None or out.no_color:
        out.print(Text(f"  {task.command.request}"))
        named = [f"{language.say(NAMES[p.role])}: {p.text.strip()}" for p in pieces if p.role in NAMES]
        out.print(Text(f"  ({'; '.join(named)})"))
        return
    coloured = Text("  ")
    for piece in account(task):
        coloured.append(piece.text, style=WORDS.get(piece.role, ""))
    out.print(coloured)
    used = [role for role in WORDS if any(piece.role == role for piece in pieces)]
    out.print(Text("  ") + Text("  ").join(Text(language.say(NAMES[role]), style=WORDS[role]) for role in used))


def show_review(review: Review, language: Language = ENGLISH) -> None:
    """The read-back in that language, then every problem on its own line."""
    show_request(review.task, language)
    if review.read_back is not None:
        heading(language.say(message("What will be done")))
        for line in language.read(review.read_back.text_lines()):
            out.print(Text(line))
    show_problems(review, language)


def show_problems(review: Review, language: Language = ENGLISH) -> None:
    """Every problem on its own line, errors first."""
    if review.problems:
        heading(language.say(message("Problems")))
    for problem in sorted(review.problems, key=lambda p: p.severity != "error"):
        style = "red" if problem.severity == "error" else "yellow"
        kind = message("error: ") if problem.severity == "error" else message("warning: ")
        out.print(Text(language.say(kind), style=style) + Text(language.say(problem.line())))


def show_outcomes(outcomes: Sequence[GoalOutcome], name: Callable[[str], str]) -> None:
    """What came of each goal; ``name`` says a goal's id in words."""
    heading("What came of it")
    for outcome in outcomes:
        mark, style = MARK[outcome.outcome]
        out.print(Text(f"  {mark} ", style=style) + Text(f"{name(outcome.goal)}: {outcome.why}"))
