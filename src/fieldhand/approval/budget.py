"""Check that the budgets of a mission suffice for its mandatory work."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from fieldhand.approval.problem import PlanProblem
from fieldhand.errors import FieldhandError
from fieldhand.forecast.estimate import BranchEstimate, Estimate
from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.resource_limits import ResourceLimit, resource_limits
from fieldhand.forecast.route_cost import cost_model
from fieldhand.forecast.service import service_of
from fieldhand.forecast.visit_order import drives_for, first_places
from fieldhand.language import message
from fieldhand.language.words import say_duration, say_number, say_rounded
from fieldhand.orienteering.overrun import quantile_table, standardised_quantile
from fieldhand.places.context import Context
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import acts, walk

#: Probability of running short from which a mission is refused; below it, the mission is approved with a warning.
_HOPELESS = 0.5


def budget_problems(task: Task, site: Site, robot: RobotProfile, forecast: Estimate) -> Iterator[PlanProblem]:
    """Yield the problems of a mission's budgets, with the figures."""
    nothing = list(_nothing_fits(task, site, robot)) if _does_nothing(task, forecast.branches) else []
    if nothing:
        yield from nothing
        return
    worst = forecast.worst
    hopeless = any(c.exceeded and c.chance > _HOPELESS for c in worst.chances)
    for sentence in forecast.problems:
        yield PlanProblem(
            where=message("budget"),
            what=sentence,
            advice=message("allow more, or ask for less"),
            severity="error" if hopeless else "warning",
        )


def _does_nothing(task: Task, branches: tuple[BranchEstimate, ...]) -> bool:
    """Return True if no branch makes a capture although the plan contains optional actions."""
    does = any(acts(task.composition.plan))
    return does and any(b.shed for b in branches) and all(b.captures == 0 for b in branches)


def _nothing_fits(task: Task, site: Site, robot: RobotProfile) -> Iterator[PlanProblem]:
    """Yield each limit that even the cheapest single visit exceeds."""
    drives = drives_for(site, robot, task.constraints)
    home = site.home(task.composition.nominal, site.start)
    for node in walk(task.composition.plan):
        if not node.is_optional:
            continue
        try:
            places = first_places(node, site, Context(here=site.start))
            ways = [(drives.between(site.start, p).length_m, drives.between(p, home).length_m) for p in places]
            metres = min(ways, key=sum)
        except (FieldhandError, ValueError):
            continue  # relative places: the cost of a single visit is unknown
        (body,) = node.children
        seconds, joules = service_of(body, robot)
        for resource in resource_limits(task.constraints, robot):
            work = resource.of_work(robot, Work(seconds=seconds, joules=joules))
            need = sum(metres) * resource.per_metre + work
            amount, limit = _amount(resource, need), _amount(resource, resource.limit)
            sentence = PlanProblem(
                node=node.id,
                where=message("budget"),
                what=message(
                    "{limit} is too small for a single visit: the nearest takes about {amount}, including the way home",
                    limit=limit,
                    amount=amount,
                ),
                advice=message("allow more"),
            )
            if need > resource.limit:
                yield sentence
            elif resource.kind != "reserve":
                high = _exceeded(metres, robot, resource.failure_probability) * resource.per_metre + work
                what = message(
                    "{limit} is not enough for a single visit: the nearest takes about {amount} on average, including"
                    " the way home, and more than {high} in {chance} of 100 missions",
                    limit=limit,
                    amount=amount,
                    high=_amount(resource, high),
                    chance=say_number(100 * resource.failure_probability),
                )
                yield replace(sentence, what=what)


def _exceeded(metres: Sequence[float], robot: RobotProfile, chance: float) -> float:
    """Return the metres that drives of these lengths cost together with that chance, or more."""
    second, third = cost_model(robot).cumulants()
    variance, cubes = (sum(length**power for length in metres) for power in (2, 3))
    over = standardised_quantile(quantile_table(chance), second * variance, third * cubes)
    return sum(metres) + math.sqrt(second * variance) * over


def _amount(resource: ResourceLimit, value: float) -> str:
    match resource.kind:
        case "distance_m":
            return message("{number} m", number=say_rounded(value))
        case "duration_s":
            return say_duration(max(0.0, value))
        case "energy_percent":
            return message("{number} % of the battery", number=say_rounded(value, 1))
        case "reserve":
            return message("{number} % of the battery above the reserve", number=say_rounded(value, 1))
