"""Kill missions with ``kill -9`` at random instants, resume them, and compare their logs with the robot's record.

    python scripts/kill_nine.py --kills 300 [--seed 1] [--json]

The robot is simulated in this process; the mission runs in another, which is killed at any moment: during a commit,
between two, or while a goal is executed. The robot survives, as a real one does, and keeps its own record of the
captures it made. Missions are drawn as in ``fieldhand bench guard`` (conditions, loops, optional visits, budgets that
bind), with faults of actions, sensors and aisles.

Each mission is judged from its journal, its event log and the robot's record:

* lost: captures that the robot made and that are neither in the log nor in doubt;
* repeated: captures beyond those that the plan requires on its branch, or more captures in the log than were made;
* incomplete: the log does not end with a single end, differs from the journal, or goes back in time.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import multiprocessing
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.checks import examine
from fieldhand.clock import Clock, SimulatedClock
from fieldhand.errors import NotApprovedError
from fieldhand.evaluation.budget_guard import BudgetGuard
from fieldhand.evaluation.failsafe import BudgetFailsafe
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Progress
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    SensorSilent,
    TreeRef,
    World,
    WorldFault,
)
from fieldhand.execution.journal.store import Journal, create
from fieldhand.execution.mission_runner import run
from fieldhand.forecast.visit_order import drives_for
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Acted, Ended, InDoubt, Started
from fieldhand_bench.draw import Draft, draw

#: Methods of the driver that are called over the connection, besides those of the clock.
DRIVER_METHODS = (
    "start_drive",
    "start_action",
    "poll",
    "cancel",
    "next_event_in",
    "position",
    "charge_percent",
    "stopped",
    "lost",
)
LONGEST_S = 1800.0


@dataclass
class Robot:
    """The simulated robot, which survives the processes that control it, and its record of captures."""

    driver: Driver
    clock: Clock
    made: list[tuple[str, str]] = field(default_factory=list)
    open: ActionGoal | None = None

    def answer(self, name: str, *words: Any) -> Any:
        """Call a method of the driver or the clock and return its result."""
        if name in ("now", "advance"):
            return getattr(self.clock, name)(*words)
        if name == "seed":
            return self.driver.seed
        if name in ("start_drive", "start_action"):
            self.note()
        answer = getattr(self.driver, name)(*words)
        if name == "start_action":
            self.open = words[0]
        self.note()
        return answer

    def note(self) -> None:
        """Record the current capture if it has succeeded."""
        progress: Progress = self.driver.poll()
        if self.open is not None and progress.over:
            if progress.state == "succeeded":
                self.made.append((self.open.action, self.open.place.id))
            self.open = None


class RemoteDriver:
    """A proxy of the driver and the clock in the parent process."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self.seed: int | None = self._ask("seed")

    def _ask(self, name: str, *words: Any) -> Any:
        self._connection.send((name, *words))
        return self._connection.recv()

    def start_drive(self, goal: DriveGoal) -> None:
        self._ask("start_drive", goal)

    def start_action(self, goal: ActionGoal) -> None:
        self._ask("start_action", goal)

    def __getattr__(self, name: str) -> Any:
        if name not in (*DRIVER_METHODS, "now", "advance"):
            raise AttributeError(name)
        return lambda *words: self._ask(name, *words)


@dataclass
class KillTotals:
    """Totals of all missions."""

    missions: int = 0
    kills: int = 0
    lives: int = 0
    made: int = 0
    in_doubt: int = 0
    lost: int = 0
    repeated: int = 0
    incomplete: int = 0
    ends: Counter[str] = field(default_factory=Counter)
    outcomes: Counter[str] = field(default_factory=Counter)
    troubles: list[str] = field(default_factory=list)


def world_of(draft: Draft, rng: random.Random) -> World:
    """Return the world of a mission, with random faults."""
    spots = [TreeRef(id=tree.place.id) for tree in draft.site.trees]
    faults: list[WorldFault] = []
    if rng.random() < 0.4:
        faults.append(ActionFails(action=rng.choice([a.name for a in draft.robot.actions]), times=rng.randint(1, 3)))
    if rng.random() < 0.3:
        names = [q.name for q in draft.robot.quantities]
        faults.append(SensorSilent(quantity=rng.choice(names), times=rng.randint(1, 3)))
    if rng.random() < 0.3:
        faults.append(Blocked(at=rng.choice(spots), within_m=1.0, times=rng.randint(1, 2)))
    if rng.random() < 0.3:
        faults.append(BatteryDrains(factor=rng.uniform(1.5, 12.0), from_s=rng.uniform(0.0, 300.0)))
    return World(faults=tuple(faults), charge_percent=draft.charge_percent)


def ignore_event(_event: object) -> None:
    """Ignore an event."""


def live(folder: Path, approved: AuthorizedTask, draft: Draft, connection: Connection) -> None:
    """Start or resume the mission; runs in the process that is killed."""
    robot: Any = RemoteDriver(connection)
    task, site, profile = draft.task, draft.site, draft.robot
    guard = BudgetGuard(
        task, site, profile, drives_for(site, profile), draft.flight_seed, charge_percent=draft.charge_percent
    )
    with Journal(folder / "journal.sqlite", "kill -9", folder / "events.jsonl", ignore_event) as journal:
        run(
            approved,
            site=site,
            robot=profile,
            driver=robot,
            guard=guard,
            failsafe=BudgetFailsafe(task, profile, guard.drain),
            clock=robot,
            emit=ignore_event,
            log=journal,
        )


def one_life(
    folder: Path, approved: AuthorizedTask, draft: Draft, robot: Robot, until_s: float | None
) -> tuple[bool, float]:
    """Run the mission in a child process, and kill it after so many seconds; None waits for its end.

    Returns:
        True if it was killed, and its lifetime in seconds.
    """
    here, there = multiprocessing.Pipe()
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        status = 70
        try:
            here.close()
            live(folder, approved, draft, there)
            status = 0
        except BaseException as error:  # noqa: BLE001  the parent must see any exception
            print(f"{type(error).__name__}: {error}", file=sys.stderr)
        finally:
            os._exit(status)
    there.close()
    began = time.perf_counter()
    deadline = began + (LONGEST_S if until_s is None else until_s)
    with contextlib.suppress(EOFError, OSError):
        while (left := deadline - time.perf_counter()) > 0:
            if here.poll(left):
                name, *words = here.recv()
                here.send(robot.answer(name, *words))
    lived = time.perf_counter() - began
    with contextlib.suppress(ProcessLookupError):
        os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    here.close()
    if os.WIFEXITED(status) and os.WEXITSTATUS(status) != 0:
        raise SystemExit(f"the mission of seed {draft.seed} ended with an error")
    if os.WIFSIGNALED(status) and until_s is None:
        raise SystemExit(f"the mission of seed {draft.seed} did not end within {LONGEST_S:g} s")
    return os.WIFSIGNALED(status), lived


def approved_draft(seed: int) -> tuple[Draft, AuthorizedTask] | None:
    """Return the mission of a seed, or None if it is not approved."""
    draft = draw(seed, 0, 60)
    if draft is None:
        return None
    try:
        at = "2026-01-01T00:00:00+00:00"
        examined = examine(draft.task, draft.site, draft.robot)
        return draft, approve(examined, by="the test", at=at, confirmed=EveryWarning())
    except NotApprovedError:
        return None


def judge(folder: Path, draft: Draft, robot: Robot, totals: KillTotals) -> None:
    """Compare journal and event log with the robot's record, and add the result to the totals."""
    robot.note()
    lines = (folder / "events.jsonl").read_text().splitlines()
    with Journal(folder / "journal.sqlite", "kill -9", folder / "events.jsonl", ignore_event) as journal:
        kept = list(journal.before)
    events = [event for event in map(from_json, lines) if event is not None]
    logged = Counter((e.action, e.place) for e in events if isinstance(e, Acted) and e.status == "success")
    failed = Counter((e.action, e.place) for e in events if isinstance(e, Acted) and e.status == "failed")
    doubt = Counter((e.action, e.place) for e in events if isinstance(e, InDoubt))
    made = Counter(robot.made)
    # A capture whose reading was rejected was made as well.
    totals.lost += (made - logged - failed - doubt).total()
    totals.repeated += (logged - made).total()
    ends = [e for e in events if isinstance(e, Ended)]
    whole = lines == kept and len(ends) == 1 and events[-1] is ends[0] and isinstance(events[0], Started)
    whole = whole and all(a.t <= b.t + 1e-9 for a, b in itertools.pairwise(events))
    outcomes = mission.assess(draft.task, events).outcomes
    for goal in outcomes:
        if goal.wanted is not None and goal.done > goal.wanted:
            totals.repeated += goal.done - goal.wanted
            totals.troubles.append(f"seed {draft.seed}: goal {goal.goal}: {goal.why}")
        totals.outcomes[goal.outcome] += 1
    if not whole:
        totals.incomplete += 1
        totals.troubles.append(f"seed {draft.seed}: the log is not whole")
    totals.missions += 1
    totals.made += made.total()
    totals.in_doubt += doubt.total()
    totals.ends[ends[0].status if ends else "none"] += 1


def measure(kills: int, seed: int) -> KillTotals:
    """Kill and resume missions of successive seeds until the number of kills is reached."""
    rng, totals, number = random.Random(seed), KillTotals(), seed * 100_000
    while totals.kills < kills:
        number += 1
        drawn = approved_draft(number)
        if drawn is None:
            continue
        draft, approved = drawn
        world = world_of(draft, rng)

        def new_robot(draft: Draft = draft, world: World = world) -> Robot:
            clock = SimulatedClock()
            chance = np.random.default_rng(draft.flight_seed)
            return Robot(driver=SimulatedDriver(draft.site, draft.robot, world, clock, chance), clock=clock)

        with tempfile.TemporaryDirectory() as name:
            whole, folder = Path(name) / "whole", Path(name) / "killed"
            for one in (whole, folder):
                one.mkdir()
                create(one / "journal.sqlite", "kill -9")
            _, lasts_s = one_life(whole, approved, draft, new_robot(), None)
            robot = new_robot()
            for _ in range(rng.choice((1, 1, 2, 3, 5))):
                killed, _ = one_life(folder, approved, draft, robot, rng.uniform(0.0, lasts_s))
                totals.kills += killed
                totals.lives += 1
                if not killed:
                    break
            else:
                one_life(folder, approved, draft, robot, None)
                totals.lives += 1
            judge(folder, draft, robot, totals)
    return totals


def main(words: Sequence[str] | None = None) -> int:
    """Run the command line; return 1 if anything was lost, repeated or incomplete."""
    parser = argparse.ArgumentParser(description="Kill missions with kill -9 at random instants and resume them.")
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args(words)
    found = measure(given.kills, given.seed)
    if given.json:
        print(json.dumps(vars(found)))
    else:
        for name, value in vars(found).items():
            print(f"{name:<12}{dict(value) if isinstance(value, Counter) else value}")
    return 1 if found.lost or found.repeated or found.incomplete else 0


if __name__ == "__main__":
    sys.exit(main())
