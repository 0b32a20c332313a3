"""Conversion of optional work to visits, including the drives within it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.forecast.mission_state import Visit
from fieldhand.forecast.remaining_work import arrived, every_answer
from fieldhand.forecast.request_handler import ForecastHandler
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.service import rewards_of, work_of
from fieldhand.forecast.walk_state import Answers
from fieldhand.forecast.walk_steps import work_in
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task import plan
from fieldhand.task.frames import Task
from fieldhand.task.plan import ForEach, Node, OptionalStep

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Number of visits whose inner drives are computed individually; all further visits count with the longest one found.
_LOOKED_AT = 60


class OptionalVisits:
    """Builds visits from optional nodes.

    Args:
        task, site, robot, drives: Task, site, robot and drives of the mission.
    """

    def __init__(self, task: Task, site: Site, robot: RobotProfile, drives: Drives) -> None:
        self._task, self._site, self._robot, self._drives = task, site, robot, drives

    def of_places(self, node: ForEach, places: Sequence[Place], context: Context) -> tuple[Visit, ...]:
        """Return the visits of an optional for-each.

        Args:
            node: The for-each.
            places: Places of the visits, with stands.
            context: The robot's current place and visited trees at the for-each.
        """
        work = work_of(node.body, self._robot)
        visits = [
            Visit(
                place=place,
                reward=reward,
                service_s=work.seconds,
                service_j=work.joules,
            )
            for place, reward in zip(places, rewards_of(node, places, self._site), strict=True)
        ]
        if all(inner.selector is None for inner in plan.walk(node.body)):
            return tuple(visits)
        step = max(1, -(-len(visits) // _LOOKED_AT))
        looked_at = {k: self._inside(node, visits[k], context) for k in range(0, len(visits), step)}
        longest = max((v.inside_m for v in looked_at.values()), default=0.0)
        return tuple(looked_at.get(k, replace(visit, inside_m=longest)) for k, visit in enumerate(visits))

    def of_step(self, node: OptionalStep, context: Context) -> Visit:
        """Return the visit of an optional step, on its most demanding branch.

        Args:
            node: The step.
            context: The robot's current place and visited trees.

        Returns:
            The visit; at the current place if it includes no drive. From the first place on that can only be resolved
            on the way, only work is counted, and no drives.

        Raises:
            PlaceError: Its first place cannot be resolved.
            DriveFault: A place cannot be reached.
        """
        return replace(self._longest(node.body, context), reward=node.reward)

    def _inside(self, node: ForEach, visit: Visit, context: Context) -> Visit:
        """Return a visit with the drives of its body, or without them if they cannot be resolved."""
        there = arrived(context, [visit])
        if node.label:
            there = replace(there, bound={**there.bound, node.label: (visit.place,)})
        try:
            found = self._longest(node.body, there)
        except (PlaceError, DriveFault):
            return visit
        if visit.place.covers(found.place):
            return replace(visit, inside_m=found.inside_m, leaves=found.leaves)
        first = self._drives.between(visit.place, found.place).length_m
        return replace(visit, inside_m=first + found.inside_m, leaves=found.end)

    def _longest(self, body: Node, context: Context) -> Visit:
        """Return the visit that a body makes on its most demanding branch."""
        speed, work = speed_of(self._task.constraints, self._robot), work_of(body, self._robot)
        longest, most = Visit(place=context.here), -1.0
        for holds in every_answer((body,)):
            answers = Answers(holds=holds)
            walker = ForecastHandler(self._task, self._site, self._robot, self._drives, answers, context=context)
            steps = walker.along(body)
            legs = [(s.drive.length_m, s.places[0]) for s in steps if s.drive is not None]
            acts = [work_in(s) for s in steps]
            visit = Visit(
                place=legs[0][1] if legs else context.here,
                service_s=max(work.seconds, sum(s.seconds for s in acts)),
                service_j=max(work.joules, sum(s.joules for s in acts)),
                inside_m=sum(metres for metres, _ in legs[1:]),
                leaves=legs[-1][1] if len(legs) > 1 else None,
            )
            seconds = visit.service_s + sum(metres for metres, _ in legs) / speed
            if seconds > most:
                longest, most = visit, seconds
        return longest
