"""Check that a mission can recharge as it asks, and that a charged battery suffices for every visit."""

from __future__ import annotations

import math
from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.forecast.charge_simulation import charges_needed, stretches
from fieldhand.forecast.estimate import Estimate
from fieldhand.forecast.recharge_rules import LEAST_GAIN_PERCENT, charge_target, recharge_rules
from fieldhand.forecast.resource_limits import reserve_percent
from fieldhand.forecast.visit_order import drives_for
from fieldhand.language import message
from fieldhand.language.words import say_number, say_rounded
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.task.recharging import recharges
from fieldhand.wording.steps import say_place


def recharge_ability_problems(task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield what the robot, the site or the Task lacks for recharging."""
    constraints = task.constraints
    if not recharges(task):
        return
    if robot.energy.charging is None:
        yield PlanProblem(
            where=message("battery"),
            what=message("{robot} cannot recharge: its profile has no charging", robot=robot.name),
            advice=message("describe its charger under energy: charging in its profile, or ask for less"),
        )
        return
    drives = drives_for(site, robot)
    charger = site.markers.get("charger")
    if charger is None:
        yield PlanProblem(
            where=site.name,
            what=message("the site has no charger"),
            advice=message('add a point of "kind": "charger" to its file'),
        )
    elif reason := drives.problem(charger):
        yield PlanProblem(
            where=site.name,
            what=message("{place} is {reason}", place=say_place(charger), reason=reason),
            advice=message("correct the site"),
        )
    if constraints.recharge and constraints.return_percent is not None:
        yield PlanProblem(
            where=message("battery"),
            what=message("it is to recharge, and to drive home when the charge falls: only one of them is possible"),
            advice=message("choose one"),
        )
    target, reserve = charge_target(constraints, robot), reserve_percent(constraints, robot)
    targets = [target] if constraints.recharge else []
    targets += [
        node.recharge.until_percent
        for node in walk(task.composition.plan)
        if node.recharge is not None and node.recharge.until_percent is not None
    ]
    for until in targets:
        if until < reserve + LEAST_GAIN_PERCENT:
            yield PlanProblem(
                where=message("battery"),
                what=message(
                    "charging up to {until} % gains nothing: {reserve} % must be left at the end",
                    until=say_number(until),
                    reserve=say_number(reserve),
                ),
                advice=message("charge further, or keep a smaller reserve"),
            )
    below = constraints.recharge_below_percent
    if constraints.recharge and below is not None and below > target - LEAST_GAIN_PERCENT:
        yield PlanProblem(
            where=message("battery"),
            what=message(
                "it is to charge below {below} %, but only up to {until} %",
                below=say_number(below),
                until=say_number(target),
            ),
            advice=message("charge further, or later"),
        )


def recharge_problems(task: Task, site: Site, robot: RobotProfile, forecast: Estimate) -> Iterator[PlanProblem]:
    """Yield the visits that are not possible even with a charged battery."""
    rules = recharge_rules(task, site, robot)
    if rules is None or not task.constraints.recharge:
        return
    drives, seen = drives_for(site, robot), set[tuple[str, str]]()
    for branch in forecast.branches:
        some = stretches(branch.walk.steps, rules, drives)
        needed = charges_needed(some, rules)
        for number, stretch in enumerate(some):
            if stretch.step is None:
                continue
            wanted, place = float(needed.from_charger[number]), stretch.step.places[0]
            within = wanted <= rules.most_percent or needed.here[number] <= forecast.charge_percent
            if stretch.asked is None or within or (stretch.step.node.id, place.id) in seen:
                continue
            seen.add((stretch.step.node.id, place.id))
            if len(seen) > 1:
                continue
            yield PlanProblem(
                node=stretch.step.node.id,
                where=message("battery"),
                what=message(
                    "{place} is too far from the charger: the way there and back with the work takes more than the"
                    " battery has, {needed} % with the reserve, but it is charged to {until} %",
                    place=say_place(place),
                    needed=say_rounded(wanted),
                    until=say_number(rules.most_percent),
                ),
                advice=message("leave it out, charge further, or do less at a time"),
            )


def stranding_problems(task: Task, site: Site, robot: RobotProfile, forecast: Estimate) -> Iterator[PlanProblem]:
    """Yield a problem if too many missions would be stopped on their way to the charger or home.

    It is a warning where the plan says when to charge: then the limit of the reserve is what was accepted.
    """
    rules = recharge_rules(task, site, robot)
    if rules is None:
        return
    worst = max(forecast.branches, key=lambda branch: branch.stranding)
    if worst.stranding <= rules.stranding:
        return
    ways = [
        (stretch.to_charger_m, stretch.step.places[0])
        for stretch in stretches(worst.walk.steps, rules, drives_for(site, robot))
        if stretch.step is not None and math.isfinite(stretch.to_charger_m)
    ]
    metres, place = max(ways, key=lambda way: way[0])
    yield PlanProblem(
        where=message("battery"),
        what=message(
            "one mission in {number} would be stopped by its battery on the way to the charger or home, more than"
            " the accepted one in {accepted}: {place} is {metres} m from the charger, {percent} % of the battery each"
            " way, and it is charged to {until} %",
            number=say_rounded(1.0 / worst.stranding),
            accepted=say_rounded(1.0 / rules.stranding),
            place=say_place(place),
            metres=say_rounded(metres),
            percent=say_rounded(metres * rules.per_metre),
            until=say_number(rules.most_percent),
        ),
        advice=message(
            "leave out the places far from the charger, charge further, or accept more (stranding_probability under"
            " energy: charging in the profile)"
        ),
        severity="error" if task.constraints.recharge else "warning",
    )


def return_problems(task: Task, robot: RobotProfile, forecast: Estimate) -> Iterator[PlanProblem]:
    """Warn if the charge will fall to the level at which the robot drives home before the plan is done."""
    level = task.constraints.return_percent
    if level is None:
        return
    worst = forecast.worst
    home = worst.walk.steps[-1]
    way_home = robot.percent(0.0, home.seconds, home.joules) if home.kind == "exit" else 0.0
    used = forecast.charge_percent - worst.percent.mean
    left = way_home + (used if worst.charges is None else worst.left[0])
    if left < level:
        yield PlanProblem(
            where=message("battery"),
            what=message(
                "the charge falls to {level} % before everything is done: about {percent} % would be left, so the robot"
                " drives home early and gives up the rest",
                level=say_number(level),
                percent=say_rounded(max(0.0, left)),
            ),
            advice=message("ask for less, or let the robot recharge"),
            severity="warning",
        )
