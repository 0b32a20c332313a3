"""Execution of a plan's requests (:mod:`fieldhand.task.instructions`) on the robot."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from typing import Any

from fieldhand.errors import BlockedFault, DriveFault, FieldhandError, OutputError, PlaceError
from fieldhand.execution.attempt import Attempt, Ending
from fieldhand.execution.giving_up import Over, admit, first_places_of, give_up_unreachable, shed, to_come, visit_to
from fieldhand.execution.goals import capture, drive
from fieldhand.execution.obstacles import open_a_way
from fieldhand.execution.tours import OneVisit, Tour
from fieldhand.forecast.conditions import evaluate
from fieldhand.forecast.mission_state import VisitChoice
from fieldhand.forecast.visit_order import home_if_last, steps_in_order
from fieldhand.language import message
from fieldhand.places.selector import Selector
from fieldhand.site.model import Place
from fieldhand.task import instructions as ask
from fieldhand.task.conditions import Condition
from fieldhand.task.nodes.base import Failed, GivenUp, Stopped
from fieldhand.task.plan import Act, AnyOrder, Node, OptionalStep
from fieldhand.task.results import Decided, MissionStatus
from fieldhand.task.run import Steps, carry_out_in_steps

Answer = Generator[None, None, Any]


class Performer:
    """Carries out a plan on the robot.

    Args:
        attempt: The mission.

    Attributes:
        place: Place of the current drive or action, once it is known.
        between: True between two rounds or visits, when operator commands are read.
    """

    def __init__(self, attempt: Attempt) -> None:
        self.attempt = attempt
        self.place: Place | None = None
        self.between = False

    def program(self) -> Steps:
        """Carry out the whole plan; yield while the robot is busy, and between rounds.

        It ends with the plan, done or failed, or when :attr:`Attempt.ending` is set.

        Raises:
            OutputError: An event cannot be written.
        """
        run = self.attempt.run
        try:
            yield from carry_out_in_steps(run.program(), self._perform)
        except Failed:
            pass  # the mission has recorded the fault
        except Over:
            pass
        except Stopped as stopped:
            self._stop(stopped)

    def _perform(self, request: ask.Instruction) -> Answer:
        """Carry out a request; record a failure and raise it in the plan."""
        try:
            return (yield from self._answer(request))
        except OutputError:
            raise
        except FieldhandError as error:
            raise self._failure(request, error) from error

    def _failure(self, request: ask.Instruction, error: FieldhandError) -> Failed | GivenUp:
        """Record a failure, and return the exception to raise in the plan."""
        at_work = isinstance(request, ask.Locate | ask.DriveTo | ask.Capture)
        if isinstance(error, BlockedFault) and at_work:
            if isinstance(request, ask.DriveTo) and request.tour is not None:
                request.tour.cannot_reach(error)
                return GivenUp(request.node.id)
            if optional := give_up_unreachable(self.attempt, error.what):
                return GivenUp(optional)
        self.attempt.fail(request.node.id, error, handled=self.attempt.run.is_caught)
        return Failed(request.node.id)

    def _answer(self, request: ask.Instruction) -> Answer:
        match request:
            case ask.Locate(selector=selector):
                return (yield from self._locate(request.node, selector))
            case ask.Permit(node=node, place=place):
                admit(self.attempt, visit_to(self.attempt, place, node), refused=[place])
            case ask.DriveTo():
                return (yield from self._drive(request))
            case ask.BindLabel(label=label, places=places):
                self.attempt.bind(label, places)
            case ask.Capture(node=act):
                return (yield from self._capture(act))
            case ask.ForgetReading(reading=reading):
                self.attempt.readings.pop(reading, None)
            case ask.SetReading(reading=reading, value=value):
                self.attempt.readings[reading] = value
            case ask.Decide(node=node, condition=condition):
                return self._decide(node, condition)
            case ask.ArrangeSteps(node=any_order):
                return self._arrange(any_order)
            case ask.BeginVisits(node=for_each):
                return Tour(self.attempt, for_each)
            case ask.NextVisit(tour=tour, made=made):
                self.place = None
                yield from self._look_around(first=tour.place is None and made == 0)
                return tour.next(made)
            case ask.BeginRound(node=repeat, left=left):
                yield from self._look_around(first=left == repeat.times - 1)
            case ask.OfferStep(node=optional):
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
        attempt, self.place = self.attempt, None
        if selector is None:
            self.place = attempt.here
            return attempt.here
        place = attempt.resolve_one(selector)
        if not attempt.is_at(place) and attempt.standing != place:
            yield from open_a_way(attempt, node.id, place)
        self.place = there = attempt.reached(place)
        return there

    def _drive(self, request: ask.DriveTo) -> Generator[None, None, Place]:
        """Drive to a place; ask the guard again if an obstacle changes the way."""
        attempt, node = self.attempt, request.node
        tour: Tour | None = request.tour
        place: Place = request.place
        self.place = place
        if request.back and attempt.standing == place:
            return place

        def ask(there: Place) -> Steps:
            yield from ()
            if tour is not None:
                tour.permit(there)
            else:
                admit(attempt, visit_to(attempt, there, node), refused=[there])

        yield from drive(attempt, node.id, place, patient=tour is None or tour.is_last_resort, ask=ask)
        if tour is not None:
            tour.arrived()
        return place

    def _capture(self, node: Act) -> Generator[None, None, Mapping[str, float]]:
        readings: Mapping[str, float] = {}
        for _ in range(node.count):
            readings = yield from capture(self.attempt, node)
        return readings

    def _decide(self, node: Node, condition: Condition) -> bool:
        attempt = self.attempt
        found = evaluate(condition, attempt.facts)
        attempt.emit(Decided(t=attempt.t, node=node.id, holds=found.holds, why=found.why))
        return found.holds

    def _arrange(self, node: AnyOrder) -> tuple[int, ...]:
        """Return the order with the shortest drives from here.

        If a step has no place, keep the given order: that step reports it itself.
        """
        attempt = self.attempt
        home = home_if_last(attempt.task, attempt.site, node.id, attempt.here)
        try:
            return steps_in_order(node, attempt.site, attempt.drives, attempt.state().context, home)
        except (PlaceError, DriveFault):
            return tuple(range(len(node.steps)))

    def _offer(self, node: OptionalStep) -> bool:
        """Ask the guard whether the step may be done; report it as given up if not."""
        attempt = self.attempt
        state = attempt.state()
        try:
            visit = attempt.visits.of_step(node, state.context)
        except DriveFault as fault:
            why = message("cannot be reached: {why}", context="log", why=fault.what)
            never = VisitChoice(index=None, reason=why)
            shed(attempt, node.id, first_places_of(node, attempt), never, optional=True, cause="unreachable")
            return False
        attempt.run.frame.tour = OneVisit(place=visit.place)
        choice = attempt.guard.choose(state, [visit], still_to_come=to_come(attempt))
        if choice.index is None:
            shed(attempt, node.id, [visit.place], choice, optional=True)
        return choice.index is not None

    def _stop(self, stopped: Stopped) -> None:
        attempt, stop = self.attempt, stopped.node
        nominal = stop.exit == "nominal"
        status: MissionStatus = "completed" if nominal else "faulted"
        attempt.end(
            Ending(
                status=status,
                exit=stop.exit,
                then=attempt.task.composition.nominal if nominal else attempt.exit_for("action_failed"),
                reason=message("the plan says to stop here", context="log"),
                node=stop.id,
            )
        )
