"""The two things that a robot does, as steps that a behavior takes tick by tick: drive to a place, make a capture.

Each is a generator that yields while the robot is busy. It ends when it is done and raises when it failed for good.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping

from fieldhand.errors import ActionFault, DriveFault
from fieldhand.execution.attempt import Attempt
from fieldhand.site.model import Place
from fieldhand.task.plan import Act
from fieldhand.task.results import Arrived, Faulted

Steps = Generator[None, None, None]


def drive(attempt: Attempt, node: str, place: Place) -> Steps:
    """Drive to a place, which then is the place in hand. A robot that has stopped there already stays.

    A drive that fails is tried again from where the robot stands, as often as the profile's ``retries`` say.

    Raises:
        DriveFault: Every try failed. The robot stands where it stopped.
        PlaceError: There is no way to the place.
    """
    if attempt.is_at(place):
        return
    if (attempt.standing.kind, attempt.standing.id) == (place.kind, place.id):
        _arrive_in_place(attempt, node, attempt.standing)
        return
    for left in reversed(range(attempt.robot.retries + 1)):
        attempt.start_drive(node, place)
        while not (progress := attempt.attend()).over:
            yield
        if progress.state == "succeeded":
            return
        what = f"drive to {_named(place)}: {progress.what or 'it failed'}"
        if not left or progress.state == "cancelled":
            raise DriveFault(what)
        attempt.emit(Faulted(t=attempt.t, node=node, fault="drive_failed", what=f"{what}; trying again", handled=True))


def capture(attempt: Attempt, node: Act) -> Generator[None, None, Mapping[str, float]]:
    """Make one capture at the place in hand, tried again as often as the profile's ``retries`` say.

    Returns:
        What it measured, by quantity.

    Raises:
        ActionFault: Every try failed.
    """
    action = attempt.robot.action.get(node.action)
    if action is None:
        raise ActionFault(
            f"{attempt.robot.name} has no action {node.action}", where=node.id, advice="approve it for this robot"
        )
    parameters: dict[str, str | float] = {p.name: p.default for p in action.parameters}
    parameters.update(node.parameters)
    what = ""
    for number in range(1, attempt.robot.retries + 2):
        attempt.start_capture(node.id, node.action, parameters, number)
        while not (progress := attempt.attend()).over:
            yield
        if progress.state == "succeeded":
            return progress.readings
        what = progress.what
        if progress.state == "cancelled":
            raise ActionFault(what or "cancelled", where=_named(attempt.here))
    tries = attempt.robot.retries + 1
    raise ActionFault(
        f"{node.action} failed {tries} time{'s' * (tries != 1)}: {what or 'no reason given'}",
        where=_named(attempt.here),
    )


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
