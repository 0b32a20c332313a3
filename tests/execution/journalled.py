"""A mission with a journal, cut off at will and carried on: for tests of the journal."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fieldhand.clock import SimulatedClock
from fieldhand.execution import mission_clock
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.guard import Guard, NoGuard
from fieldhand.execution.journal.store import Journal, create
from fieldhand.execution.mission_runner import Result, run
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.places.selectors import Half, Take, TreeIs
from fieldhand.robot.model import RobotProfile
from fieldhand.task.conditions import Compare
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Node, Repeat, Try
from support.missions.rig import authorized, husky, orchard, task_for

PICTURE = "take_thermal_picture"
PLAN = InOrder(
    id="",
    steps=(
        Act(id="", action=PICTURE, at=TreeIs(tree="r0c0"), count=2, reading="r"),
        If(
            id="",
            condition=Compare(reading="r", quantity="canopy_temperature", test="gt", value=0, unit="degC"),
            then=AnyOrder(
                id="",
                steps=(GoTo(id="", place=TreeIs(tree="r3c3")), Act(id="", action=PICTURE, at=TreeIs(tree="r2c2"))),
            ),
        ),
        ForEach(
            id="",
            select=Take(count=2, of=Half(side="north")),
            optional=True,
            body=Try(
                id="",
                body=Act(id="", action="read_co2"),
                otherwise=Repeat(id="", times=2, body=Act(id="", action="read_ambient_temperature")),
            ),
        ),
    ),
)


class PowerCut(BaseException):
    """Nothing catches it, as nothing catches kill -9."""


class Cut(Journal):
    """A journal at whose n-th commit the power is cut, before it or behind it."""

    commits = 0
    at = 0
    behind = False

    def commit(self, *, order: int = 0) -> None:
        self.commits += 1
        if self.commits == self.at and not self.behind:
            raise PowerCut
        super().commit(order=order)
        if self.commits == self.at:
            raise PowerCut


class Field:
    """A mission in a folder, and a robot that is made anew each time or outlives the program."""

    def __init__(self, folder: Path, *, robot: RobotProfile | None = None, outlives: bool = False) -> None:
        self.folder, self.robot, self.outlives = folder, robot or husky(alpha=0.5), outlives
        folder.mkdir(exist_ok=True)
        create(folder / "journal.sqlite", "mission")
        self.clock, self.driver = self._new()

    def _new(self) -> tuple[SimulatedClock | mission_clock.MissionClock, SimulatedDriver]:
        clock = SimulatedClock() if self.outlives else mission_clock.MissionClock(SimulatedClock())
        rng = np.random.default_rng(2)
        return clock, SimulatedDriver(orchard(), self.robot, World(), clock, rng)

    def fly(
        self,
        plan: Node = PLAN,
        *,
        cut: int = 0,
        behind: bool = False,
        guard: Guard | None = None,
        orders: Callable[[], OperatorCommand | None] = lambda: None,
        journal: type[Journal] = Cut,
    ) -> Result:
        """Carry the mission out, or what is left of it."""
        if not self.outlives:
            self.clock, self.driver = self._new()
        with journal(self.folder / "journal.sqlite", "mission", self.folder / "log", lambda line: None) as opened:
            if isinstance(opened, Cut):
                opened.at, opened.behind = cut, behind
            return run(
                authorized(task_for(plan), orchard(), self.robot),
                site=orchard(),
                robot=self.robot,
                driver=self.driver,
                guard=guard or NoGuard(),
                clock=self.clock,
                emit=lambda event: None,
                orders=orders,
                log=opened,
                simulated=not self.outlives,
            )

    @property
    def lines(self) -> list[str]:
        return (self.folder / "log").read_text().splitlines()
