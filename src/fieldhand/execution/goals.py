"""Driving to a place and making a capture, with retries and the response to each kind of fault (docs/faults.md).

Both are generators that yield while the robot is busy, return when done, and raise when they fail for good.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping

from fieldhand.errors import ActionFault, BlockedFault, DriveFault, LostFault, OccupiedFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.docking import ChargeFirst, leave_charger
from fieldhand.execution.navigation_waits import Interruptions, wait_for_robot
from fieldhand.execution.obstacles import avoid, avoid_stand, wait_for_way
from fieldhand.execution.waiting import wait, wait_for_position
from fieldhand.language import joined, message
from fieldhand.language.words import say_place
from fieldhand.robot.model import Action
from fieldhand.site.model import Place
from fieldhand.task.plan import Act
from fieldhand.task.results import Faulted
from fieldhand.task.run import Steps

#: Largest number of stops by obstacles during one drive, and of lost positions during one drive or capture.
MOST_STOPS = 20

AskGuard = Callable[[Place], Steps]


def drive(
    mission: ActiveMission, node: str, place: Place, *, patient: bool = True, ask_guard: AskGuard | None = None
) -> Steps:
    """Drive to a place, which becomes the current place. A robot that has stopped there already stays.

    A failed drive is retried from where the robot stands, up to the profile's ``retries``. Obstacles are driven around,
    and a lost position and a navigation that was restarted are waited for; none of these counts as a retry. While
    another client drives the robot, the mission pauses.

    Args:
        mission: The mission.
        node: Id of the node.
        place: Destination.
        patient: True to wait and try again if obstacles leave no way.
        ask: Asks the guard again after the way has changed.

    Raises:
        BlockedFault: No way is left. The robot stands where it stopped.
        OccupiedFault: No way is left, as something stands where the robot would stand.
        LostFault: The position is unknown.
        DriveFault: All tries failed, or there never was a way. The robot stands where it stopped.
        ChargeFirst: The battery has to be charged first; the drive was broken off.
    """
    if mission.is_at(place):
        return
    if mission.standing.serves(place):
        # The mission began at this place, so no drive is needed.
        mission.stop_at(mission.standing)
        mission.emit_arrived(node, mission.standing, 0.0)
        return
    yield from leave_charger(mission)
    tries, stops, waited, obstacle, occupied = mission.robot.retries + 1, 0, not patient, "", False
    interruptions = Interruptions(mission, node)
    while True:
        yield from wait_for_robot(mission, node)
        try:
            mission.start_drive(node, place)
        except DriveFault as fault:
            if not mission.blockages.stretches:
                raise
            if waited or stops > MOST_STOPS:
                raise _unreached(place, obstacle or fault.what, occupied=occupied) from None
            waited = True
            yield from wait_for_way(mission, node, place)
            continue
        broken_off = False
        while not (progress := mission.attend()).over:
            if mission.recharge_due and not broken_off:
                mission.stop_driver()
                broken_off = True
                continue
            yield
        if progress.state == "succeeded":
            return
        if progress.state == "cancelled" and broken_off:
            raise ChargeFirst(mission.recharge_due, mission.farthest_target)
        why = progress.what or message("it failed", context="log")
        what = message("drive to {place}: {what}", context="log", place=_named(place), what=why)
        if progress.state == "cancelled":
            raise DriveFault(what)
        if progress.fault == "interrupted":
            yield from interruptions.note(progress, what)
            continue
        stops += progress.fault in ("blocked", "occupied", "lost")
        if progress.fault in ("blocked", "occupied"):
            obstacle = progress.what
            if progress.fault == "occupied":
                occupied = True
                avoid_stand(mission, node, place, obstacle)
            else:
                avoid(mission, node, place, obstacle)
            if stops > MOST_STOPS:
                times = message("stopped {count} times on the way there", context="log", count=stops)
                raise BlockedFault(joined("; ", (what, times)))
            if ask_guard is not None and (there := _stand(mission, place)) is not None:
                yield from ask_guard(there)
            continue
        if progress.fault == "lost":
            if stops > MOST_STOPS:
                times = message("lost {count} times on the way there", context="log", count=stops)
                raise LostFault(joined("; ", (what, times)))
            continue
        tries -= 1
        if tries == 0 or progress.fault == "empty":
            raise DriveFault(what)
        what = joined("; ", (what, message("trying again", context="log")))
        mission.emit(Faulted(t=mission.t, node=node, fault="drive_failed", what=what, handled=True))
        yield from wait(mission, mission.robot.patience.retry_wait_s)


def capture(mission: ActiveMission, node: Act) -> Generator[None, None, Mapping[str, float]]:
    """Make one capture at the current place, with as many retries as the profile allows for the action.

    A robot with a lost position waits first.

    Returns:
        Readings by quantity; empty if a power cut interrupted the capture and it is not to be repeated.

    Raises:
        ActionFault: All tries failed.
        LostFault: The position is unknown.
    """
    action = mission.robot.action.get(node.action)
    if action is None:
        raise ActionFault(
            message("{robot} has no action {action}", context="log", robot=mission.robot.name, action=node.action),
            where=node.id,
            advice=message("approve it for this robot", context="log"),
        )
    parameters: dict[str, str | float] = {p.name: p.default for p in action.parameters}
    parameters.update(node.parameters)
    tries, retry_wait_s = _tries(mission, action)
    what, failed, stops, number = "", 0, 0, 0
    while failed < tries:
        yield from wait_for_position(mission, node.id)
        number += 1
        mission.start_capture(node.id, node.action, parameters, number)
        while not (progress := mission.attend()).over:
            yield
        if progress.state == "succeeded":
            return progress.readings
        if progress.state == "cut_off":
            return {}  # in doubt and not repeated: its readings are unknown
        what = progress.what
        if progress.state == "cancelled":
            raise ActionFault(what or message("cancelled", context="log"), where=_named(mission.here))
        if progress.fault == "lost":
            stops += 1
            if stops > MOST_STOPS:
                lost = message(
                    "{action}: lost {count} times at {place}",
                    context="log",
                    action=node.action,
                    count=stops,
                    place=_named(mission.here),
                )
                raise LostFault(lost)
            continue
        failed += 1
        if progress.fault == "empty":
            break
        if failed < tries:
            yield from wait(mission, retry_wait_s)
    why = what or message("no reason given", context="log")
    if failed == 1:
        what_failed = message("{action} failed 1 time: {what}", context="log", action=node.action, what=why)
    else:
        what_failed = message(
            "{action} failed {count} times: {what}", context="log", action=node.action, count=failed, what=why
        )
    raise ActionFault(what_failed, where=_named(mission.here))


def _tries(mission: ActiveMission, action: Action) -> tuple[int, float]:
    """Return the number of tries of an action, and the seconds between them."""
    robot = mission.robot
    retries = robot.retries if action.retries is None else action.retries
    return retries + 1, robot.patience.retry_wait_s if action.retry_wait_s is None else action.retry_wait_s


def _stand(mission: ActiveMission, place: Place) -> Place | None:
    """Return a place with the stand that a drive would lead to, or None if no way is left."""
    try:
        return mission.reached(place)
    except DriveFault:
        return None


def _named(place: Place) -> str:
    return say_place(place.kind, place.id, place.side)


def _unreached(place: Place, why: str, *, occupied: bool) -> BlockedFault:
    if not occupied:
        return BlockedFault(message("{place} cannot be reached: {why}", context="log", place=_named(place), why=why))
    what = message("something stands where the robot would stand at {place}", context="log", place=_named(place))
    return OccupiedFault(joined("; ", (what, why)))
