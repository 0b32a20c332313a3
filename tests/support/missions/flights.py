"""Whole missions in one call: from a request to its event log and outcomes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned, Planner
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Task
from fieldhand.task.results import Ended, Event


@dataclass(frozen=True, kw_only=True)
class Flight:
    """A finished mission."""

    task: Task
    site: Site
    events: tuple[Event, ...]
    assessment: mission.Assessment

    @property
    def lines(self) -> list[str]:
        """The event log as it is written."""
        return [to_json(event) for event in self.events]

    @property
    def end(self) -> Ended:
        """The last event."""
        last = self.events[-1]
        assert isinstance(last, Ended)
        return last


def fly_task(task: Task, site: Site, robot: str = "husky", *, world: World | None = None, seed: int = 0) -> Flight:
    """Approve a Task and carry it out."""
    profile = load_robot(robot)
    at = datetime(2026, 1, 1, tzinfo=UTC)
    approved = mission.authorize(mission.review(task, site, profile), by="tester", at=at, confirmed=EveryWarning())
    events: list[Event] = []
    mission.simulate(approved, world=world or World(), seed=seed, speed=None, emit=events.append)
    return Flight(task=task, site=site, events=tuple(events), assessment=mission.assess(task, events))


def fly_request(
    request: str,
    *,
    site: str = "demo",
    robot: str = "husky",
    readings: Mapping[str, Any] | None = None,
    seed: int = 0,
    planner: Planner | None = None,
) -> Flight:
    """Plan a request with the English planner (or another), approve it and carry it out."""
    ground, profile = open_site(site), load_robot(robot)
    outcome = mission.plan(request, ground, profile, planner or EnglishPlanner())
    assert isinstance(outcome, Planned), outcome
    world = parse_world({"readings": dict(readings)}) if readings else World()
    return fly_task(outcome.task, ground, robot, world=world, seed=seed)
