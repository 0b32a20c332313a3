"""Text about the battery: charging as a step, as a limit of the mission and in a log, and conditions on the charge."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.forecast.recharge_rules import charge_target
from fieldhand.language import counted, joined, kept_in_log, message
from fieldhand.language.words import say_duration, say_number, say_place, say_rounded, say_times
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Constraints
from fieldhand.task.plan import Recharge

if TYPE_CHECKING:
    from fieldhand.task.results import ChargeBegun, ChargeEnded


def say_recharge(node: Recharge, robot: RobotProfile) -> str:
    """Return a charge that is a step of the plan: "Drive to the charger, dock and charge to 80 %."."""
    until = 100.0 if robot.energy.charging is None else robot.energy.charging.until_percent
    percent = say_number(until if node.until_percent is None else node.until_percent)
    if node.duration_s is None:
        return message("Drive to the charger, dock and charge to {percent} %.", percent=percent)
    time = say_duration(node.duration_s)
    if node.until_percent is None:
        return message("Drive to the charger, dock and charge for {time}.", time=time)
    return message(
        "Drive to the charger, dock and charge for {time}, at most to {percent} %.", time=time, percent=percent
    )


def say_battery(percent: float, *, negated: bool) -> str:
    """Return a condition on the charge as a clause: "the battery is at 40 % or less"."""
    if negated:
        return message("the battery is above {percent} %", percent=say_number(percent))
    return message("the battery is at {percent} % or less", percent=say_number(percent))


def say_energy_limits(constraints: Constraints, robot: RobotProfile) -> tuple[str, ...]:
    """Return how a mission recharges, and at what charge it drives home, one sentence each."""
    found = []
    if constraints.recharge:
        found.append(_recharging(constraints, robot))
    if constraints.return_percent is not None:
        found.append(
            message(
                "when the charge falls to {percent} %, it drives home from wherever it is, and gives up the rest.",
                percent=say_number(constraints.return_percent),
            )
        )
    return tuple(found)


def _recharging(constraints: Constraints, robot: RobotProfile) -> str:
    until = say_number(charge_target(constraints, robot))
    if constraints.recharge_below_percent is None:
        when = message("before the charge no longer suffices for the next visit and the way to the charger")
    else:
        when = message(
            "when the charge is below {percent} %, or no longer suffices for the next visit and the way to the charger",
            percent=say_number(constraints.recharge_below_percent),
        )
    if constraints.recharge_until_percent is None:
        far = message("up to {percent} %, or as far as the rest needs", percent=until)
    else:
        far = message("up to {percent} %", percent=until)
    if constraints.recharge_at_most is None:
        return message("it charges at the charger as often as needed, {when}, {far}, and goes on.", when=when, far=far)
    times = say_times(constraints.recharge_at_most)
    return message(
        "it charges at the charger at most {times}, {when}, {far}, and goes on.", times=times, when=when, far=far
    )


def say_far_charging(constraints: Constraints, robot: RobotProfile, charged_to: float) -> tuple[str, ...]:
    """Return a sentence if a forecast charges further than usual because places are far from the charger."""
    usual = charge_target(constraints, robot)
    if round(charged_to) <= usual:
        return ()
    return (
        message(
            "before places far from the charger it charges up to {percent} %, further than the usual {usual} %.",
            percent=say_rounded(charged_to),
            usual=say_number(usual),
        ),
    )


def say_charges(mean: float, p90: float) -> str:
    """Return the forecast number of charges: "2 charges", "2 charges (up to 3)", or "perhaps 1 charge"."""
    usual, most = round(mean), round(p90)
    if usual == 0:
        return message("perhaps a charge") if most or mean > 0.0 else message("no charge")
    charges = counted("{count} charge", "{count} charges", usual)
    return message("{charges} (up to {most})", charges=charges, most=most) if most > usual else charges


def say_charge_begun(event: ChargeBegun) -> str:
    """Return the begin of a charge as a line of a log."""
    line = message(
        "charges at {place}, battery at {charge} %, up to {until} %, about {time}",
        place=say_place(event.kind, event.place),
        charge=f"{event.charge_percent:.0f}",
        until=say_number(event.until_percent),
        time=say_duration(event.seconds),
    )
    return joined("", (line, " (", kept_in_log(event.why), ")")) if event.why else line


def say_charge_ended(event: ChargeEnded) -> str:
    """Return the end of a charge as a line of a log."""
    return message(
        "charged to {charge} % in {time}", charge=f"{event.charge_percent:.0f}", time=say_duration(event.seconds)
    )
