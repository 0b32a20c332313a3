"""World of a simulation, bound to a site and a robot.

Values in the world file are exact. Others are drawn from the profile's ``typical`` and ``spread``: one value per tree
and quantity, which depends only on the seed, the tree and the quantity, not on the order of visits, plus a little noise
for each capture.
"""

from __future__ import annotations

import difflib
import hashlib
import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from shapely.geometry import LineString
from shapely.geometry import Point as ShapelyPoint

from fieldhand.errors import WorldError
from fieldhand.execution.drivers.protocol import StretchWork
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    DriveFails,
    LocalisationLost,
    RobotStops,
    RobotStrays,
    SensorAbsurd,
    SensorSilent,
    TreeRef,
    Truth,
    World,
)
from fieldhand.execution.drivers.simulation.world_events import EventScript
from fieldhand.language import message
from fieldhand.robot.model import Quantity, RobotProfile
from fieldhand.site.model import Place, Site

#: Standard deviation of a capture's noise, as a fraction of the spread between trees.
NOISE = 0.02

#: Metres within which a robot stands at the edge of an obstacle.
RIM = 1e-6

#: Metres from a path within which a tree is beside it.
_BESIDE_M = 4.0

Point = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Hindrance:
    """Hindrance of a drive: distance along its path in metres, number of the world's fault, and description.

    Attributes:
        for_s: Duration of a lost position in seconds.
        recovers: The robot's navigation recovers for ever before it.
    """

    at_m: float
    number: int
    what: str
    for_s: float = 0.0
    recovers: bool = False


class GroundTruth:
    """World of one simulated mission: readings, failures and obstacles; counts faults that occur a limited number of
    times.

    Args:
        world: Content of the world file.
        site, robot: Site and robot of the mission.
        seed: Seed of the values that the file leaves open.

    Raises:
        WorldError: The file names a quantity or an action that the robot lacks, or a tree that the site lacks.
    """

    def __init__(self, world: World, site: Site, robot: RobotProfile, seed: int) -> None:
        self._robot = robot
        self.seed = seed
        self._captures: Counter[tuple[str, str]] = Counter()
        self._used: Counter[int] = Counter()
        self._source = world.source
        self._known(world.readings, robot.quantity, "readings", "quantity")
        self._values = {name: self._bound(truth, site, name) for name, truth in world.readings.items()}
        self._defaults = {name: t.default for name, t in world.readings.items() if t.default is not None}
        self._faults = world.faults
        self._trees: dict[int, Place] = {}
        self._between: dict[int, tuple[Place, Place]] = {}
        self._middles: dict[int, Point] = {}
        for number in range(len(world.faults)):
            self._bind_fault(number, site)
        self.events = self._script(world, site)
        self._drains = sorted((f.from_s, f.factor) for f in world.faults if isinstance(f, BatteryDrains))
        self.stop = min((f for f in world.faults if isinstance(f, RobotStops)), key=lambda f: f.at_s, default=None)

    def capture(self, action: str, place: Place, *, counted: bool = True) -> tuple[dict[str, float], str]:
        """Make one attempt at an action; return its readings, and why it failed (empty if it did not).

        Args:
            counted: False to leave faults that occur a limited number of times untouched.
        """
        for number, fault in enumerate(self._faults):
            if isinstance(fault, ActionFails) and fault.action == action and self._strikes(number, place, counted):
                return {}, message("{action} gave an error", context="log", action=action)
        readings: dict[str, float] = {}
        for name in self._robot.doable[action].measures:
            value = self._sensed(self._robot.quantity[name], place, counted)
            if value is not None:
                readings[name] = value
        return readings, ""

    def implement_fails(self, work: StretchWork, path: tuple[Point, ...]) -> tuple[float, str] | None:
        """Return the part of a path, 0 to 1, after which an implement fails, and why, and count it, or None.

        A failure at a tree occurs where the path passes it; any other in the middle of the path.
        """
        line = LineString(path)
        for number, fault in enumerate(self._faults):
            if not isinstance(fault, ActionFails) or fault.action != work.action or self._exhausted(number):
                continue
            tree, part = self._trees.get(number), 0.5
            if tree is not None:
                at = ShapelyPoint(tree.xy)
                if line.distance(at) > _BESIDE_M:
                    continue
                part = float(line.project(at, normalized=True))
            self._used[number] += 1
            return part, message("{action} gave an error", context="log", action=work.action)
        return None

    def switch_fails(self, action: str, place: Place) -> str:
        """Return why an implement does not switch on at a place, and count it; empty if it does."""
        for number, fault in enumerate(self._faults):
            if isinstance(fault, ActionFails) and fault.action == action and self._strikes(number, place):
                return message("{action} gave an error", context="log", action=action)
        return ""

    def drive_fails(self, place: Place) -> str:
        """Return why a drive to a place fails half-way, and count it; empty if it does not."""
        fails = (n for n, fault in enumerate(self._faults) if isinstance(fault, DriveFails) and self._strikes(n, place))
        return message("the drive gave an error", context="log") if next(fails, None) is not None else ""

    def strays_by_m(self, place: Place) -> float:
        """Return the metres by which a drive to a place leaves its way, and count it; 0 if it does not."""
        strays = (f.by_m for n, f in enumerate(self._faults) if isinstance(f, RobotStrays) and self._strikes(n, place))
        return next(strays, 0.0)

    def obstacle(self, path: tuple[Point, ...], when: Callable[[float], float]) -> Hindrance | None:
        """Return the first obstacle of a drive, or None.

        Args:
            path: Corners in local metres.
            when: Returns the mission time in seconds at a distance along the path.
        """
        found: list[tuple[float, int, str]] = []
        for number, fault in enumerate(self._faults):
            if not isinstance(fault, Blocked) or self._exhausted(number):
                continue
            reach = _enters(path, self._middles[number], fault.within_m)
            until_s = math.inf if fault.until_s is None else fault.until_s
            if reach is not None and fault.from_s <= when(reach) < until_s:
                there = message("something stands in the way {where}", context="log", where=self._place_words(number))
                found.append((reach, number, there))
        if not found:
            return None
        at_m, number, what = min(found)
        fault = self._faults[number]
        return Hindrance(at_m=at_m, number=number, what=what, recovers=isinstance(fault, Blocked) and fault.recovers)

    def counts(self) -> tuple[tuple[tuple[str, str, int], ...], tuple[tuple[int, int], ...]]:
        """Return the counts so far: draws per quantity and place, and occurrences per fault."""
        captures = tuple((quantity, place, times) for (quantity, place), times in self._captures.items())
        return captures, tuple(self._used.items())

    def restore(self, seed: int, captures: Iterable[tuple[str, str, int]], struck: Iterable[tuple[int, int]]) -> None:
        """Continue from the seed and :meth:`counts` of another one."""
        self.seed = seed
        self._captures = Counter({(quantity, place): times for quantity, place, times in captures})
        self._used = Counter(dict(struck))

    def tree_of(self, number: int) -> Place:
        """Return the tree that a fault of the world names."""
        return self._trees[number]

    def met(self, hindrance: Hindrance) -> None:
        """Count a hindrance that the robot has met."""
        self._used[hindrance.number] += 1

    def lost_on(self, path: tuple[Point, ...]) -> Hindrance | None:
        """Return where along a path the position is first lost, or None."""
        found = [
            (reach, number)
            for number, fault in enumerate(self._faults)
            if isinstance(fault, LocalisationLost) and fault.at is not None and not self._exhausted(number)
            if (reach := _enters(path, self._middles[number], fault.within_m)) is not None
        ]
        if not found:
            return None
        at_m, number = min(found)
        fault = self._faults[number]
        assert isinstance(fault, LocalisationLost)  # noqa: S101  as filtered above
        for_s = math.inf if fault.for_s is None else fault.for_s
        what = message("no position {where}", context="log", where=self._place_words(number))
        return Hindrance(at_m=at_m, number=number, what=what, for_s=for_s)

    @property
    def lost_spans(self) -> tuple[tuple[float, float], ...]:
        """Intervals in seconds of the mission in which the position is lost, regardless of place."""
        return tuple(
            (f.at_s, math.inf if f.for_s is None else f.at_s + f.for_s)
            for f in self._faults
            if isinstance(f, LocalisationLost) and f.at_s is not None
        )

    def drain(self, from_s: float, to_s: float) -> float:
        """Return the battery drain between two mission times, as a multiple of its model."""
        edges = [from_s, *(at for at, _ in self._drains if from_s < at < to_s), max(from_s, to_s)]
        paces = [math.prod(factor for at, factor in self._drains if at <= edge) for edge in edges[:-1]]
        if to_s <= from_s:
            return paces[0]
        spans = [b - a for a, b in itertools.pairwise(edges)]
        return sum(pace * span for pace, span in zip(paces, spans, strict=True)) / (to_s - from_s)

    def _place_words(self, number: int) -> str:
        """Return the place of a fault in words."""
        tree = self._trees.get(number)
        if tree is not None:
            return message("at tree {id}", context="log", id=tree.id)
        one, two = self._between[number]
        return message("between tree {one} and tree {two}", context="log", one=one.id, two=two.id)

    def _sensed(self, quantity: Quantity, place: Place, counted: bool) -> float | None:
        for number, fault in enumerate(self._faults):
            match fault:
                case SensorSilent(quantity=name) if name == quantity.name and self._strikes(number, place, counted):
                    return None
                case SensorAbsurd(quantity=name) if name == quantity.name and self._strikes(number, place, counted):
                    return fault.value
                case _:
                    pass
        reading = self._values.get(quantity.name, {}).get(place.id) if place.kind == "tree" else None
        if reading is None:
            reading = self._defaults.get(quantity.name)
        return self._drawn(quantity, place) if reading is None else reading

    def _drawn(self, quantity: Quantity, place: Place) -> float:
        times = self._captures[quantity.name, place.id]
        self._captures[quantity.name, place.id] += 1
        base = self._generator(quantity.name, place.kind, place.id).normal(quantity.typical, quantity.spread)
        noise = self._generator(quantity.name, place.kind, place.id, str(times)).normal(0.0, NOISE * quantity.spread)
        return float(np.clip(base + noise, quantity.minimum, quantity.maximum))

    def _generator(self, *key: str) -> np.random.Generator:
        digest = hashlib.sha256("\0".join(key).encode()).digest()
        return np.random.default_rng([self.seed, int.from_bytes(digest[:8], "big")])

    def _strikes(self, number: int, place: Place, counted: bool = True) -> bool:
        """Return True if a fault occurs here and now, and count it; limited ones only if ``counted``."""
        fault = self._faults[number]
        tree = self._trees.get(number)
        if self._exhausted(number) or (tree is not None and (place.kind, place.id) != ("tree", tree.id)):
            return False
        if not counted and getattr(fault, "times", None) is not None:
            return False
        if isinstance(fault, ActionFails | SensorSilent | SensorAbsurd | DriveFails | RobotStrays):
            self._used[number] += 1
        return True

    def _exhausted(self, number: int) -> bool:
        times = getattr(self._faults[number], "times", None)
        return times is not None and self._used[number] >= times

    def _bind_fault(self, number: int, site: Site) -> None:
        fault = self._faults[number]
        where = f"faults[{number}]"
        match fault:
            case ActionFails(action=action):
                self._known([action], self._robot.doable, where, "action")
            case SensorSilent(quantity=quantity) | SensorAbsurd(quantity=quantity):
                self._known([quantity], self._robot.quantity, where, "quantity")
            case _:
                pass
        reference = getattr(fault, "at", None)
        if isinstance(reference, TreeRef):
            tree = self._trees[number] = self._tree(reference, site, where)
            self._middles[number] = tree.xy
        if isinstance(fault, Blocked) and fault.between is not None:
            one, two = (self._tree(reference, site, where) for reference in fault.between)
            self._between[number] = (one, two)
            self._middles[number] = ((one.x + two.x) / 2.0, (one.y + two.y) / 2.0)
        if isinstance(fault, Blocked):
            x, y = self._middles[number]
            self._middles[number] = (x + fault.east_m, y + fault.north_m)

    def _script(self, world: World, site: Site) -> EventScript:
        middles: dict[int, Point] = {}
        for number, one in enumerate(world.events):
            where = f"events[{number}]"
            self._known([one.event], self._robot.event, where, "event")
            if one.at is not None:
                middles[number] = self._tree(one.at, site, where).xy
        return EventScript(world.events, self._robot.events, middles, lambda: self.seed)

    def _bound(self, truth: Truth, site: Site, name: str) -> dict[str, float]:
        """Return the values by tree id."""
        return {
            self._tree(reference, site, f"readings.{name}.trees[{number}]").id: value
            for number, (reference, value) in enumerate(truth.trees)
        }

    def _known(self, names: Iterable[str], known: Mapping[str, object], where: str, noun: str) -> None:
        for name in names:
            if name not in known:
                near = difflib.get_close_matches(name.lower(), known, n=1)
                hint = f"did you mean '{near[0]}'? " if near else ""
                many = "quantities" if noun == "quantity" else f"{noun}s"
                raise WorldError(
                    f"the robot {self._robot.name} has no {noun} '{name}'",
                    where=f"{self._source}: {where}",
                    advice=f"{hint}its {many} are {', '.join(known)}" if known else f"its profile lists no {many}",
                )

    def _tree(self, reference: TreeRef, site: Site, where: str) -> Place:
        """Return the tree that a reference names: by id, or the nearest within a tree spacing."""
        if reference.id is not None:
            tree = site.by_id.get(reference.id)
            if tree is None:
                near = difflib.get_close_matches(reference.id, site.by_id, n=1)
                raise WorldError(
                    f"{site.name} has no tree '{reference.id}'",
                    where=f"{self._source}: {where}",
                    advice=f"did you mean '{near[0]}'?" if near else f"it has {len(site.trees)} trees",
                )
            return tree.place
        xy = site.projection.metres(reference.lat, reference.lon)[0]
        away = np.hypot(*(site.xy - xy).T)
        nearest = int(np.argmin(away))
        if not away[nearest] <= site.spacing_m:
            raise WorldError(
                f"{site.name} has no tree at {reference}: the nearest is {away[nearest]:.0f} m away",
                where=f"{self._source}: {where}",
                advice="check that the world file belongs to this site",
            )
        return site.trees[nearest].place


def _enters(path: tuple[Point, ...], centre: Point, radius: float) -> float | None:
    """Return the distance in metres at which a path first comes within ``radius`` of a point; None if it never does.

    A path that begins inside may leave, and ends where it comes back in. A robot that was stopped at the edge counts as
    outside, so that trying again does not get through.
    """
    driven, outside = 0.0, math.dist(path[0], centre) > radius - RIM
    for (ax, ay), (bx, by) in itertools.pairwise(path):
        length = math.dist((ax, ay), (bx, by))
        if length == 0:
            continue
        ux, uy = (bx - ax) / length, (by - ay) / length
        along = (centre[0] - ax) * ux + (centre[1] - ay) * uy
        across = abs((centre[0] - ax) * uy - (centre[1] - ay) * ux)
        if across <= radius:
            half = math.sqrt(radius**2 - across**2)
            entry, leave = along - half, along + half
            if outside and -RIM <= entry <= length:
                return driven + max(0.0, entry)
            outside = leave < length if not outside else True
        driven += length
    return None
