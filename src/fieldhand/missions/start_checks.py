"""Whether a real robot may set out: it stands on the site, knows where it is, may move, and has the charge.

The simulation begins at the start with the charge that its world says; a robot is where somebody left it.
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

#: Metres from the nearest tree or marker beyond which a robot is elsewhere, where no boundary says what belongs to the
#: site.
FAR_M = 100.0


def require_in_place(site: Site, robot: RobotProfile, driver: Driver) -> float:
    """See whether the robot may set out from where it stands.

    Returns:
        Metres from where it stands to the start, in a straight line.

    Raises:
        ExecutionError: It is stopped, does not know where it is, or stands where no drive can begin.
    """
    from fieldhand.forecast.visit_order import drives_for, start_place

    driver.poll()
    stopped, lost = driver.stopped(), driver.lost()
    if stopped is not None:
        raise ExecutionError(
            message("the robot will not move: {why}", why=kept_in_log(stopped)),
            advice=message("mend that, then try again"),
        )
    if lost is not None:
        raise ExecutionError(
            message("the robot does not know where it is: {why}", why=kept_in_log(lost)),
            advice=message("mend that, then try again"),
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
                "the robot stands {metres} m from the start, at {lat}, {lon}, and that is {why}",
                metres=Number(f"{away_m:,.0f}"),
                lat=Number(f"{at.lat:.6f}"),
                lon=Number(f"{at.lon:.6f}"),
                why=why,
            ),
            where=site.name,
            advice=message("drive it into an aisle, onto a headland or to the start; or give the site where it is"),
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
    """See whether a mission can be made with the charge that the robot has: it was approved for a full battery.

    Args:
        promised: The review of the approval.
        site, robot: Of the mission.
        charge_percent: Of the battery now.
        confirm: What becomes doubtful by it is accepted.

    Raises:
        NotApprovedError: It does not last.
        NotConfirmedError: It may well not last.
    """
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
            advice=message("charge it first, or give --confirm if it shall set out nevertheless"),
        )


def _elsewhere(site: Site, xy: XY) -> str:
    """In words that follow "that is", why a point is no part of the site; empty if it is."""
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
