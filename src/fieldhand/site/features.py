"""Validate the features of a site file and sort them into points, areas and barriers."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import count
from typing import Any, NoReturn

from fieldhand.hidden_characters import find_hidden, visible
from fieldhand.site.feature_kinds import (
    PointKind,
    ZoneKind,
    area_kind,
    barrier_name,
    is_derived,
    number_text,
    point_kind,
    text_of,
)
from fieldhand.site.formats.faults import Faults, UnusableFeature
from fieldhand.site.formats.records import SiteRecords, UnusablePart
from fieldhand.terms import Value

_LONGEST_KEY = 100
_LONGEST_ID = 64
#: Whole numbers below this are exact as float.
_SAFE = 1 << 53
_GATE_KEYS = ("width m", "width", "gate width m", "gate width", "opening m", "opening")
_METRES = re.compile(r"\s*(\d+(?:\.\d+)?)\s*(?:m|metres?|meters?)?\s*", re.IGNORECASE)
USUAL_GATE_M = 4.0

LonLat = tuple[float, float]
Ring = list[LonLat]


@dataclass(slots=True, kw_only=True)
class PointFeature:
    """A point in degrees; a MultiPoint yields several.

    Attributes:
        own_id: Property ``id``, else the id of the feature; empty if neither is printable and short enough to type.
        feature_id: The ``id`` member of the feature.
    """

    feature: int
    kind: PointKind
    word: str
    lon: float
    lat: float
    properties: Mapping[str, Value]
    own_id: str
    feature_id: str


@dataclass(frozen=True, kw_only=True)
class AreaFeature:
    """A polygon in degrees: its outer ring, then its holes."""

    feature: int
    kind: ZoneKind
    name: str
    rings: tuple[Ring, ...]


@dataclass(frozen=True, kw_only=True)
class BarrierFeature:
    """A line in degrees that no robot may cross."""

    feature: int
    name: str
    positions: Ring


@dataclass(kw_only=True)
class FeatureSet:
    """The features of a file, in file order.

    Attributes:
        lines: Number of ignored lines, which are neither barriers nor derived from the trees.
        heights: Number of features with heights, which are ignored.
        closed: Numbers of the features with a ring that the reader closed.
    """

    points: list[PointFeature] = field(default_factory=list)
    areas: list[AreaFeature] = field(default_factory=list)
    barriers: list[BarrierFeature] = field(default_factory=list)
    lines: int = 0
    heights: int = 0
    closed: list[int] = field(default_factory=list)


def parse_features(records: SiteRecords, faults: Faults) -> FeatureSet:
    """Sort the features into points, areas and barriers; report unusable ones to ``faults``."""
    features = FeatureSet()
    reader = _FeatureReader(features, lenient=faults.lenient)
    for number, feature in zip(records.numbers or count(1), records.features, strict=False):
        try:
            reader.read(number, feature)
        except UnusableFeature as fault:
            faults.add(number, fault.what, fault.advice, needed=_keeps_out(feature))
    features.heights = len(reader.high)
    return features


def readable(text: str, what: str) -> str:
    """Return the text of a feature on one line.

    Args:
        text: Text from the file; line ends and tabs become spaces.
        what: Name of the text in error messages.

    Raises:
        UnusableFeature: The text contains an invisible character.
    """
    if text.isprintable() and text.isascii():
        return text
    flat = re.sub(r"[\t\r\n]+", " ", text)
    hidden = find_hidden(flat)
    if hidden is not None:
        _fail(f"its {what} contains the invisible character {hidden.name}", "remove it from the file")
    return flat


def gate_width_m(properties: Mapping[str, Value]) -> float:
    """Return the width of a gate in metres, or the usual one if the file gives none.

    Raises:
        UnusableFeature: The width is not a number of metres from 0.1 to 100.
    """
    width_text = text_of(properties, _GATE_KEYS)
    if not width_text:
        return USUAL_GATE_M
    match = _METRES.fullmatch(width_text.replace(",", "."))
    width = float(match[1]) if match else math.nan
    if not 0.1 <= width <= 100.0:
        raise UnusableFeature(f"its width is {_shown(width_text)}", "write it in metres, from 0.1 to 100, as width_m")
    return width


def _keeps_out(feature: Any) -> bool:
    """Return True if an unreadable feature is meant as a keep-out, a barrier or the boundary."""
    known = isinstance(feature, dict)
    properties = feature.get("properties") if known else getattr(feature, "properties", None)
    if not isinstance(properties, Mapping):
        return False
    texts = {k: v for k, v in properties.items() if isinstance(v, str | bool)}
    geometry = feature.get("geometry") if known else None
    kind = str(geometry.get("type", "")) if isinstance(geometry, dict) else ""
    if "Point" in kind:
        return False
    return area_kind(texts)[0] != "zone" or bool(barrier_name(texts))


class _FeatureReader:
    """Reader that adds features to ``features``; equal property names and texts are stored only once."""

    def __init__(self, features: FeatureSet, *, lenient: bool) -> None:
        self._into = features
        self._lenient = lenient
        self._number = 0
        self._keys: dict[str, str] = {}
        self._texts: dict[str, str] = {}
        self.high: set[int] = set()

    def read(self, number: int, feature: Any) -> None:
        self._number = number
        if isinstance(feature, UnusablePart):
            _fail(feature.what, feature.advice)
        if not isinstance(feature, dict) or feature.get("type") != "Feature":
            _fail("it is not a GeoJSON Feature", 'every entry of "features" needs "type": "Feature"')
        geometry, raw = feature.get("geometry"), feature.get("properties")
        if not isinstance(geometry, dict):
            _fail("it has no geometry", "give it a Point or a Polygon, or remove it")
        if raw is None:
            raw = {}
        if not isinstance(raw, dict):
            _fail("its properties are not an object", 'write "properties": {"name": value, ...} or null')
        kind, coordinates = geometry.get("type"), geometry.get("coordinates")
        match kind:
            case "Point":
                self._points([coordinates], raw, feature)
            case "MultiPoint":
                self._points(_listed(coordinates), raw, feature)
            case "Polygon":
                self._areas([coordinates], raw)
            case "MultiPolygon":
                self._areas(_listed(coordinates), raw)
            case "LineString":
                self._lines([coordinates], raw)
            case "MultiLineString":
                self._lines(_listed(coordinates), raw)
            case "GeometryCollection" if isinstance(geometry.get("geometries"), list):
                for part in geometry["geometries"]:
                    if isinstance(part, dict) and part.get("type") == "GeometryCollection":
                        _fail("its geometries are nested", "use one geometry per feature")
                    self.read(number, {**feature, "geometry": part})
            case _:
                _fail(
                    f"a geometry of type {_shown(kind)} cannot be used",
                    "use Point, MultiPoint, Polygon or MultiPolygon, one geometry per feature",
                )

    def _points(self, positions: list[Any], raw: Mapping[str, Any], feature: Mapping[str, Any]) -> None:
        properties = self._scalars(raw)
        what, word = point_kind(properties)
        feature_id = feature.get("id")
        feature_text = "" if feature_id is None else _id_text(feature_id)
        own = raw.get("id")
        own_text = feature_text if own is None else _id_text(own)
        if what == "gate":
            gate_width_m(properties)
        degrees = [self._position(p) for p in positions]
        for lon, lat in degrees:
            self._into.points.append(
                PointFeature(
                    feature=self._number,
                    kind=what,
                    word=word,
                    lon=lon,
                    lat=lat,
                    properties=properties,
                    own_id=own_text,
                    feature_id=feature_text,
                )
            )

    def _areas(self, polygons: list[Any], raw: Mapping[str, Any]) -> None:
        zone, name = area_kind(self._scalars(raw))
        every = [tuple(self._ring(ring) for ring in _listed(polygon)) for polygon in polygons]
        self._into.areas.extend(AreaFeature(feature=self._number, kind=zone, name=name, rings=rings) for rings in every)

    def _lines(self, lines: list[Any], raw: Mapping[str, Any]) -> None:
        texts = {k: v for k, v in raw.items() if isinstance(v, str)}
        name = readable(barrier_name(texts), "name")
        if not name:
            self._into.lines += not is_derived(texts)
            return
        every = [[self._position(p) for p in _listed(line)] for line in lines]
        if any(len(set(line)) < 2 for line in every):
            _fail("its line has fewer than 2 different positions", "draw it from one end to the other")
        self._into.barriers.extend(BarrierFeature(feature=self._number, name=name, positions=line) for line in every)

    def _scalars(self, raw: Mapping[str, Any]) -> dict[str, Value]:
        """Return the texts, numbers (as float) and booleans by name; nested values and nulls are left out."""
        kept: dict[str, Value] = {}
        keys, texts = self._keys, self._texts
        for name, value in raw.items():
            key = keys.get(name)
            if key is None:
                key = keys[name] = readable(name, f"property {_shown(name)}")[:_LONGEST_KEY]
            kind = type(value)
            if (kind is float and value - value == 0.0) or (kind is int and -_SAFE < value < _SAFE):
                kept[key] = float(value)
            elif kind is str:
                known = texts.get(value)
                if known is None:
                    known = readable(value, key)
                    if len(texts) < 10_000:
                        texts[value] = known
                kept[key] = known
            elif kind is bool:
                kept[key] = value
            elif isinstance(value, int | float):
                kept[key] = _number(value, f"property {_shown(name)}")
        return kept

    def _position(self, value: Any) -> LonLat:
        """Return longitude and latitude; a height is ignored."""
        if not isinstance(value, list) or len(value) < 2:
            held = f"are {_shown(value)}"
            if isinstance(value, list):
                held = f"contain {('nothing', 'only one number')[len(value)]}"
            _fail(f"its coordinates {held}", "write them as [longitude, latitude] in degrees")
        if len(value) > 2:
            self.high.add(self._number)
        lon, lat = value[0], value[1]
        if type(lon) is not float or type(lat) is not float:
            lon, lat = _number(lon, "its longitude"), _number(lat, "its latitude")
        if not (-180.0 <= lon <= 180.0 and -90.0 <= lat <= 90.0):
            _out_of_range(_number(lon, "its longitude"), _number(lat, "its latitude"))
        return lon, lat

    def _ring(self, value: Any) -> Ring:
        positions = [self._position(p) for p in _listed(value)]
        if positions[0] != positions[-1] and self._lenient and len(positions) > 2:
            positions.append(positions[0])
            self._into.closed.append(self._number)
        if len(positions) < 4:
            _fail(
                f"its polygon has {len(positions)} positions",
                "a ring needs at least 4, the last equal to the first",
            )
        if positions[0] != positions[-1]:
            _fail("its polygon is not closed", "repeat the first position at the end")
        return positions


def _fail(what: str, advice: str) -> NoReturn:
    raise UnusableFeature(what, advice)


def _out_of_range(lon: float, lat: float) -> NoReturn:
    if abs(lon) <= 90.0 and abs(lat) <= 180.0:
        _fail(
            f"its latitude would be {lat:g}: latitude and longitude seem to be swapped",
            f"write [longitude, latitude]: [{lat:g}, {lon:g}]",
        )
    _fail(
        f"its coordinates [{lon:g}, {lat:g}] are out of range",
        "give longitude (-180 to 180) and latitude (-90 to 90) in degrees, WGS 84 (EPSG:4326)",
    )


def _number(value: Any, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        _fail(f"{what} is {_shown(value)}", "a number is needed, without quotation marks")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        _fail(f"{what} is not a finite number (NaN or infinite)", "correct or remove it")
    return number


def _listed(value: Any) -> list[Any]:
    if not isinstance(value, list) or not value:
        _fail("its coordinates are missing or not a list", "write them as the GeoJSON standard (RFC 7946) does")
    return value


def _id_text(value: Any) -> str:
    """Return the id as text; empty if it is not printable or too long to type."""
    if isinstance(value, str):
        readable(value, "id")
        return value.strip() if value.isprintable() and len(value) <= _LONGEST_ID else ""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return ""
    return number_text(float(value)) if abs(value) < 1e15 else ""


def _shown(value: Any) -> str:
    text = visible(repr(value)) if not isinstance(value, list | dict) else type(value).__name__
    return text if len(text) <= 60 else text[:57] + "..."
