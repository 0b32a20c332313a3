"""A site from a GeoJSON file: points become trees and markers, polygons become boundary, keep-outs and named zones."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from fieldhand.errors import SiteError
from fieldhand.site.features import AreaFeature, Gathered, PointFeature, clean, gather
from fieldhand.site.kinds import row_of
from fieldhand.site.model import Place, Site, Tree, Zone
from fieldhand.site.projection import Projection

MAX_BYTES = 200_000_000
MAX_EXTENT_M = 20_000.0
_EARTH_RADIUS_M = 6_371_000.0
_DEGREES_CRS = ("crs84", "4326")


def demo_path() -> Path:
    """The file of the built-in orchard."""
    return Path(str(resources.files("fieldhand.site") / "data" / "demo.geojson"))


def load_demo() -> Site:
    """The built-in orchard."""
    return load_site(demo_path())


def open_site(name_or_path: str) -> Site:
    """The built-in orchard for ``demo``, else the site of that file (``./demo`` for a file of that name).

    Raises:
        SiteError: The file cannot be read or used; see :func:`load_site`.
    """
    return load_demo() if name_or_path == "demo" else load_site(Path(name_or_path))


def load_site(path: Path) -> Site:
    """Read a site from a GeoJSON file.

    Raises:
        SiteError: The file is missing, no file, too big, or does not hold a site; see :func:`parse_site`.
    """
    where = clean(str(path))
    try:
        if not path.is_file():
            if path.exists():
                raise SiteError("this is not a file", where=where, advice="give the GeoJSON file itself")
            raise SiteError(
                "there is no such file",
                where=where,
                advice="check the path, or use 'demo' for the built-in orchard",
            )
        if path.stat().st_size > MAX_BYTES:
            raise _too_big(where, path.stat().st_size)
        data = path.read_bytes()
    except OSError as fault:
        reason = fault.strerror or type(fault).__name__
        raise SiteError(f"the file cannot be read ({reason})", where=where, advice="check its permissions") from None
    return parse_site(data, name=path.stem, source=str(path))


def parse_site(data: bytes, *, name: str, source: str = "") -> Site:
    """A site from the bytes of a GeoJSON document.

    Args:
        data: A FeatureCollection, UTF-8, in degrees WGS 84.
        name: The site's name where the document has no ``name`` of its own.
        source: Where the bytes came from, for messages.

    Raises:
        SiteError: The document cannot be used; the message names the source, the feature (counted from 1) and what
            to do.
    """
    at = source or name
    document = _document(data, at)
    gathered = gather(_features(document, at), at)
    planted = [p for p in gathered.points if p.kind == "tree"]
    if not planted:
        raise _no_trees(gathered, at)
    _check_extent(planted, gathered, at)
    projection = _projection(planted)
    zones = _zones(gathered.areas, projection, at)
    own_name = document.get("name")
    site = Site(
        name=clean(own_name.strip())[:100] if isinstance(own_name, str) and own_name.strip() else name,
        trees=_trees(planted, projection),
        markers=_markers([p for p in gathered.points if p.kind not in ("tree", "landmark")], projection, at),
        zones=zones,
        projection=projection,
        sha256=hashlib.sha256(data).hexdigest(),
        source=source,
        notes=_notes(gathered, planted),
    )
    _check_markers(site, gathered, at)
    return site


def _document(data: bytes, at: str) -> Mapping[str, Any]:
    if len(data) > MAX_BYTES:
        raise _too_big(at, len(data))
    if not data.strip():
        raise SiteError("the file is empty", where=at, advice="give a GeoJSON FeatureCollection")
    try:
        document = json.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as fault:
        raise SiteError(
            f"the file is not UTF-8 text (byte {fault.start + 1})", where=at, advice="save it as GeoJSON in UTF-8"
        ) from None
    except json.JSONDecodeError as fault:
        raise SiteError(
            f"the file is not JSON: {fault.msg}",
            where=f"{at}, line {fault.lineno}",
            advice="export it again as GeoJSON",
        ) from None
    except RecursionError:
        raise SiteError("the file is nested too deeply", where=at, advice="export it again as GeoJSON") from None
    except ValueError:
        raise SiteError(
            "a number in the file has thousands of digits", where=at, advice="export it again as GeoJSON"
        ) from None
    if not isinstance(document, dict):
        raise SiteError(
            "this is JSON, but not GeoJSON", where=at, advice='give an object of "type": "FeatureCollection"'
        )
    return document


def _features(document: Mapping[str, Any], at: str) -> Sequence[Any]:
    kind, features = document.get("type"), document.get("features")
    if kind != "FeatureCollection" or not isinstance(features, list):
        what = f"it is one {kind}" if kind in ("Feature", "Point", "Polygon", "MultiPoint") else "it is not GeoJSON"
        raise SiteError(
            f"{what}, not a FeatureCollection",
            where=at,
            advice='give an object with "type": "FeatureCollection" and a list "features"',
        )
    named = document.get("crs")
    crs = str(named.get("properties", "")).lower() if isinstance(named, dict) else ""
    if crs and not any(known in crs for known in _DEGREES_CRS):
        raise SiteError("its coordinates are not WGS 84", where=at, advice="export it as WGS 84 (EPSG:4326)")
    return features


def _check_extent(planted: Sequence[PointFeature], gathered: Gathered, at: str) -> None:
    """Everything within 20 km of the middle tree: what is farther is stray, or has its coordinates swapped."""
    numbers = [p.feature for p in gathered.points]
    degrees = [(p.lon, p.lat) for p in gathered.points]
    for area in gathered.areas:
        for ring in area.rings:
            numbers.extend([area.feature] * len(ring))
            degrees.extend(ring)
    middle = np.median(_unwrapped(np.array([(p.lon, p.lat) for p in planted])), axis=0)
    away = _great_circle_m(np.array(degrees), middle)
    worst = int(np.argmax(away))
    if away[worst] <= MAX_EXTENT_M:
        return
    lon, lat = degrees[worst]
    swapped = abs(lon) <= 90 and _great_circle_m(np.array([(lat, lon)]), middle)[0] <= MAX_EXTENT_M
    raise SiteError(
        f"it lies {away[worst] / 1000:,.0f} km from the middle of the trees"
        + (": its latitude and longitude are swapped" if swapped else ""),
        where=f"{at}, feature {numbers[worst]}",
        advice="write [longitude, latitude]"
        if swapped
        else "correct its coordinates [longitude, latitude] or take it out",
    )


def _unwrapped(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Longitudes without the jump from 180 to -180, for sites across the date line."""
    out = degrees.copy()
    if np.ptp(out[:, 0]) > 180.0:
        out[out[:, 0] < 0.0, 0] += 360.0
    return out


def _great_circle_m(degrees: NDArray[np.float64], middle: NDArray[np.float64]) -> NDArray[np.float64]:
    lon, lat = np.radians(degrees[:, 0]), np.radians(degrees[:, 1])
    lon0, lat0 = np.radians(middle)
    h = np.sin((lat - lat0) / 2) ** 2 + np.cos(lat) * np.cos(lat0) * np.sin((lon - lon0) / 2) ** 2
    return np.asarray(2 * _EARTH_RADIUS_M * np.arcsin(np.sqrt(np.clip(h, 0.0, 1.0))), dtype=np.float64)


def _projection(planted: Sequence[PointFeature]) -> Projection:
    degrees = _unwrapped(np.array([(p.lon, p.lat) for p in planted]))
    lon, lat = (degrees.min(axis=0) + degrees.max(axis=0)) / 2
    return Projection(lat=float(lat), lon=float((lon + 180.0) % 360.0 - 180.0))


def _places(points: Sequence[PointFeature], projection: Projection) -> NDArray[np.float64]:
    if not points:
        return np.empty((0, 2))
    return projection.metres([p.lat for p in points], [p.lon for p in points])


def _trees(planted: Sequence[PointFeature], projection: Projection) -> tuple[Tree, ...]:
    """Ids are the file's own if every tree has one and all differ, else the position among the trees from 1."""
    own = [p.own_id for p in planted]
    ids = own if all(own) and len(set(own)) == len(own) else [str(k) for k in range(1, len(own) + 1)]
    metres = _places(planted, projection).tolist()
    return tuple(
        Tree(
            place=Place(kind="tree", id=tree_id, x=x, y=y, lat=p.lat, lon=p.lon),
            index=index,
            feature=p.feature,
            properties=p.properties,
            row=row_of(p.properties),
        )
        for index, (p, tree_id, (x, y)) in enumerate(zip(planted, ids, metres, strict=True))
    )


def _markers(points: Sequence[PointFeature], projection: Projection, at: str) -> Mapping[str, Place]:
    markers: dict[str, Place] = {}
    numbers: dict[str, int] = {}
    for p, (x, y) in zip(points, _places(points, projection).tolist(), strict=True):
        if p.kind in markers:
            raise SiteError(
                f"it is a second {p.kind} marker (the first is feature {numbers[p.kind]})",
                where=f"{at}, feature {p.feature}",
                advice="keep one of them",
            )
        numbers[p.kind] = p.feature
        markers[p.kind] = Place(kind="marker", id=p.kind, x=x, y=y, lat=p.lat, lon=p.lon)
    return markers


def _zones(areas: Sequence[AreaFeature], projection: Projection, at: str) -> tuple[Zone, ...]:
    zones: list[Zone] = []
    unnamed = 0
    for area in areas:
        rings = [projection.metres([lat for _, lat in ring], [lon for lon, _ in ring]) for ring in area.rings]
        polygon = Polygon(rings[0], rings[1:])
        if not polygon.is_valid or polygon.area <= 0.0:
            raise SiteError(
                f"its polygon crosses or touches itself ({_where_invalid(polygon, projection)})",
                where=f"{at}, feature {area.feature}",
                advice="redraw it so that its edges do not cross",
            )
        unnamed += not area.name
        zones.append(Zone(name=area.name[:80] or f"zone {unnamed}", kind=area.kind, polygon=polygon))
    return tuple(zones)


def _where_invalid(polygon: Polygon, projection: Projection) -> str:
    reason = shapely.is_valid_reason(polygon)
    words, _, spot = reason.partition("[")
    try:
        east, north = (float(v) for v in spot.rstrip("]").split()[:2])
    except ValueError:
        return "it encloses no area" if polygon.is_valid else words.lower()
    lat, lon = projection.degrees([[east, north]])[0]
    return f"{words.lower()} near latitude {lat:.6f}, longitude {lon:.6f}"


def _check_markers(site: Site, gathered: Gathered, at: str) -> None:
    """A marker that no robot may stand on makes every mission impossible."""
    numbers = {p.kind: p.feature for p in gathered.points}
    boundaries = [z.polygon for z in site.zones_of("boundary")]
    for name, place in site.markers.items():
        where = f"{at}, feature {numbers[name]}"  # type: ignore[index]
        for zone in site.zones_of("keep_out"):
            if shapely.contains_xy(zone.polygon, place.x, place.y):
                raise SiteError(
                    f"the {name} marker lies inside the keep-out {zone.name!r}", where=where, advice="move one of them"
                )
        if boundaries and not any(shapely.intersects_xy(b, place.x, place.y) for b in boundaries):
            raise SiteError(f"the {name} marker lies outside the boundary", where=where, advice="move one of them")


def _notes(gathered: Gathered, planted: Sequence[PointFeature]) -> tuple[str, ...]:
    notes: list[str] = []
    landmarks = Counter(p.word.lower()[:30] for p in gathered.points if p.kind == "landmark")
    if landmarks:
        said = ", ".join(f"{n} x {word}" for word, n in landmarks.most_common(5))
        notes.append(f"points that are no trees were left out: {said}")
    if gathered.lines:
        notes.append(f"{gathered.lines} line{'s' * (gathered.lines > 1)} left out: only points and areas are used")
    own = [p.own_id for p in planted]
    if any(own) and not (all(own) and len(set(own)) == len(own)):
        notes.append("the trees' own ids are not complete or not unique, so trees are numbered in file order from 1")
    twice = len(planted) - len({(p.lon, p.lat) for p in planted})
    if twice:
        notes.append(
            f"{twice} of the trees {'stand' if twice > 1 else 'stands'} where another does, so probably entered twice"
        )
    return tuple(notes)


def _no_trees(gathered: Gathered, at: str) -> SiteError:
    if not gathered.points:
        return SiteError("it has no points", where=at, advice="a site needs at least one tree, given as a Point")
    return SiteError(
        "it has no trees, only markers and landmarks",
        where=at,
        advice="a site needs at least one tree, given as a Point",
    )


def _too_big(at: str, size: int) -> SiteError:
    return SiteError(
        f"the file has {size / 1e6:,.0f} MB, more than {MAX_BYTES / 1e6:,.0f} MB",
        where=at,
        advice="cut the site into smaller ones",
    )
