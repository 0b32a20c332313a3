"""Convert fences and other barrier lines into thin keep-outs with openings at the gates."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, count

import shapely
from shapely.geometry.base import BaseGeometry

from fieldhand.site.feature_kinds import NAME_KEYS, phrase, text_of
from fieldhand.site.features import BarrierFeature, PointFeature, gate_width_m
from fieldhand.site.model import Gate, Place, Zone
from fieldhand.site.projection import Projection

#: Half the thickness in metres of the keep-out along a line.
HALF_THICK_M = 0.05
#: A gate up to this distance in metres from a fence belongs to it, since both may be drawn by hand.
_GATE_REACH_M = 2.0


def gates_of(points: Sequence[PointFeature], projection: Projection) -> tuple[Gate, ...]:
    """Return the gates with unique names: their own, numbered if used before, else ``gate 1``, ``gate 2`` ..."""
    gates: list[Gate] = []
    used: set[str] = set()
    for number, p in enumerate(points, start=1):
        (x, y), *_ = projection.metres([p.lat], [p.lon]).tolist()
        name = text_of(p.properties, NAME_KEYS)[:80] or f"gate {number}"
        name = next(n for n in chain([name], (f"{name} {k}" for k in count(2))) if phrase(n) not in used)
        used.add(phrase(name))
        place = Place(kind="point", id=name, x=x, y=y, lat=p.lat, lon=p.lon)
        gates.append(Gate(place=place, width_m=gate_width_m(p.properties)))
    return tuple(gates)


def barrier_zones(
    barriers: Sequence[BarrierFeature], gates: Sequence[Gate], projection: Projection
) -> tuple[tuple[Zone, ...], list[str]]:
    """Return keep-outs along the lines with an opening at each gate, and notes about gates far from any line."""
    lines = [
        shapely.LineString(projection.metres([lat for _, lat in b.positions], [lon for lon, _ in b.positions]))
        for b in barriers
    ]
    zones: list[Zone] = []
    for barrier, line in zip(barriers, lines, strict=True):
        opened: BaseGeometry = line
        for gate in gates:
            at = shapely.Point(gate.place.xy)
            if line.distance(at) <= max(_GATE_REACH_M, gate.width_m / 2):
                middle = line.interpolate(line.project(at))
                opened = opened.difference(middle.buffer(gate.width_m / 2, quad_segs=64))
        thick = shapely.buffer(opened, HALF_THICK_M, cap_style="flat", join_style="mitre")
        zones.extend(
            Zone(name=barrier.name[:80], kind="keep_out", polygon=part)
            for part in shapely.get_parts(thick)
            if isinstance(part, shapely.Polygon) and not part.is_empty
        )
    idle = [g.place.id for g in gates if not _opens(g, lines)] if lines else []
    return tuple(zones), [f"the gate {name!r} is not on a fence, so it has no effect" for name in idle[:5]]


def _opens(gate: Gate, lines: Sequence[shapely.LineString]) -> bool:
    at = shapely.Point(gate.place.xy)
    return any(line.distance(at) <= max(_GATE_REACH_M, gate.width_m / 2) for line in lines)
