"""Simulate the charges of sampled missions along a walk, by the rules of :mod:`fieldhand.forecast.recharge_rules`.

Every sampled mission decides before each visit whether it charges first, from its own charge: with the costs of its own
legs, missions along the same walk charge at different places, and a different number of times.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.recharge_rules import (
    ChargeCycle,
    RechargeRules,
    charge_cycle,
    charge_target,
    charger_distance,
)
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.sampled_costs import MissionSamples, SampledCharging, SampledUse, SampledVisits
from fieldhand.forecast.service import work_of
from fieldhand.forecast.walk_steps import WalkStep, work_in
from fieldhand.site.model import Place
from fieldhand.task.frames import Task
from fieldhand.task.plan import Recharge

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class GuardedStep:
    """A step of a walk as the guard sees it: a drive, an action, a wait, work along a path, or a charge.

    Attributes:
        step: The step; None for optional visits.
        leg_m: Metres driven to its place; 0 for an action.
        work: Work of the step itself, with the time by which a pace slows its drive.
        asked: Work that the guard was asked about with it; None if an earlier question covered it.
        from_charger_m, to_charger_m: Metres from the charger to its place, and back; infinite if there is no way.
        visits: Optional visits of each sampled mission.
    """

    step: WalkStep | None
    leg_m: float
    work: Work
    asked: Work | None
    from_charger_m: float
    to_charger_m: float
    visits: SampledVisits | None = None

    @property
    def charges(self) -> Recharge | None:
        """Return the node that charges the battery here as a step of the plan."""
        return self.step.node.recharge if self.step is not None and self.step.kind == "charge" else None


def stretches(
    steps: Iterable[WalkStep | SampledVisits], rules: RechargeRules, drives: Drives
) -> tuple[GuardedStep, ...]:
    """Return the steps of a walk that drive, act or charge."""
    found: list[GuardedStep] = []
    metres: dict[tuple[float, float], float] = {}
    covered: str | None = None
    for step in steps:
        if isinstance(step, SampledVisits):
            found.append(_of_visits(step))
            covered = None
            continue
        if step.kind not in ("drive", "act", "wait", "work", "charge", "exit") or not step.places:
            continue
        place = step.places[0]
        away = metres.get(place.xy)
        if away is None:
            known = charger_distance(drives, place, rules.charger)
            away = metres[place.xy] = math.inf if known is None else known
        leg_m = 0.0 if step.drive is None else step.drive.length_m
        work = Work() if step.kind == "charge" else step.work if step.kind == "work" else work_in(step)
        asked: Work | None = work
        if step.kind == "drive" and step.node.visits_each and step.node.work is None:
            (body,) = step.node.children
            asked, covered = work + work_of(body, rules.robot), _spot(place)
        elif step.kind == "work":
            covered, before = None, found[-1] if found else None
            drive = None if before is None else before.step
            if before is not None and drive is not None and drive.node is step.node and drive.kind == "drive":
                # It is asked about before the drive to its begin, and leads to another place.
                found[-1] = replace(before, asked=before.work + work, to_charger_m=away)
                asked = None
        elif step.kind in ("drive", "exit"):
            covered = None
        elif covered == _spot(place):
            asked = None
        if step.node.recharge is not None:
            asked = None
        found.append(
            GuardedStep(
                step=step,
                leg_m=leg_m,
                work=work,
                asked=asked,
                from_charger_m=away,
                to_charger_m=0.0 if step.kind == "exit" else away,
            )
        )
    return tuple(found)


def _of_visits(visits: SampledVisits) -> GuardedStep:
    """Return the optional visits as a stretch with the mean of all missions."""
    metres, seconds, joules = visits.work
    return GuardedStep(
        step=None,
        leg_m=float((visits.preview.legs + metres).mean()),
        work=Work(seconds=float(seconds.mean()), joules=float(joules.mean())),
        asked=None,
        from_charger_m=math.inf,
        to_charger_m=math.inf,
        visits=visits,
    )


def _spot(place: Place) -> str:
    return f"{place.kind} {place.id}"


@dataclass(frozen=True, kw_only=True)
class ChargesNeeded:
    """The charge in percent that suffices for each stretch, shape (stretches,).

    It is for the stretch and the way to the charger, or for everything that is left, whichever takes less.

    Attributes:
        here: From where the robot is.
        from_charger: From the charger, with a charged battery.
        rest: From the charger, for everything that is left.
    """

    here: Floats
    from_charger: Floats
    rest: Floats


def charges_needed(some: Sequence[GuardedStep], rules: RechargeRules) -> ChargesNeeded:
    """Return the charge that suffices for each stretch. Up to a charge of the plan, what follows it is not counted."""
    here, from_charger = np.zeros(len(some)), np.zeros(len(some))
    leg, back, begin = (
        np.array([getattr(s, name) for s in some]) for name in ("leg_m", "to_charger_m", "from_charger_m")
    )
    work = np.array([_percent(s.asked or s.work, rules) for s in some])
    own = np.array([_percent(s.work, rules) for s in some])
    later = np.zeros((3, len(some) + 1))
    later_work = np.zeros(len(some) + 1)
    for k in range(len(some) - 1, -1, -1):
        # A charge of the plan begins with the way to it, which its own drive has covered.
        ends = some[k].charges is not None
        later[:, k] = 0.0 if ends else later[:, k + 1] + [leg[k], leg[k] ** 2, leg[k] ** 3]
        later_work[k] = 0.0 if ends else later_work[k + 1] + own[k]
    starts = ((leg, here, False), (np.where(np.isfinite(begin), begin, 0.0), from_charger, True))
    for first, needed, charged in starts:
        there = np.where(np.isfinite(back), back, 0.0)
        docked = work + np.where(back > 0.0, rules.dock_percent, 0.0)
        to_charger = rules.needed([first**n + there**n for n in (1, 2, 3)], docked, charged=charged)
        after = [first**n + later[n - 1, 1:] for n in (1, 2, 3)]
        rest = rules.needed(after, own + later_work[1:], charged=charged)
        needed[:] = np.where(np.isfinite(back), np.minimum(to_charger, rest), rest)
    start, known = np.where(np.isfinite(begin), begin, 0.0), np.isfinite(begin)
    whole = rules.needed([start**n + later[n - 1, 1:] for n in (1, 2, 3)], own + later_work[1:])
    return ChargesNeeded(
        here=here, from_charger=np.where(known, from_charger, np.inf), rest=np.where(known, whole, np.inf)
    )


def _percent(work: Work, rules: RechargeRules) -> float:
    """Return the charge in percent that work takes."""
    return rules.robot.percent(0.0, work.seconds, work.joules) + work.metres * rules.per_metre


def charged_use(
    steps: Sequence[WalkStep | SampledVisits],
    task: Task,
    rules: RechargeRules,
    drives: Drives,
    samples: MissionSamples,
    charge_percent: float,
) -> SampledUse:
    """Return the resources used by missions along a walk, with their charges.

    Args:
        steps: Steps of the walk, and the optional visits of each mission.
        task: The Task.
        rules: Rules of its recharging.
        drives: Drives between places.
        samples: Sampled costs of the legs.
        charge_percent: Charge at the start.
    """
    some = stretches(steps, rules, drives)
    needed = charges_needed(some, rules)
    missions, leaving = _ChargingMissions(rules, task, samples, charge_percent), None
    for number, stretch in enumerate(some):
        if stretch.charges is not None:
            missions.charge_as_planned(stretch.charges)
            continue
        if stretch.visits is not None:
            later = some[number + 1 :]
            rest = sum((s.work for s in later), Work(metres=sum(s.leg_m for s in later)))
            missions.visit(stretch.visits, charge_cycle(rules, task, drives), rest)
            leaving = stretch.visits.preview.last
            continue
        if stretch.asked is None:
            charging = np.zeros(samples.draws, dtype=bool)
        else:
            charging = missions.charge_first(number, needed)
        back_m, costs = stretch.from_charger_m if charging.any() else 0.0, samples.leg(number)
        ahead = stretch.leg_m * costs if leaving is None or not stretch.leg_m else leaving
        leaving = None if stretch.leg_m else leaving
        missions.drive(np.where(charging, back_m * costs, ahead))
        missions.act(stretch.work)
        if stretch.work.metres:
            missions.drive(np.full(samples.draws, stretch.work.metres))
        missions.away_m = stretch.from_charger_m
    return missions.used


class _ChargingMissions:
    """Many missions at once, each with its own charge.

    Attributes:
        level: Charge of each in percent.
        away_m: Metres from their common place to the charger.
    """

    def __init__(self, rules: RechargeRules, task: Task, samples: MissionSamples, charge_percent: float) -> None:
        charging = rules.robot.energy.charging
        assert charging is not None  # noqa: S101  rules exist only for a robot that charges
        self._rules, self._robot, self._samples, self._charging = rules, rules.robot, samples, charging
        self._until = charge_target(task.constraints, rules.robot)
        self._budgets = task.constraints.budgets
        self._speed = speed_of(task.constraints, rules.robot)
        self.level, none = np.full(samples.draws, charge_percent), np.zeros(samples.draws)
        self.away_m = math.inf
        self._metres, self._seconds, self._joules = none.copy(), none.copy(), none.copy()
        self._charges, self._ordered, self._docked_s = none.copy(), none.copy(), none.copy()
        self._lowest = self.level.copy()

    @property
    def used(self) -> SampledUse:
        """Return the resources used so far."""
        return SampledUse(
            metres=self._metres,
            seconds=self._seconds,
            joules=self._joules,
            charging=SampledCharging(
                charges=self._charges,
                docked_s=self._docked_s,
                left=self.level,
                lowest=np.minimum(self._lowest, self.level),
            ),
        )

    def drive(self, metres: Floats) -> None:
        """Drive legs of these costs in metres."""
        self._metres += metres
        self.level = self.level - self._robot.percent(1.0, 1.0 / self._speed) * metres

    def act(self, work: Work) -> None:
        """Do work, without the metres driven in it."""
        self._seconds += work.seconds
        self._joules += work.joules
        self.level = self.level - self._robot.percent(0.0, work.seconds, work.joules)

    def charge_first(self, number: int, needed: ChargesNeeded) -> NDArray[np.bool_]:
        """Send the missions that must charge before the next stretch to the charger; return True for these."""
        rules, enough = self._rules, float(needed.here[number])
        possible = bool(needed.from_charger[number] <= rules.until_percent)
        able = rules.gains(self.level) & possible & (self._ordered < rules.at_most)
        goes: NDArray[np.bool_] = rules.must_charge(self.level, enough) & able & math.isfinite(self.away_m)
        if goes.any():
            self.drive(np.where(goes, self.away_m, 0.0) * self._samples.leg(number, detour=True))
            self._ordered += goes
            self._dock(goes, rules.target(float(needed.rest[number]), self.level), None)
        return goes

    def visit(self, visits: SampledVisits, cycle: ChargeCycle, rest: Work) -> None:
        """Make each mission's optional visits, charging in between as often as needed, each time from a usual place.

        Missions whose budgets do not allow the last charge leave out the visits that need it.

        Args:
            visits: The visits of each mission.
            cycle: A usual charge.
            rest: Mean of what follows.
        """
        rules, charging, robot = self._rules, self._charging, self._robot
        inside_m, seconds, joules = visits.work
        metres = inside_m + visits.preview.legs
        seconds = seconds + metres * visits.slower_s_per_m
        takes = robot.percent(1.0, 1.0 / self._speed) * metres
        takes = takes + robot.percent(0.0, 1.0) * seconds + robot.percent(0.0, 0.0, 1.0) * joules
        above = self.level - cycle.floor_percent
        missing = np.maximum(takes - above, 0.0)
        times = np.minimum(np.ceil(missing / cycle.net_percent), rules.at_most - self._ordered)
        short = self._exceeds(
            metres + times * cycle.detour_m, seconds + times * cycle.charge_s, takes, cycle, times, rest
        )
        times = np.where(short & (times > 0), times - 1.0, times)
        gained = np.maximum(above + times * cycle.net_percent, 0.0)
        part = np.where(short, np.minimum(1.0, gained / np.maximum(takes, 1e-9)), 1.0)
        self._metres += part * metres + times * cycle.detour_m
        self._seconds += part * seconds + times * (charging.around_s + cycle.charge_s)
        self._joules += part * joules + times * charging.around_j
        self._docked_s += times * cycle.charge_s
        self._ordered += times
        self._charges += times
        self.level = self.level - part * takes + times * cycle.net_percent
        self.away_m = cycle.detour_m / 2.0

    def _exceeds(
        self, metres: Floats, seconds: Floats, takes: Floats, cycle: ChargeCycle, times: Floats, rest: Work
    ) -> NDArray[np.bool_]:
        """Return True for the missions that would exceed a budget by their visits, charges and the mean of the rest."""
        robot, speed = self._robot, self._speed
        driven = self._metres + metres + rest.metres
        spent_s = self._seconds + seconds + times * self._charging.around_s + rest.seconds + driven / speed
        rest_percent = robot.percent(rest.metres, rest.seconds + rest.metres / speed, rest.joules)
        used = {
            "distance_m": driven,
            "duration_s": spent_s,
            "energy_percent": self._used_percent + takes + times * cycle.percent + rest_percent,
        }
        exceeded = np.zeros(len(metres), dtype=bool)
        for budget in self._budgets:
            exceeded |= used[budget.kind] > budget.limit
        return exceeded

    @property
    def _used_percent(self) -> Floats:
        robot = self._robot
        seconds = self._metres / self._speed + self._seconds - self._docked_s
        return (
            robot.percent(1.0, 0.0) * self._metres
            + robot.percent(0.0, 1.0) * seconds
            + robot.percent(0.0, 0.0, 1.0) * self._joules
        )

    def charge_as_planned(self, node: Recharge) -> None:
        """Charge all missions at their place, as the plan says."""
        until = self._until if node.until_percent is None else node.until_percent
        if node.duration_s is not None and node.until_percent is None:
            until = 100.0
        self._dock(np.ones(len(self.level), dtype=bool), np.full(len(self.level), until), node.duration_s)

    def _dock(self, docks: NDArray[np.bool_], until: Floats, most_s: float | None) -> None:
        charging, capacity_j = self._charging, self._robot.energy.capacity_j
        self._lowest = np.where(docks, np.minimum(self._lowest, self.level), self._lowest)
        before = self._maneuver(docks, charging.dock.duration_s, charging.dock.energy_j)
        full_s = charging.seconds(before, until, capacity_j)
        seconds = full_s if most_s is None else np.minimum(most_s, full_s)
        seconds = np.where(docks, seconds, 0.0)
        self.level = np.where(docks, charging.percent_after(before, seconds, capacity_j), self.level)
        self._seconds += seconds
        self._docked_s += seconds
        self._charges += docks
        if charging.undock is not None:
            self._maneuver(docks, charging.undock.duration_s, charging.undock.energy_j)

    def _maneuver(self, docks: NDArray[np.bool_], seconds: float, joules: float) -> Floats:
        self._seconds += np.where(docks, seconds, 0.0)
        self._joules += np.where(docks, joules, 0.0)
        self.level = self.level - np.where(docks, self._robot.percent(0.0, seconds, joules), 0.0)
        return self.level
