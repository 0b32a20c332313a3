"""Site model: trees, markers, zones and gates, in degrees and in local metres.

Metres are east (x) and north (y) in one projection per site, whose origin is the middle of the trees.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import Polygon

from fieldhand.short_repr import short_repr
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.feature_kinds import ZoneKind
from fieldhand.site.planting import Planting
from fieldhand.site.projection import Projection
from fieldhand.terms import Side, Value

#: Sample size for the median tree spacing; the median of this many trees differs from that of all by about 1 mm.
_ENOUGH_TREES = 5_000

PlaceKind = Literal["tree", "marker", "point", "gap"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A position that a robot can be sent to: a tree, a marker, a free point or an empty position of a row.

    Attributes:
        id: Id of the tree, name of the marker, name of the point or of the gap.
        x, y: Metres east and north in the site's projection.
        lat, lon: Degrees, WGS 84.
        stand: Position from which the robot works on the place, in metres; None until :mod:`fieldhand.site.drives`
            chooses it. A robot works on a tree, or on the gap that a missing one left, from the aisle beside it.
        side: Side of the tree on which the stand has to lie; empty for any.
    """

    kind: PlaceKind
    id: str
    x: float
    y: float
    lat: float
    lon: float
    stand: tuple[float, float] | None = field(default=None, compare=False)
    side: Side | Literal[""] = ""

    @classmethod
    def of_robot(cls, xy: tuple[float, float], *, lat: float, lon: float, name: str = "on the way") -> Place:
        """Return the position of a robot as a place, by default between two stops.

        Args:
            xy: Metres east and north in the site's projection.
            lat, lon: The same position in degrees, WGS 84.
            name: Name of the place.
        """
        return cls(kind="point", id=name, x=xy[0], y=xy[1], lat=lat, lon=lon, stand=xy)

    @property
    def xy(self) -> tuple[float, float]:
        """Metres east and north."""
        return (self.x, self.y)

    @property
    def key(self) -> tuple[str, str, str]:
        """Kind, id and side, which identify the place on its site."""
        return (self.kind, self.id, self.side)

    def serves(self, wanted: Place) -> bool:
        """Return True if a robot that has stopped at this place is at the wanted one: the same, on a side that fits."""
        return (self.kind, self.id) == (wanted.kind, wanted.id) and self._suits(wanted)

    def covers(self, wanted: Place) -> bool:
        """Return True if the wanted place has the same position, and this one a side that fits: no drive is needed."""
        return self.xy == wanted.xy and self._suits(wanted)

    def _suits(self, wanted: Place) -> bool:
        return wanted.side in ("", self.side)

    @property
    def planted(self) -> bool:
        """True for a tree or a gap, which are worked on from one of several stands."""
        return self.kind in ("tree", "gap")


@dataclass(frozen=True, slots=True, kw_only=True)
class Tree:
    """A tree (or vine, or plant) with its properties from the file.

    Attributes:
        index: Index among the site's trees, from 0, and into :attr:`Site.xy`.
        feature: Number of the feature in the file (in a table, of the line), from 1, for error messages.
        row: Name of the row if the file gives one, else empty.
    """

    place: Place
    index: int
    feature: int
    properties: Mapping[str, Value] = field(default_factory=dict)
    row: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.properties, MappingProxyType):
            object.__setattr__(self, "properties", MappingProxyType(dict(self.properties)))

    def __reduce__(self) -> tuple[object, ...]:
        return _tree, (self.place, self.index, self.feature, dict(self.properties), self.row)


def _tree(place: Place, index: int, feature: int, properties: dict[str, Value], row: str) -> Tree:
    return Tree(place=place, index=index, feature=feature, properties=properties, row=row)


@dataclass(frozen=True, kw_only=True)
class Zone:
    """A polygon of the site, in local metres."""

    name: str
    kind: ZoneKind
    polygon: Polygon


@dataclass(frozen=True, kw_only=True)
class Gate:
    """An opening in a fence, through which a robot passes from one fenced part of the site to the next.

    Attributes:
        width_m: Width of the opening along the fence, in metres.
    """

    place: Place
    width_m: float


@dataclass(frozen=True, kw_only=True, repr=False)
class Site:
    """A site, immutable.

    Attributes:
        name: Name of the FeatureCollection, else the file name without its extension.
        sha256: SHA-256 of the bytes that the site was read from; an approval refers to it.
        source: Path or name of the input, for messages.
        gates: Openings in fences.
        marker_names: Kind of a marker and the name that the file gives it, such as ("start", "barn").
        earlier: What earlier missions did here (:meth:`with_earlier`); None if it is not given. It is not part of the
            site file: :attr:`sha256` and :attr:`content_sha256` do not depend on it.
        notes: Sentences about features that the reader left out or interpreted differently from the file.
    """

    name: str
    trees: tuple[Tree, ...]
    markers: Mapping[str, Place]
    zones: tuple[Zone, ...]
    projection: Projection
    sha256: str
    source: str = ""
    notes: tuple[str, ...] = ()
    gates: tuple[Gate, ...] = ()
    marker_names: tuple[tuple[str, str], ...] = ()
    earlier: EarlierMissions | None = field(default=None, compare=False)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if not isinstance(self.markers, MappingProxyType):
            object.__setattr__(self, "markers", MappingProxyType(dict(self.markers)))

    @classmethod
    def read(cls, path: str | Path, *, lenient: bool = False) -> Site:
        """Read a site from a file: GeoJSON, CSV; with the extra ``gis`` Shapefile, GeoPackage, KML, KMZ, or a zip.

        Args:
            path: Path of the file; its extension selects the format.
            lenient: Skip unusable features, with a note for each, instead of rejecting the file.

        Raises:
            SiteError: The file cannot be read or is not a valid site; the message names the faulty features.
        """
        from fieldhand.site.loader import load_site

        return load_site(Path(path), lenient=lenient)

    @classmethod
    def demo(cls) -> Site:
        """Return the built-in synthetic orchard."""
        from fieldhand.site.loader import load_demo

        return load_demo()

    def with_earlier(self, earlier: EarlierMissions | None) -> Site:
        """Return the same site with what earlier missions did here; it shares all computed results with this one."""
        if earlier == self.earlier:
            return self
        self.cache  # noqa: B018  both share the dictionary
        made = object.__new__(Site)
        made.__dict__.update(self.__dict__, earlier=earlier)
        return made

    def __getstate__(self) -> dict[str, object]:
        """Return only the fields; another process computes the cached properties again."""
        return {f.name: getattr(self, f.name) for f in fields(self)} | {"markers": dict(self.markers)}

    def __setstate__(self, state: dict[str, object]) -> None:
        self.__dict__.update(state, markers=MappingProxyType(state["markers"]))  # type: ignore[arg-type]

    def _repr_html_(self) -> str:
        """Return an HTML map and description of the site for a notebook."""
        from fieldhand.site.drawing.notebook import html_of_site

        return html_of_site(self)

    @cached_property
    def content_sha256(self) -> str:
        """Return a SHA-256 of the trees in file order, their properties, the markers, zones and gates.

        It is equal for the same orchard in another file format or layout; :attr:`sha256` is the hash of the file's
        bytes.
        """
        from fieldhand.site.content_hash import content_sha256, rings_of

        trees = [[t.place.id, t.place.lat, t.place.lon, sorted(t.properties.items())] for t in self.trees]
        markers = [[name, place.lat, place.lon] for name, place in self.markers.items()]
        gates = [[g.place.id, g.place.lat, g.place.lon, g.width_m] for g in self.gates]
        zones = [[z.kind, z.name, rings_of(z.polygon)] for z in self.zones]
        return content_sha256(trees, markers, gates, zones)

    @cached_property
    def xy(self) -> NDArray[np.float64]:
        """Return the trees in local metres, shape (n, 2)."""
        xy = np.array([t.place.xy for t in self.trees], dtype=np.float64).reshape(-1, 2)
        xy.flags.writeable = False
        return xy

    @cached_property
    def outline_xy(self) -> NDArray[np.float64]:
        """Return points that span the site, in local metres: the trees, or without any the corners of its areas."""
        if self.trees:
            return self.xy
        return np.vstack([np.array(zone.polygon.exterior.coords) for zone in self.zones if zone.kind != "keep_out"])

    @cached_property
    def planting(self) -> Planting:
        """Return the blocks and rows: those named in the file, else those inferred from the positions of the trees."""
        from fieldhand.site.rows import planting_of

        self.spacing_m  # noqa: B018  computed now, since selectors over rows need it next
        return planting_of(self.xy, [t.row for t in self.trees], [t.properties for t in self.trees])

    @cached_property
    def cache(self) -> dict[object, object]:
        """Return a dictionary in which other modules cache results computed from this site."""
        return {}

    @cached_property
    def by_id(self) -> Mapping[str, Tree]:
        """Return the trees by id."""
        return MappingProxyType({t.place.id: t for t in self.trees})

    @cached_property
    def spacing_m(self) -> float:
        """Return the median distance from a tree to its nearest neighbour, in metres; 5 for a single tree."""
        from fieldhand.site.point_index import PointIndex

        if len(self.trees) < 2:
            return 5.0
        some = self.xy[:: max(1, len(self.trees) // _ENOUGH_TREES)]
        nearest = PointIndex(self.xy).nearest_few(some, 2)[0][:, 1]
        apart = nearest[nearest > 0.01]  # exclude trees entered twice
        return float(np.median(apart)) if apart.size else 5.0

    @cached_property
    def attributes(self) -> Mapping[str, tuple[Value, ...]]:
        """Return each attribute of the trees with its distinct values, sorted within their type."""
        found: dict[str, set[Value]] = {}
        for tree in self.trees:
            for key, value in tree.properties.items():
                found.setdefault(key, set()).add(value)
        return MappingProxyType(
            {key: tuple(sorted(values, key=lambda v: (isinstance(v, str), v))) for key, values in found.items()}
        )

    def zones_of(self, kind: ZoneKind) -> tuple[Zone, ...]:
        """Return the zones of one kind."""
        return tuple(z for z in self.zones if z.kind == kind)

    @property
    def start(self) -> Place:
        """Return the place at which missions start: the start marker, else the first tree; one of them is there."""
        return self.markers["start"] if "start" in self.markers else self.trees[0].place

    def home(self, then: Literal["return_to_end", "return_to_start", "stay"], here: Place) -> Place:
        """Return the place at which an exit ends.

        A missing end marker falls back to the start, a missing start marker to the first tree.
        """
        match then:
            case "return_to_end":
                return self.markers.get("end", self.start)
            case "return_to_start":
                return self.start
            case "stay":
                return here
