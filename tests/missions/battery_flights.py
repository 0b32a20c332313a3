"""Missions in which battery, distance or time runs out, and a judge of their logs.

``python tests/missions/battery_flights.py COUNT [FIRST]`` carries out so many and prints what came of them
(docs/faults.md).
The judge reads the limits from Task and profile and everything else from the lines of the log.
"""

from __future__ import annotations

import json
import math
import sys
from collections import Counter
from dataclasses import fields, replace
from typing import Any

import numpy as np

from fieldhand import mission
from fieldhand.execution.drivers.simulation.world import BatteryDrains, Blocked, TreeRef, World, WorldFault
from fieldhand.places.selectors import TreeIs, Trees
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.build import make_task
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach, InOrder, Node
from fieldhand.task.results import Event
from support.missions import faulted_flights
from support.missions.faulted_flights import Flown, random_plan, small_site
from support.missions.rig import approved

#: What floating-point sums may differ by.
SUMS = 1e-6


def draw_plan(rng: np.random.Generator, ids: list[str]) -> Node:
    """As many trees as fit, mandatory work at one far tree, or a mixture."""
    every = ForEach(id="", select=Trees(), body=Act(id="", action="read_co2"), optional=True)
    far = Act(id="", action="take_thermal_picture", at=TreeIs(tree=ids[-1]))
    match int(rng.integers(4)):
        case 0:
            return every
        case 1:
            return InOrder(id="", steps=(far, every))
        case 2:
            return ForEach(id="", select=Trees(), body=Act(id="", action="read_co2"), order="best")
        case _:
            return random_plan(rng, ids)


def draw_faults(rng: np.random.Generator, ids: list[str]) -> tuple[WorldFault, ...]:
    """A battery that drains 1 to 15 times as fast, from the beginning or from midway on, and perhaps blocked aisles."""
    factor = float(np.exp(rng.uniform(0.0, math.log(15.0))))
    begins = 0.0 if rng.random() < 0.5 else float(rng.uniform(5.0, 250.0))
    faults: list[WorldFault] = [BatteryDrains(factor=factor, from_s=begins)]
    blocked = int(rng.integers(0, 3)) if rng.random() < 0.5 else 0
    spots = ((TreeRef(id=str(rng.choice(ids))), float(rng.uniform(0.5, 4.0))) for _ in range(blocked))
    return (*faults, *(Blocked(at=spot, within_m=within_m) for spot, within_m in spots))


def draw_limits(rng: np.random.Generator) -> Constraints:
    """Limits of distance, time, energy, or none; now and then a reserve of the Task's own."""
    budgets = []
    if rng.random() < 0.4:
        budgets.append(Budget(kind="distance_m", limit=float(rng.uniform(60.0, 700.0))))
    if rng.random() < 0.3:
        budgets.append(Budget(kind="duration_s", limit=float(rng.uniform(100.0, 1200.0))))
    if rng.random() < 0.15:
        budgets.append(Budget(kind="energy_percent", limit=float(rng.uniform(2.0, 30.0))))
    reserve = round(float(rng.uniform(3.0, 60.0)), 1) if rng.random() < 0.3 else None
    return Constraints(budgets=tuple(budgets), reserve_percent=reserve)


def fly(seed: int) -> Flown:
    """Carry out the mission of a seed: site, plan, limits, battery and faults all follow from it."""
    rng = np.random.default_rng([23, seed])
    away_m = float(rng.uniform(20.0, 250.0)) if rng.random() < 0.4 else 0.0
    site = open_site("demo") if rng.random() < 0.2 else small_site(seed % 97, away_m=away_m)
    robot = load_robot("husky")
    share = float(np.exp(rng.uniform(math.log(0.05), 0.0)))
    reserve = round(float(rng.choice([rng.uniform(4.0, 12.0), 20.0, rng.uniform(25.0, 60.0)])), 1)
    energy = replace(robot.energy, capacity_j=share * robot.energy.capacity_j, reserve_percent=reserve)
    robot = replace(robot, energy=energy)
    drives = faulted_flights._drives(site, robot)
    ids = [t.place.id for t in site.trees if not drives.problem(t.place)]
    constraints = draw_limits(rng)
    plan = draw_plan(rng, ids)
    nominal = str(rng.choice(["return_to_start", "return_to_end", "stay"]))
    task = make_task(request="any", plan=plan, measures={}, nominal=nominal, constraints=constraints)  # type: ignore[arg-type]
    kept = reserve if constraints.reserve_percent is None else constraints.reserve_percent
    above = float(rng.choice([rng.uniform(0.3, 3.0), rng.uniform(3.0, 20.0), 100.0]))
    world = World(faults=draw_faults(rng, ids), charge_percent=min(100.0, kept + above))
    if rng.random() < 0.4 and "meter_step_percent" in {f.name for f in fields(World)}:
        world = replace(world, meter_step_percent=1.0)
    events: list[Event] = []
    mission.simulate(approved(task, site, robot), world=world, seed=seed, speed=None, emit=events.append)
    log = [json.loads(to_json(event)) for event in events]
    outcomes = mission.assess(task, events).outcomes
    return Flown(task=task, site=site, robot=robot, world=world, log=log, events=tuple(events), outcomes=outcomes)


def levels(flown: Flown) -> dict[str, float]:
    """Charge at which the mission warns, turns home and stops, and what must be left, by Task and profile."""
    energy, asked = flown.robot.energy, flown.task.constraints.reserve_percent
    reserve = energy.reserve_percent if asked is None else asked
    return {"warn": min(100.0, reserve + 10.0), "return": reserve, "reserve": reserve, "stop": reserve / 2.0}


def broken(flown: Flown) -> list[str]:
    """The limits that the log shows to be exceeded, from its last line."""
    end, started = flown.log[-1], flown.log[0]
    used = {
        "distance_m": end["travelled_m"],
        "duration_s": end["t"],
        "energy_percent": started["charge_percent"] - end["charge_percent"],
    }
    found = [b.kind for b in flown.task.constraints.budgets if used[b.kind] > b.limit + SUMS * max(1.0, b.limit)]
    return [*found, *(["reserve"] if end["charge_percent"] < levels(flown)["reserve"] - SUMS else [])]


def called_success(flown: Flown) -> bool:
    """Return True for the command line's exit status 0."""
    return flown.log[-1]["status"] == "completed" and all(o.outcome == "success" for o in flown.outcomes)


def said(flown: Flown, level: str, t: float = math.inf) -> bool:
    """Return True if the log says by then that the battery has come down to a level."""
    return any(e["event"] == "limit" and e["level"] == level and e["t"] <= t + SUMS for e in flown.log)


def below_stop_unsaid(flown: Flown) -> bool:
    """Return True if the charge went below the stop level without a line before that says so."""
    stop = levels(flown)["stop"]
    low = [e["t"] for e in flown.log if e.get("charge_percent", 100.0) < stop - SUMS and e["event"] != "limit"]
    return bool(low) and not said(flown, "stop", low[0])


def problems(flown: Flown) -> list[str]:
    """Return the faults that no mission may have."""
    found = [*faulted_flights.problems(flown)]
    lowest = min(e["charge_percent"] for e in flown.log if "charge_percent" in e)
    limits = [e for e in flown.log if e["event"] == "limit"]
    if called_success(flown) and broken(flown):
        found.append(f"a success beyond {broken(flown)}")
    if below_stop_unsaid(flown):
        found.append(f"{lowest:.1f} % is below the stop level, and nothing said so before")
    for level, at in levels(flown).items():
        if lowest <= at - SUMS and not said(flown, level):
            found.append(f"{level} level {at:g} % was crossed ({lowest:.1f} %) without an event")
    kinds = {e["quantity"] for e in limits if e["level"] == "limit"}
    found += [f"{kind} was exceeded without an event" for kind in broken(flown) if kind not in (*kinds, "reserve")]
    keys = [(e["quantity"], e["level"]) for e in limits if not e["cleared"]]
    found += [f"{key} was crossed {times} times" for key, times in Counter(keys).items() if times > 1]
    if broken(flown) and flown.log[-1]["status"] in ("completed", "returned"):
        found.append(f"it ended as {flown.log[-1]['status']} beyond {broken(flown)}")
    return [*found, *_after_crossings(flown, limits)]


def _after_crossings(flown: Flown, limits: list[dict[str, Any]]) -> list[str]:
    """After the return level nothing new is begun; after the stop level the robot stands."""
    found = []
    for limit in limits:
        later = [e for e in flown.log if e["t"] >= limit["t"] and flown.log.index(e) > flown.log.index(limit)]
        if limit["then"] in ("return", "stop") and any(e["event"] == "drive" and e["kind"] == "tree" for e in later):
            found.append(f"a drive to a tree after the {limit['level']} level")
        if limit["then"] == "stop" and limit["level"] == "stop":
            end = flown.log[-1]
            away = math.dist(faulted_flights._xy(flown.site, limit), faulted_flights._xy(flown.site, end))
            if away > 1.0 or not end["reason"]:
                found.append(f"it ends {away:.1f} m from where it stopped, {end['reason']!r}")
    return found


def main(count: int, first: int) -> None:
    """Carry missions out, print what came of them."""
    table: Counter[str] = Counter()
    statuses: Counter[str] = Counter()
    least: list[float] = []
    for seed in range(first, first + count):
        flown = fly(seed)
        end, at = flown.log[-1], levels(flown)
        found = problems(flown)
        if found:
            print(f"seed {seed}: {found}", flush=True)
        statuses[end["status"]] += 1
        over = broken(flown)
        least.append(end["charge_percent"] - at["reserve"])
        home = faulted_flights._ends(flown) == [] and end["status"] in ("completed", "returned", "exceeded")
        table.update(
            {
                "a rule broken": bool(found),
                "a limit or the reserve exceeded": bool(over),
                "of these called a success": bool(over) and called_success(flown),
                "below the stop level": end["charge_percent"] < at["stop"] - SUMS,
                "of these without saying so before": below_stop_unsaid(flown),
                "battery empty": end["charge_percent"] <= 0.0,
                "ended at its exit": home,
                "ended at its exit, all limits kept": home and not over,
                "success": called_success(flown),
                "captures": sum(e["event"] == "action" and e["status"] == "success" for e in flown.log),
            }
        )
    print(json.dumps({"missions": count, **table, "status": statuses, "least above reserve": min(least)}, indent=1))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
