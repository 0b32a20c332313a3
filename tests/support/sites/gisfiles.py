"""Files of geographic information systems for tests, written with GDAL or by hand, and GeoJSON lines in metres."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio.raw
import shapely

from fieldhand.site.projection import Projection

HERE = Projection(37.26, -120.42)


def degrees(*xy: tuple[float, float]) -> list[list[float]]:
    """GeoJSON positions of points in metres east and north of latitude 37.26, longitude -120.42."""
    return [[lon, lat] for lat, lon in HERE.degrees(xy).tolist()]


def line(*xy: tuple[float, float], **properties: object) -> dict[str, object]:
    """A GeoJSON LineString feature through points in these metres."""
    geometry = {"type": "LineString", "coordinates": degrees(*xy)}
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def write_layer(
    path: Path,
    layer: str,
    shapes: Sequence[Any],
    fields: Mapping[str, Sequence[Any]] | None = None,
    *,
    crs: str | None = "EPSG:4326",
    append: bool = False,
) -> Path:
    """Write shapes, all of one type, with their fields as one layer of a file."""
    columns = {name: np.array(values, dtype=_dtype(values)) for name, values in (fields or {}).items()}
    kind = next(s.geom_type + (" Z" if s.has_z else "") for s in shapes if s is not None)
    pyogrio.raw.write(
        path,
        shapely.to_wkb(np.array(shapes, dtype=object)),
        list(columns.values()),
        list(columns),
        geometry_type=kind,
        crs=crs,
        layer=layer,
        append=append,
        driver="LIBKML" if path.suffix == ".kml" else None,
    )
    return path


def _dtype(values: Sequence[Any]) -> Any:
    return object if isinstance(values[0], str | None) else np.asarray(values).dtype


def zipped(target: Path, files: Mapping[str, bytes]) -> Path:
    """A zip file of these members."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return target


def kml(*placemarks: str, head: str = "", root: str = "kml") -> bytes:
    """A KML document of these placemarks."""
    inside = "\n".join(placemarks)
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>{head}'
        f'<{root} xmlns="http://www.opengis.net/kml/2.2"><Document><name>Farm</name>{inside}</Document></{root}>'
    ).encode()


def placemark(lon: float, lat: float, name: str = "", **data: Any) -> str:
    """A KML placemark of one point."""
    said = "".join(f'<Data name="{key}"><value>{value}</value></Data>' for key, value in data.items())
    return (
        f"<Placemark><name>{name}</name><ExtendedData>{said}</ExtendedData>"
        f"<Point><coordinates>{lon!r},{lat!r},0</coordinates></Point></Placemark>"
    )
