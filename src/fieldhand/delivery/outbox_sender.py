"""Send the missions of the outbox to their robots, now or when they can be reached again."""

from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from datetime import datetime

from fieldhand.compatibility import UTC
from fieldhand.delivery.bundle_checks import Sendable
from fieldhand.delivery.outbox import Outbox, OutboxEntry
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.errors import FieldhandError, UnreachableError

#: Seconds before the second attempt, and the maximum; doubled with each attempt, times a random factor of 0.5 to 1.
FIRST_S, LONGEST_S = 4.0, 300.0
#: Seconds after which a waiting mission is delivered but not started, as nobody expects its start any more.
START_WITHIN_S = 12 * 3600.0

Connect = Callable[[OutboxEntry], RobotClient]
Check = Callable[[bytes, str], Sendable]


@dataclass(frozen=True, kw_only=True)
class OutboxSender:
    """Sender of the missions in an outbox.

    Attributes:
        outbox: The outbox.
        connect: Returns a client of the robot of an entry.
        check: Checks a signed mission (:func:`fieldhand.delivery.bundle_checks.require_sendable`).
        clock: Returns the time in seconds since 1970.
        rng: Random generator of the waiting times, so that many senders do not try again at once.
    """

    outbox: Outbox
    connect: Connect
    check: Check
    clock: Callable[[], float]
    rng: random.Random

    def post(self, entry: OutboxEntry) -> OutboxEntry:
        """Try to deliver a mission.

        Returns:
            The updated entry; ``waiting`` if a later attempt may succeed.

        Raises:
            StoreError: The outbox cannot be used.
        """
        tries = entry.tries + 1
        try:
            response = self._deliver(entry)
            done = replace(entry, tries=tries, state="delivered", response=response)
        except UnreachableError as error:
            done = replace(entry, tries=tries, response=str(error), next_at=self.clock() + self._pause_s(tries))
        except FieldhandError as error:
            done = replace(entry, tries=tries, state="refused", response=str(error))
        self.outbox.note(done)
        return done

    def post_due(self, *, all_of_them: bool = False) -> tuple[OutboxEntry, ...]:
        """Try to deliver the missions that are due, or all that wait."""
        now = self.clock()
        # After the clock was set back, times beyond the longest wait are due at once.
        due = [e for e in self.outbox.waiting() if all_of_them or e.next_at <= now or e.next_at > now + LONGEST_S]
        return tuple(self.post(entry) for entry in due)

    def next_s(self) -> float | None:
        """Return the seconds until the next attempt; None if no mission waits."""
        waits = [min(LONGEST_S, max(0.0, e.next_at - self.clock())) for e in self.outbox.waiting()]
        return min(waits, default=None)

    def _deliver(self, entry: OutboxEntry) -> str:
        """Deliver a mission, and start it if that was requested recently enough.

        Returns:
            Result in words.
        """
        data = self.outbox.bundle(entry)
        hashes = self.check(data, entry.name).hashes
        with closing(self.connect(entry)) as link:
            receipt = link.deliver(data, hashes)
            if not entry.start:
                return f"has arrived complete; the robot reports {receipt.mission.state}"
            waited = self.clock() - entry.queued_at
            if not 0 <= waited <= START_WITHIN_S:
                at = datetime.fromtimestamp(entry.queued_at, UTC).isoformat(timespec="minutes")
                return f"has arrived complete, but was not started: it was sent at {at}, too long ago; send it again"
            mission = link.order(entry.sha256, "start", "sent with --start").mission
            return f"has arrived complete and was told to start; the robot reports {mission.state}"

    def _pause_s(self, tries: int) -> float:
        most = min(LONGEST_S, FIRST_S * 2.0 ** min(tries - 1, 20))
        return most * (0.5 + 0.5 * self.rng.random())
