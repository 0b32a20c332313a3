"""Responses of the API about a plan: words, problems, forecast and map."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from fieldhand.api.maps import choices_map, plan_map, site_map
from fieldhand.language import ENGLISH, Language, message
from fieldhand.mission import Review
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.planning.planner import Clarify, Refused
from fieldhand.task.frames import Task
from fieldhand.task.request_coverage import ROLE_NAMES, has_ranges, request_pieces


def unplanned_answer(
    outcome: Clarify | Refused, site_and_robot: SiteAndRobot, language: Language = ENGLISH
) -> dict[str, Any]:
    """Return the response of a question, with the places of its choices, or of a refusal.

    A question and its choices stay English, since they are sent back as an answer; ``shown`` has them in the language.
    """
    match outcome:
        case Clarify():
            return {
                "outcome": "clarify",
                "planner": outcome.planner,
                "question": outcome.question,
                "choices": list(outcome.choices),
                "shown": {
                    "question": language.say(outcome.question),
                    "choices": [language.say(choice) for choice in outcome.choices],
                },
                "free": outcome.free,
                "places": [[place.id for place in one] for one in outcome.places],
                "map": choices_map(site_and_robot.site, outcome.places),
            }
        case Refused():
            reasons = [
                {
                    "what": language.say(r.what),
                    "said": [list(s) for s in r.said],
                    "advice": language.say(r.advice),
                }
                for r in outcome.reasons
            ]
            return {
                "outcome": "refused",
                "planner": outcome.planner,
                "reasons": reasons,
                "understood": [language.say(part) for part in outcome.understood],
                "example": outcome.example,
            }


def words_answer(task: Task, language: Language = ENGLISH) -> list[dict[str, Any]]:
    """Return the request in pieces with the role of each; empty if the Task does not record them."""
    if not has_ranges(task):
        return []
    return [
        {"text": p.text, "role": p.role, "name": language.say(ROLE_NAMES.get(p.role, "")), "nodes": list(p.nodes)}
        for p in request_pieces(task)
    ]


def review_answer(review: Review, site_and_robot: SiteAndRobot, language: Language = ENGLISH) -> dict[str, Any]:
    """Return the response of a review: problems, warnings to confirm, plan in words, forecast and map."""
    estimate = review.estimate
    return {
        "task": review.task.id,
        "words": words_answer(review.task, language),
        "approvable": not review.errors,
        "warnings": list(language.read(review.warnings)),
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
        "read_back": None if review.read_back is None else asdict(language.read(review.read_back)),
        "language": language.code,
        "headings": language.read(_headings(review)),
        "estimate": None if estimate is None else estimate.as_record(),
        "map": site_map(site_and_robot.site) if estimate is None else plan_map(site_and_robot.site, estimate),
    }


def _headings(review: Review) -> dict[str, str]:
    """Return the headings of a page for the parts of the read-back."""
    totals = message("What it takes")
    if review.read_back is not None and review.read_back.totals.branches > 1:
        totals = message(
            "What it takes on the most demanding of {count} branches", count=review.read_back.totals.branches
        )
    return {
        "assumptions": message("Assumed"),
        "notes": message("To note"),
        "times": message("Times"),
        "limits": message("Limits"),
        "faults": message("When something goes wrong"),
        "totals": totals,
        "mean": message("on average"),
        "p50": message("half of the time below"),
        "p90": message("nine times in ten below"),
        "driving": message("Driving"),
        "time": message("Time"),
        "battery": message("Battery"),
        "captures": message("Captures"),
    }
