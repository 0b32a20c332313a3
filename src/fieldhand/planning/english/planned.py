"""From what a request says to a Task: its exit, its limits, and whether its places are on this site."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import Number, message, named
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.averages import check_averages
from fieldhand.planning.english.draft import Halt, node_of
from fieldhand.planning.english.faults import Unclear
from fieldhand.planning.english.limits import LimitPhrase
from fieldhand.planning.english.told import Told
from fieldhand.planning.foreseen import foreseeable
from fieldhand.planning.homeward import faulted_exits, usual_exit, with_assumed_exit
from fieldhand.planning.planner import Outcome, Planned, Reason, Refused
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.frames import Budget, BudgetKind, Constraints, Resource, Then

NAME = "english"
KINDS: dict[str, BudgetKind] = {"metres": "distance_m", "seconds": "duration_s", "percent": "energy_percent"}


def planned(
    request: str, read_as: str, told: Told, site: Site, robot: RobotProfile, *, warnings: tuple[str, ...] = ()
) -> Outcome:
    """The Task of what a request says.

    Args:
        read_as: The request with the words of its answers; empty if there were none.
        warnings: What has to be confirmed before the Task is approved, as sentences.

    Raises:
        Unclear: A limit that cannot be kept.
    """
    if all(isinstance(step, Halt) for step in told.root.steps):
        reason = Reason(
            what=message("the request asks for nothing to be done"),
            advice=message("say what to take or measure, and at which trees"),
        )
        return Refused(reasons=(reason,), planner=NAME)
    check_averages(told.root, request, robot)
    plan = node_of(told.root)
    if plan.is_series:
        plan = replace(plan, said=tuple(told.joints))
    else:
        told.no_part += told.joints  # there is nothing that they could put in order
    return planned_as(
        Meant(
            plan=plan,
            limits=tuple(told.limits),
            nominal=told.nominal,
            nominal_said=tuple(told.nominal_said),
            no_part=tuple(told.no_part),
            assumptions=tuple(told.assumptions),
            warnings=warnings,
        ),
        request,
        site,
        robot,
        read_as=read_as,
    )


@dataclass(frozen=True, kw_only=True)
class Meant:
    """The meaning of a request, from which its Task is made.

    Attributes:
        plan: Plan.
        limits: Budgets and reserves.
        nominal: How the mission ends; None if the request does not say so.
        nominal_said: Spans of the request that say it.
        no_part: Spans of the request that ask for nothing.
        assumptions: What was assumed, as sentences.
        warnings: What has to be confirmed before the Task is approved, as sentences.
    """

    plan: p.Node
    limits: tuple[LimitPhrase, ...] = ()
    nominal: Then | None = None
    nominal_said: tuple[p.Span, ...] = ()
    no_part: tuple[p.Span, ...] = ()
    assumptions: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def planned_as(meant: Meant, request: str, site: Site, robot: RobotProfile, *, read_as: str = "") -> Outcome:
    """Return the Task of what a request means, or a refusal that names the places which the site does not have.

    Raises:
        Unclear: A limit cannot be kept.
    """
    nominal = usual_exit(site) if meant.nominal is None else meant.nominal
    task = make_task(
        request=request,
        plan=meant.plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=_constraints(meant.limits),
        nominal=nominal,
        nominal_said=meant.nominal_said,
        no_part=tuple((start, end) for start, end in meant.no_part if re.search(r"\w", request[start:end])),
        faulted=faulted_exits(nominal),
        read_as=read_as,
        assumptions=tuple(dict.fromkeys(meant.assumptions)),
        warnings=meant.warnings,
    )
    problems = tuple(_impossible(task.composition.plan, site))
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
        _check(limit)
        if limit.keep:
            reserve = max(limit.amount, reserve or 0.0)
            reserve_said = (*reserve_said, limit.said)
        else:
            kind = KINDS[limit.unit]
            known = budgets.get(kind, Budget(kind=kind, limit=limit.amount))
            budgets[kind] = replace(known, limit=min(limit.amount, known.limit), said=(*known.said, limit.said))
    return Constraints(budgets=tuple(budgets.values()), reserve_percent=reserve, reserve_said=reserve_said)


def _check(limit: LimitPhrase) -> None:
    most = 100.0 if limit.unit == "percent" else math.inf
    if not 0.0 < limit.amount <= most:
        what = message(
            "a limit of {amount} {unit} cannot be kept",
            amount=Number(f"{limit.amount:g}"),
            unit=named(limit.unit, "unit"),
        )
        raise Unclear(Reason(what=what, advice=message("say a number above 0, at most 100 for percent of the battery")))


def _impossible(plan: p.Node, site: Site) -> Iterable[Reason]:
    """Places that this site does not have, as far as it can be told before the robot drives."""
    for node in p.walk(plan):
        selector = node.selector
        for part in () if selector is None else foreseeable(selector):
            try:
                resolve(part, site, Context(here=site.start))
            except (PlaceError, TaskError) as error:
                yield Reason(what=error.what, said=node.said, advice=error.advice, final=True)
                break
