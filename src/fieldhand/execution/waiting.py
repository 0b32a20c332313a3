"""Waiting: for a time, as a step of the plan, and for a lost position."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.errors import LostFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.language import joined, message
from fieldhand.task.results import Dwelling, Dwelt, Faulted, Waited
from fieldhand.task.run import Steps

#: Seconds within which two times are equal: clocks add floating-point numbers.
SAME_S = 1e-6


def wait(mission: ActiveMission, seconds: float, over: Callable[[], bool] = lambda: False) -> Steps:
    """Stand still for some seconds of the mission, or until ``over`` returns True."""
    until_s = mission.clock.now() + seconds
    mission.wait_until(until_s)
    try:
        while mission.clock.now() < until_s - SAME_S and not over():
            yield
    finally:
        mission.wait_until(None)


def dwell(mission: ActiveMission, node: str, seconds: float, charge: Callable[[], Steps]) -> Steps:
    """Stand still for some seconds of the mission because the plan says so. The time of a pause counts.

    Args:
        mission: The mission.
        node: Id of the node.
        seconds: Seconds to wait.
        charge: Charges the battery and returns, if that interrupts the wait; its time does not count.
    """
    while mission.halted:
        yield
    mission.emit(Dwelling(t=mission.t, node=node, seconds=seconds))
    waited_s = 0.0
    while True:
        begun_s = mission.clock.now()
        mission.dwells_until_s = begun_s + seconds - waited_s
        try:
            yield from wait(mission, seconds - waited_s, over=lambda: bool(mission.recharge_due))
        finally:
            mission.dwells_until_s = None
        waited_s += mission.clock.now() - begun_s
        if waited_s >= seconds - SAME_S:
            break
        yield from charge()
    mission.emit(Dwelt(t=mission.t, node=node, seconds=waited_s))


def wait_for_position(mission: ActiveMission, node: str) -> Steps:
    """Wait for a lost position as long as the profile allows; indefinitely while the mission is halted.

    Raises:
        LostFault: The position is still unknown.
    """
    while mission.halted:
        yield
    why = mission.observation.lost
    if why is None:
        return
    begun_s, patience = mission.clock.now(), mission.robot.patience.lost_wait_s
    what = message("the robot does not know where it is ({why})", context="log", why=why)
    still = message("it stands still for at most {seconds} s", context="log", seconds=f"{patience:g}")
    standing = joined("; ", (what, still))
    mission.emit(Faulted(t=mission.t, node=node, fault="lost", what=standing, handled=True))
    yield from wait(mission, patience, over=lambda: mission.observation.lost is None)
    known, waited_s = mission.observation.lost is None, mission.clock.now() - begun_s
    mission.emit(Waited(t=mission.t, node=node, wanted="position", seconds=waited_s, over=known, what=why))
    if not known:
        lasting = message("{known}, {seconds} s on still", context="log", known=what, seconds=f"{patience:g}")
        raise LostFault(lasting, advice=message("bring it back by hand", context="log"))
