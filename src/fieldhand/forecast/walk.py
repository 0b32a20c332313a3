"""A Task walked through without a robot: where it drives, in which order, what it does there, along one branch.

The meaning of every node is that of :mod:`fieldhand.task.plan`; orders come from :mod:`fieldhand.forecast.routes`, as
they do on the robot. Optional visits and steps are done if they fit the budgets as legs cost on the whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

from fieldhand.errors import PlaceError, TaskError
from fieldhand.forecast import routes
from fieldhand.forecast.limits import speed_of
from fieldhand.forecast.state import Spent
from fieldhand.forecast.steps import Answer, Decision, Ended, Failed, Round, Step, StepKind, Walk
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task import plan
from fieldhand.task.build import FAULTED_EXITS
from fieldhand.task.frames import Fault, Task, Then
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, Node, Optional, Repeat, Stop, Try

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

__all__ = ["Answer", "Decision", "Step", "StepKind", "Walk", "Walker", "exit_of", "never", "walk"]


#: A walk comes to so many nodes; a mission that would come to more is refused, as no robot could carry it out.
MAX_NODES = 100_000


def never(node_id: str) -> bool:  # noqa: ARG001
    """No action fails."""
    return False


def walk(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    holds: Answer,
    fails: Answer = never,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
) -> Walk:
    """Walk a Task from the start of the site to its exit.

    Args:
        task: What to walk.
        site, robot: Where and with what.
        holds: Asked for the id of each ``If`` that is reached, and of a loop with ``until`` after each of its rounds.
        fails: Asked for the id of each action inside a ``Try``; what is outside one does not fail in a forecast.
        drives: The ways of the site, if the caller has them; they remember what they found.
        charge_percent: Charge at the beginning.

    Raises:
        PlaceError: A selector gives nothing, or several places where one is needed; ``where`` names the node.
        DriveFault: A place that cannot be reached.
        TaskError: It comes to more than ``MAX_NODES`` nodes.
    """
    walker = Walker(task, site, robot, drives or routes.drives_for(site, robot), holds, fails, charge_percent)
    return walker.run((task.composition.plan,))


def exit_of(task: Task, fault: Fault) -> Then:
    """What the Task does about a fault: what it says, else what every mission does."""
    chosen = {e.fault: e.then for e in (*FAULTED_EXITS, *task.composition.faulted)}
    return chosen[fault]


class Walker:
    """The state of one walk; the functions of a walk are its methods, one for each kind of node.

    Args:
        optional: Whether to plan optional visits and steps; without, a walk is what must be done.
        context: Where the walk begins; at the start of the site by default.
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
        self._nodes = 0
        self.spent = Spent()
        #: The for-eaches under way around optional steps, outermost first.
        self.rounds: list[Round] = []
        #: Every place that was gone to, in order; also those where the walk stood already.
        self.stops: list[Place] = []

    @property
    def context(self) -> Context:
        """Where the walk is and has been."""
        return self._context

    def run(self, nodes: Sequence[Node | tuple[ForEach, tuple[Place, ...]]]) -> Walk:
        """Walk nodes one after the other, then the exit. A for-each with places has these places left to visit."""
        taken: Literal["nominal", "faulted"] = "nominal"
        last: Node = self.task.composition.plan
        then = self.task.composition.nominal
        try:
            for node in nodes:
                if isinstance(node, tuple):
                    self._visit_rest(*node)
                else:
                    self._node(node)
        except Ended as end:
            last, taken = end.node, end.node.exit
            then = then if taken == "nominal" else exit_of(self.task, "action_failed")
        self._exit(last, self.site.home(then, self._context.here), goes=then != "stay")
        return Walk(steps=tuple(self._steps), end=self._context.here, exit=taken, decisions=tuple(self._decisions))

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
                for _ in range(node.times):
                    self._node(node.body)
                    if node.until is not None and self._decide(node, "holds"):
                        break
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
        shed: tuple[Place, ...] = ()
        if node.optional:
            places, closed = routes.reachable(self.drives, places)
            places, shed = self._affordable(node, routes.standing(self.drives, self._context.here, places))
            shed = (*shed, *closed)
        else:
            home = routes.home_if_last(self.task, self.site, node.id, self._context.here)
            places = routes.visits_in_order(node, self.drives, self._context.here, places, home)
        self._note(Step(node=node, kind="visit-list", context=self._context, places=places, shed=shed))
        self._visit_all(node, places)

    def _visit_rest(self, node: ForEach, places: tuple[Place, ...]) -> None:
        places = routes.standing(self.drives, self._context.here, places)
        if node.order == "best":
            order = routes.order_visits(self.drives, self._context.here, places, None)
            places = tuple(places[i] for i in order)
        self._visit_all(node, places)

    def _visit_all(self, node: ForEach, places: tuple[Place, ...]) -> None:
        """Do the body at each place; afterwards the label means all the places that were visited."""
        visited: list[Place] = []
        begun = self._begin_round(node, places)
        try:
            for at, place in enumerate(places):
                if begun:
                    self.rounds[-1].at = at
                self._drive_to(node, place)
                self._bind(node.label, place)
                self._node(node.body)
                visited.append(place)
                if node.until is not None and self._decide(node, "holds"):
                    break
        finally:
            if begun:
                self.rounds.pop()
        if visited:
            self._bind(node.label, *visited)

    def _begin_round(self, node: ForEach, places: tuple[Place, ...]) -> bool:
        """Keep what is left of a loop where an optional step inside will be weighed against it."""
        if not self.optional or not any(isinstance(inner, Optional) for inner in plan.walk(node.body)):
            return False
        legs = tuple(self.drives.between(a, b).length_m for a, b in pairwise(places))
        self.rounds.append(Round(node=node, places=places, legs_m=legs))
        return True

    def _optional_step(self, node: Optional) -> None:
        if not self.optional:
            return
        from fieldhand.forecast.optional import weigh

        place, fits = weigh(self, node)
        done, shed = ((place,), ()) if fits else ((), (place,))
        self._note(Step(node=node, kind="visit-list", context=self._context, places=done, shed=shed))
        if fits:
            self._node(node.body)

    def _affordable(self, node: ForEach, places: tuple[Place, ...]) -> tuple[tuple[Place, ...], tuple[Place, ...]]:
        """The optional visits that fit the budgets, in their order, and those that do not."""
        if not self.optional or not places:
            return (), places
        from fieldhand.forecast.optional import affordable

        chosen = affordable(self, node, places)
        return tuple(places[i] for i in chosen), tuple(p for i, p in enumerate(places) if i not in chosen)

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
        self.spent += Spent(
            metres=metres, seconds=step.seconds, percent=self.robot.percent(0.0, step.seconds, step.joules)
        )
