"""What is in the outbox, handed to its robots: at once, or when they are back."""

from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from datetime import UTC, datetime

from fieldhand.delivery.bundle_checks import Sendable
from fieldhand.delivery.outbox import Outbox, OutboxEntry
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.errors import FieldhandError, UnreachableError

#: Seconds until the second try, doubled with each further one up to the longest; each is drawn between half and all.
FIRST_S, LONGEST_S = 4.0, 300.0
#: Seconds after which a mission that waited is delivered, but not started any more: nobody expects it.
START_WITHIN_S = 12 * 3600.0

Connect = Callable[[OutboxEntry], RobotClient]
Check = Callable[[bytes, str], Sendable]


@dataclass(frozen=True, kw_only=True)
class OutboxSender:
    """Hands missions over.

    Attributes:
        outbox: Where they wait.
        connect: Opens the link to a robot.
        check: Sees whether a bundle is whole; see :func:`fieldhand.delivery.bundle_checks.require_sendable`.
        clock: Seconds since 1970.
        rng: Draws how long to wait, so that many senders do not come back at once.
    """

    outbox: Outbox
    connect: Connect
    check: Check
    clock: Callable[[], float]
    rng: random.Random

    def post(self, entry: OutboxEntry) -> OutboxEntry:
        """Try to deliver one.

        Returns:
            What became of it, as it is kept: ``waiting`` if it may succeed later.

        Raises:
            StoreError: The outbox cannot be used.
        """
        tries = entry.tries + 1
        try:
            said = self._deliver(entry)
            done = replace(entry, tries=tries, state="delivered", said=said)
        except UnreachableError as error:
            done = replace(entry, tries=tries, said=str(error), next_at=self.clock() + self._pause_s(tries))
        except FieldhandError as error:
            done = replace(entry, tries=tries, state="refused", said=str(error))
        self.outbox.note(done)
        return done

    def post_due(self, *, all_of_them: bool = False) -> tuple[OutboxEntry, ...]:
        """Try to deliver those whose time has come, or all that wait."""
        now = self.clock()
        # A clock that was set back would let them wait for as long as it was set back.
        due = [e for e in self.outbox.waiting() if all_of_them or e.next_at <= now or e.next_at > now + LONGEST_S]
        return tuple(self.post(entry) for entry in due)

    def next_s(self) -> float | None:
        """Seconds until the next try; None if nothing waits."""
        waits = [min(LONGEST_S, max(0.0, e.next_at - self.clock())) for e in self.outbox.waiting()]
        return min(waits, default=None)

    def _deliver(self, entry: OutboxEntry) -> str:
        """Hand one over, and start it if that was asked for and is still expected.

        Returns:
            What to say of it.
        """
        data = self.outbox.bundle(entry)
        hashes = self.check(data, entry.name).hashes
        with closing(self.connect(entry)) as link:
            receipt = link.deliver(data, hashes)
            if not entry.start:
                return f"has arrived whole; the robot says {receipt.mission.state}"
            waited = self.clock() - entry.queued_at
            if not 0 <= waited <= START_WITHIN_S:
                at = datetime.fromtimestamp(entry.queued_at, UTC).isoformat(timespec="minutes")
                return f"has arrived whole, and was not started: it was sent at {at}, too long ago; send it again"
            mission = link.order(entry.sha256, "start", "sent with --start").mission
            return f"has arrived whole, and was told to start; the robot says {mission.state}"

    def _pause_s(self, tries: int) -> float:
        most = min(LONGEST_S, FIRST_S * 2.0 ** min(tries - 1, 20))
        return most * (0.5 + 0.5 * self.rng.random())
