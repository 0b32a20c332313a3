"""All checks of a Task that precede a person's approval for a site and a robot.

Checks run in three stages: the document (schema, references, intended site and robot), each selector, and the whole
mission on every branch (reachable places, no drive through a keep-out zone or outside the boundary, sufficient budget).
A stage runs only if the stages before it found no error, so that each fault is reported once.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from fieldhand.approval.account import unaccounted
from fieldhand.approval.battery import battery_problems
from fieldhand.approval.branch_checks import branch_problems, exit_problems
from fieldhand.approval.budget import budget_problems
from fieldhand.approval.camera_checks import camera_problems
from fieldhand.approval.earlier_checks import choice_problems, none_now, records_problems
from fieldhand.approval.problem import PlanProblem, node_in, with_words
from fieldhand.approval.recharging import (
    recharge_ability_problems,
    recharge_problems,
    return_problems,
    stranding_problems,
)
from fieldhand.approval.request_warnings import request_warnings
from fieldhand.approval.speed import speed_problems
from fieldhand.approval.timing import timing_problems
from fieldhand.approval.watch_checks import watch_problems
from fieldhand.approval.ways import by_rules, rule_problems, way_problems
from fieldhand.approval.working_checks import implement_problems, working_problems
from fieldhand.errors import FieldhandError, NoPlaceError, PlaceError, TaskError
from fieldhand.forecast.estimate import Estimate, estimate, explore
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.language import message, named
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve, resolve_one
from fieldhand.places.selector import Selector
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.drives import Drives
from fieldhand.site.model import Place, Site
from fieldhand.task.codec import encode
from fieldhand.task.earlier import may_have_none, site_of
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, walk
from fieldhand.task.references import reference_problems
from fieldhand.task.schema import validate
from fieldhand.wording.steps import say_place

__all__ = ["Examination", "PlanProblem", "check", "examine"]


@dataclass(frozen=True, kw_only=True, repr=False)
class Examination:
    """Result of examining a Task for a site and a robot, created only by :func:`examine` and required for approval.

    Attributes:
        task, site, robot: The examined Task, site and robot profile.
        problems: Every problem found, errors first.
        estimate: Forecast used by the checks; None if the mission could not be simulated.
    """

    task: Task
    site: Site
    robot: RobotProfile
    problems: tuple[PlanProblem, ...]
    estimate: Estimate | None

    __repr__ = short_repr

    @property
    def errors(self) -> tuple[PlanProblem, ...]:
        """Return the problems that forbid approval."""
        return tuple(p for p in self.problems if p.severity == "error")


def check(task: Task, site: Site, robot: RobotProfile, document: bytes | None = None) -> tuple[PlanProblem, ...]:
    """Return every problem of a Task for this site and robot, errors first.

    Args:
        task: The Task.
        site, robot: Site and robot profile that will carry out the Task.
        document: Bytes from which the Task was read; by default the Task is encoded again.
    """
    return examine(task, site, robot, document=document).problems


def examine(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    document: bytes | None = None,
    seed: int = 0,
    charge_percent: float = 100.0,
) -> Examination:
    """Check a Task as :func:`check` does and return the estimate along with the problems.

    Args:
        task, site, robot, document: As for :func:`check`. The site of the examination has the earlier missions that the
            Task contains.
        seed: Seed of the estimate.
        charge_percent: State of charge at the start, in percent.
    """
    site = site_of(task, site)
    problems = [*_document(task, robot, document), *_references(task, robot), *_resources(task, site, robot)]
    problems.extend(implement_problems(task, robot))
    problems.extend(unaccounted(task))
    problems.extend(speed_problems(task, robot))
    problems.extend(records_problems(task))
    if not _errors(problems):
        problems.extend(watch_problems(task, robot))
    if not _errors(problems):
        problems.extend(request_warnings(task, site, robot))
        problems.extend(way_problems(task, site, robot))
        problems.extend(recharge_ability_problems(task, site, robot))
    if not _errors(problems):
        problems.extend(_places(task, site, robot))
    if not _errors(problems):
        problems.extend(choice_problems(task, site))
    forecast = None
    if not _errors(problems):
        try:
            explored = explore(task, site, robot, seed, charge_percent=charge_percent)
        except TaskError as error:
            problems.append(_of_error(error))
        else:
            problems.extend(branch_problems(explored, task, site, robot))
            if not explored.broken:
                forecast = estimate(task, site, robot, seed, charge_percent=charge_percent)
                problems.extend(exit_problems(forecast, site))
                problems.extend(budget_problems(task, site, robot, forecast))
                problems.extend(battery_problems(task, robot))
                problems.extend(timing_problems(task, site, forecast))
                problems.extend(working_problems(task, robot, forecast))
                problems.extend(camera_problems(robot, forecast))
                problems.extend(recharge_problems(task, site, robot, forecast))
                problems.extend(stranding_problems(task, site, robot, forecast))
                problems.extend(return_problems(task, robot, forecast))
    once = dict.fromkeys(with_words(problem, task) for problem in problems)
    found = tuple(sorted(once, key=lambda p: p.severity != "error"))
    return Examination(task=task, site=site, robot=robot, problems=found, estimate=forecast)


def _errors(problems: list[PlanProblem]) -> bool:
    return any(p.severity == "error" for p in problems)


def _document(task: Task, robot: RobotProfile, document: bytes | None) -> Iterator[PlanProblem]:
    """Validate the document against the robot's schema: actions, parameters, quantities, units and vocabulary."""
    try:
        data = encode(task) if document is None else document
    except TaskError as error:
        yield _of_error(error)
        return
    for found in validate(data, capabilities_of(robot)):
        where = message("line {number}", number=found.line)
        if found.element:
            where = message("line {number}, {element}", number=found.line, element=f"<{found.element}>")
        yield PlanProblem(where=where, what=found.message)


def _references(task: Task, robot: RobotProfile) -> Iterator[PlanProblem]:
    for problem in reference_problems(task, capabilities_of(robot)):
        yield PlanProblem(node=problem.node, where=message("plan"), what=problem.what)


def _resources(task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Compare the SHA-256 of the site and robot profile with those that the Task was planned for."""
    here: dict[Literal["site", "robot"], tuple[str, str]] = {
        "site": (site.name, site.sha256),
        "robot": (robot.name, robot.sha256),
    }
    for kind, (name, sha256) in here.items():
        planned = [r for r in task.resources if r.kind == kind]
        if not planned:
            what = {
                "site": message("the Task does not say for which site it was planned"),
                "robot": message("the Task does not say for which robot it was planned"),
            }
            yield PlanProblem(where=message("resources"), what=what[kind], severity="warning")
        for resource in planned:
            if resource.sha256 == sha256:
                continue
            if resource.name == name:
                planned_for = message("planned for another version of {name}", name=name)
            else:
                planned_for = message("planned for {other}, but this is {name}", other=resource.name, name=name)
            advice = {
                "site": message("plan it again for this site, or give the site it was planned for"),
                "robot": message("plan it again for this robot, or give the robot it was planned for"),
            }
            yield PlanProblem(where=message("resources"), what=planned_for, advice=advice[kind])


def _places(task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Check each selector that is resolved before the start: it matches enough places, and they are reachable."""
    drives = drives_for(site, robot, task.constraints)
    yield from _exits(task, site, drives)
    steps = {inner.id: node for node in walk(task.composition.plan) if node.is_optional_step for inner in walk(node)}
    for node in walk(task.composition.plan):
        selector = node.selector
        if selector is None or selector.relative:
            continue
        if node.work is not None and node.work.mode in ("area", "perimeter"):
            continue  # an area may have no trees; it is resolved on every branch
        try:
            places = _resolved(node, selector, site)
        except NoPlaceError as error:
            if node.visits_each and may_have_none(task, selector):
                yield none_now(error, node.id)
            else:
                yield _of_error(error, node.id)
            continue
        except PlaceError as error:
            yield _of_error(error, node.id)
            continue
        if node.work is not None:
            continue  # its stretches are checked on every branch
        closed = [(p, reason) for p, reason in zip(places, drives.problems(places), strict=True) if reason]
        if node.visits_each and node.is_optional and len(closed) < len(places):
            yield from _left_out(node, closed, site)
            continue
        if closed and node.id in steps:
            yield from _left_out(steps[node.id], closed, site)
            continue
        kept_away, others = by_rules(closed, drives_for(site, robot))
        yield from rule_problems(kept_away, node.id, site)
        for place, reason in others:
            yield PlanProblem(
                node=node.id,
                where=site.name,
                what=message("{place} is {reason}", place=say_place(place), reason=reason),
                advice=message("leave it out, or correct the site"),
            )


def _left_out(node: Node, closed: list[tuple[Place, str]], site: Site) -> Iterator[PlanProblem]:
    """Warn about optional visits and steps that will be skipped because their place is unreachable."""
    if closed:
        place, reason = closed[0]
        text = message("{place} is {reason}", place=say_place(place), reason=reason)
        if node.is_optional_step:
            what = message("an optional step will be left out: {why}", why=text)
        elif len(closed) > 1:
            what = message(
                "{place} and {count} more will be left out: {why}",
                place=say_place(place),
                count=len(closed) - 1,
                why=text,
            )
        else:
            what = message("{place} will be left out: {why}", place=say_place(place), why=text)
        yield PlanProblem(
            node=node.id,
            where=site.name,
            what=what,
            advice=message("correct the site if that is wrong"),
            severity="warning",
        )


def _exits(task: Task, site: Site, drives: Drives) -> Iterator[PlanProblem]:
    """Check that every exit place after a fault is reachable from the start."""
    start = start_place(drives)
    for taken in task.composition.faulted:
        home = site.home(taken.then, start)
        reason = "" if home.xy == start.xy else drives.problem(home)
        if reason:
            yield PlanProblem(
                where=site.name,
                what=message(
                    "{place}, where the robot has to go after the fault {fault}, is {reason}",
                    place=say_place(home),
                    fault=named(taken.fault, "fault"),
                    reason=reason,
                ),
                advice=message("correct the site; otherwise the robot will stop where it is at that moment"),
                severity="warning",
            )


def _resolved(node: Node, selector: Selector, site: Site) -> tuple[Place, ...]:
    context = Context(here=site.start)
    if not node.visits_each:
        return (resolve_one(selector, site, context),)
    places = tuple(resolve(selector, site, context))
    if not places:
        raise PlaceError(
            message("no place on this site is selected"), where=site.name, advice=message("ask for other trees")
        )
    return places


def _of_error(error: FieldhandError, node: str = "") -> PlanProblem:
    found, where = node_in(error.where)
    return PlanProblem(node=found or node, where=where, what=error.what, advice=error.advice)
