"""The state of a walk through a Task, one function for each kind of node.

The meaning of every node is that of :mod:`fieldhand.task.plan`; orders come from :mod:`fieldhand.forecast.routes`, as
they do on the robot. Optional visits and steps are made as missions make them on average.
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
from fieldhand.forecast.limits import speed_of
from fieldhand.forecast.service import work_of
from fieldhand.forecast.state import Spent, Visit, Work
from fieldhand.forecast.steps import Answer, Decision, Ended, Failed, Step, StepKind, Walk, never
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

#: A walk comes to so many nodes; a mission that would come to more is refused, as no robot could carry it out.
MAX_NODES = 100_000


class Walker:
    """The state of one walk; the functions of a walk are its methods, one for each kind of node.

    Args:
        task, site, robot, drives, holds, fails, charge_percent: As for :func:`fieldhand.forecast.walk.walk`.
        optional: Whether to plan optional visits and steps; without, a walk is what must be done.
        context: Where the walk begins; at the start of the site by default.
        drawn: Missions that use what the walk takes, each with its own luck; None for none.
        kept: What was found of optional visits on walks that had the same answers by then.
    """

    def __init__(
        self,
        task: Task,
        site: Site,
        robot: RobotProfile,
        drives: Drives,
        holds: Answer,
        fails: Answer = never,
        charge_percent: float = 100.0,
        *,
        optional: bool = True,
        context: Context | None = None,
        drawn: Drawn | None = None,
        kept: dict[object, Expected] | None = None,
    ) -> None:
        self.task, self.site, self.robot, self.drives = task, site, robot, drives
        self.charge_percent, self.optional = charge_percent, optional
        self._holds, self._fails = holds, fails
        #: Where the walk began.
        self.beginning = context or Context(here=routes.beginning(drives))
        self._context = self.beginning
        self._speed = speed_of(task.constraints, robot)
        self._steps: list[Step] = []
        self._decisions: list[Decision] = []
        self._inside_try = 0
        self._inside_optional = 0
        self._nodes = 0
        self.drawn, self._kept = drawn, {} if kept is None else kept
        #: What optional visits may still add to the chance of running short; None before the first of them.
        self.allowance: Allowance | None = None
        self.spent = Spent()
        #: Places still to come of each for-each under way, outermost first.
        self.loops: list[tuple[ForEach, tuple[Place, ...]]] = []
        #: Further rounds of each repeat under way, by node id.
        self.rounds: dict[str, int] = {}
        #: Every place that was gone to, in order; also those where the walk stood already.
        self.stops: list[Place] = []

    @property
    def context(self) -> Context:
        """Where the walk is and has been."""
        return self._context

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
        self._exit(last, self.site.home(then, self._context.here), goes=then != "stay")
        return Walk(
            steps=tuple(self._steps),
            end=self._context.here,
            exit=taken,
            decisions=tuple(self._decisions),
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
            if not self._steps:
                raise
        return tuple(self._steps)

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
                home = routes.home_if_last(self.task, self.site, node.id, self._context.here)
                for index in routes.steps_in_order(node, self.site, self.drives, self._context, home):
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
                self._drive_to(node, routes.place_of(node, node.place, self.site, self._context))
                self._bind(node.label, self._context.here)
            case Act():
                self._act(node)
            case Stop():
                raise Ended(node)

    def _for_each(self, node: ForEach) -> None:
        places = routes.places_of(node, node.select, self.site, self._context)
        if node.optional:
            open_, closed = routes.reachable(self.drives, places)
            standing = routes.standing(self.drives, self._context.here, open_)
            visits = self._visits().of_places(node, standing, self._context) if self.optional else ()
            self._visit_all(node, self._some(node, visits, closed))
            return
        home = routes.home_if_last(self.task, self.site, node.id, self._context.here)
        places = routes.visits_in_order(node, self.drives, self._context.here, places, home)
        self._note(Step(node=node, kind="visit-list", context=self._context, places=places))
        self._visit_all(node, places)

    def _optional_step(self, node: Optional) -> None:
        if not self.optional:
            return
        here = self._context
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

    def _visits(self) -> Visits:
        from fieldhand.forecast.visits import Visits

        return Visits(self.task, self.site, self.robot, self.drives)

    def _some(self, node: ForEach | Optional, visits: Sequence[Visit], closed: tuple[Place, ...]) -> tuple[Place, ...]:
        """Of optional visits the likeliest to fit the budgets, as many as missions make on average."""
        if not self.optional or not visits:
            self._note(Step(node=node, kind="visit-list", context=self._context, shed=closed))
            return ()
        from fieldhand.forecast.expected import expected_visits

        key = (node.id, len(self._steps), tuple(self._decisions))
        found = self._kept.get(key)
        if found is None:
            rng = np.random.default_rng([0 if self.drawn is None else self.drawn.seed, len(self._steps)])
            found = expected_visits(self, node, visits, rng, self._kept.get(node.id))
            self._kept[key] = self._kept[node.id] = found
        self.allowance = found.allowance
        step = Step(node=node, kind="visit-list", context=self._context, shed=(*found.shed, *closed))
        self._note(replace(step, places=found.places, outlook=found.outlook))
        if self.drawn is not None:
            self.drawn.visit(found.preview, [v.work for v in visits])
        return found.places

    def to_come(self) -> tuple[Visit, ...]:
        """The visits that are still to come of the loops under way, in their order."""
        found = []
        for node, places in reversed(self.loops):
            work = work_of(node.body, self.robot)
            found += [Visit(place=p, service_s=work.seconds, service_j=work.joules) for p in places]
        return tuple(found)

    def _visit_all(self, node: ForEach, places: tuple[Place, ...]) -> None:
        """Do the body at each place; afterwards the label means all the places that were visited."""
        visited: list[Place] = []
        around, optional = len(self.loops), self._inside_optional
        self._inside_optional += node.optional
        try:
            for at, place in enumerate(places):
                self.loops[around:] = [(node, () if node.optional else places[at + 1 :])]
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
            self._drive_to(node, routes.place_of(node, node.at, self.site, self._context))
        here = self._context.here
        self._bind(node.label, here)
        action = self.robot.action[node.action]
        self._note(
            Step(
                node=node,
                kind="act",
                context=self._context,
                places=(here,),
                captures=node.count,
                seconds=node.count * action.duration_s,
                joules=node.count * action.energy_j,
            )
        )
        if self._inside_try and self._decide(node, "fails"):
            raise Failed(node.id)

    def _drive_to(self, node: Node, place: Place) -> None:
        if place.xy != self._context.here.xy:
            leg = self._leg(node, "drive", place)
            self._note(leg)
            (place,) = leg.places
        else:
            place = self._context.here
        self.stops.append(place)
        visited = self._context.visited
        if place.kind == "tree" and place.id not in visited:
            visited = (*visited, place.id)
        self._context = Context(here=place, visited=visited, bound=self._context.bound)

    def _exit(self, node: Node, home: Place, *, goes: bool) -> None:
        if home.xy == self._context.here.xy:
            if goes:
                self.stops.append(self._context.here)
            self._note(Step(node=node, kind="exit", context=self._context, places=(home,)))
            return
        leg = self._leg(node, "exit", home)
        self._note(leg)
        (home,) = leg.places
        self.stops.append(home)
        self._context = Context(here=home, visited=self._context.visited, bound=self._context.bound)

    def _leg(self, node: Node, kind: StepKind, place: Place) -> Step:
        drive = self.drives.between(self._context.here, place)
        return Step(
            node=node,
            kind=kind,
            context=self._context,
            places=(drive.end,),
            drive=drive,
            seconds=drive.length_m / self._speed,
            joules=drive.length_m * self.robot.energy.drive_j_per_m,
        )

    def _decide(self, node: Node, kind: Literal["holds", "fails"]) -> bool:
        answer = self._holds(node.id) if kind == "holds" else self._fails(node.id)
        self._decisions.append(Decision(node=node.id, kind=kind, answer=answer))
        if kind == "holds":
            self._note(Step(node=node, kind="decide", context=self._context, answer=answer))
        return answer

    def _bind(self, label: str, *places: Place) -> None:
        if label:
            bound = {**self._context.bound, label: places}
            self._context = Context(here=self._context.here, visited=self._context.visited, bound=bound)

    def _note(self, step: Step) -> None:
        self._steps.append(step)
        metres = 0.0 if step.drive is None else step.drive.length_m
        if self.drawn is not None and not self._inside_optional:
            if step.drive is not None:
                self.drawn.drive(metres)
            elif step.kind == "act":
                self.drawn.work(Work(seconds=step.seconds, joules=step.joules))
        self.spent += Spent(
            metres=metres, seconds=step.seconds, percent=self.robot.percent(0.0, step.seconds, step.joules)
        )
