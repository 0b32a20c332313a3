"""Work along a path: its stretches on a site, and what each costs and applies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from shapely import unary_union

from fieldhand.errors import PlaceError
from fieldhand.forecast import visit_order
from fieldhand.forecast.mission_state import Visit, Work
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.slow_ground import NO_SLOW_GROUND, SlowGround, slow_ground
from fieldhand.language import message
from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution
from fieldhand.robot.implement import Implement, rate_unit
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.site.working.areas import AreaWork, area_work, headland_units, perimeter_units
from fieldhand.site.working.heading import LANE_BEARINGS, headed
from fieldhand.site.working.order import in_order
from fieldhand.site.working.stretch import Stretch, total_m, within
from fieldhand.site.working.units import AisleWork, RowWork, WorkUnit, aisle_units, row_units
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.nodes.work_along import WorkAlong

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

XY = tuple[float, float]

#: Maximum number of cached orders of stretches per site.
_KEPT = 64


@dataclass(frozen=True, kw_only=True)
class AppliedAmount:
    """An amount that an implement applies.

    Attributes:
        value: The amount in ``unit``.
        rate: Rate in ``rate_unit``.
    """

    value: float
    unit: str
    rate: float
    rate_unit: str


@dataclass(frozen=True, kw_only=True)
class StretchUse:
    """Resources used by a stretch, and what is done on it.

    Attributes:
        metres: Length of the path.
        seconds: Time from its begin to its end.
        implement_j: Energy of the implement in joules, in addition to driving and idling.
        on_m: Metres with the implement on.
        area_m2: Square metres worked; 0 if the implement covers no ground.
    """

    metres: float
    seconds: float
    implement_j: float
    on_m: float
    area_m2: float

    def work(self, speed_m_s: float) -> Work:
        """Return the use as work whose metres are driven at a given speed; only the remaining time counts as work."""
        return Work(metres=self.metres, seconds=self.seconds - self.metres / speed_m_s, joules=self.implement_j)


def implement_of(node: WorkAlong, robot: RobotProfile) -> Implement | None:
    """Return the implement of a node; None if it only drives.

    Raises:
        KeyError: The robot lacks the action, which does not happen with a checked Task.
    """
    return robot.action[node.action].implement if node.action else None


def working_speed(node: WorkAlong, constraints: Constraints, robot: RobotProfile) -> float:
    """Return the speed in m/s on a stretch: that of the implement, or the mission's if slower."""
    speed, implement = speed_of(constraints, robot), implement_of(node, robot)
    return speed if implement is None else min(speed, implement.speed_m_s)


def use_of(
    stretch: Stretch,
    node: WorkAlong,
    constraints: Constraints,
    robot: RobotProfile,
    slow: SlowGround = NO_SLOW_GROUND,
) -> StretchUse:
    """Return the resources used by a stretch. Its costs are not random: the robot follows a given path.

    Where slow ground changes the speed, the implement is switched off and on again.
    """
    implement, speed = implement_of(node, robot), working_speed(node, constraints, robot)
    on_m = stretch.on_m if implement is not None else 0.0
    parts = slow.pieces(stretch.points, stretch.length_m, speed)
    seconds = on_s = delay = 0.0
    for part in parts:
        on_part_m = total_m(within(stretch.on, part.from_m, part.to_m)) if on_m else 0.0
        seconds += (part.to_m - part.from_m) / part.speed_m_s
        on_s += on_part_m / part.speed_m_s
        delay += implement.on_delay_s if implement is not None and on_part_m else 0.0
    return StretchUse(
        metres=stretch.length_m,
        seconds=seconds + delay,
        implement_j=0.0 if implement is None else implement.power_w * (on_s + delay),
        on_m=on_m,
        area_m2=on_m * (0.0 if implement is None else implement.width_m or 0.0),
    )


def amount_of(node: WorkAlong, robot: RobotProfile, on_m: float) -> AppliedAmount | None:
    """Return the amount applied on some metres; None if the action applies nothing."""
    implement = implement_of(node, robot)
    if implement is None or not implement.rate:
        return None
    parameter = next(p for p in robot.action[node.action].parameters if p.name == implement.rate)
    rate = dict(node.parameters).get(implement.rate, parameter.default)
    unit = rate_unit(parameter.unit)
    assert unit is not None  # noqa: S101  the profile was checked
    value = unit.amount_for(float(rate), metres=on_m, width_m=implement.width_m or 0.0)
    return AppliedAmount(value=value, unit=unit.amount, rate=float(rate), rate_unit=parameter.unit)


def begin_of(stretch: Stretch, site: Site) -> Place:
    """Return the place where a stretch begins, which has its name."""
    return _point(stretch.begin, stretch.name, site)


def end_of(stretch: Stretch, site: Site) -> Place:
    """Return the place where a stretch ends."""
    return _point(stretch.end, message("end of {stretch}", context="log", stretch=stretch.name), site)


def visit_of(stretch: Stretch, node: WorkAlong, task: Task, site: Site, robot: RobotProfile) -> Visit:
    """Return a stretch in the form that guard and solver expect."""
    use = use_of(stretch, node, task.constraints, robot, slow_ground(task.constraints, site, robot))
    work = use.work(speed_of(task.constraints, robot))
    return Visit(
        place=begin_of(stretch, site),
        service_s=work.seconds,
        service_j=work.joules,
        inside_m=work.metres,
        leaves=end_of(stretch, site),
    )


def stretches_of(
    node: WorkAlong, task: Task, site: Site, robot: RobotProfile, drives: Drives, context: Context
) -> tuple[Stretch, ...]:
    """Return the stretches of a node in driving order.

    Args:
        node: The node.
        task, site, robot, drives: Task, site, robot and drives of the mission.
        context: The robot's current place and visited trees.

    Raises:
        PlaceError: Nothing can be worked along; ``where`` names the node.
        DriveFault: A place cannot be reached.
    """
    home = visit_order.home_if_last(task, site, node.id, context.here)
    here = context.here.stand or context.here.xy
    end = None if home is None else visit_order.with_stands(drives, context.here, (home,))[0].stand
    by_rows = node.mode in ("rows", "aisles", "headlands")
    places = visit_order.places_of(node, node.along, site, context) if by_rows else ()
    ids = tuple(place.id for place in places)
    kept = drives.site.cache.setdefault("stretches", {})
    assert isinstance(kept, dict)  # noqa: S101  nobody else keeps anything there
    key = (node, ids, robot.sha256, here, end, id(drives), None if by_rows else site.earlier)
    if key not in kept:
        while len(kept) >= _KEPT:
            del kept[next(iter(kept))]
        try:
            if rounds_side_by_side(node, robot):
                done = _rounds(node, site, robot, drives, context, here, end)
            else:
                if node.mode == "area":
                    units = _area(node, site, robot, drives, context, end).units
                else:
                    units = _units(node, places, site, robot, drives, context)
                once = in_order(drives, units, here, end, given=node.order == "given" or node.mode == "area")
                done = _laps(once, node.laps)
        except PlaceError as error:
            raise visit_order.at_node(error, node) from error
        kept[key] = (drives, done)
    found: tuple[Stretch, ...] = kept[key][1]
    return found


def _area(
    node: WorkAlong, site: Site, robot: RobotProfile, drives: Drives, context: Context, home: XY | None
) -> AreaWork:
    """Return the work of a node over its area.

    Raises:
        PlaceError: The action covers no ground, or there is none to work on.
    """
    implement = implement_of(node, robot)
    width_m = robot.width_m if implement is None else implement.width_m
    if width_m is None:
        raise PlaceError(
            message("{action} covers no ground, so no lanes can be laid out", action=node.action),
            advice=message("give its working width in the profile, or work along rows or the edge"),
        )
    here = context.here.stand or context.here.xy
    ground, bearing = node.along.ground(Resolution(site, context)), LANE_BEARINGS.get(node.heading)
    return area_work(drives, ground, width_m, here, home, bearing_deg=bearing)


def rounds_side_by_side(node: WorkAlong, robot: RobotProfile) -> bool:
    """Return True for several rounds along an edge with an implement that covers ground: each is beside the last."""
    if node.mode != "perimeter" or node.laps < 2 or node.action not in robot.action:
        return False
    implement = implement_of(node, robot)
    return implement is not None and implement.covers


def _rounds(
    node: WorkAlong, site: Site, robot: RobotProfile, drives: Drives, context: Context, here: XY, end: XY | None
) -> tuple[Stretch, ...]:
    """Return the stretches of rounds along an edge, each farther from it than the one before by the working width.

    Raises:
        PlaceError: There is no room for so many.
    """
    implement = implement_of(node, robot)
    width = 0.0 if implement is None or implement.width_m is None else implement.width_m
    found: list[Stretch] = []
    for lap in range(node.laps):
        units = _perimeter(node, site, robot, drives, context, from_edge_m=lap * width)
        last = end if lap == node.laps - 1 else None
        done = in_order(drives, units, found[-1].end if found else here, last, given=node.order == "given")
        found += done if lap == 0 else _named_by_lap(done, lap + 1)
    return tuple(found)


def _perimeter(
    node: WorkAlong, site: Site, robot: RobotProfile, drives: Drives, context: Context, *, from_edge_m: float = 0.0
) -> tuple[WorkUnit, ...]:
    """Return the work of a node along the edge of its area: outside around keep-outs and trees, else inside.

    Args:
        node, site, robot, drives, context: As of :func:`stretches_of`.
        from_edge_m: Width of the ground along the edge that is done already.
    """
    implement = implement_of(node, robot)
    width = None if implement is None else implement.width_m
    ground = node.along.ground(Resolution(site, context))
    inner = [zone.polygon for zone in site.zones if zone.kind != "keep_out"]
    outside = not any(ground.equals(polygon) for polygon in inner) and not ground.equals(
        unary_union([zone.polygon for zone in site.zones_of("boundary")])
    )
    units = perimeter_units(
        drives,
        ground,
        0.0 if width is None else width / 2.0,
        from_edge_m=from_edge_m,
        outside=outside,
        mounted="both" if implement is None else implement.side,
        side=None if node.sides == "one" or node.sides == "both" else node.sides,
        clockwise={"clockwise": True, "counterclockwise": False}.get(node.heading),
    )
    return _headed(units, node, site)


def _headed(units: tuple[WorkUnit, ...], node: WorkAlong, site: Site) -> tuple[WorkUnit, ...]:
    """Return units driven towards the side of the compass that a node names, if it names one.

    Raises:
        PlaceError: A unit runs across that direction, or can be driven only the other way.
    """
    side = node.heading
    return headed(units, side, site.name) if side in ("north", "east", "south", "west") else units


def _units(
    node: WorkAlong, places: Sequence[Place], site: Site, robot: RobotProfile, drives: Drives, context: Context
) -> tuple[WorkUnit, ...]:
    implement = implement_of(node, robot)
    if node.mode == "perimeter":
        return _perimeter(node, site, robot, drives, context)
    trees = [site.by_id[place.id].index for place in places if place.kind == "tree"]
    if node.mode == "headlands":
        return headland_units(drives, trees)
    if node.mode == "rows":
        mounted = "both" if implement is None else implement.side
        units = row_units(drives, trees, RowWork(sides=node.sides, mounted=mounted, gaps_on=node.gaps == "on"))
    else:
        width = implement.width_m if implement is not None and implement.covers else None
        units = aisle_units(drives, trees, AisleWork(width_m=width, every=node.every))
    return _headed(units, node, site)


def _laps(stretches: tuple[Stretch, ...], laps: int) -> tuple[Stretch, ...]:
    """Return the stretches as often as wanted; each further lap has names of its own."""
    found = list(stretches)
    for lap in range(2, laps + 1):
        found += _named_by_lap(stretches, lap)
    return tuple(found)


def _named_by_lap(stretches: Sequence[Stretch], lap: int) -> list[Stretch]:
    return [
        replace(s, name=message("{stretch}, lap {number}", context="log", stretch=s.name, number=lap))
        for s in stretches
    ]


def _point(xy: tuple[float, float], name: str, site: Site) -> Place:
    ((lat, lon),) = site.projection.lat_lon([xy])
    return Place.of_robot(xy, lat=lat, lon=lon, name=name)


class PlannedStretches:
    """The stretches of a node on a walk.

    Args:
        stretches: Stretches in driving order.
        visits: The same as visits.

    Attributes:
        current: The current stretch.
    """

    def __init__(self, stretches: Sequence[Stretch], visits: Sequence[Visit]) -> None:
        self._stretches, self._visits, self._begun = tuple(stretches), tuple(visits), 0
        self.current: Stretch | None = None

    def next(self) -> Place | None:
        """Begin the next stretch and return where it begins; None after the last."""
        if self._begun == len(self._stretches):
            self.current = None
            return None
        self.current = self._stretches[self._begun]
        self._begun += 1
        return self._visits[self._begun - 1].place

    @property
    def to_come(self) -> tuple[Visit, ...]:
        """Return the stretches that have not begun, as visits."""
        return self._visits[self._begun :]
