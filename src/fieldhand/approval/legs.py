"""Where planned drives cross what they must not, found from the zones alone: a second opinion on the drives."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.forecast.walk import Walk
from fieldhand.site.model import Site

#: Metres inside a keep-out, or outside the boundary, that a drive may show from rounding.
TOLERANCE_M = 0.01


def driven_through(walks: Sequence[Walk], site: Site) -> tuple[tuple[str, str], ...]:
    """Each forbidden crossing as the id of the node that drives and what it crosses ("through the keep-out “pond”")."""
    if not site.zones:
        return ()
    from shapely.geometry import LineString
    from shapely.ops import unary_union

    keep_outs = site.zones_of("keep_out")
    boundaries = site.zones_of("boundary")
    inside = unary_union([b.polygon for b in boundaries]) if boundaries else None
    found: dict[tuple[str, str], None] = {}
    seen: set[tuple[tuple[float, float], ...]] = set()
    for step in (s for w in walks for s in w.steps):
        if step.drive is None or step.drive.points in seen:
            continue
        seen.add(step.drive.points)
        line = LineString(step.drive.points)
        for zone in keep_outs:
            if line.intersects(zone.polygon) and line.intersection(zone.polygon).length > TOLERANCE_M:
                found[step.node.id, f"through the keep-out “{zone.name}”"] = None
        if inside is not None and line.difference(inside).length > TOLERANCE_M:
            found[step.node.id, "outside the boundary"] = None
    return tuple(found)
