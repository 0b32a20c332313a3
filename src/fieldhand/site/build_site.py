"""Build a :class:`Site` from the features of a file: project them into metres and check them against each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType

import numpy as np
import shapely
from numpy.typing import NDArray

from fieldhand.errors import SiteError
from fieldhand.site.barriers import barrier_zones, gates_of
from fieldhand.site.extent import drop_strays, middle_of
from fieldhand.site.feature_kinds import row_of
from fieldhand.site.features import AreaFeature, FeatureSet, PointFeature, readable
from fieldhand.site.formats.faults import Faults, UnusableFeature, numbered
from fieldhand.site.landmarks import is_named, landmark_zones
from fieldhand.site.model import Place, Site, Tree, Zone
from fieldhand.site.projection import Projection

SAME_TREE_M = 0.2
#: Tolerance in metres. A boundary is often drawn from tree to tree, and a tree between two of its corners may then lie
#: slightly outside.
ON_BOUNDARY_M = 0.05
_MOST_PAIRS = 5
#: Distance in metres from keep-outs of the start of a site without trees and without a start marker.
_OFF_KEEP_OUTS_M = 2.0
#: Maximum number of characters of the name of a marker that requests may use.
_LONGEST_MARKER_NAME = 60


def build(features: FeatureSet, faults: Faults, *, name: str, sha256: str, notes: Sequence[str] = ()) -> Site:
    """Return the site; in a lenient reading without the features that cannot be used.

    Args:
        features: Features that were read individually.
        faults: Features that could not be read; faults found by comparing features are added.
        name: Name of the site.
        sha256: SHA-256 of the bytes that were read.
        notes: Notes of the format's reader.

    Raises:
        SiteError: There are no trees, or there are faults that must not be left out.
    """
    numbering = _numbering([p for p in features.points if p.kind == "tree"])
    sound = drop_strays(features, faults)
    planted = [p for p in sound.points if p.kind == "tree"]
    grounds = [area for area in sound.areas if area.kind != "keep_out"]
    if not planted and not grounds:
        faults.check()
        raise _no_trees(features, faults.source)
    projection = middle_of(planted, grounds)
    zones = _zones(sound.areas, projection, faults)
    gates = gates_of([p for p in sound.points if p.kind == "gate"], projection)
    fences, opens_nothing = barrier_zones(sound.barriers, gates, projection)
    trees, about_trees = _trees(planted, numbering, projection, zones + fences, faults)
    marked = [p for p in sound.points if p.kind not in ("tree", "gate", "landmark")]
    landmarks = [p for p in sound.points if p.kind == "landmark"]
    others = [p for p in sound.points if p.kind != "landmark"]
    fences += landmark_zones(landmarks, others, zones, projection)
    markers = _markers(marked, projection, zones + fences, faults)
    faults.check()
    bare = [z for z in (*zones, *fences) if z.kind != "keep_out"]
    if not trees and (planted or not bare):
        raise _no_trees(features, faults.source, left_out=True)
    no_start = not trees and "start" not in markers
    if no_start:
        markers = {
            **markers,
            "start": _start_on(bare, [z for z in (*zones, *fences) if z.kind == "keep_out"], projection),
        }
    return Site(
        name=_site_name(name, faults.source),
        trees=trees,
        markers=markers,
        zones=zones + fences,
        projection=projection,
        sha256=sha256,
        source=faults.source,
        notes=(
            *faults.notes(),
            *notes,
            *_notes(features, faults),
            *numbering.notes,
            *about_trees,
            *opens_nothing,
            *(
                ("there is no start marker and no tree, so missions start in the middle of the area",)
                if no_start
                else ()
            ),
        ),
        gates=gates,
        marker_names=tuple(_marker_names(marked, markers)),
    )


class _Numbering:
    """The id of each tree of the file, including trees that are left out later."""

    def __init__(self, ids: Mapping[int, str], notes: tuple[str, ...]) -> None:
        self._ids, self.notes = ids, notes

    def id_of(self, tree: PointFeature) -> str:
        return self._ids[id(tree)]


def _numbering(planted: Sequence[PointFeature]) -> _Numbering:
    """Return the file's own ids if every tree has one and all differ, else numbers in file order from 1."""
    notes: tuple[str, ...] = ()
    ids = [p.own_id for p in planted]
    if not _all_differ(ids):
        if any(ids):
            notes = ("the trees' own ids are not complete or not unique, so trees are numbered in file order from 1",)
        ids = [p.feature_id for p in planted]
        if _all_differ(ids):
            notes = ()
        else:
            ids = [str(k) for k in range(1, len(planted) + 1)]
    return _Numbering({id(p): tree_id for p, tree_id in zip(planted, ids, strict=True)}, notes)


def _all_differ(ids: Sequence[str]) -> bool:
    return all(ids) and len(set(ids)) == len(ids)


def _trees(
    planted: Sequence[PointFeature],
    numbering: _Numbering,
    projection: Projection,
    zones: Sequence[Zone],
    faults: Faults,
) -> tuple[tuple[Tree, ...], list[str]]:
    """Return the trees, and notes about them."""
    metres = projection.metres([p.lat for p in planted], [p.lon for p in planted])
    numbers = [p.feature for p in planted]
    stays = _inside_boundary(metres, numbers, zones, faults)
    points = shapely.STRtree(np.asarray(shapely.points(metres)))
    again, notes = _entered_twice(points, numbers, stays, faults)
    stays &= ~again
    notes.extend(_in_keep_outs(points, numbers, stays, zones, faults))
    kept = np.flatnonzero(stays).tolist()
    xy = metres.tolist()
    trees = []
    for index, k in enumerate(kept):
        p, (x, y) = planted[k], xy[k]
        trees.append(
            Tree(
                place=Place(kind="tree", id=numbering.id_of(p), x=x, y=y, lat=p.lat, lon=p.lon),
                index=index,
                feature=p.feature,
                properties=MappingProxyType(p.properties),
                row=row_of(p.properties),
            )
        )
    return tuple(trees), notes


def _inside_boundary(
    metres: NDArray[np.float64], numbers: Sequence[int], zones: Sequence[Zone], faults: Faults
) -> NDArray[np.bool_]:
    """Return a mask of the trees inside the boundary and report the others.

    Trees outside the boundary can never be reached: either the tree or the boundary is wrong.
    """
    boundaries = [z.polygon for z in zones if z.kind == "boundary"]
    inside = np.full(len(metres), not boundaries)
    for polygon in boundaries:
        shapely.prepare(polygon)
        inside |= shapely.dwithin(polygon, shapely.points(metres), ON_BOUNDARY_M)
    for k in np.flatnonzero(~inside).tolist():
        faults.add(numbers[k], "the tree stands outside the boundary", "correct the tree or draw the boundary wider")
    return inside


def _entered_twice(
    points: shapely.STRtree, numbers: Sequence[int], stays: NDArray[np.bool_], faults: Faults
) -> tuple[NDArray[np.bool_], list[str]]:
    """Return a mask of the trees to leave out because they stand within 0.2 m of an earlier one, and notes about them.

    Real surveys contain a few such pairs, so they are noted and kept unless the reading is lenient.
    """
    one, other = points.query(points.geometries, predicate="dwithin", distance=SAME_TREE_M)
    later = one > other
    again = np.zeros(len(numbers), dtype=bool)
    pairs: list[tuple[int, int]] = []
    for k, before in sorted(zip(one[later].tolist(), other[later].tolist(), strict=True)):
        if stays[k] and stays[before] and not again[before] and not again[k]:
            again[k] = True
            pairs.append((numbers[before], numbers[k]))
    if not pairs:
        return again, []
    if faults.lenient:
        for before, number in pairs:
            faults.add(
                number,
                f"the tree stands within {SAME_TREE_M:g} m of that of {faults.unit} {before}, probably the same",
                "",
            )
        return again, []
    listing = ", ".join(f"{a} and {b}" for a, b in pairs[:_MOST_PAIRS])
    more = f" and {len(pairs) - _MOST_PAIRS} more pairs" if len(pairs) > _MOST_PAIRS else ""
    return np.zeros_like(again), [
        f"trees within {SAME_TREE_M:g} m of one another, probably entered twice: {faults.unit}s {listing}{more}"
    ]


def _in_keep_outs(
    points: shapely.STRtree,
    numbers: Sequence[int],
    stays: NDArray[np.bool_],
    zones: Sequence[Zone],
    faults: Faults,
) -> list[str]:
    """Return notes about trees inside keep-outs: they stay on the site, but no robot can reach them."""
    notes = []
    for zone in zones:
        if zone.kind != "keep_out":
            continue
        inside = [k for k in sorted(points.query(zone.polygon, predicate="contains").tolist()) if stays[k]]
        if inside:
            which = numbered(faults.unit, [numbers[k] for k in inside])
            one = len(inside) == 1
            notes.append(
                f"the tree{'s' * (not one)} of {which} stand{'s' * one} inside the keep-out {zone.name!r}"
                f" and cannot be visited"
            )
    return notes


def _markers(
    points: Sequence[PointFeature], projection: Projection, zones: Sequence[Zone], faults: Faults
) -> Mapping[str, Place]:
    """Return the start, end and charger markers and report duplicates and unreachable ones.

    A marker inside a keep-out or outside the boundary would make every mission impossible.
    """
    markers: dict[str, Place] = {}
    numbers: dict[str, int] = {}
    boundaries = [z.polygon for z in zones if z.kind == "boundary"]
    keep_outs = [z for z in zones if z.kind == "keep_out"]
    metres = projection.metres([p.lat for p in points], [p.lon for p in points]).tolist() if points else []
    for p, (x, y) in zip(points, metres, strict=True):
        if p.kind in markers:
            faults.add(
                p.feature,
                f"it is a second {p.kind} marker (the first is {faults.unit} {numbers[p.kind]})",
                "keep one of them",
            )
            continue
        within = next((z for z in keep_outs if shapely.contains_xy(z.polygon, x, y)), None)
        if within is not None:
            faults.add(p.feature, f"the {p.kind} marker lies inside the keep-out {within.name!r}", "move one of them")
        elif boundaries and not any(shapely.intersects_xy(b, x, y) for b in boundaries):
            faults.add(p.feature, f"the {p.kind} marker lies outside the boundary", "move one of them")
        else:
            numbers[p.kind] = p.feature
            markers[p.kind] = Place(kind="marker", id=p.kind, x=x, y=y, lat=p.lat, lon=p.lon)
    return markers


def _start_on(grounds: Sequence[Zone], keep_outs: Sequence[Zone], projection: Projection) -> Place:
    """Return a start inside the boundary, or else the first zone, of a site without trees; clear of keep-outs."""
    ground = min(grounds, key=lambda zone: zone.kind != "boundary").polygon
    free = ground.difference(shapely.union_all([zone.polygon.buffer(_OFF_KEEP_OUTS_M) for zone in keep_outs]))
    at = (ground if free.is_empty else free).representative_point()
    lat, lon = projection.degrees([[at.x, at.y]])[0].tolist()
    return Place(kind="marker", id="start", x=at.x, y=at.y, lat=lat, lon=lon)


def _marker_names(points: Sequence[PointFeature], markers: Mapping[str, Place]) -> Iterator[tuple[str, str]]:
    """Yield the kind of each marker whose name says something else than its kind, and the name."""
    named: set[str] = set()
    for p in points:
        name = str(p.properties.get("name") or p.own_id or "").strip()
        known = p.kind not in markers or p.kind in named
        if not known and name and name.isprintable() and len(name) <= _LONGEST_MARKER_NAME and name.lower() != p.kind:
            named.add(p.kind)
            yield p.kind, name


def _zones(areas: Sequence[AreaFeature], projection: Projection, faults: Faults) -> tuple[Zone, ...]:
    zones: list[Zone] = []
    unnamed = 0
    for area in areas:
        rings = [projection.metres([lat for _, lat in ring], [lon for lon, _ in ring]) for ring in area.rings]
        polygon = shapely.Polygon(rings[0], rings[1:])
        if not polygon.is_valid or polygon.area <= 0.0:
            faults.add(
                area.feature,
                f"its polygon crosses or touches itself ({_where_invalid(polygon, projection)})",
                "redraw it so that its edges do not cross",
                needed=area.kind != "zone",
            )
            continue
        unnamed += not area.name
        zones.append(Zone(name=area.name[:80] or f"zone {unnamed}", kind=area.kind, polygon=polygon))
    return tuple(zones)


def _where_invalid(polygon: shapely.Polygon, projection: Projection) -> str:
    reason = shapely.is_valid_reason(polygon)
    words, _, spot = reason.partition("[")
    try:
        east, north = (float(v) for v in spot.rstrip("]").split()[:2])
    except ValueError:
        return "it encloses no area" if polygon.is_valid else words.lower()
    lat, lon = projection.degrees([[east, north]])[0]
    return f"{words.lower()} near latitude {lat:.6f}, longitude {lon:.6f}"


def _notes(features: FeatureSet, faults: Faults) -> list[str]:
    notes: list[str] = []
    if features.closed:
        notes.append(f"a polygon that was not closed was closed: {numbered(faults.unit, features.closed)}")
    unnamed = Counter(p.word.lower()[:30] for p in features.points if p.kind == "landmark" and not is_named(p))
    if unnamed:
        listing = ", ".join(f"{n} x {word}" for word, n in unnamed.most_common(5))
        notes.append(f"points that are neither trees nor named were left out: {listing}")
    if features.lines:
        notes.append(
            f"{features.lines} line{'s' * (features.lines > 1)} left out: the only lines used are barriers"
            " that no robot crosses (a fence, a ditch)"
        )
    if features.heights:
        notes.append(
            f"heights are not used ({features.heights} {faults.unit}{'s' * (features.heights > 1)} "
            f"{'have' if features.heights > 1 else 'has'} them)"
        )
    return notes


def _site_name(name: str, at: str) -> str:
    """Return the name of a site.

    Raises:
        SiteError: The name contains an invisible character.
    """
    try:
        return readable(name.strip(), "name")[:100]
    except UnusableFeature as fault:
        raise SiteError(fault.what, where=at, advice="correct the name in the file, or the name of the file") from None


def _no_trees(features: FeatureSet, at: str, *, left_out: bool = False) -> SiteError:
    if left_out:
        what = "none of its trees can be used"
    elif not features.points:
        what = "it has no points, no boundary and no zone"
    else:
        what = "it has no trees, only markers and landmarks"
    return SiteError(what, where=at, advice="a site needs at least one tree, given as a Point, or a boundary or a zone")
