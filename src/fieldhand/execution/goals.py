"""The two things that a robot does, as steps that a behavior takes tick by tick: drive to a place, make a capture.

Each is a generator that yields while the robot is busy. It ends when it is done and raises when it failed for good.
What is done about each kind of failure stands here; docs/faults.md tells it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping

from fieldhand.errors import ActionFault, BlockedFault, DriveFault, LostFault
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.obstacles import avoid, open_a_way
from fieldhand.execution.waiting import Steps, know_position, wait
from fieldhand.robot.model import Action
from fieldhand.site.model import Place
from fieldhand.task.plan import Act
from fieldhand.task.results import Arrived, Faulted

#: So often one drive is stopped by something in its way, and one drive or capture by a lost position, before it fails.
MOST_STOPS = 20

Asked = Callable[[Place], Steps]


def drive(attempt: Attempt, node: str, place: Place, *, patient: bool = True, ask: Asked | None = None) -> Steps:
    """Drive to a place, which then is the place in hand. A robot that has stopped there already stays.

    A drive that fails is tried again from where the robot stands, as often as the profile's ``retries`` say. What
    stands in the way is driven around; a lost position is waited for. Neither counts as a try.

    Args:
        attempt, node, place: What for, and where to.
        patient: Whether to wait and try again where what stands in the way leaves no other.
        ask: Asks the guard anew when the way has become another one.

    Raises:
        BlockedFault: No way is left. The robot stands where it stopped.
        LostFault: It does not know where it is.
        DriveFault: Every try failed, or there never was a way. The robot stands where it stopped.
    """
    if attempt.is_at(place):
        return
    if (attempt.standing.kind, attempt.standing.id) == (place.kind, place.id):
        _arrive_in_place(attempt, node, attempt.standing)
        return
    tries, stops, waited, obstacle = attempt.robot.retries + 1, 0, not patient, ""
    while True:
        yield from know_position(attempt, node)
        try:
            attempt.start_drive(node, place)
        except DriveFault as fault:
            if not attempt.blockages.stretches:
                raise
            if waited or stops > MOST_STOPS:
                raise BlockedFault(f"{_named(place)} cannot be reached: {obstacle or fault.what}") from None
            waited = True
            yield from open_a_way(attempt, node, place)
            continue
        while not (progress := attempt.attend()).over:
            yield
        if progress.state == "succeeded":
            return
        what = f"drive to {_named(place)}: {progress.what or 'it failed'}"
        if progress.state == "cancelled":
            raise DriveFault(what)
        stops += progress.fault in ("blocked", "lost")
        if progress.fault == "blocked":
            obstacle = progress.what
            avoid(attempt, node, place, obstacle)
            if stops > MOST_STOPS:
                raise BlockedFault(f"{what}; stopped {stops} times on the way there")
            if ask is not None and (there := _stand(attempt, place)) is not None:
                yield from ask(there)
            continue
        if progress.fault == "lost":
            if stops > MOST_STOPS:
                raise LostFault(f"{what}; lost {stops} times on the way there")
            continue
        tries -= 1
        if tries == 0 or progress.fault == "empty":
            raise DriveFault(what)
        attempt.emit(Faulted(t=attempt.t, node=node, fault="drive_failed", what=f"{what}; trying again", handled=True))
        yield from wait(attempt, attempt.robot.patience.retry_wait_s)


def capture(attempt: Attempt, node: Act) -> Generator[None, None, Mapping[str, float]]:
    """Make one capture at the place in hand, tried again as often as the profile says of the action.

    A robot that does not know where it is makes none: it waits first.

    Returns:
        What it measured, by quantity; nothing where the power was cut and it is not to be made again.

    Raises:
        ActionFault: Every try failed.
        LostFault: The robot does not know where it is.
    """
    action = attempt.robot.action.get(node.action)
    if action is None:
        raise ActionFault(
            f"{attempt.robot.name} has no action {node.action}", where=node.id, advice="approve it for this robot"
        )
    parameters: dict[str, str | float] = {p.name: p.default for p in action.parameters}
    parameters.update(node.parameters)
    tries, retry_wait_s = _tries(attempt, action)
    what, failed, stops, number = "", 0, 0, 0
    while failed < tries:
        yield from know_position(attempt, node.id)
        number += 1
        attempt.start_capture(node.id, node.action, parameters, number)
        while not (progress := attempt.attend()).over:
            yield
        if progress.state == "succeeded":
            return progress.readings
        if progress.state == "cut_off":
            return {}  # in doubt, and not to be made again: what it read is unknown
        what = progress.what
        if progress.state == "cancelled":
            raise ActionFault(what or "cancelled", where=_named(attempt.here))
        if progress.fault == "lost":
            stops += 1
            if stops > MOST_STOPS:
                raise LostFault(f"{node.action}: lost {stops} times at {_named(attempt.here)}")
            continue
        failed += 1
        if progress.fault == "empty":
            break
        if failed < tries:
            yield from wait(attempt, retry_wait_s)
    raise ActionFault(
        f"{node.action} failed {failed} time{'s' * (failed != 1)}: {what or 'no reason given'}",
        where=_named(attempt.here),
    )


def _tries(attempt: Attempt, action: Action) -> tuple[int, float]:
    """How often an action is tried, and seconds between."""
    robot = attempt.robot
    retries = robot.retries if action.retries is None else action.retries
    return retries + 1, robot.patience.retry_wait_s if action.retry_wait_s is None else action.retry_wait_s


def _stand(attempt: Attempt, place: Place) -> Place | None:
    """The place with where the robot will stand there; None where no way is left."""
    try:
        return attempt.reached(place)
    except DriveFault:
        return None


def _arrive_in_place(attempt: Attempt, node: str, place: Place) -> None:
    """The robot began the mission at this very place: it is there without a drive."""
    attempt.stop_at(place)
    position = attempt.driver.position()
    attempt.emit(
        Arrived(
            t=attempt.t,
            node=node,
            kind=place.kind,
            place=place.id,
            lat=position.lat,
            lon=position.lon,
            leg_m=0.0,
            travelled_m=attempt.travelled_m,
            charge_percent=attempt.driver.charge_percent(),
        )
    )


def _named(place: Place) -> str:
    return f"tree {place.id}" if place.kind == "tree" else f"the {place.id}"
