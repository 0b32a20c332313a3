"""Dubins paths: the shortest paths between two poses for a vehicle that drives forwards with a least turning radius.

Each consists of three parts, arcs or straight lines, in one of six words (Dubins 1957; the lengths in closed form are
by Shkel and Lumelsky 2001). Angles are in radians, anticlockwise from east.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: The words: L and R are arcs to the left and to the right, S is a straight line.
WORDS = ("LSL", "RSR", "LSR", "RSL", "RLR", "LRL")

#: Greatest angle in radians between two points of an arc.
_STEP = np.radians(10.0)


def dubins_parts(start: Floats, goal: Floats, radius_m: float) -> Floats:
    """Return the three parts of each word between poses, in turning radii; nan for a word that does not exist.

    Args:
        start, goal: Poses (x, y, angle), shapes (..., 3), which broadcast.
        radius_m: Turning radius in metres, greater than 0.

    Returns:
        Shape (6, 3, ...).
    """
    dx, dy = (goal[..., 0] - start[..., 0]) / radius_m, (goal[..., 1] - start[..., 1]) / radius_m
    d, towards = np.hypot(dx, dy), np.arctan2(dy, dx)
    a, b = start[..., 2] - towards, goal[..., 2] - towards
    sa, sb, ca, cb, cab = np.sin(a), np.sin(b), np.cos(a), np.cos(b), np.cos(a - b)
    with np.errstate(invalid="ignore"):
        found = []
        straight = np.sqrt(_not_negative(2.0 + d * d - 2.0 * cab + 2.0 * d * (sa - sb)))
        turn = np.arctan2(cb - ca, d + sa - sb)
        found.append((turn - a, straight, b - turn))
        straight = np.sqrt(_not_negative(2.0 + d * d - 2.0 * cab + 2.0 * d * (sb - sa)))
        turn = np.arctan2(ca - cb, d - sa + sb)
        found.append((a - turn, straight, turn - b))
        straight = np.sqrt(_not_negative(d * d - 2.0 + 2.0 * cab + 2.0 * d * (sa + sb)))
        turn = np.arctan2(-ca - cb, d + sa + sb) - np.arctan2(-2.0, straight)
        found.append((turn - a, straight, turn - b))
        straight = np.sqrt(_not_negative(d * d - 2.0 + 2.0 * cab - 2.0 * d * (sa + sb)))
        turn = np.arctan2(ca + cb, d - sa - sb) - np.arctan2(2.0, straight)
        found.append((a - turn, straight, b - turn))
        arc = 2.0 * np.pi - np.arccos((6.0 - d * d + 2.0 * cab + 2.0 * d * (sa - sb)) / 8.0)
        turn = a - np.arctan2(ca - cb, d - sa + sb) + arc / 2.0
        found.append((turn, arc, a - b - turn + arc))
        arc = 2.0 * np.pi - np.arccos((6.0 - d * d + 2.0 * cab + 2.0 * d * (sb - sa)) / 8.0)
        turn = -a + np.arctan2(-ca + cb, d + sa - sb) + arc / 2.0
        found.append((turn, arc, b - a - turn + arc))
    return np.array([[_arc(one), middle if word < 4 else _arc(middle), _arc(two)]
                     for word, (one, middle, two) in enumerate(found)])  # fmt: skip


def dubins_lengths(start: Floats, goal: Floats, radius_m: float) -> Floats:
    """Return the length in metres of the shortest path between poses; arguments as of :func:`dubins_parts`."""
    return np.asarray(np.nanmin(dubins_parts(start, goal, radius_m).sum(axis=1), axis=0) * radius_m)


def dubins_paths(start: Floats, goal: Floats, radius_m: float) -> list[Floats]:
    """Return the path of each word that exists between two poses, shortest first.

    A path is a sequence of points, shape (n, 2); arcs are approximated by chords of up to 10 degrees.
    """
    parts = dubins_parts(start, goal, radius_m)
    lengths = parts.sum(axis=1)
    order = [k for k in np.argsort(lengths, kind="stable").tolist() if np.isfinite(lengths[k])]
    return [_points(start, goal, WORDS[k], parts[k].tolist(), radius_m) for k in order]


def _points(start: Floats, goal: Floats, word: str, parts: list[float], radius_m: float) -> Floats:
    x, y, angle = start.tolist()
    points = [(x, y)]
    for kind, part in zip(word, parts, strict=True):
        if kind == "S":
            x, y = x + part * radius_m * np.cos(angle), y + part * radius_m * np.sin(angle)
            points.append((x, y))
            continue
        side = 1.0 if kind == "L" else -1.0
        centre_x, centre_y = x - side * radius_m * np.sin(angle), y + side * radius_m * np.cos(angle)
        steps = max(int(np.ceil(part / _STEP)), 1)
        for turned in (angle + side * part * np.arange(1, steps + 1) / steps).tolist():
            x, y = centre_x + side * radius_m * np.sin(turned), centre_y - side * radius_m * np.cos(turned)
            points.append((x, y))
        angle += side * part
    points[-1] = (float(goal[0]), float(goal[1]))
    at = np.array(points)
    apart = np.hypot(*np.diff(at, axis=0).T) > 1e-9
    return np.asarray(at[np.concatenate([[True], apart])])


def _not_negative(squares: Floats) -> Floats:
    """Return squares without those that are negative beyond rounding, which become nan."""
    return np.where(squares > -1e-12, np.maximum(squares, 0.0), np.nan)


def _arc(angle: Floats) -> Floats:
    """Return angles in 0 up to a full turn; a full turn that is due to rounding becomes 0."""
    turned = np.mod(angle, 2.0 * np.pi)
    return np.where(2.0 * np.pi - turned < 1e-9, 0.0, turned)
