"""Recharging during a mission: to the charger, dock, charge, and back to the plan.

The battery is charged until it has reached the wanted charge, as measured. If the charge does not rise as the profile
says, the robot docks again, as often as failed docking is retried; then charging has failed for good.
"""

from __future__ import annotations

from collections.abc import Generator

from fieldhand.errors import ActionFault, DriveFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.docking import leave_charger, maneuver, tries_of
from fieldhand.execution.goals import drive
from fieldhand.execution.waiting import SAME_S, wait
from fieldhand.language import message
from fieldhand.robot.charging import Charging
from fieldhand.task.plan import Recharge
from fieldhand.task.results import ChargeBegun, ChargeEnded, Faulted
from fieldhand.task.run import Steps

#: Charge in percent below the wanted one at which charging counts as done, unless its time is set: meters show steps.
SLACK_PERCENT = 0.5

#: Charging may take this many times as long as the profile says, and so many seconds more, before it has failed.
_PATIENCE, _PATIENCE_S = 2.0, 300.0


def charge_and_return(mission: ActiveMission, why: str, until_percent: float) -> Steps:
    """Interrupt the plan to charge the battery; its current place does not change, but the robot stays at the charger.

    Raises:
        DriveFault, ActionFault: The charger cannot be reached, or charging failed for good.
    """
    charger = mission.charger
    if charger is None:
        raise DriveFault(message("there is no charger to drive to", context="log"))
    plan_place, mission.recharge_due = mission.here, ""
    mission.to_charger = True
    try:
        yield from drive(mission, "", charger)
        mission.here = charger
        yield from charge(mission, "", until_percent, None, why)
    finally:
        mission.to_charger = False
        mission.here = plan_place
    mission.recharged()


def charge_as_planned(mission: ActiveMission, node: Recharge) -> Steps:
    """Charge the battery at the current place, as a step of the plan asks.

    Raises:
        ActionFault: Charging failed for good.
    """
    until = 100.0 if node.duration_s is not None else mission.charge_target
    yield from charge(mission, node.id, until if node.until_percent is None else node.until_percent, node.duration_s)
    mission.planned_charges += 1


def charge(mission: ActiveMission, node: str, until_percent: float, most_s: float | None, why: str = "") -> Steps:
    """Dock at the current place and charge the battery.

    Args:
        mission: The mission; the robot is at its charger.
        node: Id of the node; empty if the plan is interrupted.
        until_percent: Charge at which charging ends.
        most_s: Maximum time of charging in seconds; None for as long as it takes.
        why: Reason in words, where the plan is interrupted.

    Raises:
        ActionFault: The robot cannot dock, or its battery does not charge.
    """
    charging = mission.robot.energy.charging
    if charging is None:
        raise ActionFault(
            message("{robot} cannot recharge: its profile has no charging", context="log", robot=mission.robot.name)
        )
    tries = tries_of(mission, charging.dock)
    for attempt in range(1, tries + 1):
        yield from maneuver(mission, node, charging.dock)
        if (yield from _charged(mission, node, charging, until_percent, most_s, why)):
            return
        what = message("the battery does not charge as the profile says", context="log")
        mission.emit(Faulted(t=mission.t, node=node, fault="not_charging", what=what, handled=attempt < tries))
        yield from leave_charger(mission)
    raise ActionFault(what, advice=message("check the charger and its contacts", context="log"))


def _charged(
    mission: ActiveMission, node: str, charging: Charging, until_percent: float, most_s: float | None, why: str
) -> Generator[None, None, bool]:
    """Charge; return True if the wanted charge or time was reached."""
    capacity_j, begun_s, begun = mission.robot.energy.capacity_j, mission.clock.now(), mission.charge_percent()
    mission.docked_now()
    takes_s = float(charging.seconds(begun, until_percent, capacity_j))
    wanted_s = takes_s if most_s is None else min(most_s, takes_s)
    at, here = mission.observation.position, mission.here
    lat, lon = at.lat, at.lon
    mission.emit(
        ChargeBegun(
            t=mission.t,
            node=node,
            kind=here.kind,
            place=here.id,
            lat=lat,
            lon=lon,
            charge_percent=begun,
            until_percent=until_percent,
            seconds=wanted_s,
            why=why,
        )
    )
    limit_s = _PATIENCE * takes_s + _PATIENCE_S if most_s is None else most_s

    enough_percent = until_percent - (SLACK_PERCENT if most_s is None else 0.0)

    def full() -> bool:
        return mission.charge_percent() >= enough_percent

    while not full() and (left_s := limit_s - (mission.clock.now() - begun_s)) > SAME_S:
        soon_s = float(charging.seconds(mission.charge_percent(), until_percent, capacity_j))
        with mission.looking_every(soon_s / 2.0):
            yield from wait(mission, min(left_s, max(1.0, soon_s)), over=full)
    done, now = full() or most_s is not None, mission.charge_percent()
    mission.emit(
        ChargeEnded(
            t=mission.t,
            node=node,
            kind=here.kind,
            place=here.id,
            lat=lat,
            lon=lon,
            charge_percent=now,
            gained_percent=now - begun,
            seconds=mission.clock.now() - begun_s,
        )
    )
    return done
