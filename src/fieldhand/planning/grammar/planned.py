"""From the meaning of a request to its Task: its exit, its limits, and whether the site has its places."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import Number, message, named
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.foreseen import foreseeable
from fieldhand.planning.grammar.dialogue.energy import MeantRecharging
from fieldhand.planning.homeward import faulted_exits, usual_exit, with_assumed_exit
from fieldhand.planning.planner import Outcome, Planned, Reason, Refused
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.frames import Budget, BudgetKind, Constraints, Resource, Task, Then
from fieldhand.task.recharging import recharges

NAME = "english"
KINDS: dict[str, BudgetKind] = {"metres": "distance_m", "seconds": "duration_s", "percent": "energy_percent"}


@dataclass(frozen=True, kw_only=True)
class LimitPhrase:
    """A limit on a resource.

    Attributes:
        amount: Amount in ``unit``.
        unit: ``metres``, ``seconds`` or ``percent``.
        keep: The amount must be left at the end; else it may be used.
        said: Range of the request that says it.
    """

    amount: float
    unit: str
    keep: bool = False
    said: p.Span = (0, 0)


@dataclass(frozen=True, kw_only=True)
class Meant:
    """The meaning of a request, from which its Task is made.

    Attributes:
        plan: Plan.
        limits: Budgets and reserves.
        recharging: How the mission recharges; None if it does not.
        nominal: How the mission ends; None if the request does not say so.
        nominal_said: Spans of the request that say it.
        no_part: Spans of the request that ask for nothing.
        assumptions: What was assumed, as sentences.
        warnings: What has to be confirmed before the Task is approved, as sentences.
        read_as: The request with its corrections made; empty if it has none.
    """

    plan: p.Node
    limits: tuple[LimitPhrase, ...] = ()
    recharging: MeantRecharging | None = None
    nominal: Then | None = None
    nominal_said: tuple[p.Span, ...] = ()
    no_part: tuple[p.Span, ...] = ()
    assumptions: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    read_as: str = ""


def planned_as(meant: Meant, request: str, site: Site, robot: RobotProfile) -> Outcome:
    """Return the Task of what a request means, or a refusal that names the limits and places that cannot be."""
    limits = tuple(_impossible_limits(meant.limits))
    if limits:
        return Refused(reasons=limits, planner=NAME)
    nominal = usual_exit(site) if meant.nominal is None else meant.nominal
    task = make_task(
        request=request,
        read_as=meant.read_as,
        plan=meant.plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=_with_recharging(_constraints(meant.limits), meant.recharging),
        nominal=nominal,
        nominal_said=meant.nominal_said,
        no_part=tuple((start, end) for start, end in meant.no_part if re.search(r"\w", request[start:end])),
        faulted=faulted_exits(nominal),
        assumptions=tuple(dict.fromkeys(meant.assumptions)),
        warnings=meant.warnings,
    )
    problems = (*_unable(task, robot, site), *_impossible(task.composition.plan, site))
    if problems:
        return Refused(reasons=problems, planner=NAME)
    if meant.nominal is None:
        task = with_assumed_exit(task, site, robot)
    return Planned(task=task, planner=NAME)


def _constraints(limits: Iterable[LimitPhrase]) -> Constraints:
    budgets: dict[BudgetKind, Budget] = {}
    reserve: float | None = None
    reserve_said: tuple[p.Span, ...] = ()
    for limit in limits:
        if limit.keep:
            reserve = max(limit.amount, reserve or 0.0)
            reserve_said = (*reserve_said, limit.said)
        else:
            kind = KINDS[limit.unit]
            known = budgets.get(kind, Budget(kind=kind, limit=limit.amount))
            budgets[kind] = replace(known, limit=min(limit.amount, known.limit), said=(*known.said, limit.said))
    return Constraints(budgets=tuple(budgets.values()), reserve_percent=reserve, reserve_said=reserve_said)


def _with_recharging(constraints: Constraints, meant: MeantRecharging | None) -> Constraints:
    if meant is None:
        return constraints
    return replace(
        constraints,
        recharge=True,
        recharge_below_percent=meant.below_percent,
        recharge_until_percent=meant.until_percent,
        recharge_at_most=meant.at_most,
        energy_said=meant.said,
    )


def _unable(task: Task, robot: RobotProfile, site: Site) -> Iterable[Reason]:
    """Yield what the robot or the site lacks for recharging."""
    if not recharges(task):
        return
    steps = [span for node in p.walk(task.composition.plan) if node.recharge is not None for span in node.said]
    said = (*task.constraints.energy_said, *steps)
    if robot.energy.charging is None:
        what = message("{robot} cannot recharge: its profile has no charging", robot=robot.name)
        advice = message("describe its charger under energy: charging in its profile, or ask for less")
        yield Reason(what=what, said=said, advice=advice, final=True)
    elif "charger" not in site.markers:
        advice = message('add a point of "kind": "charger" to its file')
        yield Reason(what=message("the site has no charger"), said=said, advice=advice, final=True)


def _impossible_limits(limits: Iterable[LimitPhrase]) -> Iterable[Reason]:
    """Yield a reason for each limit that cannot be kept."""
    for limit in limits:
        most = 100.0 if limit.unit == "percent" else math.inf
        if not 0.0 < limit.amount <= most:
            what = message(
                "a limit of {amount} {unit} cannot be kept",
                amount=Number(f"{limit.amount:g}"),
                unit=named(limit.unit, "unit"),
            )
            advice = message("say a number above 0, at most 100 for percent of the battery")
            yield Reason(what=what, said=(limit.said,), advice=advice, final=True)


def _impossible(plan: p.Node, site: Site) -> Iterable[Reason]:
    """Yield a reason for each place that the site lacks, as far as it can be told before the robot drives."""
    for node in p.walk(plan):
        selector = node.selector
        for part in () if selector is None else foreseeable(selector):
            try:
                resolve(part, site, Context(here=site.start))
            except (PlaceError, TaskError) as error:
                yield Reason(what=error.what, said=node.said, advice=error.advice, final=True)
                break
