"""From the meaning of a request to its Task: its exit, its limits, and whether the site has its places."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import Number, message, named
from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution, resolve
from fieldhand.places.wording import say_selector
from fieldhand.planning.foreseen import foreseeable
from fieldhand.planning.grammar.dialogue.energy import MeantRecharging
from fieldhand.planning.grammar.dialogue.other_ground import with_bare_corners
from fieldhand.planning.grammar.dialogue.watching import with_visits
from fieldhand.planning.grammar.earlier.unsaid import tells_earlier_missions, with_quantities
from fieldhand.planning.grammar.meaning import WayRule
from fieldhand.planning.homeward import faulted_exits, usual_exit, with_assumed_exit
from fieldhand.planning.planner import Clarify, Outcome, Planned, Reason, Refused
from fieldhand.planning.selections import as_zone, is_gate
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.frames import Budget, BudgetKind, Constraints, Resource, Task, Then
from fieldhand.task.recharging import recharges
from fieldhand.task.timing import Timing
from fieldhand.task.watches import Watch
from fieldhand.task.ways import Avoid, OnlyGate, SlowNear

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
        speed_m_s: Highest driving speed of the mission; None for the robot's.
        speed_said: Spans of the request that say it.
        ways: Rules of where the robot drives, each with the spans of the request that say it.
        recharging: How the mission recharges; None if it does not.
        nominal: How the mission ends; None if the request does not say so.
        nominal_said: Spans of the request that say it.
        no_part: Spans of the request that ask for nothing.
        assumptions: What was assumed, as sentences.
        warnings: What has to be confirmed before the Task is approved, as sentences.
        read_as: The request with its corrections made; empty if it has none.
        timing: When the mission runs; None if it begins when it is started.
    """

    plan: p.Node
    limits: tuple[LimitPhrase, ...] = ()
    speed_m_s: float | None = None
    speed_said: tuple[p.Span, ...] = ()
    ways: tuple[tuple[WayRule, tuple[p.Span, ...]], ...] = ()
    recharging: MeantRecharging | None = None
    nominal: Then | None = None
    nominal_said: tuple[p.Span, ...] = ()
    no_part: tuple[p.Span, ...] = ()
    assumptions: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    read_as: str = ""
    timing: Timing | None = None
    watches: tuple[Watch, ...] = ()


def planned_as(meant: Meant, request: str, site: Site, robot: RobotProfile) -> Outcome:
    """Return the Task of what a request means, or a refusal that names the limits and places that cannot be."""
    limits = tuple(_impossible_limits(meant.limits))
    if limits:
        return Refused(reasons=limits, planner=NAME)
    if not tells_earlier_missions(meant.plan, robot):
        return Refused(reasons=(_open_time(meant.plan),), planner=NAME)
    plan = with_quantities(meant.plan, robot)
    if plan is None:
        return Refused(reasons=(_open_quantity(meant.plan),), planner=NAME)
    meant = replace(meant, plan=with_bare_corners(plan, site))
    if not meant.limits and any(node.rewarded_first != "value" for node in p.walk(plan)):
        asked = message("As many of the best as possible: within which time, distance or share of the battery?")
        return Clarify(question=asked, planner=NAME)
    nominal = usual_exit(site) if meant.nominal is None else meant.nominal
    task = make_task(
        request=request,
        read_as=meant.read_as,
        plan=with_visits(meant.plan) if any(_skips(watch) for watch in meant.watches) else meant.plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=_with_recharging(_with_speed(_constraints(meant), meant), meant.recharging),
        nominal=nominal,
        nominal_said=meant.nominal_said,
        no_part=tuple((start, end) for start, end in meant.no_part if re.search(r"\w", request[start:end])),
        faulted=faulted_exits(nominal),
        assumptions=tuple(dict.fromkeys(meant.assumptions)),
        warnings=meant.warnings,
        timing=meant.timing,
        watches=meant.watches,
    )
    problems = (
        *_unable(task, robot, site),
        *_ordered_choices(task.composition.plan),
        *_impossible(task.composition.plan, site),
        *_impossible_ways(meant, site),
    )
    if problems:
        return Refused(reasons=problems, planner=NAME)
    if meant.nominal is None:
        task = with_assumed_exit(task, site, robot)
    return Planned(task=task, planner=NAME)


def _open_time(plan: p.Node) -> Reason:
    """Return the reason for words about what was done that may mean this mission or an earlier one."""
    return Reason(
        what=message("it is not clear whether this mission or an earlier one is meant"),
        said=plan.said,
        advice=message("say when: 'visited yesterday', 'visited in an earlier mission'"),
        final=True,
    )


def _open_quantity(plan: p.Node) -> Reason:
    """Return the reason for words about earlier readings that do not name what was read."""
    return Reason(
        what=message("it is not clear which earlier readings are meant"),
        said=plan.said,
        advice=message("name the quantity: 'where the CO2 was above 450 ppm last time'"),
    )


def _skips(watch: Watch) -> bool:
    """Return True if a watch may leave out a visit."""
    return watch.response in ("skip", "skip_row") or (watch.response == "wait" and watch.fallback == "skip")


def _ordered_choices(plan: p.Node) -> Iterator[Reason]:
    """Yield a reason for visits in a fixed order of which only as many are made as fit."""
    for node in p.walk(plan):
        if node.is_optional and node.visits_each and not node.in_any_order:
            yield Reason(
                what=message("an order of places cannot be combined with a choice of how many", context="fault"),
                said=node.said,
                advice=message("say among how many: 'as many as you can of the 30 oldest trees'"),
                final=True,
            )


def _constraints(meant: Meant) -> Constraints:
    budgets: dict[BudgetKind, Budget] = {}
    reserve: float | None = None
    reserve_said: tuple[p.Span, ...] = ()
    for limit in meant.limits:
        if limit.keep:
            reserve = max(limit.amount, reserve or 0.0)
            reserve_said = (*reserve_said, limit.said)
        else:
            kind = KINDS[limit.unit]
            known = budgets.get(kind, Budget(kind=kind, limit=limit.amount))
            budgets[kind] = replace(known, limit=min(limit.amount, known.limit), said=(*known.said, limit.said))
    return Constraints(
        budgets=tuple(budgets.values()),
        reserve_percent=reserve,
        reserve_said=reserve_said,
        avoid=tuple(
            Avoid(places=places, distance_m=metres, said=said)
            for rule, said in meant.ways
            for places, metres in rule.avoid
        ),
        only_gates=_only_gates(meant),
        slow=tuple(
            SlowNear(
                places=one.places,
                distance_m=one.metres or 0.0,
                speed_m_s=None if one.pace is None else one.pace.speed,
                said=said,
            )
            for rule, said in meant.ways
            for one in rule.slow
        ),
    )


def _only_gates(meant: Meant) -> tuple[OnlyGate, ...]:
    """Return the gates that the robot may pass, each once: "in by the north door, ... and out by the north door"."""
    said: dict[str, tuple[p.Span, ...]] = {}
    for rule, spans in meant.ways:
        for gate in rule.gates:
            said[gate] = (*said.get(gate, ()), *(span for span in spans if span not in said.get(gate, ())))
    return tuple(OnlyGate(gate=gate, said=spans) for gate, spans in said.items())


def _with_speed(constraints: Constraints, meant: Meant) -> Constraints:
    if meant.speed_m_s is None:
        return constraints
    said = (*constraints.reserve_said, *meant.speed_said)
    return replace(constraints, speed_m_s=meant.speed_m_s, reserve_said=said)


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


def _impossible_ways(meant: Meant, site: Site) -> Iterable[Reason]:
    """Yield a reason for each place to keep away from that the site lacks, or of which no distance is said."""
    for rule, said in meant.ways:
        for places, metres in (*rule.avoid, *((one.places, one.metres) for one in rule.slow)):
            if as_zone(places) is not None:
                continue  # a zone without trees is one, too
            try:
                resolve(places, site, Context(here=site.start))
            except (PlaceError, TaskError) as error:
                yield Reason(what=error.what, said=said, advice=error.advice, final=True)
            if not metres and places.single and not places.named_tree and not is_gate(places):
                what = message("it is not said how far to keep from {place}", place=say_selector(places))
                yield Reason(what=what, said=said, advice=message("give a distance: 'keep 5 m from it'"), final=True)


def _impossible(plan: p.Node, site: Site) -> Iterable[Reason]:
    """Yield a reason for each place that the site lacks, as far as it can be told before the robot drives."""
    for node in p.walk(plan):
        selector, here = node.selector, Context(here=site.start)
        of_ground = node.work is not None and node.work.on_ground
        for part in () if selector is None else foreseeable(selector):
            try:
                if of_ground:
                    part.ground(Resolution(site, here))
                else:
                    resolve(part, site, here)
            except (PlaceError, TaskError) as error:
                yield Reason(what=error.what, said=node.said, advice=error.advice, final=True)
                break
