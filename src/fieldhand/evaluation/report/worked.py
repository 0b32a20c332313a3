"""Work of implements during a mission: metres, area with overlap, and amounts, from the event log."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString

from fieldhand.language.words import capitalised, say_action, say_number
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.results import Event, Shed, Visiting, Worked

#: Headings of the table.
WORKED_HEAD = ("Work", "Passes", "Worked", "Area", "Applied")


@dataclass(frozen=True, kw_only=True)
class WorkedRow:
    """The work of one action along paths, each figure in words.

    Attributes:
        passes: Whole passes of those that were planned.
        metres: Metres with the implement on.
        area: Area covered, and how much of it was covered again; empty for an implement without a width.
        amount: Amount that was applied; empty for none.
    """

    action: str
    passes: str
    metres: str
    area: str
    amount: str


def worked_rows(site: Site, robot: RobotProfile, events: Sequence[Event]) -> tuple[WorkedRow, ...]:
    """Return a row for each action that was on along a path, in the order in which they began."""
    done = [event for event in events if isinstance(event, Worked) and event.action]
    return tuple(
        _row(site, robot, action, [event for event in done if event.action == action], events)
        for action in dict.fromkeys(event.action for event in done)
    )


def _row(site: Site, robot: RobotProfile, action: str, done: list[Worked], events: Sequence[Event]) -> WorkedRow:
    nodes = {event.node for event in done}
    planned = sum(len(e.places) for e in events if isinstance(e, Visiting) and e.node in nodes)
    missed = {p for e in events if isinstance(e, Shed) and e.node in nodes for p in e.places}
    whole = sum(event.status == "success" and event.stretch not in missed for event in done)
    amount = sum(event.amount for event in done)
    unit = next((event.unit for event in done if event.unit), "")
    return WorkedRow(
        action=capitalised(say_action(action)),
        passes=f"{whole} of {max(planned, whole)}",
        metres=f"{sum(event.worked_m for event in done):,.0f} m",
        area=_area(site, robot, action, done),
        amount=f"{say_number(amount, 1)} {unit}" if unit else "",
    )


def _area(site: Site, robot: RobotProfile, action: str, done: list[Worked]) -> str:
    known = robot.action.get(action)
    width = None if known is None or known.implement is None else known.implement.width_m
    if width is None:
        return ""
    strips = []
    for part in (part for event in done for part in event.paths):
        degrees = np.asarray(part, dtype=np.float64).reshape(-1, 2)
        if len(degrees) > 1 and np.isfinite(degrees).all():
            line = LineString(site.projection.metres(degrees[:, 0], degrees[:, 1]))
            strips.append(line.buffer(width / 2.0, cap_style="flat"))
    total, covered = sum(strip.area for strip in strips), shapely.union_all(strips).area
    again = total - covered
    text = f"{covered:,.0f} m²" if covered < 2_000 else f"{covered / 10_000:,.2f} ha"
    return f"{text}, {again:,.0f} m² of it twice" if again >= 0.5 else text
