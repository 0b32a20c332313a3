"""Events and states of live missions as JSON."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any

from fieldhand.fleet import FleetMission, LoggedLine, MissionFeed
from fieldhand.language import ENGLISH, Language
from fieldhand.wording.events import EventText, goal_names


def event_record(feed: MissionFeed, line: LoggedLine, language: Language = ENGLISH) -> dict[str, Any]:
    """Return an event with its number, its time, and in words; unknown numbers are null."""
    told = None if line.event is None else EventText(feed.robot).line(line.event)
    return {
        "mission": feed.id,
        "n": line.n,
        "at": line.at,
        "event": json.loads(line.line, parse_constant=lambda _: None),
        "told": language.say(told or ""),
    }


def summary_record(
    feed: MissionFeed, language: Language = ENGLISH, found: FleetMission | None = None
) -> dict[str, Any]:
    """Return the state of a mission.

    Args:
        feed: Reader of the mission.
        language: Language of the words in it.
        found: The state, if it was read already.
    """
    found = found or feed.summary()
    now = found.now
    name, nodes = goal_names(feed.task, feed.robot), {goal.id: goal.node for goal in feed.task.command.goals}
    return {
        "id": found.id,
        "state": found.state,
        "status": now.status,
        "reason": language.say(now.reason),
        "request": found.request,
        "site": found.site,
        "robot": found.robot,
        "by": found.settings.by,
        "begun_at": found.begun_at,
        "speed": "max" if found.settings.speed is None else found.settings.speed,
        "doing": language.say(now.doing),
        "node": now.node,
        "place": now.place,
        "near": language.say(now.near),
        "lat": _finite(now.lat),
        "lon": _finite(now.lon),
        "seconds": _finite(now.seconds),
        "travelled_m": _finite(now.travelled_m),
        "charge_percent": _finite(now.charge_percent),
        "captures": now.captures,
        "in_doubt": now.in_doubt,
        "limits": now.limits,
        "exceeded": [asdict(language.read(one)) for one in now.exceeded],
        "goals": [
            {**asdict(language.read(goal)), "node": nodes.get(goal.goal, ""), "name": language.say(name(goal.goal))}
            for goal in now.goals
        ],
        "events": now.events,
        "report": found.report,
        "fault": language.say(found.fault),
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
