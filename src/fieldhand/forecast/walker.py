"""The state of a walk through a Task, one function for each kind of node.

The meaning of every node is that of :mod:`fieldhand.task.plan`; orders come from :mod:`fieldhand.forecast.routes`, as
they do on the robot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldhand.errors import DriveFault, PlaceError, TaskError
from fieldhand.forecast import routes
from fieldhand.forecast.allowance import Allowance
from fieldhand.forecast.drawn import Drawn
from fieldhand.forecast.possible import Readings
from fieldhand.forecast.service import tried_again, work_of
from fieldhand.forecast.state import Visit, Work
from fieldhand.forecast.steps import Ended, Failed, Step, Walk
from fieldhand.forecast.trail import Answers, Trail
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task import plan
from fieldhand.task.build import exit_of
from fieldhand.task.frames import Task
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, Node, Optional, Repeat, Stop, Try

if TYPE_CHECKING:
    from fieldhand.forecast.expected import Expected
    from fieldhand.forecast.visits import Visits
    from fieldhand.site.drives import Drives

OptionalVisits = Literal["likely", "told", "none"]

#: A walk comes to so many nodes; a mission that would come to more is refused, as no robot could carry it out.
MAX_NODES = 100_000

#: Of optional visits of which nothing is known so many are driven to where a walk is told to make them.
MOST_TOLD = 200


class Walker(Trail):
    """The functions of a walk, one for each kind of node.

    Args:
        task, site, robot, drives, answers, context, drawn, readings: As for a trail.
        charge_percent: Charge at the beginning.
        optional: What becomes of optional visits and steps: as many as missions make on average, what the answers say
            of each step and all visits or none, or only what must be done.
        kept: What was found of optional visits on walks that had the same answers by then.
    """

    def __init__(
        self,
        task: Task,
        site: Site,
        robot: RobotProfile,
        drives: Drives,
        answers: Answers,
        charge_percent: float = 100.0,
        *,
        optional: OptionalVisits = "likely",
        context: Context | None = None,
        drawn: Drawn | None = None,
        readings: Readings | None = None,
        kept: dict[object, Expected] | None = None,
    ) -> None:
        super().__init__(task, site, robot, drives, answers, context=context, drawn=drawn, readings=readings)
        self.charge_percent, self.optional = charge_percent, optional
        self._nodes = 0
        self._kept = {} if kept is None else kept
        #: What optional visits may still add to the chance of running short; None before the first of them.
        self.allowance: Allowance | None = None
        #: Of each for-each under way the places that must be visited, and how many of them were begun; outermost first.
        self.loops: list[tuple[ForEach, tuple[Place, ...], int]] = []
        #: Further rounds of each repeat under way, by node id.
        self.rounds: dict[str, int] = {}

    def run(self, nodes: Sequence[Node]) -> Walk:
        """Walk nodes one after the other, then the exit."""
        taken: Literal["nominal", "faulted"] = "nominal"
        last: Node = self.task.composition.plan
        then = self.task.composition.nominal
        try:
            for node in nodes:
                self._node(node)
        except Ended as end:
            last, taken = end.node, end.node.exit
            then = then if taken == "nominal" else exit_of(self.task, "action_failed")
        self._exit(last, self.site.home(then, self._standing), goes=then != "stay")
        return Walk(
            steps=tuple(self.steps),
            end=self.context.here,
            exit=taken,
            decisions=tuple(self.decisions),
            unread=tuple(dict.fromkeys(self.unread)),
            used=None if self.drawn is None else self.drawn.used,
        )

    def along(self, node: Node) -> tuple[Step, ...]:
        """The steps of one node, with no exit after them, as far as its places can be told from here.

        Raises:
            PlaceError: Its first place cannot be told.
            DriveFault: A place that cannot be reached.
        """
        try:
            self._node(node)
        except Ended:
            pass
        except PlaceError:
            if not self.steps:
                raise
        return tuple(self.steps)

    def _node(self, node: Node) -> None:
        self._nodes += 1
        if self._nodes > MAX_NODES:
            raise TaskError(
                f"the plan has more than {MAX_NODES:,} steps when it is carried out",
                where=node.id,
                advice="repeat less often, or nest fewer loops",
            )
        match node:
            case plan.Sequence(steps=steps):
                for step in steps:
                    self._node(step)
            case AnyOrder():
                home = routes.home_if_last(self.task, self.site, node.id, self.context.here)
                for index in routes.steps_in_order(node, self.site, self.drives, self.context, home):
                    self._node(node.steps[index])
            case ForEach():
                self._for_each(node)
            case Repeat():
                for done in range(node.times):
                    self.rounds[node.id] = node.times - done - 1
                    self._node(node.body)
                    if node.until is not None and self._decide(node, "holds"):
                        break
                self.rounds.pop(node.id, None)
            case If():
                if self._decide(node, "holds"):
                    self._node(node.then)
                elif node.otherwise is not None:
                    self._node(node.otherwise)
            case Try():
                self._try(node)
            case Optional():
                self._optional_step(node)
            case GoTo():
                self._drive_to(node, routes.place_of(node, node.place, self.site, self.context))
                self._bind(node.label, self.context.here)
            case Act():
                self._act(node)
            case Stop():
                raise Ended(node)

    def _for_each(self, node: ForEach) -> None:
        places = routes.places_of(node, node.select, self.site, self.context)
        if node.optional:
            open_, closed = routes.reachable(self.drives, places)
            standing = routes.standing(self.drives, self.context.here, open_)
            if self.optional == "told":
                places = self._told(node, standing, most=self._decide(node, "taken"))
                self._note(Step(node=node, kind="visit-list", context=self.context, places=places, shed=closed))
                self._visit_all(node, places)
                return
            visits = self._visits().of_places(node, standing, self.context) if self.optional == "likely" else ()
            self._visit_all(node, self._some(node, visits, closed))
            return
        home = routes.home_if_last(self.task, self.site, node.id, self.context.here)
        places = routes.visits_in_order(node, self.drives, self.context.here, places, home)
        self._note(Step(node=node, kind="visit-list", context=self.context, places=places))
        self._visit_all(node, places)

    def _optional_step(self, node: Optional) -> None:
        if self.optional == "none":
            return
        here = self.context
        if self.optional == "told":
            self._step_as_told(node)
            return
        try:
            visit = self._visits().of_step(node, here)
        except DriveFault:
            never = next(iter(routes.first_places(node.body, self.site, here)), here.here)
            self._some(node, [], (never,))
            return
        if self._some(node, [visit], ()):
            self._inside_optional += 1
            try:
                self._node(node.body)
            finally:
                self._inside_optional -= 1

    def _told(self, node: ForEach, standing: tuple[Place, ...], *, most: bool) -> tuple[Place, ...]:
        """The optional visits of the mission that makes most, or fewest; where none is known all, or none."""
        known = self._kept.get(node.id)
        if known is None:
            return (standing if node.at_most is None else standing[: node.at_most])[:MOST_TOLD] if most else ()
        visits, by_id = known.preview.visits, {p.id: p for p in standing}
        made = known.preview.stops(int(visits.argmax() if most else visits.argmin()))
        return tuple(by_id[name] for vertex in made if (name := known.ids[vertex - 1]) in by_id)

    def _step_as_told(self, node: Optional) -> None:
        try:
            first = self._visits().of_step(node, self.context).place
        except DriveFault:
            return
        known = self._kept.get(node.id)
        if (known is None or known.preview.visited.any()) and self._decide(node, "taken"):
            self._note(Step(node=node, kind="visit-list", context=self.context, places=(first,)))
            self._node(node.body)

    def _visits(self) -> Visits:
        from fieldhand.forecast.visits import Visits

        return Visits(self.task, self.site, self.robot, self.drives)

    def _some(self, node: ForEach | Optional, visits: Sequence[Visit], closed: tuple[Place, ...]) -> tuple[Place, ...]:
        """Of optional visits the likeliest to fit the budgets, as many as missions make on average."""
        if self.optional == "none" or not visits:
            self._note(Step(node=node, kind="visit-list", context=self.context, shed=closed))
            return ()
        from fieldhand.forecast.expected import expected_visits

        key = (node.id, len(self.steps), tuple(self.decisions))
        found = self._kept.get(key)
        if found is None:
            rng = np.random.default_rng([0 if self.drawn is None else self.drawn.seed, len(self.steps)])
            found = expected_visits(self, node, visits, rng, self._kept.get(node.id))
            self._kept[key] = self._kept[node.id] = found
        self.allowance = found.allowance
        step = Step(node=node, kind="visit-list", context=self.context, shed=(*found.shed, *closed))
        self._note(replace(step, places=found.places, outlook=found.outlook))
        if self.drawn is not None:
            self.drawn.visit(found.preview, [v.work for v in visits])
        return found.places

    def to_come(self) -> tuple[Visit, ...]:
        """The visits that are still to come of the loops under way, in their order."""
        found = []
        for node, places, begun in reversed(self.loops):
            work = work_of(node.body, self.robot)
            found += [Visit(place=p, service_s=work.seconds, service_j=work.joules) for p in places[begun:]]
        return tuple(found)

    def _visit_all(self, node: ForEach, places: tuple[Place, ...]) -> None:
        """Do the body at each place; afterwards the label means all the places that were visited."""
        visited: list[Place] = []
        around, optional = len(self.loops), self._inside_optional
        self._inside_optional += node.optional
        try:
            for at, place in enumerate(places):
                self.loops[around:] = [(node, () if node.optional else places, at + 1)]
                self._drive_to(node, place)
                self._bind(node.label, place)
                self._node(node.body)
                visited.append(place)
                if node.until is not None and self._decide(node, "holds"):
                    break
        finally:
            del self.loops[around:]
            self._inside_optional = optional
        if visited:
            self._bind(node.label, *visited)

    def _try(self, node: Try) -> None:
        self._inside_try += 1
        try:
            self._node(node.body)
        except Failed:
            failed = True
        else:
            failed = False
        finally:
            self._inside_try -= 1
        if failed:
            self._node(node.otherwise)

    def _act(self, node: Act) -> None:
        if node.at is not None:
            self._drive_to(node, routes.place_of(node, node.at, self.site, self.context))
        elif self._stuck:
            self._drive_to(node, self.context.here)
        here = self.context.here
        self._bind(node.label, here)
        if self.readings is not None and node.reading:
            self.readings.lose(node.reading)
        action = self.robot.action[node.action]
        fails = bool(self._inside_try) and self._decide(node, "fails")
        # One that fails is taken to do so at its last capture, each time that it is tried again.
        again = tried_again(node, self.robot) if fails else Work()
        self._note(
            Step(
                node=node,
                kind="act",
                context=self.context,
                places=(here,),
                captures=node.count - fails,
                seconds=node.count * action.duration_s + again.seconds,
                joules=node.count * action.energy_j + again.joules,
            )
        )
        if fails:
            raise Failed(node.id)
        if self.readings is not None and node.reading:
            self.readings.take(node.reading, node.action)
