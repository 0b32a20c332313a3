"""The two things that a robot does, as steps that a behavior takes tick by tick: drive to a place, make a capture.

Each is a generator that yields while the robot is busy. It ends when it is done and raises when it failed for good.
What is done about each kind of failure stands here; docs/faults.md tells it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping

from fieldhand.errors import ActionFault, BlockedFault, DriveFault, LostFault
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.obstacles import avoid, open_a_way
from fieldhand.execution.waiting import know_position, wait
from fieldhand.language import joined, message
from fieldhand.language.words import say_place
from fieldhand.robot.model import Action
from fieldhand.site.model import Place
from fieldhand.task.plan import Act
from fieldhand.task.results import Faulted
from fieldhand.task.run import Steps

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
        # The robot began the mission at this very place: it is there without a drive.
        attempt.stop_at(attempt.standing)
        attempt.emit_arrived(node, attempt.standing, 0.0)
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
                raise BlockedFault(_unreached(place, obstacle or fault.what)) from None
            waited = True
            yield from open_a_way(attempt, node, place)
            continue
        while not (progress := attempt.attend()).over:
            yield
        if progress.state == "succeeded":
            return
        why = progress.what or message("it failed", context="log")
        what = message("drive to {place}: {what}", context="log", place=_named(place), what=why)
        if progress.state == "cancelled":
            raise DriveFault(what)
        stops += progress.fault in ("blocked", "lost")
        if progress.fault == "blocked":
            obstacle = progress.what
            avoid(attempt, node, place, obstacle)
            if stops > MOST_STOPS:
                times = message("stopped {count} times on the way there", context="log", count=stops)
                raise BlockedFault(joined("; ", (what, times)))
            if ask is not None and (there := _stand(attempt, place)) is not None:
                yield from ask(there)
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
        attempt.emit(Faulted(t=attempt.t, node=node, fault="drive_failed", what=what, handled=True))
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
            message("{robot} has no action {action}", context="log", robot=attempt.robot.name, action=node.action),
            where=node.id,
            advice=message("approve it for this robot", context="log"),
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
            raise ActionFault(what or message("cancelled", context="log"), where=_named(attempt.here))
        if progress.fault == "lost":
            stops += 1
            if stops > MOST_STOPS:
                lost = message(
                    "{action}: lost {count} times at {place}",
                    context="log",
                    action=node.action,
                    count=stops,
                    place=_named(attempt.here),
                )
                raise LostFault(lost)
            continue
        failed += 1
        if progress.fault == "empty":
            break
        if failed < tries:
            yield from wait(attempt, retry_wait_s)
    why = what or message("no reason given", context="log")
    if failed == 1:
        said = message("{action} failed 1 time: {what}", context="log", action=node.action, what=why)
    else:
        said = message(
            "{action} failed {count} times: {what}", context="log", action=node.action, count=failed, what=why
        )
    raise ActionFault(said, where=_named(attempt.here))


def _tries(attempt: Attempt, action: Action) -> tuple[int, float]:
    """Return how often an action is tried, and the seconds between."""
    robot = attempt.robot
    retries = robot.retries if action.retries is None else action.retries
    return retries + 1, robot.patience.retry_wait_s if action.retry_wait_s is None else action.retry_wait_s


def _stand(attempt: Attempt, place: Place) -> Place | None:
    """Return a place with the stand that a drive would lead to, or None if no way is left."""
    try:
        return attempt.reached(place)
    except DriveFault:
        return None


def _named(place: Place) -> str:
    return say_place(place.kind, place.id)


def _unreached(place: Place, why: str) -> str:
    return message("{place} cannot be reached: {why}", context="log", place=_named(place), why=why)
