"""Missions driven on paper: a guard decides, legs cost what is drawn, nothing else is simulated."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from fieldhand.evaluation.budget_guard import BudgetGuard
from fieldhand.forecast.mission_state import MissionState, Spent, Verdict, Visit, VisitChoice
from fieldhand.forecast.service import reward_of, service_of
from fieldhand.forecast.visit_order import drives_for, start_place, with_stands
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drives import Drives
from fieldhand.site.model import Place, Site
from fieldhand.task import instructions as ask
from fieldhand.task.frames import Task
from fieldhand.task.nodes.base import Stopped
from fieldhand.task.plan import ForEach, Node
from fieldhand.task.run import PlanRun, StackFrame, carry_out


class Paper:
    """One mission on paper.

    Args:
        seed: Of the legs' cost and of the guard.
    """

    def __init__(self, task: Task, site: Site, robot: RobotProfile, seed: int, drives: Drives | None = None) -> None:
        self.task, self.site, self.robot = task, site, robot
        self.drives = drives or drives_for(site, robot)
        self.guard = BudgetGuard(task, site, robot, self.drives, seed)
        self.rng = np.random.default_rng([seed, 9])
        self.spent = Spent()
        self.here: Place = start_place(self.drives)
        self.visited: tuple[str, ...] = ()
        self.shed: list[tuple[str, str]] = []

    def state(self, node: str) -> MissionState:
        context = Context(here=self.here, visited=self.visited)
        frames = frames_at(self.task.composition.plan, node)
        return MissionState(frames=frames, context=context, spent=self.spent, charge_percent=100.0 - self.spent.percent)

    def visit(self, place: Place, work: Node) -> Visit:
        seconds, joules = service_of(work, self.robot)
        reward = reward_of(work, place, self.site) if isinstance(work, ForEach) else 1.0
        return Visit(place=place, reward=reward, service_s=seconds, service_j=joules)

    def go(self, place: Place, work: tuple[float, float] = (0.0, 0.0)) -> None:
        """Drive to a place and work there, at a cost that is drawn."""
        alpha = self.robot.leg_cost.alpha
        drive = self.drives.between(self.here, place)
        metres = drive.length_m * (alpha + self.rng.exponential(1.0 - alpha))
        seconds = metres / self.robot.speed_m_s + work[0]
        self.spent += Spent(metres=metres, seconds=seconds, percent=self.robot.percent(metres, seconds, work[1]))
        self.here = drive.end
        if place.kind == "tree" and place.id not in self.visited:
            self.visited = (*self.visited, place.id)

    def optional(self, node: ForEach, places: Sequence[Place]) -> VisitChoice | None:
        """The visits of an optional for-each; the last answer of the guard."""
        left, choice, made = list(with_stands(self.drives, self.here, places)), None, 0
        while left and made != node.at_most:
            at_most = None if node.at_most is None else node.at_most - made
            candidates = [self.visit(p, node) for p in left]
            choice = self.guard.choose(self.state(node.id), candidates, at_most=at_most)
            self.shed += [(left[i].id, choice.reason) for i in choice.shed]
            if choice.index is None:
                return choice
            place = left[choice.index]
            left = [p for i, p in enumerate(left) if i != choice.index and i not in choice.shed]
            self.go(place, service_of(node.body, self.robot))
            made += 1
        return choice

    def mandatory(self, node: Node, place: Place, later: Sequence[Visit] = ()) -> Verdict:
        """Ask for a mandatory visit, and make it if the guard agrees."""
        place = self.drives.between(self.here, place).end
        verdict = self.guard.admit(self.state(node.id), self.visit(place, node), later)
        if verdict.go:
            self.go(place, service_of(node, self.robot))
        return verdict

    def home(self) -> None:
        """Drive home."""
        self.go(self.site.home("return_to_end", self.here))


class _Reached(Exception):
    pass


def frames_at(plan: Node, node_id: str, time: int = 1) -> tuple[StackFrame, ...]:
    """The nodes in hand when a node is reached.

    Args:
        plan: The plan; its steps are done as they stand, every condition of an if holds, a for-each has three visits.
        node_id: The node.
        time: How often it has been reached then, this time included.
    """
    run, found = PlanRun(plan), list[tuple[StackFrame, ...]]()

    def entered(node: Node) -> None:
        if node.id == node_id:
            found.append(tuple(replace(frame) for frame in run.frames))
        if len(found) == time:
            raise _Reached

    def answer(request: ask.Instruction) -> Any:
        match request:
            case ask.ArrangeSteps(node=node):
                return tuple(range(len(node.steps)))
            case ask.BeginVisits():
                return iter("abc")
            case ask.NextVisit(tour=tour):
                return next(tour, None)
            case ask.Decide(node=node):
                return node.is_choice
            case ask.OfferStep():
                return True
        return None

    run.entered = entered
    with suppress(_Reached, Stopped):
        carry_out(run.program(), answer)
    return found[time - 1]
