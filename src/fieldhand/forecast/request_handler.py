"""The forecast's handler of plan instructions: it walks a Task along one branch without a robot.

Orders come from :mod:`fieldhand.forecast.visit_order`, as they do on the robot.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Protocol

from fieldhand.errors import NoPlaceError, PlaceError, TaskError
from fieldhand.forecast import visit_order
from fieldhand.forecast.charge_simulation import charged_missions
from fieldhand.forecast.charging_missions import ChargingMissions
from fieldhand.forecast.mission_state import Visit, Work
from fieldhand.forecast.possible_answers import BranchReadings
from fieldhand.forecast.recharge_rules import recharge_rules
from fieldhand.forecast.risk_allowance import RiskAllowance
from fieldhand.forecast.sampled_costs import MissionSamples, SampledUse
from fieldhand.forecast.service import retry_work, work_of
from fieldhand.forecast.walk_state import Answers, WalkState
from fieldhand.forecast.walk_steps import Walk, WalkStep
from fieldhand.forecast.working import PlannedStretches, stretches_of, visit_of
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task import instructions as ask
from fieldhand.task.build import exit_of
from fieldhand.task.earlier import may_have_none
from fieldhand.task.frames import Task
from fieldhand.task.nodes.base import Failed, Stopped
from fieldhand.task.plan import Act, ForEach, Node, OptionalStep, Recharge, WorkAlong
from fieldhand.task.run import carry_out

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Maximum number of nodes on a walk; a Task with more is rejected, as no robot could carry it out.
MAX_NODES = 100_000


class OptionalWorkPolicy(Protocol):
    """Policy that decides which optional visits and steps a walk includes."""

    def visits(
        self,
        walker: ForecastHandler,
        node: ForEach | WorkAlong,
        places: tuple[Place, ...],
        closed: tuple[Place, ...],
        stretches: tuple[Visit, ...] = (),
    ) -> tuple[Place, ...]:
        """Return the optional visits to make, in visiting order, and record them as a step.

        Args:
            walker: Handler of a walk that has reached the for-each, or work along a path.
            node: The for-each or the work.
            places: Reachable places, with stands.
            closed: Places that can never be reached.
            stretches: The visits themselves, if they are stretches of work.
        """

    def takes(self, walker: ForecastHandler, node: OptionalStep) -> bool:
        """Return True if an optional step is done, and record the decision as a step."""


class SkipOptionalWork:
    """Policy that leaves out all optional work."""

    def visits(
        self,
        walker: ForecastHandler,
        node: ForEach | WorkAlong,
        places: tuple[Place, ...],  # noqa: ARG002
        closed: tuple[Place, ...],
        stretches: tuple[Visit, ...] = (),  # noqa: ARG002
    ) -> tuple[Place, ...]:
        walker.note(WalkStep(node=node, kind="visit-list", context=walker.context, shed=closed))
        return ()

    def takes(self, walker: ForecastHandler, node: OptionalStep) -> bool:  # noqa: ARG002
        return False


class PlannedVisits:
    """The visits of a for-each.

    Args:
        places: Places in visiting order, with stands.
        work: Work of each visit, excluding drives.
        pace_m_s: Speed limit of the drives to them.
    """

    def __init__(self, places: tuple[Place, ...], work: Work | None = None, pace_m_s: float = math.inf) -> None:
        self._places, self._work, self._pace, self._begun = places, work or Work(), pace_m_s, 0

    def next(self) -> Place | None:
        """Return the next place; None after the last."""
        if self._begun == len(self._places):
            return None
        self._begun += 1
        return self._places[self._begun - 1]

    @property
    def to_come(self) -> tuple[Visit, ...]:
        """Return the visits that have not begun."""
        seconds, joules = self._work.seconds, self._work.joules
        left = self._places[self._begun :]
        return tuple(Visit(place=p, service_s=seconds, service_j=joules, pace_m_s=self._pace) for p in left)


class ForecastHandler(WalkState):
    """Handler that answers the instructions of a Task's nodes and records the resulting steps.

    Args:
        task, site, robot, drives, answers, context, samples, readings: As for :class:`WalkState`.
        charge_percent: Battery charge at the start of the mission, 0 to 100.
        optional: Policy for optional visits and steps; by default all are left out.
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
        optional: OptionalWorkPolicy | None = None,
        context: Context | None = None,
        samples: MissionSamples | None = None,
        readings: BranchReadings | None = None,
    ) -> None:
        super().__init__(task, site, robot, drives, answers, context=context, samples=samples, readings=readings)
        self.charge_percent, self._optional = charge_percent, optional or SkipOptionalWork()
        self._nodes = 0
        #: Probability of running short that optional visits may still add; None before the first of them.
        self.allowance: RiskAllowance | None = None
        self.plan.entered = self._entered

    def run(self, nodes: Sequence[Node]) -> Walk:
        """Walk nodes in order, then the exit."""
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
            used=self._used(),
        )

    def _used(self) -> SampledUse | None:
        """Return the resources used by the sampled missions, with their charges."""
        if self.samples is None:
            return None
        missions = self.charged(ends=True)
        return self.samples.used if missions is None else missions.used

    def charged(self, *, ends: bool = False) -> ChargingMissions | None:
        """Return the sampled missions so far with their charges; None if none are sampled, or they do not recharge.

        Args:
            ends: True if they end here.
        """
        rules = recharge_rules(self.task, self.site, self.robot)
        if rules is None or self.samples is None:
            return None
        return charged_missions(
            self.sampled, self.task, rules, self.drives, self.samples, self.charge_percent, ends=ends
        )

    def along(self, node: Node) -> tuple[WalkStep, ...]:
        """Return the steps of one node without an exit, up to the first place that cannot be resolved from here.

        Raises:
            PlaceError: Its first place cannot be resolved.
            DriveFault: A place cannot be reached.
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
        """The remaining mandatory visits of the current loops, innermost first."""
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

    def _answer(self, request: ask.Instruction) -> Any:
        """Answer an instruction of a node."""
        match request:
            case ask.DriveTo(node=node, place=place, back=back):
                if not back or self._stuck:
                    self._drive_to(node, place)
                return self.context.here
            case ask.BindLabel(label=label, places=places):
                return self._bind(label, *places)
            case ask.Capture(node=act):
                return self._capture(act)
            case ask.WaitFor(node=node, seconds=seconds):
                here = (self.context.here,)
                self.note(WalkStep(node=node, kind="wait", context=self.context, places=here, seconds=seconds))
            case ask.Charge(node=recharge):
                return self._recharge(recharge)
            case ask.Locate(node=node, selector=selector):
                if selector is None:
                    return self.context.here
                return visit_order.place_of(node, selector, self.site, self.context)
            case ask.Decide(node=node):
                return self.decide(node, "holds")
            case ask.NextVisit(tour=tour):
                return tour.next()
            case ask.BeginVisits(node=for_each):
                return self._begin_visits(for_each)
            case ask.BeginStretches(node=work):
                return self._begin_stretches(work)
            case ask.WorkStretch(node=work, tour=tour):
                self._work_along(work, tour.current)
            case ask.OfferStep(node=optional):
                return self._optional.takes(self, optional)
            case ask.ArrangeSteps(node=any_order):
                home = visit_order.home_if_last(self.task, self.site, any_order.id, self.context.here)
                return visit_order.steps_in_order(any_order, self.site, self.drives, self.context, home)
            case ask.ForgetReading(reading=reading):
                if self.readings is not None:
                    self.readings.lose(reading)
            case ask.BeginSeries(reading=reading):
                self.discard(reading)
            case ask.SetReading(node=act, reading=reading):
                if self.readings is not None:
                    self.readings.take(reading, act.action)
            case ask.Permit() | ask.BeginRound():
                pass
        return None

    def _begin_visits(self, node: ForEach) -> PlannedVisits:
        """Return the visits of a for-each in visiting order."""
        try:
            places = visit_order.places_of(node, node.select, self.site, self.context)
        except NoPlaceError:
            if not may_have_none(self.task, node.select):
                raise
            places = ()
        if not node.optional:
            home = visit_order.home_if_last(self.task, self.site, node.id, self.context.here)
            places = visit_order.visits_in_order(node, self.drives, self.context.here, places, home, self.robot)
            self.note(WalkStep(node=node, kind="visit-list", context=self.context, places=places))
            return PlannedVisits(places, work_of(node.body, self.robot), self.plan.pace_m_s)
        open_, closed = visit_order.reachable(self.drives, places)
        return PlannedVisits(
            self._optional.visits(self, node, visit_order.with_stands(self.drives, self.context.here, open_), closed)
        )

    def _begin_stretches(self, node: WorkAlong) -> PlannedStretches:
        """Return the stretches of work along a path in driving order."""
        stretches = stretches_of(node, self.task, self.site, self.robot, self.drives, self.context)
        visits = tuple(visit_of(s, node, self.task, self.site, self.robot) for s in stretches)
        places = tuple(visit.place for visit in visits)
        if node.optional:
            made = self._optional.visits(self, node, places, (), visits)
            order = [places.index(place) for place in made]
            return PlannedStretches([stretches[k] for k in order], [visits[k] for k in order])
        self.note(WalkStep(node=node, kind="visit-list", context=self.context, places=places))
        return PlannedStretches(stretches, visits)

    def _recharge(self, node: Recharge) -> None:
        """Record a charge of the battery; how long it takes depends on the charge of each sampled mission."""
        work = work_of(node, self.robot)
        self.note(
            WalkStep(
                node=node,
                kind="charge",
                context=self.context,
                places=(self.context.here,),
                seconds=work.seconds,
                joules=work.joules,
            )
        )

    def _capture(self, node: Act) -> Mapping[str, float]:
        """Record the captures of an action, which may fail inside a ``Try``.

        Raises:
            Failed: The action fails on this branch.
        """
        action = self.robot.action[node.action]
        fails = self.plan.is_caught and self.decide(node, "fails")
        # A failing action is assumed to fail at its last capture, at every retry.
        again = retry_work(node, self.robot) if fails else Work()
        turn, faces = self._face(action.camera)
        self.collect(node, node.count - fails)
        self.note(
            WalkStep(
                node=node,
                kind="act",
                context=self.context,
                places=(self.context.here,),
                captures=node.count - fails,
                seconds=node.count * action.duration_s + again.seconds + turn,
                joules=node.count * action.energy_j + again.joules,
                heading_deg=faces.heading_deg,
                sees=faces.sees,
            )
        )
        if fails:
            raise Failed(node.id)
        return {}
