"""The planner without a model: each request is planned in its own language."""

from __future__ import annotations

from fieldhand.language import language_of_request
from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.grammar.spanish.planner import SpanishPlanner
from fieldhand.planning.planner import Answer, Outcome, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site


class BuiltinPlanner:
    """A planner of English and of Spanish requests.

    The words of a request decide its language, not the language in which plans are read back.
    """

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan a request in the language of most of its words.

        Raises:
            RequestError: The request is empty, too long, or contains characters that no document can contain.
        """
        if language_of_request(request) == "es":
            outcome = SpanishPlanner().plan(request, site, robot, answers)
            if not isinstance(outcome, Refused) or language_of([request]) in ("", "Spanish"):
                return outcome  # what resembles Spanish may be Portuguese or Italian, which the other one names
        return EnglishPlanner().plan(request, site, robot, answers)
