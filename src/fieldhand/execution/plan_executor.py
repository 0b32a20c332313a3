"""Execution of a plan's requests (:mod:`fieldhand.task.instructions`) on the robot."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import replace
from typing import Any

from fieldhand.errors import BlockedFault, DriveFault, FieldhandError, OccupiedFault, OutputError, PlaceError
from fieldhand.execution.active_mission import ActiveMission, Ending
from fieldhand.execution.docking import ChargeFirst
from fieldhand.execution.for_each_visits import ForEachVisits, OptionalStepVisit
from fieldhand.execution.goals import capture, drive
from fieldhand.execution.leaving_out import can_leave_out
from fieldhand.execution.obstacles import wait_for_way
from fieldhand.execution.recharging import charge_and_return, charge_as_planned
from fieldhand.execution.shed_work import (
    PlanOver,
    admit,
    first_places_of,
    mandatory_visit,
    mandatory_visits_left,
    report_shed,
    shed_rest,
    shed_unreachable,
)
from fieldhand.execution.stretch_visits import StretchVisits
from fieldhand.execution.waiting import dwell
from fieldhand.execution.working import work
from fieldhand.forecast.conditions import evaluate
from fieldhand.forecast.mission_state import Verdict, Visit, VisitChoice
from fieldhand.forecast.visit_order import home_if_last, steps_in_order
from fieldhand.language import message
from fieldhand.places.selector import Selector
from fieldhand.site.model import Place
from fieldhand.task import instructions
from fieldhand.task.conditions import Condition
from fieldhand.task.nodes.base import Cut, Failed, GivenUp, Stopped
from fieldhand.task.plan import Act, AnyOrder, Node, OptionalStep, WorkAlong
from fieldhand.task.results import Decided, MissionStatus
from fieldhand.task.run import StackFrame, Steps, carry_out_in_steps

Instructions = Generator[None, None, Any]


class PlanExecutor:
    """Carries out a plan on the robot.

    Args:
        mission: The mission.

    Attributes:
        place: Place of the current drive or action, once it is known.
        between: True between two rounds or visits, when operator commands are read.
    """

    def __init__(self, mission: ActiveMission) -> None:
        self.mission = mission
        self.place: Place | None = None
        self.between = False
        self._charged_again = False

    def program(self) -> Steps:
        """Carry out the whole plan; yield while the robot is busy, and between rounds.

        It ends with the plan, done or failed, or when :attr:`ActiveMission.ending` is set.

        Raises:
            OutputError: An event cannot be written.
        """
        run = self.mission.run
        try:
            yield from carry_out_in_steps(run.program(), self._perform)
            yield from self._charge_for_the_way_home()
        except Failed:
            pass  # the mission has recorded the fault
        except PlanOver:
            pass
        except Stopped as stopped:
            self._stop(stopped)

    @property
    def visit(self) -> ForEachVisits | None:
        """The innermost for-each with a current visit; None between visits and outside of loops."""
        if self.between:
            return None
        tours = (frame.tour for frame in self.mission.run.outwards())
        return next((tour for tour in tours if isinstance(tour, ForEachVisits) and tour.place is not None), None)

    def _perform(self, request: instructions.Instruction) -> Instructions:
        """Carry out a request; record a failure and raise it in the plan."""
        try:
            return (yield from self._answer_charged(request))
        except OutputError:
            raise
        except FieldhandError as error:
            raise self._failure(request, error) from error

    def _failure(self, request: instructions.Instruction, error: FieldhandError) -> Failed | GivenUp | Cut:
        """Record a failure, and return the exception to raise in the plan."""
        at_work = isinstance(request, instructions.Locate | instructions.DriveTo | instructions.Capture)
        if isinstance(error, BlockedFault) and at_work:
            if isinstance(request, instructions.DriveTo) and request.tour is not None:
                request.tour.cannot_reach(error)
                return GivenUp(request.node.id)
            if optional := shed_unreachable(self.mission, error.what):
                return GivenUp(optional)
            at = self.place
            if isinstance(error, OccupiedFault) and at is not None and can_leave_out(self.mission.run):
                never = VisitChoice(index=None, reason=error.what, cause="unreachable")
                report_shed(self.mission, request.node.id, [at], never, optional=False)
                return Cut(request.node.id)
        self.mission.fail(request.node.id, error, handled=self.mission.run.is_caught)
        return Failed(request.node.id)

    def _answer_charged(self, request: instructions.Instruction) -> Instructions:
        """Carry out a request, as often interrupted to charge the battery as is needed."""
        moves = isinstance(request, instructions.Permit | instructions.DriveTo | instructions.NextVisit)
        while True:
            try:
                if moves and self.mission.recharge_due:
                    raise ChargeFirst(self.mission.recharge_due, self.mission.farthest_target)
                return (yield from self._answer(request))
            except ChargeFirst as first:
                yield from self._charge(first.why, first.until_percent)

    def _charge(self, why: str, until_percent: float) -> Steps:
        """Interrupt the plan to charge; the mission ends if that fails for good.

        Raises:
            PlanOver: It has failed.
        """
        mission, again = self.mission, self.mission.charged_in_vain
        in_vain = again and not mission.turns and (bool(mission.recharge_due) or self._charged_again)
        self._charged_again = again
        try:
            yield from charge_and_return(mission, why, until_percent)
        except OutputError:
            raise
        except FieldhandError as error:
            mission.fail("", error, handled=False)
            shed_rest(mission, self.place, Verdict(go=False, reason=mission.what))
            then = mission.exit_for("low_budget")
            mission.end(Ending(status="faulted", exit="faulted", then=then, reason=mission.what))
            raise PlanOver from error
        if in_vain:
            # A charged battery did not last for the next visit: the robot would go to and fro for ever.
            what = message("not even a charged battery lasts for the next visit: {why}", context="log", why=why)
            shed_rest(mission, self.place, Verdict(go=False, reason=what))
            then = mission.exit_for("low_budget")
            mission.end(Ending(status="returned", exit="faulted", then=then, reason=what))
            raise PlanOver

    def _charge_for_the_way_home(self) -> Steps:
        """Charge once more if the plan is done but the charge does not suffice for the way home."""
        mission = self.mission
        if not mission.task.constraints.recharge or mission.charger is None:
            return
        home = mission.site.home(mission.task.composition.nominal, mission.standing)
        state = mission.state()
        state = replace(state, frames=(StackFrame(node=mission.run.plan),))
        verdict = mission.guard.admit(state, Visit(place=home, ends=True))
        if verdict.charge_to:
            yield from self._charge(verdict.reason, verdict.charge_to)

    def _answer(self, request: instructions.Instruction) -> Instructions:
        match request:
            case instructions.Locate(selector=selector):
                return (yield from self._locate(request.node, selector))
            case instructions.Permit(node=node, place=place):
                admit(self.mission, mandatory_visit(self.mission, place, node), refused=[place])
            case instructions.DriveTo():
                return (yield from self._drive(request))
            case instructions.BindLabel(label=label, places=places):
                self.mission.bind(label, places)
            case instructions.Capture(node=act):
                return (yield from self._capture(act))
            case instructions.WaitFor(node=node, seconds=seconds):
                yield from self._wait(node, seconds)
            case instructions.Charge(node=node):
                yield from charge_as_planned(self.mission, node)
            case instructions.ForgetReading(reading=reading):
                self.mission.readings.pop(reading, None)
            case instructions.SetReading(reading=reading, value=value):
                self.mission.readings[reading] = value
            case instructions.BeginSeries(reading=reading):
                self.mission.series.pop(reading, None)
            case instructions.Decide(node=node, condition=condition):
                return self._decide(node, condition)
            case instructions.ArrangeSteps(node=any_order):
                return self._arrange(any_order)
            case instructions.BeginVisits(node=for_each):
                return ForEachVisits(self.mission, for_each)
            case instructions.BeginStretches(node=along):
                return StretchVisits(self.mission, along)
            case instructions.WorkStretch(node=along, tour=stretches):
                yield from self._work(along, stretches)
            case instructions.NextVisit(tour=tour, made=made):
                self.place = None
                yield from self._look_around(first=tour.place is None and made == 0)
                return tour.next(made)
            case instructions.BeginRound(node=repeat, left=left):
                yield from self._look_around(first=left == repeat.times - 1)
            case instructions.OfferStep(node=optional):
                return self._offer(optional)
        return None

    def _look_around(self, *, first: bool) -> Steps:
        """Yield between one round and the next, so that commands and limits are checked."""
        if first:
            return
        self.between = True
        yield
        self.between = False

    def _locate(self, node: Node, selector: Selector | None) -> Generator[None, None, Place]:
        """Return the place with its stand; wait if obstacles leave no way."""
        mission, self.place = self.mission, None
        if selector is None:
            self.place = mission.here
            return mission.here
        place = mission.resolve_one(selector)
        if not mission.is_at(place) and mission.standing != place:
            yield from wait_for_way(mission, node.id, place)
        self.place = there = mission.reached(place, node.id)
        return there

    def _drive(self, request: instructions.DriveTo) -> Generator[None, None, Place]:
        """Drive to a place; ask the guard again if an obstacle changes the way."""
        mission, node = self.mission, request.node
        tour: ForEachVisits | StretchVisits | None = request.tour
        place: Place = request.place
        self.place = place
        if request.back and mission.standing == place:
            return place

        def ask_guard(there: Place) -> Steps:
            yield from ()
            if tour is not None:
                tour.permit(there)
            else:
                admit(mission, mandatory_visit(mission, there, node), refused=[there])

        yield from drive(mission, node.id, place, patient=tour is None or tour.is_last_resort, ask_guard=ask_guard)
        if tour is not None:
            tour.arrived()
            if mission.task.composition.watches:
                yield  # a visit can be left out on arrival
        return place

    def _capture(self, node: Act) -> Generator[None, None, Mapping[str, float]]:
        readings: Mapping[str, float] = {}
        yield from self._have_enough_for(node)
        for _ in range(node.count):
            if self.mission.recharge_due:
                yield from self._charge(self.mission.recharge_due, self.mission.charge_target)
                yield from drive(self.mission, "", self.mission.here)
            readings = yield from capture(self.mission, node)
            self.mission.collect(node.reading, readings)
        return readings

    def _have_enough_for(self, node: Act) -> Steps:
        """Charge before an action if the drive to it took more than expected, and come back."""
        mission = self.mission
        if not mission.may_recharge or mission.charged_in_vain:
            return
        visit = mandatory_visit(mission, mission.here, node)
        verdict = mission.guard.admit(mission.state(), visit, mandatory_visits_left(mission))
        if verdict.charge_to:
            yield from self._charge(verdict.reason, verdict.charge_to)
            yield from drive(mission, "", mission.here)

    def _wait(self, node: Node, seconds: float) -> Steps:
        """Stand still where the robot is; the battery is charged before or in between if need be."""
        mission = self.mission
        here = self.place = mission.standing
        try:
            admit(mission, mandatory_visit(mission, here, node), refused=[here])
        except ChargeFirst as first:
            yield from self._charge(first.why, first.until_percent)
            yield from drive(mission, "", mission.here)

        def charge() -> Steps:
            yield from self._charge(mission.recharge_due, mission.charge_target)
            yield from drive(mission, "", mission.here)

        yield from dwell(mission, node.id, seconds, charge)

    def _work(self, node: WorkAlong, tour: StretchVisits) -> Steps:
        """Work along the current stretch, interrupted to charge the battery if need be."""
        while True:
            try:
                yield from work(self.mission, node, tour)
            except ChargeFirst as first:
                yield from self._charge(first.why, first.until_percent)
                assert tour.place is not None  # noqa: S101  a stretch is current
                yield from drive(self.mission, node.id, tour.place)
            else:
                return

    def _decide(self, node: Node, condition: Condition) -> bool:
        mission = self.mission
        found = evaluate(condition, mission.facts)
        mission.emit(Decided(t=mission.t, node=node.id, holds=found.holds, why=found.why))
        return found.holds

    def _arrange(self, node: AnyOrder) -> tuple[int, ...]:
        """Return the order with the shortest drives from here.

        If a step has no place, keep the given order: that step reports it itself.
        """
        mission = self.mission
        home = home_if_last(mission.task, mission.site, node.id, mission.here)
        try:
            return steps_in_order(node, mission.site, mission.drives, mission.state().context, home)
        except (PlaceError, DriveFault):
            return tuple(range(len(node.steps)))

    def _offer(self, node: OptionalStep) -> bool:
        """Ask the guard whether the step may be done; report it as given up if not."""
        mission = self.mission
        state = mission.state()
        try:
            visit = mission.visits.of_step(node, state.context)
        except DriveFault as fault:
            why = message("cannot be reached: {why}", context="log", why=fault.what)
            never = VisitChoice(index=None, reason=why, cause="unreachable")
            report_shed(mission, node.id, first_places_of(node, mission), never, optional=True)
            return False
        mission.run.frame.tour = OptionalStepVisit(place=visit.place)
        choice = mission.guard.choose(state, [visit], still_to_come=mandatory_visits_left(mission))
        if choice.charge_to:
            raise ChargeFirst(choice.reason, choice.charge_to)
        if choice.index is None:
            report_shed(mission, node.id, [visit.place], choice, optional=True)
        return choice.index is not None

    def _stop(self, stopped: Stopped) -> None:
        mission, stop = self.mission, stopped.node
        nominal = stop.exit == "nominal"
        status: MissionStatus = "completed" if nominal else "faulted"
        mission.end(
            Ending(
                status=status,
                exit=stop.exit,
                then=mission.task.composition.nominal if nominal else mission.exit_for("action_failed"),
                reason=message("the plan says to stop here", context="log"),
                node=stop.id,
            )
        )
