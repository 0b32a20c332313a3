"""The state of a walk: its steps and answers, current place, and resources used."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.forecast import visit_order
from fieldhand.forecast.expected_charge import ExpectedCharge
from fieldhand.forecast.headings import Facing, cameras_of, facing, turn_s, way_in
from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.forecast.possible_answers import BranchReadings
from fieldhand.forecast.resource_limits import slower_s_per_m, speed_of
from fieldhand.forecast.sampled_costs import MissionSamples, SampledVisits
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.forecast.walk_steps import Decision, DecisionKind, NodeAnswer, StepKind, WalkStep, never
from fieldhand.forecast.working import end_of, use_of
from fieldhand.places.context import Context, VisitedIds
from fieldhand.places.reading_series import ReadingSeries, TakenReading
from fieldhand.robot.camera import Camera
from fieldhand.robot.model import RobotProfile
from fieldhand.site.bearings import first_heading, last_heading
from fieldhand.site.model import Place, Site
from fieldhand.task.collected import collected
from fieldhand.task.frames import Task
from fieldhand.task.nodes.base import Failed
from fieldhand.task.plan import Act, Node, WorkAlong
from fieldhand.task.run import PlanRun

if TYPE_CHECKING:
    from fieldhand.forecast.charged_visits import ChargedVisits
    from fieldhand.orienteering.preview import Preview
    from fieldhand.site.drives import Drive, Drives
    from fieldhand.site.working.stretch import Stretch


def _always(node_id: str) -> bool:  # noqa: ARG001
    """Answer that every condition holds."""
    return True


#: Returns the values of an action's captures, given its id.
ReadingsAnswer = Callable[[str], Sequence[Mapping[str, float]]]


def nothing(node_id: str) -> Sequence[Mapping[str, float]]:  # noqa: ARG001
    """Answer that no value is known."""
    return ()


@dataclass(frozen=True, kw_only=True)
class Answers:
    """Sources of the answers that a walk cannot determine itself.

    Attributes:
        holds: Called with the id of each ``If`` that is reached, and of a loop with ``until`` after each of its rounds.
        fails: Called with the id of each action inside a ``Try``; actions outside of one never fail on a walk.
        blocked: Called with the id of each driving node inside a ``Try``; True if the drive never arrives.
        taken: Called with the id of each optional step, if the walk does not make the most probable choice.
        measured: Called with the id of each action whose readings are used as a series, for the values of its captures;
            unknown in a forecast.
    """

    holds: NodeAnswer = _always
    fails: NodeAnswer = never
    blocked: NodeAnswer = never
    taken: NodeAnswer = never
    measured: ReadingsAnswer = nothing

    def of(self, kind: DecisionKind) -> NodeAnswer:
        """Return the source of answers to a kind of decision."""
        by_kind: dict[DecisionKind, Callable[[str], bool]] = {
            "holds": self.holds,
            "fails": self.fails,
            "blocked": self.blocked,
            "taken": self.taken,
        }
        return by_kind[kind]


class WalkState:
    """The state of a walk.

    Args:
        task, site, robot, drives: Task, site, robot and drives of the mission.
        answers: Answers that the walk cannot determine itself.
        context: Initial context; the start of the site by default.
        samples: Missions sampled along the walk; None to sample none.
        readings: Readings taken on the way; None if the walk begins in the middle of a mission, where they are unknown.
    """

    #: Battery charge at the start of the mission, 0 to 100.
    charge_percent: float = 100.0

    def __init__(
        self,
        task: Task,
        site: Site,
        robot: RobotProfile,
        drives: Drives,
        answers: Answers,
        *,
        context: Context | None = None,
        samples: MissionSamples | None = None,
        readings: BranchReadings | None = None,
    ) -> None:
        self.task, self.site, self.robot, self.drives = task, site, robot, drives
        self._answers, self.readings = answers, readings
        #: Initial context of the walk.
        self.beginning = context or Context(here=visit_order.start_place(drives))
        self.context = self.beginning
        self._visited = VisitedIds(self.beginning.visited)
        #: Position of the robot itself: the current place, or the point where a drive was blocked.
        self._standing = self.context.here
        self._speed = speed_of(task.constraints, robot)
        self._slow = slow_ground(task.constraints, site, robot)
        self._cameras = cameras_of(task.composition.plan, robot)
        #: Heading of the robot in degrees clockwise from north; None if it is unknown, or never matters.
        self._heading_deg: float | None = None
        self.steps: list[WalkStep] = []
        self.decisions: list[Decision] = []
        #: Tests of readings that were not taken: node id and reading.
        self.unread: list[tuple[str, str]] = []
        #: Id of the node of the last drive, successful or not.
        self.bound_for = ""
        #: Execution of the plan, with its current nodes.
        self.plan = PlanRun(task.composition.plan)
        self._collected = collected(task.composition.plan)
        self.samples = samples
        self.spent = Spent()
        self._charge = ExpectedCharge(task, robot)
        #: Steps and optional visits in order, as the sampled missions do them.
        self.sampled: list[WalkStep | SampledVisits] = []
        #: Destinations in order, including those at which the walk already was.
        self.stops: list[Place] = []
        #: Positions in ``stops`` from which a stretch leads to the next one.
        self.worked: set[int] = set()

    def _drive_to(self, node: Node, place: Place) -> None:
        if not self.context.here.covers(place) or self._stuck:
            leg = self._leg(node, "drive", place)
            if self.plan.is_caught and self.decide(node, "blocked"):
                # Worst case: the whole way is driven, and the robot stops just before the place.
                self.note(replace(leg, reached=False))
                self._standing = _on_the_way(leg.places[0])
                raise Failed(node.id)
            self.note(leg)
            (place,) = leg.places
        else:
            place = self.context.here
        self.stops.append(place)
        if place.kind == "tree":
            self._visited = self._visited.plus(place.id)
        self._stand(replace(self.context, here=place, visited=self._visited))

    def _work_along(self, node: WorkAlong, stretch: Stretch) -> None:
        """Record the work along a stretch from its begin, where the walk is, to its end."""
        end = end_of(stretch, self.site)
        if self.plan.is_caught and self.decide(node, "fails"):
            # Worst case: it fails just before the end, where the robot then stands.
            self.note(self._stretch_step(node, stretch, end, reached=False))
            self._standing = _on_the_way(end)
            raise Failed(node.id)
        self.note(self._stretch_step(node, stretch, end))
        self.worked.add(len(self.stops) - 1)
        self.stops.append(end)
        self._heading_deg = last_heading(stretch.points)
        self._stand(replace(self.context, here=end, visited=self._visited))

    def _stretch_step(self, node: WorkAlong, stretch: Stretch, end: Place, *, reached: bool = True) -> WalkStep:
        use = use_of(stretch, node, self.task.constraints, self.robot, self._slow)
        turn = turn_s(self.robot, self._heading_deg, first_heading(stretch.points))
        return WalkStep(
            node=node,
            kind="work",
            context=self.context,
            places=(end,),
            seconds=use.seconds + turn,
            joules=use.metres * self.robot.energy.drive_j_per_m + use.implement_j,
            stretch=stretch,
            work=use.work(self._speed) + Work(seconds=turn),
            reached=reached,
        )

    def _exit(self, node: Node, home: Place, *, goes: bool) -> None:
        if not goes or (home.xy == self.context.here.xy and not self._stuck):
            if goes:
                self.stops.append(self.context.here)
            self.note(WalkStep(node=node, kind="exit", context=self.context, places=(home,)))
            return
        leg = self._leg(node, "exit", home)
        self.note(leg)
        (home,) = leg.places
        self.stops.append(home)
        self._stand(replace(self.context, here=home))

    @property
    def slower_s_per_m(self) -> float:
        """Return the seconds per metre that the pace of the current nodes adds to those of the mission."""
        return slower_s_per_m(self.task.constraints, self.robot, self.plan.pace_m_s)

    @property
    def choosing_pace_m_s(self) -> float:
        """Return the speed at which optional visits are chosen: all driving counts as slow as its slowest part."""
        return min(self.plan.pace_m_s, self._slow.slowest_m_s)

    @property
    def choosing_slower_s_per_m(self) -> float:
        """Return the seconds per metre that this speed adds to that of the mission."""
        return slower_s_per_m(self.task.constraints, self.robot, self.choosing_pace_m_s)

    @property
    def _stuck(self) -> bool:
        return self._standing is not self.context.here

    def _stand(self, context: Context) -> None:
        self.context, self._standing = context, context.here

    def _leg(self, node: Node, kind: StepKind, place: Place) -> WalkStep:
        self.bound_for = node.id
        camera = self._cameras.get(node.id) if kind == "drive" else None
        drive = way_in(self.drives, self.robot, self._standing, place, camera)
        turn, heading = self._turn(drive, camera)
        slower = 0.0 if kind == "exit" else self.slower_s_per_m
        if self._slow and drive.length_m:
            slower += self._slow.extra_s(drive.points, 1.0 / (1.0 / self._speed + slower)) / drive.length_m
        return WalkStep(
            node=node,
            kind=kind,
            context=self.context,
            places=(drive.end,),
            drive=drive,
            seconds=drive.length_m * (1.0 / self._speed + slower) + turn,
            joules=drive.length_m * self.robot.energy.drive_j_per_m,
            slower_s_per_m=slower,
            heading_deg=heading,
            turn_s=turn,
        )

    def _turn(self, drive: Drive, camera: Camera | None) -> tuple[float, float | None]:
        """Return the seconds of turning on the spot before and after a drive, and the heading after it."""
        if not self._cameras and self.robot.turn_deg_s is None:
            return 0.0, None
        along = self.drives.heading_after(drive)
        before, self._heading_deg = self._heading_deg, along
        if along is None:
            self._heading_deg = before
        self._heading_deg = facing(self.drives, self.robot, drive.end, camera, self._heading_deg).heading_deg
        turn = turn_s(self.robot, before, first_heading(drive.points))
        return turn + turn_s(self.robot, last_heading(drive.points), self._heading_deg), self._heading_deg

    def _face(self, camera: Camera | None) -> tuple[float, Facing]:
        """Turn the robot for a camera; return the seconds that takes, and its heading."""
        if camera is None:
            return 0.0, Facing(heading_deg=self._heading_deg)
        faces = facing(self.drives, self.robot, self.context.here, camera, self._heading_deg)
        turn = turn_s(self.robot, self._heading_deg, faces.heading_deg)
        self._heading_deg = faces.heading_deg
        return turn, faces

    def decide(self, node: Node, kind: DecisionKind) -> bool:
        """Return the answer to a question that the walk cannot determine itself, and record it as a decision."""
        condition = node.tested if kind == "holds" else None
        charges = self._charge.likely(self.charge_percent)
        possible: tuple[bool, ...] = (True, False)
        if condition is not None and self.readings is not None:
            possible = self.readings.answers(node.id, condition, self.context.here, charges)
            self.unread += [(node.id, reading) for reading in self.readings.missing(condition)]
        sure = len(possible) == 1
        answer = possible[0] if sure else self._answers.of(kind)(node.id)
        if condition is not None and self.readings is not None:
            self.readings.settle(node.id, condition, self.context.here, answer, charges)
        place = self.context.here.id
        self.decisions.append(Decision(node=node.id, kind=kind, answer=answer, sure=sure, place=place))
        if kind == "holds":
            self.note(WalkStep(node=node, kind="decide", context=self.context, answer=answer))
        return answer

    def _bind(self, label: str, *places: Place) -> None:
        if label:
            bound = {**self.context.bound, label: places}
            self.context = replace(self.context, bound=bound)

    def collect(self, node: Act, count: int) -> None:
        """Add readings taken here by an action to their series, if the plan uses it."""
        reading = node.reading
        if reading not in self._collected:
            return
        series, known = self.context.series.get(reading, ReadingSeries()), self._answers.measured(node.id)
        for number in range(count):
            values = known[number] if number < len(known) else {}
            series = series.plus(TakenReading(place=self.context.here, values=values))
        self.context = replace(self.context, series={**self.context.series, reading: series})
        if self.readings is not None:
            self.readings.collect(reading, len(series))

    def discard(self, reading: str) -> None:
        """Begin a series anew."""
        self.context = replace(self.context, series={k: v for k, v in self.context.series.items() if k != reading})
        if self.readings is not None:
            self.readings.collect(reading, 0)

    def sample_visits(self, preview: Preview, works: Sequence[Work], charged: ChargedVisits | None) -> None:
        """Add the optional visits of each sampled mission."""
        if self.samples is not None:
            slower = self.choosing_slower_s_per_m
            visits = SampledVisits(preview=preview, works=tuple(works), slower_s_per_m=slower, charged=charged)
            self.samples.visit(visits)
            self.sampled.append(visits)

    def note(self, step: WalkStep) -> None:
        """Add a step and the resources it uses."""
        self.steps.append(step)
        metres = step.work.metres if step.drive is None else step.drive.length_m
        if self.samples is not None and self.plan.optional is None:
            self.sampled.append(step)
            if step.drive is not None:
                self.samples.drive(metres, step.slower_s_per_m)
                if step.turn_s:
                    self.samples.work(Work(seconds=step.turn_s))
            elif step.kind == "work":
                self.samples.work(step.work)
            elif step.kind in ("act", "wait", "charge"):
                self.samples.work(Work(seconds=step.seconds, joules=step.joules))
        self._charge.after(step)
        self.spent += Spent(
            metres=metres, seconds=step.seconds, percent=self.robot.percent(0.0, step.seconds, step.joules)
        )


def _on_the_way(place: Place) -> Place:
    """Return the point just before a place that was not reached."""
    return Place.of_robot(place.stand or place.xy, lat=place.lat, lon=place.lon)
