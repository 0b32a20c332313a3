"""Checks before a mission starts on a real robot: position on the site, localization, stop signal and charge.

The simulation starts at the site's start with the charge of its world file; a real robot may be anywhere.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fieldhand import mission
from fieldhand.errors import ExecutionError, NotApprovedError, NotConfirmedError
from fieldhand.language import Number, joined, kept_in_log, message

if TYPE_CHECKING:
    from fieldhand.execution.drivers.protocol import Driver
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.drives import XY
    from fieldhand.site.model import Site

#: Distance from the nearest tree or marker, in metres, beyond which a robot is not on a site without a boundary.
FAR_M = 100.0
#: Charge for which missions are reviewed, in percent.
FULL_PERCENT = 100.0


def require_in_place(site: Site, robot: RobotProfile, driver: Driver) -> float:
    """Require that the robot can start driving from its position.

    Returns:
        Distance from the robot to the site's start, in metres, in a straight line.

    Raises:
        ExecutionError: The robot is stopped, has no position, or is where no drive can begin.
    """
    from fieldhand.forecast.visit_order import drives_for, start_place

    driver.poll()
    stopped, lost = driver.stopped(), driver.lost()
    if stopped is not None:
        raise ExecutionError(
            message("the robot will not move: {why}", why=kept_in_log(stopped)),
            advice=message("correct that, then try again"),
        )
    if lost is not None:
        raise ExecutionError(
            message("the robot does not know where it is: {why}", why=kept_in_log(lost)),
            advice=message("correct that, then try again"),
        )
    at, drives = driver.position(), drives_for(site, robot)
    start = start_place(drives)
    away_m = math.dist(at.xy, start.stand or start.xy)
    if at.is_at(start):
        return away_m
    why = _elsewhere(site, at.xy) or drives.problem(at.as_place("where the robot stands"))
    if why:
        raise ExecutionError(
            message(
                "the robot is {metres} m from the start, at {lat}, {lon}, which is {why}",
                metres=Number(f"{away_m:,.0f}"),
                lat=Number(f"{at.lat:.6f}"),
                lon=Number(f"{at.lon:.6f}"),
                why=why,
            ),
            where=site.name,
            advice=message("drive it into an aisle, onto a headland or to the start; or give the site that it is on"),
        )
    return away_m


def require_charged(
    promised: mission.Review,
    site: Site,
    robot: RobotProfile,
    charge_percent: float,
    *,
    confirm: bool = False,
) -> None:
    """Require that the charge of the robot is enough for a mission, which was approved for a full battery.

    The mission is examined again only if the battery is not full.

    Args:
        promised: Review that was approved.
        site: Site of the mission.
        robot: Robot of the mission.
        charge_percent: Charge of the battery now, in percent.
        confirm: Accept the warnings that the lower charge adds.

    Raises:
        NotApprovedError: The charge is not enough.
        NotConfirmedError: The charge may not be enough.
    """
    if charge_percent >= FULL_PERCENT:
        return
    known = {problem.line() for problem in promised.problems}
    seen = mission.review(promised.task, site, robot, charge_percent=charge_percent)
    new = [problem for problem in seen.problems if problem.line() not in known]
    charge = f"{charge_percent:.0f}"
    lines = tuple(
        message("with the battery at {charge} %, {problem}", charge=charge, problem=problem.line()) for problem in new
    )
    if any(problem.severity == "error" for problem in new):
        raise NotApprovedError(joined("; ", lines), advice=message("charge it first"))
    if lines and not confirm:
        raise NotConfirmedError(
            message("not confirmed: {warnings}", warnings=joined("; ", lines)),
            lines,
            advice=message("charge it first, or give --confirm to start nevertheless"),
        )


def _elsewhere(site: Site, xy: XY) -> str:
    """Return why a point is not on the site, as words after "that is"; empty if it is on the site."""
    import numpy as np
    import shapely

    if boundaries := site.zones_of("boundary"):
        within = any(shapely.intersects_xy(zone.polygon, *xy) for zone in boundaries)
        return "" if within else message("outside the boundary")
    places = np.vstack([site.xy, *(np.array([marker.xy]) for marker in site.markers.values())])
    nearest = float(np.hypot(*(places - np.array(xy)).T).min())
    if nearest <= FAR_M:
        return ""
    return message("{metres} m from the nearest tree of the site", metres=Number(f"{nearest:,.0f}"))
