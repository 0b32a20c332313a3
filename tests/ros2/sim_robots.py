"""Simulated robots in processes of their own, reached over DDS, and what they say that they have done."""

from __future__ import annotations

import itertools
import json
import os
import signal
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from fieldhand.execution.vehicle import Connection
from fieldhand.robot.loader import profile_bytes
from support.processes.command import in_background
from support.processes.patience import until

_NUMBERS = itertools.count(1)


@dataclass
class SimRobot:
    """A ``fieldhand sim-robot``.

    Attributes:
        words: Its options.
        by: How it is reached: below a namespace of its own, so that nobody hears one that was here before.
        folder: Where its state and its account lie.
        lives: How often it was switched on.
    """

    words: tuple[str, ...]
    folder: Path
    by: Connection
    lives: int = 0
    _process: int = 0
    _stack: ExitStack = field(default_factory=ExitStack)

    def begin(self) -> None:
        """Switch it on; it is where it was."""
        self.lives += 1
        state = str(self.folder / "robot.json")
        below = ("--domain", str(self.by.domain), "--namespace", str(self.by.namespace))
        told = in_background("sim-robot", *self.words, *below, "--json", "--state", state, out=self._out(self.lives))
        self._process = self._stack.enter_context(told)
        until(lambda: sum(line["event"] == "ready" for line in self.account()) == self.lives)

    def kill(self) -> None:
        """As a power cut."""
        os.kill(self._process, signal.SIGKILL)

    def account(self) -> list[dict[str, Any]]:
        """Return what it has said in all its lives."""
        texts = [self._out(life).read_text() for life in range(1, self.lives + 1) if self._out(life).exists()]
        return [json.loads(line) for text in texts for line in text.splitlines(keepends=True) if line.endswith("\n")]

    def made(self, action: str) -> Counter[str]:
        """Return how often an action of ROS, by the end of its name, succeeded at each place."""
        return Counter(
            line["place"]
            for line in self.account()
            if line["event"] == "goal" and line["name"].endswith(action) and line["end"] == "succeeded"
        )

    @property
    def reached(self) -> tuple[str, ...]:
        """The options by which a command reaches it; its domain is in the environment."""
        return ("--on", "dds", "--namespace", str(self.by.namespace), "--sim-time")

    def end(self) -> None:
        """Switch it off: it takes its leave, so that nobody waits for it any more."""
        with suppress(ProcessLookupError):
            os.kill(self._process, signal.SIGTERM)
        until(lambda: self.account()[-1]["event"] == "ended")
        self._stack.close()

    def _out(self, life: int) -> Path:
        return self.folder / f"robot-{life}.jsonl"


@contextmanager
def sim_robot(folder: Path, *words: str) -> Iterator[SimRobot]:
    """A robot that answers."""
    by = Connection(
        transport="dds", domain=int(os.environ["ROS_DOMAIN_ID"]), namespace=f"/robot_{next(_NUMBERS)}", sim_time=True
    )
    robot = SimRobot(words=words, folder=folder, by=by)
    robot.begin()
    try:
        yield robot
    finally:
        robot.end()


def patient(folder: Path, robot: str = "husky", **navigation: object) -> Path:
    """Write the profile of a built-in robot with long limits, and a battery that loses nothing while it waits.

    At fifty times the pace a process that waits for its turn misses the built-in ones.

    Args:
        navigation: Other keys of its navigation.
    """
    profile = yaml.safe_load(profile_bytes(robot)[0])
    profile["energy"]["idle_w"] = 0
    bound = profile["ros2"]
    bound["navigation"] |= {"accept_s": 600, "quiet_s": 600, "slower": 100, "extra_s": 3600, **navigation}
    for topic in ("position", "battery", "odometry", "stop"):
        if topic in bound:
            bound[topic]["stale_s"] = 600
    for action in bound["actions"].values():
        for call in (action.get("action"), action.get("service"), *action.get("topics", {}).values()):
            if call is not None:
                call["within_s"] = 600
    path = folder / f"{robot}.yaml"
    path.write_text(yaml.safe_dump(profile, sort_keys=False))
    return path
