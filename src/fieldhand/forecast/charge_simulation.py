"""Simulate the charges of sampled missions along a walk, by the rules of :mod:`fieldhand.forecast.recharge_rules`.

Every sampled mission decides before each visit whether it charges first, from its own charge: with the costs of its own
legs, missions along the same walk charge at different places, and a different number of times.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fieldhand.forecast.charging_missions import ChargingMissions
from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.recharge_rules import RechargeRules, charger_distance
from fieldhand.forecast.sampled_costs import MissionSamples, SampledVisits
from fieldhand.forecast.service import work_of
from fieldhand.forecast.turning_back import turn_back
from fieldhand.forecast.walk_steps import WalkStep, work_in
from fieldhand.site.model import Place
from fieldhand.task.frames import Task
from fieldhand.task.plan import Recharge, walk

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
        expected: Work that the guard expects of it beforehand: of a visit the longest branch, with the visit's drive.
        from_charger_m, to_charger_m: Metres from the charger to its place, and back; infinite if there is no way.
        visits: Optional visits of each sampled mission.
    """

    step: WalkStep | None
    leg_m: float
    work: Work
    asked: Work | None
    expected: Work
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
    whole = False  # all work of the visit has been counted with its drive
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
        expected = work
        if step.kind == "drive" and step.node.visits_each and step.node.work is None:
            (body,) = step.node.children
            asked, covered = work + work_of(body, rules.robot), _spot(place)
            whole = all(node.selector is None and node.recharge is None for node in walk(body))
            expected = asked if whole else work
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
            expected = Work() if whole else work
        if step.node.recharge is not None:
            asked = None
        found.append(
            GuardedStep(
                step=step,
                leg_m=leg_m,
                work=work,
                asked=asked,
                expected=expected,
                from_charger_m=away,
                to_charger_m=0.0 if step.kind == "exit" else away,
            )
        )
    return tuple(found)


def _of_visits(visits: SampledVisits) -> GuardedStep:
    """Return the optional visits as a stretch with the mean of all missions."""
    metres, seconds, joules = visits.work
    work = Work(seconds=float(seconds.mean()), joules=float(joules.mean()))
    return GuardedStep(
        step=None,
        leg_m=float((visits.preview.legs + metres).mean()),
        work=work,
        asked=None,
        expected=work,
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
        far: Up to what percent to charge for the stretch (:meth:`RechargeRules.far`).
    """

    here: Floats
    from_charger: Floats
    rest: Floats
    far: Floats


@dataclass(frozen=True, kw_only=True)
class _Ahead:
    """Sums of the work ahead of each stretch, shape (stretches,), or (3, stretches) of lengths, squares and cubes.

    Attributes:
        back_m: Metres from its end to the charger; infinite if there is no way.
        asked: Charge in percent that the work takes about which the guard was asked.
        later: Sums of the legs after the stretch.
        work: Charge in percent that its work and all later work is expected to take.
        ends: True for the way home.
    """

    rules: RechargeRules
    back_m: Floats
    asked: Floats
    later: Floats
    work: Floats
    ends: NDArray[np.bool_]

    def suffices(self, first_m: Floats, number: int | slice = slice(None), *, charged: bool = False) -> Floats:
        """Return the charge that suffices for stretches whose first leg has this length."""
        rules, back_m = self.rules, self.back_m[number]
        there = np.where(np.isfinite(back_m), back_m, 0.0)
        docked = self.asked[number] + np.where(back_m > 0.0, rules.dock_percent, 0.0)
        ends = self.ends[number]
        to_charger = rules.needed([first_m**n + there**n for n in (1, 2, 3)], docked, charged=charged, ends=ends)
        rest = self.everything(first_m, number, charged=charged, ends=ends)
        return np.where(np.isfinite(back_m), np.minimum(to_charger, rest), rest)

    def everything(
        self, first_m: Floats, number: int | slice = slice(None), *, charged: bool = False, ends: ArrayLike = False
    ) -> Floats:
        """Return the charge that suffices for everything that is left."""
        return self.rules.needed(self.whole(first_m, number), self.work[number], charged=charged, ends=ends)

    def certain(self, first_m: Floats) -> tuple[Floats, Floats]:
        """Return the charge that keeps stretches off the stop level up to the charger, and up to the end."""
        there = np.where(np.isfinite(self.back_m), self.back_m, 0.0)
        sums = [first_m**n + there**n for n in (1, 2, 3)]
        to_charger = self.rules.certain(sums, self.asked + self.rules.dock_percent)
        end = self.rules.certain(self.whole(first_m), self.work)
        return np.where(np.isfinite(self.back_m), to_charger, np.inf), end

    def whole(self, first_m: Floats, number: int | slice = slice(None)) -> list[Floats]:
        """Return the sums of the legs that are left, where the first one has this length."""
        return [first_m**n + self.later[n - 1, number] for n in (1, 2, 3)]


def _ahead(some: Sequence[GuardedStep], rules: RechargeRules, *, ends: bool) -> _Ahead:
    """Return what lies ahead of each stretch; without ``ends``, much may follow the last one."""
    leg, back = (np.array([getattr(s, name) for s in some]) for name in ("leg_m", "to_charger_m"))
    own = np.array([_percent(s.expected, rules) for s in some])
    later = np.zeros((3, len(some) + 1))
    later_work = np.full(len(some) + 1, 0.0 if ends else np.inf)
    for k in range(len(some) - 1, -1, -1):
        # A charge of the plan begins with the way to it, which its own drive has covered.
        charges = some[k].charges is not None
        later[:, k] = 0.0 if charges else later[:, k + 1] + [leg[k], leg[k] ** 2, leg[k] ** 3]
        later_work[k] = 0.0 if charges else later_work[k + 1] + own[k]
    asked = np.array([_percent(s.asked or s.work, rules) for s in some])
    home = np.array([s.step is not None and s.step.kind == "exit" for s in some], dtype=bool)
    return _Ahead(rules=rules, back_m=back, asked=asked, later=later[:, 1:], work=own + later_work[1:], ends=home)


def charges_needed(some: Sequence[GuardedStep], rules: RechargeRules) -> ChargesNeeded:
    """Return the charge that suffices for each stretch. Up to a charge of the plan, what follows it is not counted."""
    return _needed(some, _ahead(some, rules, ends=True))


def _needed(some: Sequence[GuardedStep], ahead: _Ahead) -> ChargesNeeded:
    leg, begin = (np.array([getattr(s, name) for s in some]) for name in ("leg_m", "from_charger_m"))
    known = np.isfinite(begin)
    start = np.where(known, begin, 0.0)
    certain = zip(*(part.tolist() for part in ahead.certain(start)), strict=True)
    return ChargesNeeded(
        here=ahead.suffices(leg),
        from_charger=np.where(known, ahead.suffices(start, charged=True), np.inf),
        rest=np.where(known, ahead.everything(start), np.inf),
        far=np.where(known, [ahead.rules.far(*each) for each in certain], np.inf),
    )


def _percent(work: Work, rules: RechargeRules) -> float:
    """Return the charge in percent that work takes."""
    return rules.robot.percent(0.0, work.seconds, work.joules) + work.metres * rules.per_metre


def charged_missions(
    steps: Sequence[WalkStep | SampledVisits],
    task: Task,
    rules: RechargeRules,
    drives: Drives,
    samples: MissionSamples,
    charge_percent: float,
    *,
    ends: bool = True,
) -> ChargingMissions:
    """Return the missions along a walk, with their charges and the resources they use.

    Args:
        steps: Steps of the walk, and the optional visits of each mission.
        task: The Task.
        rules: Rules of its recharging.
        drives: Drives between places.
        samples: Sampled costs of the legs.
        charge_percent: Charge at the start.
        ends: True if the walk ends with these steps; otherwise much may follow.
    """
    some = stretches(steps, rules, drives)
    missions, leaving = ChargingMissions(rules, task, samples.draws, charge_percent), None
    if not some:
        return missions
    ahead = _ahead(some, rules, ends=ends)
    needed = _needed(some, ahead)
    for number, stretch in enumerate(some):
        if stretch.charges is not None:
            missions.charge_as_planned(stretch.charges)
            continue
        if stretch.visits is not None:
            assert stretch.visits.charged is not None  # noqa: S101  given wherever missions are sampled and recharge
            missions, leaving = stretch.visits.charged.ended(), stretch.visits
            continue
        goes = np.zeros(samples.draws, dtype=bool)
        legs_m: Floats = np.full(samples.draws, stretch.leg_m)
        after_visits = leaving is not None and stretch.leg_m > 0.0
        if leaving is not None and leaving.charged is not None and after_visits:
            legs_m = leaving.charged.onward_m
        if stretch.asked is not None:
            enough = ahead.suffices(legs_m, number) if after_visits else float(needed.here[number])
            ends = stretch.step is not None and stretch.step.kind == "exit"
            must = rules.must_charge(missions.level, enough, ends=ends)
            if must.any() and np.isfinite(ahead.work[number]):
                whole = ahead.whole(legs_m, number)
                must &= ~rules.is_way_to_charger_worse(missions.level, missions.away_m, whole, ahead.work[number])
            goes = _charge_first(missions, rules, samples, number, must, needed)
        costs = samples.leg(number)
        way = leaving.preview.last if leaving is not None and after_visits else stretch.leg_m * costs
        back_m = stretch.from_charger_m if goes.any() else 0.0
        leaving = None if stretch.leg_m else leaving
        way = np.where(goes, back_m * costs, way)
        if stretch.step is not None and (stretch.step.kind == "exit" or stretch.step.node.recharge is not None):
            missions.set_out(np.where(goes, back_m, legs_m))
        if stretch.step is not None and stretch.step.kind == "drive" and not after_visits:
            way = turn_back(
                missions,
                rules,
                np.arange(samples.draws),
                leg_m=np.where(goes, back_m, stretch.leg_m),
                costs=costs,
                begin_m=np.where(goes, 0.0, missions.away_m),
                from_charger_m=stretch.from_charger_m,
                after_m=stretch.to_charger_m,
                draw=partial(_leg_of, samples, number),
            )
        missions.drive(way)
        missions.act(stretch.work)
        if stretch.work.metres:
            missions.drive(stretch.work.metres)
        missions.away_m = np.full(samples.draws, stretch.from_charger_m)
    return missions


def _leg_of(samples: MissionSamples, number: int, some: NDArray[np.int64], which: int) -> Floats:
    """Return the cost of a further leg of 1 m between a leg of the walk and the next."""
    return samples.leg(number, detour=2 + which)[some]


def _charge_first(
    missions: ChargingMissions,
    rules: RechargeRules,
    samples: MissionSamples,
    number: int,
    must: NDArray[np.bool_],
    needed: ChargesNeeded,
) -> NDArray[np.bool_]:
    """Send the missions that must charge before a stretch to the charger if they can; return True for these."""
    possible = bool(needed.from_charger[number] <= rules.most_percent)
    able = rules.gains(missions.level) & possible & (missions.ordered < rules.at_most)
    goes: NDArray[np.bool_] = must & able & np.isfinite(missions.away_m)
    if goes.any():
        some = np.flatnonzero(goes)
        costs = samples.leg(number, detour=1)[some]
        rest, far = float(needed.rest[number]), float(needed.far[number])
        missions.interrupt(some, missions.away_m[some], costs, rest=rest, far=far)
    return goes
