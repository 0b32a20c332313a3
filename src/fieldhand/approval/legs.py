"""Where planned drives cross what they must not, found from zones and rows alone: a second opinion on the drives."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.forecast.steps import Walk
from fieldhand.language import message
from fieldhand.site.model import Site

#: Metres inside a keep-out, or outside the boundary, that a drive may show from rounding.
TOLERANCE_M = 0.01


def driven_through(walks: Sequence[Walk], site: Site) -> tuple[tuple[str, str], ...]:
    """Each forbidden crossing as the id of the node that drives and what it crosses ("through the keep-out “pond”")."""
    rows = [row for row in site.planting.rows if len(row.trees) > 1]
    if not site.zones and not rows:
        return ()
    from shapely import STRtree
    from shapely.geometry import LineString
    from shapely.ops import unary_union

    tree_lines = STRtree([LineString(site.xy[row.trees]) for row in rows])

    # Driving along an edge is allowed: only what lies inside a keep-out counts, and outside the boundary.
    keep_outs = [(z.name, z.polygon.buffer(-TOLERANCE_M)) for z in site.zones_of("keep_out")]
    boundaries = site.zones_of("boundary")
    inside = unary_union([b.polygon for b in boundaries]).buffer(TOLERANCE_M) if boundaries else None
    found: dict[tuple[str, str], None] = {}
    seen: set[tuple[tuple[float, float], ...]] = set()
    for step in (s for w in walks for s in w.steps):
        if step.drive is None or step.drive.points in seen:
            continue
        seen.add(step.drive.points)
        line = LineString(step.drive.points)
        for k in tree_lines.query(line, predicate="intersects").tolist():
            found[step.node.id, message("through the trees of row {row}", row=rows[k].name)] = None
        for name, polygon in keep_outs:
            if line.intersects(polygon) and line.intersection(polygon).length > TOLERANCE_M:
                found[step.node.id, message("through the keep-out “{zone}”", zone=name)] = None
        if inside is not None and line.difference(inside).length > TOLERANCE_M:
            found[step.node.id, message("outside the boundary")] = None
    return tuple(found)
