"""Protocols of the budget guard and the failsafe, which evaluation implements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from fieldhand.forecast.failsafe_state import FailsafeForecast, FailsafeState
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives


class Guard(Protocol):
    """Decides before every drive whether resources suffice for it and for the way home."""

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        """Decide whether the robot may make a mandatory visit.

        Args:
            state: State of the mission.
            visit: The visit in question.
            still_to_come: Later visits of the current loop.
        """
        ...

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        """Choose the next optional visit; called again after every leg.

        Args:
            state: State of the mission. Its current node is an optional for-each, or an optional step, which is its
                only
                candidate and is offered once.
            candidates: Visits to choose from.
            at_most: Number of candidates that may still be visited; None for all.
            still_to_come: Mandatory visits that follow.
        """
        ...

    def update_drives(self, drives: Drives) -> None:
        """Use other drives from now on: a way was found blocked, or free again."""
        ...


class Failsafe(Protocol):
    """Predicts whether resources suffice for the way home; called at every poll."""

    def learn(self, now: FailsafeState) -> None:
        """Learn from the resources spent. Called instead of :meth:`foresee` during a replay."""
        ...

    def foresee(self, now: FailsafeState) -> FailsafeForecast:
        """Learn, and return whether the mission may continue."""
        ...


class NoGuard:
    """Guard for missions without limits: permits everything, optional visits in the given order."""

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:  # noqa: ARG002
        return Verdict(go=True)

    def choose(
        self,
        state: MissionState,  # noqa: ARG002
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,  # noqa: ARG002
        still_to_come: Sequence[Visit] = (),  # noqa: ARG002
    ) -> VisitChoice:
        return VisitChoice(index=0 if candidates else None)

    def update_drives(self, drives: Drives) -> None:
        pass


class NoFailsafe:
    """Failsafe for missions without limits: never raises an alarm."""

    def learn(self, now: FailsafeState) -> None:
        pass

    def foresee(self, now: FailsafeState) -> FailsafeForecast:  # noqa: ARG002
        return FailsafeForecast()
