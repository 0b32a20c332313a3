"""The features of a GeoJSON document, read with care: every fault names its feature and says what to do."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NoReturn

from fieldhand.errors import SiteError
from fieldhand.site.kinds import PointKind, area_kind, number_text, point_kind
from fieldhand.site.model import ZoneKind
from fieldhand.task.selectors import Value

_LONGEST_KEY = 100
_LONGEST_ID = 64
_LINES = ("LineString", "MultiLineString")

Ring = list[tuple[float, float]]


@dataclass(frozen=True, kw_only=True)
class PointFeature:
    """One point in degrees; several of them come from one MultiPoint."""

    feature: int
    kind: PointKind
    word: str
    lon: float
    lat: float
    properties: Mapping[str, Value]
    own_id: str


@dataclass(frozen=True, kw_only=True)
class AreaFeature:
    """One polygon in degrees: its outer ring, then its holes."""

    feature: int
    kind: ZoneKind
    name: str
    rings: tuple[Ring, ...]


@dataclass(kw_only=True)
class Gathered:
    """What the features of a file hold, in their order."""

    points: list[PointFeature] = field(default_factory=list)
    areas: list[AreaFeature] = field(default_factory=list)
    lines: int = 0


def gather(features: Sequence[Any], source: str) -> Gathered:
    """Sort the features into points, areas and lines.

    Lines are counted and left out: a robot can neither visit nor be kept inside a line.

    Raises:
        SiteError: A feature is no feature, or its geometry or a property cannot be used.
    """
    gathered = Gathered()
    for number, feature in enumerate(features, start=1):
        reader = _Reader(source, number)
        kind, coordinates, raw, own_id = reader.parts(feature)
        if kind in _LINES:
            gathered.lines += 1
            continue
        properties = reader.scalars(raw)
        if kind in ("Polygon", "MultiPolygon"):
            zone, name = area_kind(properties)
            for polygon in [coordinates] if kind == "Polygon" else reader.listed(coordinates):
                rings = tuple(reader.ring(ring) for ring in reader.listed(polygon))
                gathered.areas.append(AreaFeature(feature=number, kind=zone, name=name, rings=rings))
            continue
        what, word = point_kind(properties)
        for position in [coordinates] if kind == "Point" else reader.listed(coordinates):
            lon, lat = reader.position(position)
            gathered.points.append(
                PointFeature(
                    feature=number, kind=what, word=word, lon=lon, lat=lat, properties=properties, own_id=own_id
                )
            )
    return gathered


def clean(text: str) -> str:
    """Text that can be printed and written to XML: line breaks, control characters and lone surrogates replaced."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else " " for c in text)


class _Reader:
    """Reads one feature; knows where it stands for the messages."""

    def __init__(self, source: str, number: int) -> None:
        self._source = source
        self._number = number

    def fail(self, what: str, advice: str) -> NoReturn:
        raise SiteError(what, where=f"{self._source}, feature {self._number}", advice=advice)

    def parts(self, feature: Any) -> tuple[str, Any, Mapping[str, Any], str]:
        """Geometry type, coordinates, properties and the feature's own id."""
        if not isinstance(feature, dict) or feature.get("type") != "Feature":
            self.fail("it is not a GeoJSON Feature", 'every entry of "features" needs "type": "Feature"')
        geometry, properties = feature.get("geometry"), feature.get("properties")
        if not isinstance(geometry, dict):
            self.fail("it has no geometry", "give it a Point or a Polygon, or take it out")
        kind = geometry.get("type")
        if kind not in ("Point", "MultiPoint", "Polygon", "MultiPolygon", *_LINES):
            self.fail(
                f"a geometry of type {_shown(kind)} cannot be used",
                "use Point, MultiPoint, Polygon or MultiPolygon, one geometry a feature",
            )
        if properties is None:
            properties = {}
        if not isinstance(properties, dict):
            self.fail("its properties are not an object", 'write "properties": {"name": value, ...} or null')
        own = properties.get("id", feature.get("id"))
        return kind, geometry.get("coordinates"), properties, _id_text(own)

    def scalars(self, properties: Mapping[str, Any]) -> Mapping[str, Value]:
        """Text, numbers (as float) and booleans by name; nested values and nulls are left out."""
        kept: dict[str, Value] = {}
        for key, value in properties.items():
            if isinstance(value, str):
                kept[clean(key)[:_LONGEST_KEY]] = clean(value)
            elif isinstance(value, bool):
                kept[clean(key)[:_LONGEST_KEY]] = value
            elif isinstance(value, int | float):
                kept[clean(key)[:_LONGEST_KEY]] = self.number(value, f"property {_shown(key)}")
        return kept

    def number(self, value: Any, what: str) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(f"{what} is {_shown(value)}", "a number is needed, without quotation marks")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            self.fail(f"{what} is not a finite number (NaN or infinite)", "correct it or take it out")
        return number

    def listed(self, value: Any) -> list[Any]:
        if not isinstance(value, list) or not value:
            self.fail("its coordinates are missing or not a list", "write them as the GeoJSON standard (RFC 7946) does")
        return value

    def position(self, value: Any) -> tuple[float, float]:
        """Longitude and latitude; a height is read over."""
        if not isinstance(value, list) or len(value) < 2:
            self.fail(f"its coordinates are {_shown(value)}", "write them as [longitude, latitude] in degrees")
        lon, lat = self.number(value[0], "its longitude"), self.number(value[1], "its latitude")
        if not (-180.0 <= lon <= 180.0 and -90.0 <= lat <= 90.0):
            if abs(lon) <= 90.0 and abs(lat) <= 180.0:
                self.fail(
                    f"its latitude would be {lat:g}: latitude and longitude seem to be swapped",
                    f"write [longitude, latitude]: [{lat:g}, {lon:g}]",
                )
            self.fail(
                f"its coordinates [{lon:g}, {lat:g}] are out of range",
                "give longitude (-180 to 180) and latitude (-90 to 90) in degrees, WGS 84 (EPSG:4326)",
            )
        return lon, lat

    def ring(self, value: Any) -> Ring:
        positions = [self.position(p) for p in self.listed(value)]
        if len(positions) < 4:
            self.fail(
                f"its polygon has {len(positions)} positions", "a closed ring needs at least 4, the last like the first"
            )
        if positions[0] != positions[-1]:
            self.fail("its polygon is not closed", "repeat the first position at the end")
        return positions


def _id_text(value: Any) -> str:
    """The id as text; empty where there is none that can be shown and typed."""
    if isinstance(value, bool):
        return ""
    if isinstance(value, int | float):
        return number_text(float(value)) if abs(value) < 1e15 else ""
    if isinstance(value, str) and value.isprintable() and len(value) <= _LONGEST_ID:
        return value.strip()
    return ""


def _shown(value: Any) -> str:
    text = clean(repr(value)) if not isinstance(value, list | dict) else type(value).__name__
    return text if len(text) <= 60 else text[:57] + "..."
