"""Convert named points that are no plants (a trough, a tap) into small zones, which requests can name."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, count

import numpy as np
import numpy.typing as npt
import shapely

from fieldhand.site.feature_kinds import NAME_KEYS, OPEN_LANDMARKS, phrase, text_of
from fieldhand.site.features import PointFeature
from fieldhand.site.model import Zone
from fieldhand.site.projection import Projection

#: Radius in metres of the ground that an object takes up, of which a file gives the position only.
_OBJECT_RADIUS_M = 0.3
#: An object closes no ground that is nearer than this to a tree, a gate or a marker: robots have to get there.
_CLEAR_OF_OTHERS_M = 1.0


def landmark_zones(
    landmarks: Sequence[PointFeature],
    others: Sequence[PointFeature],
    zones: Sequence[Zone],
    projection: Projection,
) -> tuple[Zone, ...]:
    """Return a zone for each landmark that has a name which no other zone has.

    Objects are keep-outs, so that robots stop beside them. Points that robots drive over (a crossing, a waypoint), and
    objects beside a tree, a gate or a marker are open zones.

    Args:
        landmarks: The landmarks; those without a name yield no zone.
        others: Trees, gates and markers.
        zones: The zones of the file, whose names are taken.
        projection: From degrees to local metres.
    """
    named = [p for p in landmarks if _name_of(p)]
    if not named:
        return ()
    taken = {phrase(zone.name) for zone in zones}
    seen: set[str] = set()
    near = shapely.STRtree(np.asarray(shapely.points(_metres(others, projection))))
    found: list[Zone] = []
    for p, xy in zip(named, _metres(named, projection), strict=True):
        own = _name_of(p)
        if phrase(own) in taken:
            continue
        name = next(n for n in chain([own], (f"{own} {k}" for k in count(2))) if phrase(n) not in taken | seen)
        seen.add(phrase(name))
        at = shapely.Point(xy)
        is_open = phrase(p.word).split()[-1] in OPEN_LANDMARKS or bool(
            near.query(at, predicate="dwithin", distance=_CLEAR_OF_OTHERS_M).size
        )
        found.append(Zone(name=name, kind="zone" if is_open else "keep_out", polygon=at.buffer(_OBJECT_RADIUS_M)))
    return tuple(found)


def is_named(landmark: PointFeature) -> bool:
    """Return True if requests can name the landmark."""
    return bool(_name_of(landmark))


def _name_of(landmark: PointFeature) -> str:
    name = text_of(landmark.properties, NAME_KEYS)[:80]
    return name if name.isprintable() else ""


def _metres(points: Sequence[PointFeature], projection: Projection) -> npt.NDArray[np.float64]:
    if not points:
        return np.empty((0, 2))
    return projection.metres([p.lat for p in points], [p.lon for p in points])
