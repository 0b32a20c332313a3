"""Where a robot leaves an aisle: by its mouths onto open ground, and around the end of a short row into the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fieldhand.site.driving.aisles import Aisle
from fieldhand.site.driving.bodies import Body
from fieldhand.site.driving.free import Area, Free
from fieldhand.site.driving.graph import Indices, Points
from fieldhand.site.driving.ground import Doors

End = Literal[0, 1]

#: A row that ends this far within its block's outline, beyond where the robot turns, is turned around there.
_SHORT_M = 1.0


@dataclass(frozen=True, eq=False)
class Mouth:
    """Where an aisle opens onto open ground.

    Attributes:
        end: Of the aisle: 0 that of least u.
        uv, at: In the frame of the rows; in metres east and north.
        outward: From the aisle, a unit vector in metres east and north.
        edge: Mouths of one straight edge have the same.
    """

    aisle: int
    end: End
    uv: Points
    at: Points
    outward: Points
    edge: tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Turn:
    """A point beyond the end of a short row, within the outline of its block: there one aisle opens into the next.

    Attributes:
        aisles: Below and above the row.
        uv, at: In the frame of the rows; in metres east and north.
    """

    aisles: tuple[int, int]
    uv: Points
    at: Points


def mouths_of(aisles: Sequence[Aisle], open_ground: Area) -> list[Mouth]:
    """The open mouths of all aisles, those of one edge one after the other."""
    found: list[Mouth] = []
    ends: tuple[End, End] = (0, 1)
    for aisle in aisles:
        for end in ends:
            if aisle.course != "closed":
                found.extend(_mouth(aisle, end, uv) for uv in aisle.mouths(end))
    if not found:
        return []
    open_ = open_ground.holds(np.array([m.at for m in found]))
    return sorted((m for m, o in zip(found, open_, strict=True) if o), key=lambda m: (m.edge, float(m.uv[1])))


def turns_of(bodies: Sequence[Body], aisles: Sequence[Aisle], free: Free, room_m: float) -> list[Turn]:
    """Where short rows between two aisles can be turned around, ``room_m`` beyond their last trees or nearer."""
    found = []
    first = 0
    for body in bodies:
        for k in range(1, len(body.lines) - 1):
            line = body.lines[k]
            beside = aisles[first + k - 1], aisles[first + k]
            if any(a.course == "closed" for a in beside):
                continue
            widths = [float(a.width(line.u[end])) for a in beside for end in (0, -1)]
            off = max(min(room_m, *(width / 2.0 for width in widths)), free.clearance_m)
            for end, sign in ((0, -1.0), (-1, 1.0)):
                v = float(line.low[end] + line.high[end]) / 2.0
                out = body.reaches(v)[0 if end == 0 else 1]
                if abs(out - float(line.u[end])) > off + _SHORT_M:
                    uv = np.array([float(line.u[end]) + sign * off, v])
                    found.append(Turn((beside[0].number, beside[1].number), uv, body.frame.world(uv[None, :])[0]))
        first += len(body.lines) - 1
    if free.bounded and found:
        clear = free.holds(np.array([t.at for t in found]), soft=True)
        return [t for t, c in zip(found, clear, strict=True) if c]
    return found


def doors_of(mouths: Sequence[Mouth]) -> Doors:
    """The mouths as doors of the open ground."""
    if not mouths:
        return Doors.none()
    numbers = {edge: k for k, edge in enumerate(dict.fromkeys(m.edge for m in mouths))}
    edge: Indices = np.array([numbers[m.edge] for m in mouths], dtype=np.intp)
    return Doors(np.array([m.at for m in mouths]), np.array([m.outward for m in mouths]), edge)


def _mouth(aisle: Aisle, end: End, uv: Points) -> Mouth:
    body = aisle.body
    v, u = body.start_outline if end == 0 else body.end_outline
    k = int(np.clip(np.searchsorted(v, uv[1]) - 1, 0, len(v) - 2))
    edge = np.array([u[k + 1] - u[k], v[k + 1] - v[k]])
    outward = np.array([edge[1], -edge[0]]) * (-1.0 if end == 0 else 1.0) / np.hypot(*edge)
    at, out = body.frame.world(np.array([uv, outward]))
    return Mouth(aisle.number, end, uv, at, out, (aisle.body_number, end, k))
