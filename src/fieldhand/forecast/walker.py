"""A walk through a Task on paper: the answers to what its nodes ask (:mod:`fieldhand.task.requests`).

Orders come from :mod:`fieldhand.forecast.routes`, as they do on the robot.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fieldhand.errors import DriveFault, PlaceError, TaskError
from fieldhand.forecast import routes
from fieldhand.forecast.allowance import Allowance
from fieldhand.forecast.drawn import Drawn
from fieldhand.forecast.possible import Readings
from fieldhand.forecast.service import tried_again, work_of
from fieldhand.forecast.state import Visit, Work
from fieldhand.forecast.steps import Step, Walk
from fieldhand.forecast.trail import Answers, Trail
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.build import exit_of
from fieldhand.task.frames import Task
from fieldhand.task.nodes.base import Failed, Stopped
from fieldhand.task.plan import Act, ForEach, Node, Optional
from fieldhand.task.requests import (
    Arrange,
    Begin,
    Bind,
    Capture,
    Decide,
    Drive,
    Forget,
    Locate,
    Next,
    Offer,
    Permit,
    Read,
    Request,
    Round,
)
from fieldhand.task.run import carry_out

if TYPE_CHECKING:
    from fieldhand.forecast.expected import Expected
    from fieldhand.forecast.visits import Visits
    from fieldhand.site.drives import Drives

OptionalVisits = Literal["likely", "told", "none"]

#: A walk comes to so many nodes; a mission that would come to more is refused, as no robot could carry it out.
MAX_NODES = 100_000

#: Of optional visits of which nothing is known so many are driven to where a walk is told to make them.
MOST_TOLD = 200


class Tour:
    """The visits of a for-each.

    Args:
        places: In the order in which they are visited, each with its stand.
        work: What each takes, drives not included.
    """

    def __init__(self, places: tuple[Place, ...], work: Work | None = None) -> None:
        self._places, self._work, self._begun = places, work or Work(), 0

    def next(self) -> Place | None:
        """The next place; None after the last."""
        if self._begun == len(self._places):
            return None
        self._begun += 1
        return self._places[self._begun - 1]

    @property
    def to_come(self) -> tuple[Visit, ...]:
        """Those that are not begun."""
        seconds, joules = self._work.seconds, self._work.joules
        return tuple(Visit(place=p, service_s=seconds, service_j=joules) for p in self._places[self._begun :])


class Walker(Trail):
    """Answers what the nodes of a Task ask, and notes what happens.

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
        self.plan.entered = self._entered

    def run(self, nodes: Sequence[Node]) -> Walk:
        """Walk nodes one after the other, then the exit."""
        taken: Literal["nominal", "faulted"] = "nominal"
        last: Node = self.task.composition.plan
        then = self.task.composition.nominal
        try:
            for node in nodes:
                carry_out(self.plan.do(node), self._answer)
        except Stopped as end:
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
            carry_out(self.plan.do(node), self._answer)
        except Stopped:
            pass
        except PlaceError:
            if not self.steps:
                raise
        return tuple(self.steps)

    def to_come(self) -> tuple[Visit, ...]:
        """The visits that must be made and are still to come, of the loops in hand, innermost first."""
        found: list[Visit] = []
        for frame in self.plan.outwards():
            if frame.tour is not None and not frame.node.is_optional:
                found += frame.tour.to_come
        return tuple(found)

    def _entered(self, node: Node) -> None:
        self._nodes += 1
        if self._nodes > MAX_NODES:
            raise TaskError(
                f"the plan has more than {MAX_NODES:,} steps when it is carried out",
                where=node.id,
                advice="repeat less often, or nest fewer loops",
            )

    def _answer(self, request: Request) -> Any:
        """Answer what a node asks."""
        match request:
            case Drive(node=node, place=place, back=back):
                if not back or self._stuck:
                    self._drive_to(node, place)
                return self.context.here
            case Bind(label=label, places=places):
                return self._bind(label, *places)
            case Capture(node=act):
                return self._capture(act)
            case Locate(node=node, selector=selector):
                if selector is None:
                    return self.context.here
                return routes.place_of(node, selector, self.site, self.context)
            case Decide(node=node):
                return self._decide(node, "holds")
            case Next(tour=tour):
                return tour.next()
            case Begin(node=for_each):
                return self._tour(for_each)
            case Offer(node=optional):
                return self._takes(optional)
            case Arrange(node=any_order):
                home = routes.home_if_last(self.task, self.site, any_order.id, self.context.here)
                return routes.steps_in_order(any_order, self.site, self.drives, self.context, home)
            case Forget(reading=reading):
                if self.readings is not None:
                    self.readings.lose(reading)
            case Read(node=act, reading=reading):
                if self.readings is not None:
                    self.readings.take(reading, act.action)
            case Permit() | Round():
                pass
        return None

    def _tour(self, node: ForEach) -> Tour:
        """The visits of a for-each, in the order in which they are made."""
        places = routes.places_of(node, node.select, self.site, self.context)
        if not node.optional:
            home = routes.home_if_last(self.task, self.site, node.id, self.context.here)
            places = routes.visits_in_order(node, self.drives, self.context.here, places, home)
            self._note(Step(node=node, kind="visit-list", context=self.context, places=places))
            return Tour(places, work_of(node.body, self.robot))
        open_, closed = routes.reachable(self.drives, places)
        standing = routes.standing(self.drives, self.context.here, open_)
        if self.optional == "told":
            places = self._told(node, standing, most=self._decide(node, "taken"))
            self._note(Step(node=node, kind="visit-list", context=self.context, places=places, shed=closed))
            return Tour(places)
        visits = self._visits().of_places(node, standing, self.context) if self.optional == "likely" else ()
        return Tour(self._some(node, visits, closed))

    def _takes(self, node: Optional) -> bool:
        """Decide on an optional step: True if it is done."""
        if self.optional == "none":
            return False
        if self.optional == "told":
            return self._takes_as_told(node)
        try:
            visit = self._visits().of_step(node, self.context)
        except DriveFault:
            never = next(iter(routes.first_places(node.body, self.site, self.context)), self.context.here)
            self._some(node, [], (never,))
            return False
        return bool(self._some(node, [visit], ()))

    def _told(self, node: ForEach, standing: tuple[Place, ...], *, most: bool) -> tuple[Place, ...]:
        """The optional visits of the mission that makes most, or fewest; where none is known all, or none."""
        known = self._kept.get(node.id)
        if known is None:
            return (standing if node.at_most is None else standing[: node.at_most])[:MOST_TOLD] if most else ()
        visits, by_id = known.preview.visits, {p.id: p for p in standing}
        made = known.preview.stops(int(visits.argmax() if most else visits.argmin()))
        return tuple(by_id[name] for vertex in made if (name := known.ids[vertex - 1]) in by_id)

    def _takes_as_told(self, node: Optional) -> bool:
        try:
            first = self._visits().of_step(node, self.context).place
        except DriveFault:
            return False
        known = self._kept.get(node.id)
        takes = (known is None or bool(known.preview.visited.any())) and self._decide(node, "taken")
        if takes:
            self._note(Step(node=node, kind="visit-list", context=self.context, places=(first,)))
        return takes

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
            # Branches that differ by what was measured where, and not by what that took, expect the same.
            state = (node.id, *self._state())
            found = self._kept.get(state)
            if found is None:
                rng = np.random.default_rng([0 if self.drawn is None else self.drawn.seed, len(self.steps)])
                found = expected_visits(self, node, visits, rng, self._kept.get(node.id))
            self._kept[key] = self._kept[state] = self._kept[node.id] = found
        self.allowance = found.allowance
        step = Step(node=node, kind="visit-list", context=self.context, shed=(*found.shed, *closed))
        self._note(replace(step, places=found.places, outlook=found.outlook))
        if self.drawn is not None:
            self.drawn.visit(found.preview, [v.work for v in visits])
        return found.places

    def _state(self) -> Iterator[object]:
        """All that decides which optional visits missions make from here on."""
        context, spent = self.context, self.spent
        yield len(self.steps), self.allowance, self.to_come()
        yield context.here, context.here.stand, tuple(context.visited), tuple(context.bound.items())
        yield tuple((frame.node.id, tuple(n.id for n in frame.left)) for frame in self.plan.frames)
        # Sums of the same durations in another order differ in their last digits.
        yield tuple(round(amount, 6) for amount in (spent.metres, spent.seconds, spent.percent, spent.joules))
        if self.drawn is not None:
            yield self.drawn.metres.tobytes()

    def _capture(self, node: Act) -> Mapping[str, float]:
        """Note the captures of an action; inside a ``Try`` it may fail.

        Raises:
            Failed: It fails.
        """
        action = self.robot.action[node.action]
        fails = self.plan.is_caught and self._decide(node, "fails")
        # One that fails is taken to do so at its last capture, each time that it is tried again.
        again = tried_again(node, self.robot) if fails else Work()
        self._note(
            Step(
                node=node,
                kind="act",
                context=self.context,
                places=(self.context.here,),
                captures=node.count - fails,
                seconds=node.count * action.duration_s + again.seconds,
                joules=node.count * action.energy_j + again.joules,
            )
        )
        if fails:
            raise Failed(node.id)
        return {}
