"""Working along a stretch, with retries and the response to each kind of fault.

The implement is switched off by the driver whenever the robot stops, whatever the reason. What is left of the stretch
is then worked from where it stopped.
"""

from __future__ import annotations

from collections.abc import Generator

from shapely.ops import unary_union

from fieldhand.errors import ActionFault, BlockedFault, DriveFault, LostFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.docking import ChargeFirst
from fieldhand.execution.goals import MOST_STOPS, drive
from fieldhand.execution.navigation_waits import Interruptions, wait_for_robot
from fieldhand.execution.obstacles import avoid
from fieldhand.execution.stretch_visits import StretchVisits
from fieldhand.execution.waiting import wait
from fieldhand.forecast.working import begin_of, end_of
from fieldhand.language import joined, message
from fieldhand.site.model import Place
from fieldhand.site.working.stretch import NOTHING_M, Stretch
from fieldhand.task.nodes.work_along import WorkAlong
from fieldhand.task.results import Faulted
from fieldhand.task.run import Steps


def work(mission: ActiveMission, node: WorkAlong, tour: StretchVisits) -> Steps:
    """Work along the current stretch of a tour, whose end becomes the current place.

    A failing implement or drive is retried from where the robot stopped, up to the profile's retries. Behind an
    obstacle, the work continues from the other end where there is a way to it; what the obstacle covers is missed.

    Args:
        mission: The mission. The robot is where the stretch begins.
        node: The node.
        tour: Its stretches.

    Raises:
        ActionFault: All tries of the implement failed.
        DriveFault: All tries to drive along failed. The robot stands where it stopped.
        LostFault: The position is unknown.
        ChargeFirst: The battery has to be charged first; the tour knows what is left of the stretch.
    """
    stretch = tour.current
    assert stretch is not None  # noqa: S101  a stretch is current
    whole, rest = stretch.name, stretch
    failed, stops, attempt = 0, 0, 0
    missed_m, why = 0.0, ""
    interruptions = Interruptions(mission, node.id)
    while True:
        yield from wait_for_robot(mission, node.id)
        attempt += 1
        mission.start_stretch(node, rest, attempt)
        broken_off = False
        while not (progress := mission.attend()).over:
            if mission.recharge_due and not broken_off:
                mission.stop_driver()
                broken_off = True
                continue
            yield
        if progress.state == "succeeded":
            break
        what = progress.what or message("it failed", context="log")
        if progress.state == "cancelled" and not broken_off:
            raise DriveFault(message("{stretch}: {what}", context="log", stretch=whole, what=what))
        left = rest.part(mission.controller.reached_m, rest.length_m)
        if left is None:
            mission.stop_at(end_of(rest, mission.site))
            break
        if progress.state == "cancelled":
            tour.break_off(left)
            if missed_m > NOTHING_M:
                tour.miss(begin_of(stretch, mission.site), why)
            raise ChargeFirst(mission.recharge_due, mission.charge_target)
        if progress.fault == "interrupted":
            drive_along = message("drive along {stretch}: {what}", context="log", stretch=whole, what=what)
            yield from interruptions.note(progress, drive_along)
            rest = left
            continue
        stops += progress.fault in ("blocked", "occupied", "lost")
        if stops > MOST_STOPS:
            raise _stopped_too_often(whole, progress.fault, stops)
        if progress.fault in ("blocked", "occupied"):
            avoid(mission, node.id, end_of(rest, mission.site), what)
            rest_on_m = left.on_m
            beyond = yield from _beyond(mission, node, tour, left)
            why = what
            missed_m += rest_on_m - (0.0 if beyond is None else beyond.on_m)
            if beyond is None:
                break
            rest = beyond
            continue
        rest = left
        if progress.fault == "lost":
            continue
        failed += 1
        tries = _tries(mission, node, implement=progress.fault == "implement")
        if failed >= tries or progress.fault == "empty":
            raise _failure(node, whole, what, failed, implement=progress.fault == "implement")
        again = joined("; ", (what, message("trying again", context="log")))
        fault = "action_failed" if progress.fault == "implement" else "drive_failed"
        mission.emit(Faulted(t=mission.t, node=node.id, fault=fault, what=again, handled=True))
        yield from wait(mission, _retry_wait_s(mission, node))
    if missed_m > NOTHING_M:
        tour.miss(begin_of(stretch, mission.site), why)


def _beyond(
    mission: ActiveMission, node: WorkAlong, tour: StretchVisits, left: Stretch
) -> Generator[None, None, Stretch | None]:
    """Drive to the part of a stretch beyond an obstacle, and return it; None if no way leads there."""
    closed = unary_union(mission.blockages.stretches).buffer(mission.drives.clearance_m)
    cut = left.line.difference(closed)
    parts = [
        (left.project(p.coords[0]), left.project(p.coords[-1])) for p in getattr(cut, "geoms", [cut]) if p.length > 0
    ]
    begins = min((a for a, _ in parts if a > NOTHING_M), default=None)
    beyond = None if begins is None else left.part(begins, left.length_m)
    if beyond is None or beyond.on_m <= NOTHING_M:
        return None
    beyond = beyond if beyond.one_way else beyond.reversed()
    place = begin_of(beyond, mission.site)

    def ask_guard(there: Place) -> Steps:
        yield from ()
        tour.permit(there)

    try:
        mission.way_to(place)
        yield from ask_guard(place)
        yield from drive(mission, node.id, place, patient=False, ask_guard=ask_guard)
    except (DriveFault, BlockedFault):
        return None
    return beyond


def _tries(mission: ActiveMission, node: WorkAlong, *, implement: bool) -> int:
    action = mission.robot.action.get(node.action)
    retries = action.retries if implement and action is not None else None
    return 1 + (mission.robot.retries if retries is None else retries)


def _retry_wait_s(mission: ActiveMission, node: WorkAlong) -> float:
    action = mission.robot.action.get(node.action)
    own = None if action is None else action.retry_wait_s
    return mission.robot.patience.retry_wait_s if own is None else own


def _failure(node: WorkAlong, stretch: str, what: str, failed: int, *, implement: bool) -> ActionFault | DriveFault:
    if not implement:
        return DriveFault(message("drive along {stretch}: {what}", context="log", stretch=stretch, what=what))
    if failed == 1:
        said = message("{action} failed 1 time: {what}", context="log", action=node.action, what=what)
    else:
        said = message(
            "{action} failed {count} times: {what}", context="log", action=node.action, count=failed, what=what
        )
    return ActionFault(said, where=stretch)


def _stopped_too_often(stretch: str, fault: str, count: int) -> DriveFault | LostFault:
    place = message("drive along {stretch}", context="log", stretch=stretch)
    if fault == "lost":
        times = message("lost {count} times on the way there", context="log", count=count)
        return LostFault(joined("; ", (place, times)))
    times = message("stopped {count} times on the way there", context="log", count=count)
    return DriveFault(joined("; ", (place, times)))
