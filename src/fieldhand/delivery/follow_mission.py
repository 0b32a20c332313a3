"""A mission followed from elsewhere: its events in order and without a gap, however often the link is lost."""

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
    """Take every event of a mission, until nobody carries it out.

    Args:
        link: To the robot.
        sha256: Of the bundle.
        take: Takes each event, once.
        once: Take what is there, and wait for nothing.
        wait_s: How long the robot may wait for the next event before it answers.
        lost: Told that the link is lost, and waits so many seconds.
        rng: Draws how long that is.
        after: Number of the last event that is known already.

    Returns:
        How the mission stands.

    Raises:
        UnreachableError: There is no link, and ``once``.
        DeliveryError: The robot refuses, or an event is missing.
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
