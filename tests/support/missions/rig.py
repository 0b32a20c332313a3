"""A small orchard, a guard that follows a script, and one call that carries a plan out: for the execution tests."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TypeVar

import numpy as np

from fieldhand import mission
from fieldhand.clock import Clock, SimulatedClock
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.guard import Guard, NoFailsafe, NoGuard
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.mission_runner import Result, run
from fieldhand.execution.recorded_inputs import RecordedInputs
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.forecast.visit_order import drives_for
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site, Tree
from fieldhand.site.projection import Projection
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.build import FAULTED_EXITS, make_task
from fieldhand.task.frames import Constraints, FaultedExit, Task, Then
from fieldhand.task.plan import Node
from fieldhand.task.results import Acted, Event
from fieldhand.terms import Value

Kind = TypeVar("Kind")

E = 5.0  # metres between trees and between rows


@cache
def orchard(rows: int = 4, columns: int = 5) -> Site:
    """A grid of trees 5 m apart, ids "r0c0" from the south-west; start 5 m west of it, end 5 m east of it.

    Trees of the odd columns are of the variety Kerman; "reward" is the column's number.
    """
    projection = Projection(37.0, -120.0)

    def place(kind: str, name: str, x: float, y: float) -> Place:
        lat, lon = projection.degrees([(x, y)])[0]
        return Place(kind=kind, id=name, x=x, y=y, lat=float(lat), lon=float(lon))

    trees = []
    for index in range(rows * columns):
        r, c = divmod(index, columns)
        properties: dict[str, Value] = {"variety": "Kerman" if c % 2 else "Peters", "reward": float(c)}
        spot = place("tree", f"r{r}c{c}", c * E, r * E)
        trees.append(Tree(place=spot, index=index, feature=index + 1, properties=properties, row=f"r{r}"))
    markers = {"start": place("marker", "start", -E, 0.0), "end": place("marker", "end", columns * E, 0.0)}
    return Site(
        name="grid",
        trees=tuple(trees),
        markers=markers,
        zones=(),
        projection=projection,
        sha256="site-hash",
        source="tests",
    )


@cache
def husky(alpha: float = 1.0, retries: int = 1) -> RobotProfile:
    """The built-in husky; its legs cost what they are long, so that figures can be worked out by hand."""
    robot = load_robot("husky")
    return replace(robot, leg_cost=replace(robot.leg_cost, alpha=alpha), retries=retries)


def task_for(
    plan: Node,
    *,
    nominal: Then = "return_to_end",
    constraints: Constraints | None = None,
    faulted: tuple[FaultedExit, ...] = FAULTED_EXITS,
) -> Task:
    """A Task around a plan."""
    return make_task(
        request="a test", plan=plan, measures={}, nominal=nominal, constraints=constraints, faulted=faulted
    )


def authorized(task: Task, site: Site, robot: RobotProfile) -> AuthorizedTask:
    """As approval would give it; tests may."""
    return AuthorizedTask(
        task=task,
        authorization=Authorization(
            by="tester",
            at="2026-01-01T00:00:00+00:00",
            task_sha256="",
            site_sha256=site.sha256,
            robot_sha256=robot.sha256,
        ),
    )


def approved(task: Task, site: Site, robot: RobotProfile) -> mission.ApprovedMission:
    """Return a mission as :func:`authorized` approves it."""
    return mission.ApprovedMission(authorized=authorized(task, site, robot), site=site, robot=robot)


@dataclass
class Rig:
    """A site, a robot and their world for a test mission; every field can be replaced."""

    site: Site = field(default_factory=orchard)
    robot: RobotProfile = field(default_factory=husky)
    world: World = field(default_factory=World)
    guard: Guard = field(default_factory=NoGuard)
    clock: Clock = field(default_factory=SimulatedClock)
    seed: int = 0

    def driver(self) -> SimulatedDriver:
        """A simulated robot at the start."""
        return SimulatedDriver(self.site, self.robot, self.world, self.clock, np.random.default_rng(self.seed))

    def attempt(self, task: Task) -> ActiveMission:
        """An attempt at a Task that begins now; its events go nowhere else."""
        inputs = RecordedInputs(
            driver=self.driver(),
            guard=self.guard,
            failsafe=NoFailsafe(),
            clock=MissionClock(self.clock),
            emit=lambda event: None,
            current_command=lambda: None,
        )
        drives = drives_for(self.site, self.robot, task.constraints)
        return ActiveMission(task=task, site=self.site, robot=self.robot, inputs=inputs, drives=drives)

    def fly(
        self,
        task: Task | Node,
        *,
        emit: Callable[[Event], None] = lambda event: None,
        interrupted: Callable[[], str | None] = lambda: None,
    ) -> Result:
        """Carry a Task (or a bare plan) out."""
        whole = task if isinstance(task, Task) else task_for(task)
        return run(
            authorized(whole, self.site, self.robot),
            site=self.site,
            robot=self.robot,
            driver=self.driver(),
            guard=self.guard,
            clock=self.clock,
            emit=emit,
            interrupted=interrupted,
        )


@dataclass
class BudgetOf(NoGuard):
    """A guard that admits a number of visits in all and then none; optional visits in the order given.

    ``asked`` keeps what it was asked about: (node, place, ids of the visits still to come).
    """

    visits: int
    asked: list[tuple[str, str, tuple[str, ...]]] = field(default_factory=list)

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        self.asked.append((state.node, visit.place.id, tuple(v.place.id for v in still_to_come)))
        self.visits -= 1
        return Verdict(go=True) if self.visits >= 0 else Verdict(go=False, reason="too little left", chance_short=0.4)

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        self.asked.append((state.node, "", tuple(v.place.id for v in candidates)))
        self.visits -= 1
        if self.visits < 0:
            return VisitChoice(
                index=None, shed=tuple(range(len(candidates))), reason="too little left", chance_short=0.4
            )
        return VisitChoice(index=0)


def of_type(events: Iterable[Event], kind: type[Kind]) -> list[Kind]:
    """The events of one type."""
    return [e for e in events if isinstance(e, kind)]


def captured(events: Iterable[Event]) -> list[tuple[str, str]]:
    """(action, place) of every capture that succeeded."""
    return [(e.action, e.place) for e in events if isinstance(e, Acted) and e.status == "success"]
