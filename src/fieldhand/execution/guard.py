"""Protocols of the budget guard and of the failsafe, which evaluation implements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from fieldhand.forecast.state import Choice, MissionState, Verdict, Visit
from fieldhand.forecast.underway import Foresight, Underway

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives


class Guard(Protocol):
    """Decides before every drive whether there is enough left for it and for the way home."""

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        """May the robot make this mandatory visit? ``still_to_come``: later visits of the loop that it stands in."""
        ...

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> Choice:
        """Choose the next optional visit. Asked again after every leg, with what is left.

        ``state.node`` is the optional for-each, or an optional step, which is its only candidate and is asked about
        once. ``at_most``: how many of the candidates may still be visited; None for all.
        """
        ...

    def ways_are(self, drives: Drives) -> None:
        """Use other drives from now on: the robot found a way blocked, or free again."""
        ...


class Failsafe(Protocol):
    """Foresees whether what is left lasts for the way home; asked at every look."""

    def learn(self, now: Underway) -> None:
        """Take note of what has been spent. A mission that is replayed only learns."""
        ...

    def foresee(self, now: Underway) -> Foresight:
        """Return whether the mission may continue as it does, after learning."""
        ...


class NoGuard:
    """A guard for missions without limits: everything is allowed, optional visits in the order given."""

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:  # noqa: ARG002
        return Verdict(go=True)

    def choose(
        self,
        state: MissionState,  # noqa: ARG002
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,  # noqa: ARG002
        still_to_come: Sequence[Visit] = (),  # noqa: ARG002
    ) -> Choice:
        return Choice(index=0 if candidates else None)

    def ways_are(self, drives: Drives) -> None:
        pass


class NoFailsafe:
    """A failsafe for missions without limits: nothing is ever foreseen."""

    def learn(self, now: Underway) -> None:
        pass

    def foresee(self, now: Underway) -> Foresight:  # noqa: ARG002
        return Foresight()
