"""Follow a mission on a robot: receive its events in order and without gaps, across lost connections."""

from __future__ import annotations

import random
from collections.abc import Callable

from fieldhand.delivery.json_models import EventLine, MissionSummary
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.errors import UnreachableError

#: Seconds until the second try, doubled with each further one up to the longest.
FIRST_S, LONGEST_S = 1.0, 60.0


def follow(
    link: RobotClient,
    sha256: str,
    *,
    take: Callable[[EventLine], None],
    once: bool,
    wait_s: float,
    lost: Callable[[UnreachableError, float], None],
    rng: random.Random,
    after: int = 0,
) -> MissionSummary:
    """Receive every event of a mission, until no process carries it out.

    Args:
        link: Client of the robot's agent.
        sha256: SHA-256 of the signed mission.
        take: Called once with each event.
        once: Receive the events that are there, without waiting for further ones.
        wait_s: Seconds that the robot may wait for the next event before it responds.
        lost: Called when the connection is lost, with the error and the seconds that it has to wait.
        rng: Random generator of the waiting times.
        after: Number of the last event that was received before.

    Returns:
        State of the mission.

    Raises:
        UnreachableError: The robot cannot be reached, and ``once`` is set.
        DeliveryError: The robot refuses the request, or an event is missing.
    """
    failed = 0
    while True:
        try:
            found = link.events(sha256, after, 0.0 if once else wait_s)
        except UnreachableError as error:
            if once:
                raise
            lost(error, min(LONGEST_S, FIRST_S * 2.0 ** min(failed, 20)) * (0.5 + 0.5 * rng.random()))
            failed += 1
            continue
        failed = 0
        for event in found.events:
            take(event)
            after = event.n
        if found.idle or (once and not found.events):
            return found.mission
