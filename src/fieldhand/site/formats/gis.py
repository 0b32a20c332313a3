"""Shapefile, GeoPackage, KML and KMZ to records, with GDAL (pyogrio, the extra ``gis``).

GDAL is a large program that obeys what it finds in a file. So it runs in a process of its own with little memory and
time (:mod:`fieldhand.site.formats.sandbox`), and gets only copies in a folder of their own, in the formats that we
mean, after a look at what is in them, and no network.
"""

from __future__ import annotations

import math
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from fieldhand.errors import SiteError
from fieldhand.hidden_characters import visible
from fieldhand.site.feature_kinds import KIND_KEYS, area_kind, barrier_name, point_kind, text_of
from fieldhand.site.formats.archive import unpack
from fieldhand.site.formats.file_checks import check_geopackage, check_kml
from fieldhand.site.formats.geojson import geojson_records
from fieldhand.site.formats.records import SHAPEFILE_PARTS, Format, SiteRecords, UnusablePart
from fieldhand.site.formats.sandbox import read_sandboxed
from fieldhand.site.formats.table import table_records, value_of

MAX_LAYERS = 100
MAX_FEATURES = 1_000_000
_WGS84 = "EPSG:4326"
#: No file over the network, whatever a file says; and a Shapefile whose index was lost is read all the same.
_SETTINGS = {"CPL_VSIL_CURL_ALLOWED_EXTENSIONS": "{none}", "GDAL_HTTP_TIMEOUT": 1, "SHAPE_RESTORE_SHX": True}
#: What GDAL may take a file for.
_DRIVERS = {
    ".shp": frozenset({"ESRI Shapefile"}),
    ".gpkg": frozenset({"GPKG"}),
    ".kml": frozenset({"KML", "LIBKML"}),
}
_MAIN = (".shp", ".gpkg", ".kml", ".geojson", ".json", ".csv")
#: What GDAL adds to each KML placemark; ids are made by the program that wrote it and say nothing to people.
_KML_OWN = (
    *("id", "timestamp", "begin", "end", "altitudeMode", "tessellate", "extrude", "visibility", "drawOrder", "icon"),
    "snippet",
)


def gis_records(form: str, contents: Mapping[str, bytes], at: str, *, lenient: bool = False) -> SiteRecords:
    """The features of all layers, one layer after the other, in degrees WGS 84.

    Args:
        form: ``shapefile``, ``geopackage``, ``kml`` or ``zip`` (which is KMZ, or one of the others packed).
        contents: The file by name, a Shapefile with its parts.
        at: Where it was read from, for messages.
        lenient: For a GeoJSON file that was packed.

    Raises:
        SiteError: The extra is not installed, or the file cannot be read with what a file of its size may take.
    """
    if form != "zip":
        _require_extra(at)
    return read_sandboxed(form, contents, at, lenient=lenient)


def read_in_process(form: Format, contents: Mapping[str, bytes], at: str, *, lenient: bool = False) -> SiteRecords:
    """Return what :func:`gis_records` does, read in this very process: for files of one's own, and for its process."""
    with tempfile.TemporaryDirectory(prefix="fieldhand-") as temporary:
        folder = Path(temporary)
        if form == "zip":
            paths = unpack(next(iter(contents.values())), {*_MAIN, *SHAPEFILE_PARTS}, folder, at)
            return _packed(paths, at, lenient=lenient)
        ending = {"shapefile": "", "geopackage": ".gpkg", "kml": ".kml"}[form]
        for name, data in contents.items():
            # One plain name for all parts: GDAL reads meaning into some names.
            (folder / f"site{ending or Path(name).suffix.lower()}").write_bytes(data)
        return _joined([(folder / f"site{ending or '.shp'}", "")], at)


def _packed(paths: Sequence[Path], at: str, *, lenient: bool) -> SiteRecords:
    """What an archive holds: Shapefiles, which belong together, or one file of another format."""
    for ending in _MAIN:
        found = [p for p in paths if p.suffix.lower() == ending]
        if not found:
            continue
        if ending == ".shp":
            return _joined([(p, p.stem) for p in found], at)
        if ending == ".kml":
            found = [next((p for p in found if p.name.lower() == "doc.kml"), found[0])]
        if len(found) > 1:
            raise SiteError(
                f"the archive holds {len(found)} {ending} files", where=at, advice="pack the one that is the site"
            )
        if ending in (".geojson", ".json"):
            return geojson_records(found[0].read_bytes(), at, lenient=lenient)
        if ending == ".csv":
            return table_records(found[0].read_bytes(), at)
        return _joined([(found[0], "")], at)
    raise SiteError(
        "the archive holds no file of a site",
        where=at,
        advice="pack a Shapefile with its parts, a GeoPackage, KML, GeoJSON or CSV file",
    )


@dataclass
class _Gathering:
    """Features of the layers read so far."""

    features: list[Any] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    layers: list[str] = field(default_factory=list)


def _joined(sources: Sequence[tuple[Path, str]], at: str) -> SiteRecords:
    gathering = _Gathering()
    with _gdal(at) as gdal:
        layers: list[tuple[Path, str, str]] = []
        for path, stem in sources:
            layers.extend((path, name, stem or name) for name in _layers_of(gdal, path, gathering, at))
        if len(layers) > MAX_LAYERS:
            raise SiteError(
                f"it has {len(layers)} layers, more than {MAX_LAYERS}", where=at, advice="export the layers of the site"
            )
        for path, layer, title in layers:
            _read_layer(gdal, path, layer, title if len(layers) > 1 else "", gathering, at)
    if len(gathering.layers) > 1:
        gathering.notes.append(f"layers were joined: {', '.join(gathering.layers)[:120]}")
    return SiteRecords(features=gathering.features, notes=tuple(gathering.notes))


def _layers_of(gdal: Any, path: Path, gathering: _Gathering, at: str) -> list[str]:
    """The names of the layers of a file that may be read."""
    if path.suffix.lower() == ".kml":
        check_kml(path, at)
    views = check_geopackage(path, at) if path.suffix.lower() == ".gpkg" else frozenset()
    if views:
        gathering.notes.append(f"views were left out, only tables are read: {', '.join(sorted(views))[:100]}")
    try:
        names = [str(name) for name, _ in gdal.list_layers(path) if name not in views]
        drivers = {str(gdal.read_info(path, layer=name)["driver"]) for name in names[:1]}
    except Exception as fault:  # noqa: BLE001  # GDAL's errors are of many classes
        raise _unreadable(fault, at) from None
    if not drivers <= _DRIVERS[path.suffix.lower()]:
        raise SiteError(f"the file is one of {visible(min(drivers))[:40]}", where=at, advice="export it again")
    return names


def _require_extra(at: str) -> None:
    try:
        installed = find_spec("pyogrio") is not None
    except ValueError:
        installed = False
    if not installed:
        raise SiteError(
            "Shapefile, GeoPackage, KML and KMZ need the extra 'gis'",
            where=at,
            advice="install it: pip install 'fieldhand[gis]'; or export the site as GeoJSON (WGS 84)",
        )


@contextmanager
def _gdal(at: str) -> Iterator[Any]:
    """pyogrio without network, and without warnings: they are of fields that we do not need, mostly."""
    _require_extra(at)
    import pyogrio

    pyogrio.set_gdal_config_options(_SETTINGS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield pyogrio


def _read_layer(gdal: Any, path: Path, layer: str, title: str, gathering: _Gathering, at: str) -> None:
    from pyogrio.raw import read

    try:
        meta, _, shapes, columns = read(
            path, layer=layer, force_2d=True, max_features=MAX_FEATURES - len(gathering.features) + 1
        )
        high = _has_heights(gdal, path, layer)
    except Exception as fault:  # noqa: BLE001
        raise _unreadable(fault, at) from None
    if shapes is None or len(shapes) == 0:
        return  # a table without geometry, or an empty folder
    if len(gathering.features) + len(shapes) > MAX_FEATURES:
        raise SiteError(
            f"it has more than {MAX_FEATURES:,} features", where=at, advice="cut the site into smaller ones"
        )
    first = len(gathering.features) + 1
    gathering.features.extend(_features(meta, shapes, columns, title, at, gathering.notes))
    if high:
        gathering.notes.append("heights are not used" + (f" (layer {title!r})" if title else ""))
    span = f"features {first} to {len(gathering.features)}" if len(shapes) > 1 else f"feature {first}"
    gathering.layers.append(f"{visible(title)!r} ({span})")


def _has_heights(gdal: Any, path: Path, layer: str) -> bool:
    kind = str(gdal.read_info(path, layer=layer)["geometry_type"])
    return " Z" in kind or kind.startswith("2.5D")


def _features(
    meta: Mapping[str, Any], shapes: Any, columns: Sequence[Any], title: str, at: str, notes: list[str]
) -> list[Any]:
    """GeoJSON features in degrees, from geometries as WKB and one array for each field."""
    import shapely

    geometries = shapely.from_wkb(shapes, on_invalid="ignore")
    geometries = _in_degrees(geometries, meta.get("crs"), at, notes)
    names = [str(name) for name in meta["fields"]]
    if meta.get("driver") in ("LIBKML", "KML") or "Name" in names:
        called = {"Name": "name", "Description": "description", **dict.fromkeys(_KML_OWN, "")}
        names = [called.get(name, name) for name in names]
        values = [_untyped(name, _values(column)) for name, column in zip(names, columns, strict=True)]
    else:
        values = [_values(column) for column in columns]
    made: list[Any] = []
    for k, geometry in enumerate(geometries):
        properties = {name: held[k] for name, held in zip(names, values, strict=True) if name and held[k] is not None}
        if title and not text_of(_texts(properties), KIND_KEYS):
            _kind_from_layer(properties, title, "" if geometry is None else geometry.geom_type)
        if geometry is None or geometry.is_empty:
            what = "it has no geometry" if geometry is None else "its geometry is empty"
            made.append(UnusablePart(what, "draw it, or take it out", properties))
            continue
        made.append({"type": "Feature", "properties": properties, "geometry": _mapping(geometry)})
    return made


def _texts(properties: Mapping[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in properties.items() if isinstance(v, str | float | bool)}


def _kind_from_layer(properties: dict[str, Any], title: str, shape: str) -> None:
    """People sort by layer what GeoJSON says in a property: a layer "keep-outs" holds keep-outs."""
    words = [title, title.removesuffix("s")]
    for word in words:
        kind = {"kind": word}
        says = (
            point_kind(kind)[0] != "tree"
            if "Point" in shape
            else bool(barrier_name(kind))
            if "Line" in shape
            else area_kind(kind)[0] != "zone"
        )
        if says:
            properties["kind"] = word
            return


def _in_degrees(geometries: Any, crs: str | None, at: str, notes: list[str]) -> Any:
    """The geometries in longitude and latitude of WGS 84."""
    import numpy as np
    import shapely

    xy = shapely.get_coordinates(geometries)
    if crs is None:
        if xy.size and (np.abs(xy[:, 0]).max() > 180.0 or np.abs(xy[:, 1]).max() > 90.0):
            raise SiteError(
                "it does not say in which coordinate system it is, and these are no degrees",
                where=at,
                advice="a Shapefile needs its .prj file; or export it as WGS 84 (EPSG:4326)",
            )
        note = "it does not say in which coordinate system it is, so it was read as WGS 84"
        if note not in notes:
            notes.append(note)
        return geometries
    import pyproj

    try:
        source = pyproj.CRS.from_user_input(crs)
        if source.equals(pyproj.CRS.from_user_input(_WGS84), ignore_axis_order=True):
            return geometries
        transformer = pyproj.Transformer.from_crs(source, _WGS84, always_xy=True)
        lon, lat = transformer.transform(xy[:, 0], xy[:, 1])
    except pyproj.exceptions.ProjError as fault:
        raise SiteError(
            f"its coordinate system cannot be used ({visible(str(fault))[:100]})",
            where=at,
            advice="export it as WGS 84 (EPSG:4326)",
        ) from None
    name = visible(str(source.name))[:60]
    note = f"coordinates were converted from {name} to WGS 84"
    if note not in notes:
        notes.append(note)
    return shapely.set_coordinates(geometries, np.column_stack([lon, lat]))


def _mapping(geometry: Any) -> dict[str, Any]:
    if geometry.geom_type == "Point":
        return {"type": "Point", "coordinates": [geometry.x, geometry.y]}
    made = geometry.__geo_interface__
    if made["type"] == "GeometryCollection":
        return {"type": "GeometryCollection", "geometries": [_mapping(part) for part in geometry.geoms]}
    return {"type": made["type"], "coordinates": _listed(made["coordinates"])}


def _listed(value: Any) -> Any:
    return [_listed(v) for v in value] if isinstance(value, tuple | list) else value


def _values(column: Any) -> list[Any]:
    """A field's values as JSON has them; None where a feature has none."""
    if column.dtype.kind == "M":
        return [None if text == "NaT" else text for text in column.astype(str).tolist()]
    return [None if v is None or (isinstance(v, float) and math.isnan(v)) or v == "" else v for v in column.tolist()]


def _untyped(name: str, values: list[Any]) -> list[Any]:
    """KML mostly has text only: numbers are known by how they are written, as in a table."""
    if name in ("name", "description"):
        return values
    return [value_of(v) if isinstance(v, str) else v for v in values]


def _unreadable(fault: Exception, at: str) -> SiteError:
    text = visible(str(fault)).strip().rstrip(".")
    reason = text.rsplit("/", 1)[-1] if "/" in text else text  # the copy's path says nothing to anybody
    return SiteError(f"the file cannot be read ({reason[:160]})", where=at, advice="export it again")
