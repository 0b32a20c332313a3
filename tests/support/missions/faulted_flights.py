"""Missions with random faults, and a judge of their logs that asks nothing of the product.

``python tests/support/missions/faulted_flights.py COUNT [FIRST]`` flies so many and prints what came of them
(docs/faults.md).
"""

from __future__ import annotations

import itertools
import json
import math
import sys
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from shapely.geometry import LineString, Polygon

from fieldhand import mission
from fieldhand.errors import OutputError
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    ClockJumps,
    DriveFails,
    LocalisationLost,
    RobotStops,
    SensorAbsurd,
    SensorSilent,
    TreeRef,
    World,
    WorldFault,
)
from fieldhand.places.selectors import TreeIs, Trees, UnionOf
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import Patience, RobotProfile
from fieldhand.site.loader import open_site, parse_site
from fieldhand.site.model import Site
from fieldhand.task.build import FAULTED_EXITS, make_task
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import FaultedExit, Task
from fieldhand.task.plan import Act, ForEach, GoTo, InOrder, Node, OptionalStep, Repeat, Try, walk
from fieldhand.task.results import Event
from support.missions.rig import approved

#: Metres within which a robot is at an exit.
AT_EXIT_M = 1.0


@dataclass(frozen=True, kw_only=True)
class Flown:
    """A mission with its log, as lines of JSON that were read back."""

    task: Task
    site: Site
    robot: RobotProfile
    world: World
    log: list[dict[str, Any]]
    events: tuple[Event, ...]
    outcomes: tuple[Any, ...]


def small_site(seed: int, *, away_m: float = 0.0) -> Site:
    """An orchard of 3 to 5 rows with a fence around it and perhaps a pond in it, made as a file and read.

    Args:
        seed: Of what is drawn.
        away_m: How much farther from the trees its start and end lie.
    """
    rng = np.random.default_rng([11, seed])
    rows, trees = int(rng.integers(3, 6)), int(rng.integers(4, 8))
    across, along = rng.uniform(4.0, 6.5), rng.uniform(3.0, 5.0)
    scale = np.array([1 / 88_900, 1 / 110_950])

    def degrees(x: float, y: float) -> list[float]:
        return (np.array([-120.0, 37.0]) + np.array([x, y]) * scale).tolist()

    def ring(x0: float, y0: float, x1: float, y1: float) -> list[list[float]]:
        return [degrees(x, y) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))]

    def feature(kind: str, shape: str, where: Any, **more: Any) -> dict[str, Any]:
        return {
            "type": "Feature",
            "properties": {"kind": kind, **more},
            "geometry": {"type": shape, "coordinates": where},
        }

    wide, deep = (rows - 1) * across, (trees - 1) * along
    features = [
        feature("tree", "Point", degrees(r * across, k * along), row=str(r + 1))
        for r, k in itertools.product(range(rows), range(trees))
    ]
    features += [
        feature("start", "Point", degrees(-4.0 - away_m, -5.0)),
        feature("end", "Point", degrees(wide + 4.0, -5.0 - away_m)),
        feature("boundary", "Polygon", [ring(-9.0 - away_m, -9.0 - away_m, wide + 9.0, deep + rng.uniform(1.0, 9.0))]),
    ]
    if rng.random() < 0.7:
        x, y = rng.uniform(0.0, wide), rng.uniform(0.0, deep)
        half = rng.uniform(0.4, 2.5)
        features.append(feature("keep_out", "Polygon", [ring(x - half, y - half, x + half, y + half)], name="pond"))
    return parse_site(json.dumps({"type": "FeatureCollection", "features": features}).encode(), name="small")


def random_plan(rng: np.random.Generator, ids: list[str]) -> Node:
    """A plan over some trees: what must be done, what may be left out, what stands in for what fails."""

    def act(at: str | None = None) -> Act:
        action = str(rng.choice(["read_co2", "take_thermal_picture", "read_ambient_temperature"]))
        return Act(id="", action=action, at=None if at is None else TreeIs(tree=at), count=int(rng.integers(1, 3)))

    def some(most: int) -> list[str]:
        return rng.permutation(ids)[: int(rng.integers(1, most + 1))].tolist()

    def step() -> Node:
        match int(rng.integers(7)):
            case 0:
                of = UnionOf(parts=tuple(TreeIs(tree=i) for i in some(6)))
                return ForEach(id="", select=of, body=act(), order=str(rng.choice(["best", "given"])))  # type: ignore[arg-type]
            case 1:
                return ForEach(id="", select=Trees(), body=act(), optional=True, at_most=int(rng.integers(1, 9)))
            case 2:
                return OptionalStep(id="", body=act(some(1)[0]))
            case 3:
                return Try(id="", body=act(some(1)[0]), otherwise=act(some(1)[0]))
            case 4:
                return Repeat(id="", times=2, body=act(some(1)[0]))
            case 5:
                return InOrder(id="", steps=(GoTo(id="", place=TreeIs(tree=some(1)[0])), act()))
            case _:
                return act(some(1)[0])

    return InOrder(id="", steps=tuple(step() for _ in range(int(rng.integers(1, 5)))))


def random_faults(rng: np.random.Generator, ids: list[str], wanted: list[str]) -> tuple[WorldFault, ...]:
    """One to five faults of any kind, most of them where the robot has work to do."""

    def tree() -> TreeRef:
        return TreeRef(id=str(rng.choice(wanted if wanted and rng.random() < 0.7 else ids)))

    def often() -> int | None:
        return None if rng.random() < 0.4 else int(rng.integers(1, 4))

    def fault() -> WorldFault:
        t = float(rng.uniform(0.0, 250.0))
        match int(rng.integers(11)):
            case 0:
                return ActionFails(action="read_co2", times=often(), at=tree() if rng.random() < 0.7 else None)
            case 1:
                return SensorSilent(quantity="co2", times=often(), at=tree() if rng.random() < 0.7 else None)
            case 2:
                absurd = float(rng.choice([np.nan, np.inf, -1e9, 99999.0]))
                return SensorAbsurd(quantity="co2", value=absurd, times=often(), at=None)
            case 3:
                return DriveFails(times=often(), at=tree() if rng.random() < 0.8 else None)
            case 4 | 5:
                until = t + float(rng.uniform(5.0, 200.0)) if rng.random() < 0.5 else None
                begins = t if rng.random() < 0.5 else 0.0
                return Blocked(
                    at=tree(), within_m=float(rng.uniform(0.3, 5.0)), times=often(), from_s=begins, until_s=until
                )
            case 6:
                return Blocked(between=(tree(), tree()), within_m=float(rng.uniform(0.5, 4.0)))
            case 7:
                for_s = float(rng.uniform(1.0, 90.0)) if rng.random() < 0.8 else None
                if rng.random() < 0.5:
                    return LocalisationLost(at_s=t, for_s=for_s)
                return LocalisationLost(at=tree(), within_m=float(rng.uniform(1.0, 6.0)), for_s=for_s, times=often())
            case 8:
                return BatteryDrains(factor=float(rng.uniform(0.5, 3.0)), from_s=t if rng.random() < 0.5 else 0.0)
            case 9:
                return ClockJumps(at_s=t, by_s=float(rng.choice([-86400.0, -60.0, 60.0, 3e7])))
            case _:
                return RobotStops(at_s=t + 30.0) if rng.random() < 0.3 else DriveFails(times=1)

    return tuple(fault() for _ in range(int(rng.integers(1, 6))))


def fly(seed: int, *, demo: bool = True) -> Flown:
    """The mission of a seed: plan, faults, charge and leg costs all follow from it. ``demo``: on a larger site, too."""
    rng = np.random.default_rng([5, seed])
    site = small_site(seed % 97) if rng.random() < 0.7 or not demo else open_site("demo")
    robot = load_robot("husky")
    robot = replace(robot, patience=Patience(retry_wait_s=float(rng.choice([0.0, 3.0]))))
    open_ids = [t.place.id for t in site.trees if not _drives(site, robot).problem(t.place)]
    faulted = tuple(
        FaultedExit(fault=e.fault, then=str(rng.choice(["return_to_start", "return_to_end", e.then])))  # type: ignore[arg-type]
        for e in FAULTED_EXITS
    )
    nominal = str(rng.choice(["return_to_start", "return_to_end", "stay"]))
    plan = random_plan(rng, open_ids)
    task = make_task(request="any", plan=plan, measures={}, nominal=nominal, faulted=faulted)  # type: ignore[arg-type]
    charge = float(rng.choice([100.0, rng.uniform(20.0, 23.0)]))
    selectors = [s for n in walk(plan) if (s := n.selector) is not None]
    wanted = sorted(
        {t.tree for s in selectors for t in (s.parts if isinstance(s, UnionOf) else (s,)) if isinstance(t, TreeIs)}
    )
    world = World(faults=random_faults(rng, open_ids, wanted), charge_percent=charge)
    events: list[Event] = []
    mission.simulate(approved(task, site, robot), world=world, seed=seed, speed=None, emit=events.append)
    log = [json.loads(to_json(event)) for event in events]
    outcomes = mission.assess(task, events).outcomes
    return Flown(task=task, site=site, robot=robot, world=world, log=log, events=tuple(events), outcomes=outcomes)


def problems(flown: Flown) -> list[str]:
    """Return what a log shows that no mission may do: from its lines, and from site and task as they were made."""
    return [*_ends(flown), *_drives_over(flown), *_recounted(flown), *_silently_shed(flown), *_believed(flown)]


def _drives(site: Site, robot: RobotProfile) -> Any:
    from fieldhand.forecast.visit_order import drives_for

    return drives_for(site, robot)


def _of(flown: Flown, event: str) -> list[dict[str, Any]]:
    return [e for e in flown.log if e["event"] == event]


def _xy(site: Site, record: dict[str, Any]) -> tuple[float, float]:
    x, y = site.projection.metres(record["lat"], record["lon"])[0]
    return float(x), float(y)


def _ends(flown: Flown) -> list[str]:
    """One end, the last; where the exit that was taken last leads, or where it stands with a reason."""
    ends, exits = _of(flown, "mission"), _of(flown, "exit")
    if ends != flown.log[-1:] or not exits:
        return [f"{len(ends)} ends, {len(exits)} exits"]
    end, left = ends[0], exits[-1]
    at = _xy(flown.site, end)
    markers = {"return_to_start": "start", "return_to_end": "end"}
    goal = markers.get(left["then"])
    if goal is None:
        return [] if end["reason"] or left["exit"] == "nominal" else ["it stays, for no reason that is said"]
    marker = flown.site.markers[goal]
    stand = _drives(flown.site, flown.robot).stands((marker,))[0].stand or marker.xy
    if math.dist(at, stand) <= AT_EXIT_M:
        return []
    stranded = end["status"] in ("faulted", "aborted") and end["reason"]
    return (
        []
        if stranded
        else [f"it ends {math.dist(at, stand):.1f} m from the {goal}, {end['status']}, {end['reason']!r}"]
    )


def _drives_over(flown: Flown) -> list[str]:
    """No path as it was announced goes through a keep-out, leaves the boundary, or goes over what was found blocked."""
    found, site = [], flown.site
    kept = [(z.name, z.polygon.buffer(-0.02)) for z in site.zones if z.kind == "keep_out"]
    inside = [z.polygon.buffer(0.02) for z in site.zones if z.kind == "boundary"]
    for drive in _of(flown, "drive"):
        degrees = np.array(drive["path"])
        line = LineString(site.projection.metres(degrees[:, 0], degrees[:, 1]))
        found += [f"a drive goes through {name}" for name, area in kept if line.intersection(area).length > 0]
        found += ["a drive leaves the boundary" for area in inside if line.difference(area).length > 0]
    # What it found blocked it does not drive over either, as long as it remembers it.
    known: list[Polygon] = []
    for event in flown.log:
        if event["event"] == "obstacle":
            areas = [np.array(area) for area in event["blocked"]]
            known = [Polygon(site.projection.metres(a[:, 0], a[:, 1])).buffer(-0.02) for a in areas]
        if event["event"] == "drive" and known:
            degrees = np.array(event["path"])
            line = LineString(site.projection.metres(degrees[:, 0], degrees[:, 1]))
            found += [
                "a drive goes over what was found blocked" for area in known if line.intersection(area).length > 0
            ]
    return found


def _recounted(flown: Flown) -> list[str]:
    """The captures of each goal, counted from the log; a goal that is met lacks none that were asked for plainly."""
    done = Counter(e["node"] for e in _of(flown, "action") if e["status"] == "success")
    nodes = {goal.id: goal for goal in flown.task.command.goals}
    found = []
    for outcome in flown.outcomes:
        goal = nodes[outcome.goal]
        if outcome.done != done[goal.node]:
            found.append(f"goal {goal.id}: {outcome.done} reported, {done[goal.node]} in the log")
        plain = goal.expected is not None and not goal.optional and not goal.conditional
        if plain and outcome.outcome == "success" and done[goal.node] < goal.expected:
            found.append(f"goal {goal.id} is met with {done[goal.node]} of {goal.expected}")
        if plain and outcome.outcome == "failure" and done[goal.node] >= goal.expected:
            found.append(f"goal {goal.id} has failed with {done[goal.node]} of {goal.expected}")
    return found


def _silently_shed(flown: Flown) -> list[str]:
    """A mission that completes has done all that it must, unless it says what it gave up; so does one that returns."""
    end = flown.log[-1]
    done = Counter(e["node"] for e in _of(flown, "action") if e["status"] == "success")
    said = bool([e for e in _of(flown, "shed") if not e["optional"]])
    turned_home = any(e["then"] == "return" for e in _of(flown, "limit"))
    lacking = [
        goal.id
        for goal in flown.task.command.goals
        if goal.expected is not None
        and not goal.optional
        and not goal.conditional
        and not _in_a_try(flown.task.composition.plan, goal.node)
        and done[goal.node] < goal.expected
    ]
    if end["status"] == "completed" and lacking and not said:
        return [f"completed, but goals {lacking} lack captures and nothing was said"]
    if end["status"] == "returned" and not said and not (turned_home and _of(flown, "shed")):
        return ["returned, and nothing was said to be given up"]
    return []


def _in_a_try(node: Node, wanted: str) -> bool:
    return any(isinstance(n, Try) and any(i.id == wanted for i in walk(n)) for n in walk(node))


def _believed(flown: Flown) -> list[str]:
    """No reading outside its range counts; time never runs back; no capture begins while the robot is lost."""
    found = []
    for action in _of(flown, "action"):
        for name, value in action["readings"].items():
            quantity = flown.robot.quantity[name]
            if not quantity.minimum <= value <= quantity.maximum:
                found.append(f"{name} {value} counts")
    times = [e["t"] for e in flown.log]
    if any(b < a - 1e-9 for a, b in itertools.pairwise(times)):
        found.append("time runs back")
    spans = [
        (f.at_s, math.inf if f.for_s is None else f.at_s + f.for_s)
        for f in flown.world.faults
        if isinstance(f, LocalisationLost) and f.at_s is not None
    ]
    for action in (e for e in _of(flown, "action") if e["status"] == "success"):
        begun = action["t"] - flown.robot.action[action["action"]].duration_s
        if any(a + 1e-3 < action["t"] and begun < b - 1e-3 for a, b in spans):
            found.append(f"a capture at {action['t']:.1f} s while lost")
    return found


def main(count: int, first: int) -> None:
    """Fly missions, print what came of them."""
    statuses: Counter[str] = Counter()
    met: Counter[str] = Counter()
    events: Counter[str] = Counter()
    metres, wrong = 0.0, 0
    for seed in range(first, first + count):
        try:
            flown = fly(seed)
        except OutputError:
            raise
        except Exception as error:  # noqa: BLE001  what no mission may do, told with its seed
            wrong += 1
            print(f"seed {seed}: {type(error).__name__}: {error}", flush=True)
            continue
        found = problems(flown)
        if found:
            wrong += 1
            print(f"seed {seed}: {found}", flush=True)
        statuses[flown.log[-1]["status"]] += 1
        met.update({type(f).__name__ for f in flown.world.faults})
        events.update(e["event"] for e in flown.log)
        metres += flown.log[-1]["travelled_m"]
    print(
        json.dumps({"missions": count, "wrong": wrong, "km": metres / 1000, **statuses, "with": met, "events": events})
    )


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
