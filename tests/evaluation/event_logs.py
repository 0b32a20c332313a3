"""Event logs made on paper: a plan is followed step by step with drawn readings, and every event is written down.

No room of the product has a part in it, so that what evaluation makes of a log can be held against what was done.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random

from fieldhand.places.selectors import Farthest, Half, Here, TreeIs
from fieldhand.task.build import make_task
from fieldhand.task.conditions import Compare
from fieldhand.task.frames import Task
from fieldhand.task.plan import (
    Act,
    AnyOrder,
    ForEach,
    GoTo,
    If,
    InOrder,
    Node,
    OptionalStep,
    Pace,
    Repeat,
    StopMission,
    Try,
    Wait,
)
from fieldhand.task.results import (
    Acted,
    Arrived,
    Decided,
    Dwelling,
    Dwelt,
    Ended,
    Event,
    Exited,
    Faulted,
    Shed,
    Started,
    Visiting,
)

HOT = Compare(reading="r", quantity="canopy_temperature", test="lt", value=33, unit="degC")
ACTIONS = ("take_thermal_picture", "read_co2", "read_ambient_temperature")


def random_plan(rng: Random, depth: int = 3) -> Node:
    """A plan of any shape; ids are given later by ``make_task``."""
    if depth == 0 or rng.random() < 0.3:
        at = rng.choice([None, TreeIs(tree=str(rng.randint(1, 9))), Farthest(origin=Here())])
        return Act(id="", action=rng.choice(ACTIONS), at=at, count=rng.randint(1, 3))
    inner = [random_plan(rng, depth - 1) for _ in range(rng.randint(1, 3))]
    match rng.randint(0, 8):
        case 0:
            return AnyOrder(id="", steps=tuple(inner))
        case 1:
            return ForEach(
                id="",
                select=Half(side="north"),
                body=inner[0],
                optional=rng.random() < 0.5,
                at_most=rng.choice([None, 2]),
                until=rng.choice([None, HOT]),
            )
        case 2:
            return Repeat(id="", times=rng.randint(1, 3), body=inner[0], until=rng.choice([None, HOT]))
        case 3:
            return If(id="", condition=HOT, then=inner[0], otherwise=inner[1] if len(inner) > 1 else None)
        case 4:
            return Try(id="", body=inner[0], otherwise=random_plan(rng, depth - 1))
        case 5:
            return InOrder(id="", steps=(GoTo(id="", place=TreeIs(tree="3")), Wait(id="", seconds=20.0), *inner))
        case 6:
            return OptionalStep(id="", body=inner[0])
        case 7:
            return Pace(id="", speed_m_s=0.5, body=InOrder(id="", steps=tuple(inner)))
        case _:
            return InOrder(id="", steps=tuple(inner))


def task_of(plan: Node, request: str = "made on paper") -> Task:
    """A Task around a plan."""
    return make_task(request=request, plan=plan, measures={})


class _Failed(Exception):
    pass


class _Stopped(Exception):
    pass


@dataclass
class Paper:
    """Follows a plan and writes down the events.

    Attributes:
        fail: Whether the capture about to be made (node id, how many captures were made before) fails for good.
        wanted: Captures that the branch taken called for, up to where the mission ended.
    """

    rng: Random
    fail: Callable[[str, int], bool] = lambda node, made: False
    events: list[Event] = field(default_factory=list)
    wanted: Counter[str] = field(default_factory=Counter)
    done: Counter[str] = field(default_factory=Counter)

    @property
    def _t(self) -> float:
        return float(len(self.events))

    def follow(self, task: Task) -> list[Event]:
        """The whole log of a mission."""
        start = Started(t=0, task=task.id, robot="husky", site="paper", lat=0, lon=0, charge_percent=100)
        self.events.append(start)
        status = "completed"
        try:
            self._do(task.composition.plan)
        except _Stopped:
            pass
        except _Failed:
            status = "faulted"
        faulted = status == "faulted"
        self.events.append(Exited(t=self._t, exit="faulted" if faulted else "nominal", then="stay"))
        self.events.append(Ended(t=self._t, status=status, lat=0, lon=0, travelled_m=9, charge_percent=50))
        return self.events

    def _do(self, node: Node) -> None:
        match node:
            case InOrder(steps=steps):
                for step in steps:
                    self._do(step)
            case AnyOrder(steps=steps):
                for step in self.rng.sample(steps, len(steps)):
                    self._do(step)
            case ForEach():
                self._loop(node)
            case Repeat():
                for _ in range(node.times):
                    self._do(node.body)
                    if node.until is not None and self._decide(node.id):
                        break
            case If():
                branch = node.then if self._decide(node.id) else node.otherwise
                if branch is not None:
                    self._do(branch)
            case Try():
                try:
                    self._do(node.body)
                except _Failed:
                    self._do(node.otherwise)
            case OptionalStep():
                if self.rng.random() < 0.4:
                    shed = Shed(t=self._t, node=node.id, places=("4",), optional=True, reason="no budget left for it")
                    self.events.append(shed)
                else:
                    self._do(node.body)
            case GoTo():
                self._arrive(node.id)
            case Wait():
                self.events.append(Dwelling(t=self._t, node=node.id, seconds=node.seconds))
                self.events.append(Dwelt(t=self._t, node=node.id, seconds=node.seconds))
            case Pace():
                self._do(node.body)
            case Act():
                self._act(node)
            case StopMission():
                raise _Stopped

    def _loop(self, node: ForEach) -> None:
        places = tuple(str(k) for k in range(self.rng.randint(1, 4)))
        self.events.append(Visiting(t=self._t, node=node.id, places=places, optional=node.optional))
        most = len(places) if node.at_most is None else min(len(places), node.at_most)
        for k, place in enumerate(places[:most]):
            if node.optional and k and self.rng.random() < 0.3:
                shed = Shed(t=self._t, node=node.id, places=places[k:], optional=True, reason="no budget left for it")
                self.events.append(shed)
                return
            self._arrive(node.id, place)
            self._do(node.body)
            if node.until is not None and self._decide(node.id):
                return

    def _decide(self, node: str) -> bool:
        holds = self.rng.random() < 0.5
        self.events.append(Decided(t=self._t, node=node, holds=holds, why=f"30 degC is{'' if holds else ' not'} low"))
        return holds

    def _arrive(self, node: str, place: str = "1") -> None:
        event = Arrived(
            t=self._t,
            node=node,
            kind="tree",
            place=place,
            lat=0,
            lon=0,
            leg_m=5,
            travelled_m=5,
            charge_percent=90,
        )
        self.events.append(event)

    def _act(self, node: Act) -> None:
        if node.at is not None:
            self._arrive(node.id)
        self.wanted[node.id] += node.count
        for _ in range(node.count):
            if self.fail(node.id, self.done[node.id]):
                for attempt in (1, 2):
                    self._capture(node, "failed", attempt)
                self.events.append(Faulted(t=self._t, node=node.id, fault="action_failed", what="lens dirty"))
                raise _Failed
            self._capture(node, "success", 1)
            self.done[node.id] += 1

    def _capture(self, node: Act, status: str, attempt: int) -> None:
        event = Acted(
            t=self._t,
            node=node.id,
            action=node.action,
            status=status,
            kind="tree",
            place="1",
            lat=0,
            lon=0,
            attempt=attempt,
        )
        self.events.append(event)
