"""Docking at the charger and leaving it, with retries."""

from __future__ import annotations

from fieldhand.errors import ActionFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.waiting import wait, wait_for_position
from fieldhand.language import message
from fieldhand.robot.model import Action
from fieldhand.task.results import Faulted
from fieldhand.task.run import Steps


class ChargeFirst(Exception):
    """Raised where the guard wants the battery charged before the work that it was asked about.

    Args:
        why: Reason in words.
        until_percent: Charge at which charging ends.
    """

    def __init__(self, why: str, until_percent: float) -> None:
        self.why, self.until_percent = why, until_percent
        super().__init__(why)


def leave_charger(mission: ActiveMission) -> Steps:
    """Undock, if the robot is docked.

    Raises:
        ActionFault: It cannot leave the charger.
    """
    charging = mission.robot.energy.charging
    if not mission.docked or charging is None:
        return
    mission.charged()
    if charging.undock is not None:
        yield from maneuver(mission, "", charging.undock)
    mission.docked = False


def maneuver(mission: ActiveMission, node: str, action: Action) -> Steps:
    """Dock or undock at the current place, with retries.

    Raises:
        ActionFault: All tries failed.
    """
    tries = tries_of(mission, action)
    for number in range(1, tries + 1):
        yield from wait_for_position(mission, node)
        mission.start_maneuver(node, action.name, number)
        while not (progress := mission.attend()).over:
            yield
        if progress.state in ("succeeded", "cut_off"):
            return
        what = _what(action, progress)
        if progress.state == "cancelled" or progress.fault == "empty" or number == tries:
            raise ActionFault(what)
        mission.emit(Faulted(t=mission.t, node=node, fault="action_failed", what=what, handled=True))
        wait_s = mission.robot.patience.retry_wait_s if action.retry_wait_s is None else action.retry_wait_s
        yield from wait(mission, wait_s)


def _what(action: Action, progress: Progress) -> str:
    why = progress.what or message("no reason given", context="log")
    return message("{action} failed: {what}", context="log", action=action.name, what=why)


def tries_of(mission: ActiveMission, action: Action) -> int:
    """Return how often docking or undocking is tried."""
    return 1 + (mission.robot.retries if action.retries is None else action.retries)
