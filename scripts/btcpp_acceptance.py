"""Export Tasks as trees, tick them with BehaviorTree.CPP, and compare the ticked leaves with the meaning of the plan.

    python scripts/btcpp_acceptance.py CHECKER [--tasks 50]

CHECKER is the program built from scripts/btcpp_check.cpp (docs/exchange.md). The Tasks are that of the demo and random
ones. Each is ticked with conditions that hold, do not hold and are unknown, and with actions that succeed and fail. The
expected leaves are computed here from the semantics of the plan (fieldhand.task.plan), independent of the tree.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, settings

from fieldhand.cli.demo import REQUEST
from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp import write_tree
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_demo
from fieldhand.task import plan as p
from fieldhand.task.conditions import AllOf, AnyOf, Condition, Not
from fieldhand.task.frames import Task
from fieldhand.testing.generated.tasks import ROVER, Parts

PLACES = 2
MOST_LINES = 20_000


class Failed(Exception):
    """Raised when an action fails."""


class Stopped(Exception):
    """Raised when a stop is reached."""


class TooLong(Exception):
    """Raised when a mission has too many leaves to be ticked."""


class Mission:
    """The leaves that a mission executes if all conditions and all actions have the same result."""

    def __init__(self, conditions: str, actions: str) -> None:
        self.answer = {"yes": True, "no": False, "unknown": None}[conditions]
        self.fails = actions == "fail"
        self.lines: list[str] = []

    def run(self, task: Task) -> list[str]:
        """Return the lines that the checker must print."""
        self.add("BeginMission")
        try:
            self.play(task.composition.plan)
            ending = "nominal"
        except Failed:
            ending = "faulted"
        except Stopped as stop:
            ending = str(stop)
        if ending == "nominal":
            return [*self.lines, f"TakeExit {task.composition.nominal}", "= SUCCESS"]
        return [*self.lines, "HandleFault", "= FAILURE"]

    def add(self, line: str) -> None:
        self.lines.append(line)
        if len(self.lines) > MOST_LINES:
            raise TooLong

    def play(self, node: p.Node) -> None:
        match node:
            case p.InOrder(steps=steps):
                for step in steps:
                    self.play(step)
            case p.AnyOrder(steps=steps):
                self.add("OrderSteps")
                for step in reversed(steps):
                    self.play(step)
            case p.ForEach():
                self.add("ResolvePlaces")
                for _ in range(PLACES):
                    if node.optional and not self.answer:
                        continue
                    self.add("GoToPlace")
                    self.play(node.body)
                    if node.until is not None and self.truth(node.until) is True:
                        break
            case p.Repeat():
                for _ in range(node.times):
                    self.play(node.body)
                    if node.until is not None and self.truth(node.until) is True:
                        break
            case p.If():
                if self.truth(node.condition) is True:
                    self.play(node.then)
                elif node.otherwise is not None:
                    self.play(node.otherwise)
            case p.Try():
                try:
                    self.play(node.body)
                except Failed:
                    self.play(node.otherwise)
            case p.OptionalStep():
                if self.answer:
                    self.play(node.body)
            case p.GoTo():
                self.add("GoToPlace")
            case p.Act():
                if node.at is not None:
                    self.add("GoToPlace")
                self.add(node.action)
                if self.fails:
                    raise Failed
            case p.StopMission():
                raise Stopped(node.exit)

    def truth(self, condition: Condition) -> bool | None:
        """Evaluate a condition in Kleene's logic over leaves that all have the same answer."""
        match condition:
            case Not(condition=inner):
                found = self.truth(inner)
                return None if found is None else not found
            case AllOf(conditions=inner):
                parts = [self.truth(c) for c in inner]
                return False if False in parts else None if None in parts else True
            case AnyOf(conditions=inner):
                parts = [self.truth(c) for c in inner]
                return True if True in parts else None if None in parts else False
            case _:
                return self.answer


def random_tasks(count: int) -> list[Task]:
    """Return random Tasks of at least five nodes; the same count gives the same Tasks."""
    found: list[Task] = []
    checks = (HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much)
    plans = Parts(ROVER).tasks().filter(lambda t: len(list(p.walk(t.composition.plan))) >= 5)

    @settings(
        max_examples=count, deadline=None, derandomize=True, phases=[Phase.generate], suppress_health_check=checks
    )
    @given(plans)
    def draw(task: Task) -> None:
        found.append(task)

    draw()
    return found


def main() -> int:
    """Check all Tasks; return 0 if every tree agrees with its plan."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("checker", type=Path)
    parser.add_argument("--tasks", type=int, default=50)
    given_ = parser.parse_args()
    done = {"tasks": 0, "runs": 0, "leaves": 0, "not carried": 0, "too long": 0}

    def check(task: Task, document: bytes) -> None:
        with tempfile.NamedTemporaryFile(suffix=".xml") as file:
            file.write(document)
            file.flush()
            for conditions in ("yes", "no", "unknown"):
                for actions in ("succeed", "fail"):
                    try:
                        expected = Mission(conditions, actions).run(task)
                    except TooLong:
                        done["too long"] += 1
                        continue
                    command = [str(given_.checker.resolve()), file.name, conditions, actions]
                    ran = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
                    if ran.returncode != 0 or ran.stdout.splitlines() != expected:
                        Path("failed_tree.xml").write_bytes(document)
                        sys.exit(f"{task.id}, {conditions}, {actions}: {ran.stderr}\n{ran.stdout}\nexpected {expected}")
                    done["runs"] += 1
                    done["leaves"] += len(expected) - 1
        done["tasks"] += 1

    site, husky = load_demo(), load_robot("husky")
    planned = EnglishPlanner().plan(REQUEST, site, husky)
    if not isinstance(planned, Planned):
        sys.exit("the demo's request was not planned")
    check(planned.task, write_tree(planned.task, capabilities_of(husky)))

    for task in random_tasks(given_.tasks):
        try:
            document = write_tree(task, ROVER)
        except TaskError:
            done["not carried"] += 1
            continue
        check(task, document)
    print(", ".join(f"{name} {count}" for name, count in done.items()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
