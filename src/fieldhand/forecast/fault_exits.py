"""Drives home after a fault: from every place where a mission may stop to the destination of the Task's exit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.errors import DriveFault
from fieldhand.forecast.mission_state import Work
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.sampled_costs import LegCostSamples, MissionSamples
from fieldhand.forecast.service import retry_work
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.forecast.walk_steps import Decision, Walk, WalkStep
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Place, Site
from fieldhand.task.build import exit_of
from fieldhand.task.frames import Fault, Task

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Maximum number of places from which the way home is computed: the farthest ones, and an even sample of the others.
MAX_PLACES = 120

_FAULTS: tuple[Fault, ...] = ("action_failed", "drive_failed", "low_budget", "aborted")


@dataclass(frozen=True, kw_only=True, repr=False)
class FaultExits:
    """The drives home after faults.

    Attributes:
        steps: One drive home per step, with the node after which it is driven.
        broken: Missing ways home: the place, the destination, and the reason.
        worst: For each fault after which the robot drives home, the longest branch up to that fault and home, with
            missions sampled along it. A low budget is excluded: the guard reserves what the way home needs.
        looked_at, places: Number of places for which the way home was computed, and number of all places.
    """

    steps: tuple[WalkStep, ...]
    broken: tuple[tuple[Place, Place, DriveFault], ...]
    worst: tuple[tuple[Fault, Walk], ...]
    looked_at: int
    places: int

    __repr__ = short_repr


def fault_exits(
    task: Task,
    site: Site,
    robot: RobotProfile,
    drives: Drives,
    walks: Sequence[Walk],
    optional_walks: Sequence[Walk],
    leg_costs: LegCostSamples,
) -> FaultExits:
    """Compute the drives home from the places of walks, for each fault after which the Task returns the robot home."""
    then = {fault: exit_of(task, fault) for fault in _FAULTS}
    homes = {f: site.home(t, site.start) for f, t in then.items() if t != "stay"}
    stops = _stops((*walks, *optional_walks))
    slow = slow_ground(task.constraints, site, robot)
    distinct = {s.places[0].stand or s.places[0].xy: s for s in stops.values()}
    ways_home: dict[tuple[object, object], WalkStep] = {}
    broken: dict[tuple[object, object], tuple[Place, Place, DriveFault]] = {}
    looked: set[object] = set()
    for home in {h.xy: h for h in homes.values()}.values():
        for stand, step in _some(distinct, home):
            looked.add(stand)
            place = step.places[0]
            if place.xy == home.xy:
                ways_home[stand, home.xy] = replace(
                    step, kind="exit", places=(home,), drive=None, seconds=0.0, joules=0.0, slower_s_per_m=0.0
                )
                continue
            try:
                drive = drives.between(place, home)
            except DriveFault as error:
                broken[stand, home.xy] = (place, home, error)
            else:
                added_s = slow.extra_s(drive.points, speed_of(task.constraints, robot)) if slow else 0.0
                slower = added_s / drive.length_m if drive.length_m else 0.0
                ways_home[stand, home.xy] = replace(
                    step, kind="exit", places=(drive.end,), drive=drive, slower_s_per_m=slower
                )
    faults = [f for f in homes if f != "low_budget"]
    worst = [(f, _longest(f, homes[f], walks, stops, ways_home, task, robot, leg_costs)) for f in faults]
    return FaultExits(
        steps=tuple(ways_home.values()),
        broken=tuple(broken.values()),
        worst=tuple((f, walked) for f, walked in worst if walked is not None),
        looked_at=len(looked),
        places=len(distinct),
    )


def _stops(walks: Sequence[Walk]) -> dict[tuple[int, int], WalkStep]:
    """Return each step at which the robot is at a place, by the indices of its walk and step."""
    return {
        (w, k): step
        for w, walked in enumerate(walks)
        for k, step in enumerate(walked.steps)
        if step.kind in ("act", "drive", "wait", "work") and step.places
    }


def _some(distinct: dict[tuple[float, float], WalkStep], home: Place) -> list[tuple[tuple[float, float], WalkStep]]:
    """Return all places, or the sample of them from which ways home are computed."""
    each = list(distinct.items())
    if len(each) <= MAX_PLACES:
        return each
    away = np.hypot(*(np.array([stand for stand, _ in each]) - np.array(home.xy)).T)
    far = np.argsort(-away)[: MAX_PLACES // 4].tolist()
    evenly = np.linspace(0, len(each) - 1, MAX_PLACES - len(far)).round().astype(int).tolist()
    return [each[k] for k in dict.fromkeys([*far, *evenly])]


def _longest(
    fault: Fault,
    home: Place,
    walks: Sequence[Walk],
    stops: dict[tuple[int, int], WalkStep],
    ways_home: dict[tuple[object, object], WalkStep],
    task: Task,
    robot: RobotProfile,
    leg_costs: LegCostSamples,
) -> Walk | None:
    """Return the longest branch up to a fault and home from there."""
    speed = speed_of(task.constraints, robot)
    longest, most = None, -1.0
    before = {w: np.cumsum([s.seconds for s in walked.steps]) for w, walked in enumerate(walks)}
    for (w, k), step in stops.items():
        if w >= len(walks):
            break
        place = step.places[0]
        way = ways_home.get((place.stand or place.xy, home.xy))
        if way is None or (
            fault == "action_failed" and step.kind != "act" and not (step.kind == "work" and _has_action(step))
        ):
            continue
        again = _again(step, robot).seconds if fault == "action_failed" else 0.0
        seconds = float(before[w][k]) + again + (0.0 if way.drive is None else way.drive.length_m / speed)
        if seconds > most:
            longest, most = (w, k, way), seconds
    if longest is None:
        return None
    w, k, way = longest
    return _ended(fault, walks[w], k, way, robot, leg_costs)


def _ended(
    fault: Fault, walked: Walk, last: int, way: WalkStep, robot: RobotProfile, leg_costs: LegCostSamples
) -> Walk:
    """Return a walk cut off by a fault at one of its steps."""
    steps, samples = list(walked.steps[: last + 1]), MissionSamples(leg_costs)
    for step in steps:
        if step.drive is not None:
            samples.drive(step.drive.length_m, step.slower_s_per_m)
            samples.work(Work(seconds=step.turn_s))
        elif step.kind == "work":
            samples.work(step.work)
        elif step.kind in ("act", "wait"):
            samples.work(Work(seconds=step.seconds, joules=step.joules))
    if fault == "action_failed":
        failed = steps[-1]
        again = _again(failed, robot)
        samples.work(again)
        steps[-1] = replace(
            failed,
            captures=max(0, failed.captures - 1),
            seconds=failed.seconds + again.seconds,
            joules=failed.joules + again.joules,
        )
    if way.drive is not None:
        samples.drive(way.drive.length_m)
    decided = sum(s.kind == "decide" for s in steps)
    decisions: list[Decision] = []
    for decision in walked.decisions:
        decided -= decision.kind == "holds"
        if decided < 0:
            break
        decisions.append(decision)
    return Walk(
        steps=(*steps, replace(way, node=steps[-1].node)),
        end=way.places[0],
        exit="faulted",
        decisions=tuple(decisions),
        used=samples.used,
    )


def _has_action(step: WalkStep) -> bool:
    return step.node.work is not None and bool(step.node.work.action)


def _again(step: WalkStep, robot: RobotProfile) -> Work:
    """Return the work of retrying the last capture of an action up to the robot's number of retries."""
    return Work() if step.node.act is None else retry_work(step.node.act, robot)
