"""A planner of its own, for one kind of request: ``survey 5 trees`` takes a picture of some trees far apart."""

from __future__ import annotations

import re

import fieldhand as fh
from fieldhand.planning.planner import PlannerSettings, Reason

_REQUEST = re.compile(r"\s*survey (\d+) trees\s*", re.IGNORECASE)


class SurveyPlanner:
    """Plan a survey: one capture at each of some trees, spread over the site."""

    def plan(
        self, request: str, site: fh.Site, robot: fh.Robot, answers: tuple[fh.Answer, ...] = ()
    ) -> fh.Planned | fh.Clarify | fh.Refused:
        """Plan one request; see :class:`fieldhand.planning.planner.Planner`."""
        del answers  # it asks nothing
        match = _REQUEST.fullmatch(request)
        if match is None or int(match[1]) < 1:
            reason = Reason(what="this planner knows surveys alone", advice="say: survey 5 trees")
            return fh.Refused(reasons=(reason,), planner="survey")
        trees = fh.selectors.Spread(of=fh.selectors.Trees(), count=min(int(match[1]), len(site.trees)))
        where = (match.span(),)  # every word of the request stands for this step
        body = fh.steps.Act(id="", action=robot.actions[0].name, said=where)
        plan = fh.steps.ForEach(id="", select=trees, body=body, said=where)
        return fh.Planned(task=fh.build_task(plan, site, robot, request=request), planner="survey")


def make_survey_planner(settings: PlannerSettings) -> SurveyPlanner:
    """Return the planner; it needs no settings."""
    del settings
    return SurveyPlanner()
