"""A robot that detects events, for missions that watch them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from fieldhand.robot.events import MonitoredEvent
from fieldhand.robot.model import RobotProfile
from fieldhand.task.build import make_task
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import Node
from fieldhand.task.watches import EventBeyond, EventHolds, Fallback, Response, Watch
from support.missions.rig import husky

EVENTS = (
    MonitoredEvent(
        name="person_near",
        description="someone is near",
        words=("person", "someone", "people"),
        labels={"es": "hay alguien cerca"},
    ),
    MonitoredEvent(
        name="rain", description="it rains", words=("rain",), verbs=("rain",), states=("rainy",), unless_heard="ignored"
    ),
    MonitoredEvent(
        name="wind",
        description="the wind is strong",
        words=("wind", "wind speed"),
        states=("windy", "strong"),
        unit="m/s",
        above=8.0,
        typical=2.0,
    ),
    MonitoredEvent(
        name="gate_closed", description="the gate is closed", words=("gate",), states=("closed", "shut"), clear_s=0.0
    ),
)


@cache
def watchful() -> RobotProfile:
    """The built-in husky with a people detector, a rain sensor, an anemometer and a gate that reports its state."""
    return replace(husky(), events=EVENTS)


def watch(
    event: str, response: Response, *, at_most_s: float | None = None, fallback: Fallback = "return_to_end"
) -> Watch:
    """Return a watch of an event that simply holds."""
    return Watch(condition=EventHolds(event=event), response=response, at_most_s=at_most_s, fallback=fallback)


def windy(limit: float, response: Response, **more: float) -> Watch:
    """Return a watch of wind above a limit in m/s."""
    condition = EventBeyond(event="wind", test="gt", value=limit, unit="m/s")
    return Watch(condition=condition, response=response, **more)  # type: ignore[arg-type]


def watching(plan: Node, *watches: Watch, nominal: Then = "return_to_end") -> Task:
    """Return a Task with watches."""
    return make_task(request="a test", plan=plan, measures={}, nominal=nominal, watches=watches)
