"""The planner of Spanish requests: the grammar alone, without a model and without the network."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.english.planner import check_request
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.grammar.spanish import SPANISH
from fieldhand.planning.planner import Answer, Outcome
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

NAME = "spanish"


class SpanishPlanner:
    """A planner with the grammar of constructions in Spanish.

    It plans a request if the grammar covers every word, asks if it can be planned in several ways, and refuses it
    otherwise.
    """

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        """Plan a request.

        Raises:
            RequestError: The request is empty, too long, or contains characters that no document can contain.
        """
        check_request(request)
        return replace(composed(request, site, robot, SPANISH, answers), planner=NAME)
