"""Load a site from a file: GeoJSON, a table (CSV), and with the extra ``gis`` the formats that GDAL reads.

Points become trees, markers and gates; polygons become boundary, keep-outs and named zones; fences, ditches and similar
lines become thin keep-outs.
"""

from __future__ import annotations

import gc
import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from importlib import resources
from pathlib import Path
from typing import Literal, get_args

from fieldhand.site.build_site import build
from fieldhand.site.features import parse_features
from fieldhand.site.formats.faults import Faults
from fieldhand.site.formats.files import SiteFiles, read_files, records_of
from fieldhand.site.formats.geojson import geojson_records
from fieldhand.site.formats.records import MAX_BYTES, SiteRecords, too_big
from fieldhand.site.model import Site

#: The sites of the package: an orchard and a vineyard.
BuiltInSite = Literal["demo", "vineyard"]
BUILT_IN_SITES: tuple[BuiltInSite, ...] = get_args(BuiltInSite)


def built_in_path(name: str) -> Path:
    """Return the path of the file of a built-in site, one of :data:`BUILT_IN_SITES`."""
    return Path(str(resources.files("fieldhand.site") / "data" / f"{name}.geojson"))


def demo_path() -> Path:
    """Return the path of the built-in orchard's file."""
    return built_in_path("demo")


@lru_cache(maxsize=len(BUILT_IN_SITES))
def load_built_in(name: str) -> Site:
    """Load a built-in site; later calls return the same site, with what has been computed from it."""
    return load_site(built_in_path(name))


def load_demo() -> Site:
    """Load the built-in orchard; later calls return the same site, with what has been computed from it."""
    return load_built_in("demo")


def open_site(name_or_path: str, *, lenient: bool = False) -> Site:
    """Load the built-in site of that name (``demo``, ``vineyard``), else the site of that file (``./demo``).

    Args:
        name_or_path: Name of a built-in site or a path, as given on a command line.
        lenient: Skip unusable features, with a note for each; see :func:`load_site`.

    Raises:
        SiteError: The file cannot be read or used; see :func:`load_site`.
    """
    if name_or_path in BUILT_IN_SITES and not lenient:
        return load_built_in(name_or_path)
    return site_of(site_files(name_or_path), lenient=lenient)


def site_files(name_or_path: str) -> SiteFiles:
    """Read the files of the built-in site of that name, else of that path, without parsing them.

    Raises:
        SiteError: The file is missing or cannot be read.
    """
    return read_files(built_in_path(name_or_path) if name_or_path in BUILT_IN_SITES else Path(name_or_path))


def load_site(path: Path, *, lenient: bool = False) -> Site:
    """Read a site from a file: GeoJSON, CSV; with the extra ``gis`` Shapefile, GeoPackage, KML, KMZ, or a zip of one.

    Args:
        path: Path of the file. Its extension selects the format; without a known extension, its content does.
        lenient: Skip unusable features, with a note for each, instead of rejecting the file. Keep-outs, fences and the
            boundary are never skipped.

    Raises:
        SiteError: The path is missing or not a file, or the file is too big or not a valid site; see
            :func:`parse_site`.
    """
    return site_of(read_files(path), lenient=lenient)


def site_of(files: SiteFiles, *, lenient: bool = False) -> Site:
    """Return the site in these files, independent of where they are stored; see :func:`load_site`.

    Raises:
        SiteError: The files are not a valid site.
    """
    with _garbage_collection_paused():
        records = records_of(files, lenient=lenient)
        name = Path(files.name).stem
        return _site(records, name=name, source=files.source, sha256=files.sha256, lenient=lenient)


def parse_site(data: bytes, *, name: str, source: str = "", lenient: bool = False) -> Site:
    """Return the site in the bytes of a GeoJSON document.

    Args:
        data: A FeatureCollection, UTF-8, in degrees WGS 84.
        name: Name of the site if the document has no ``name``.
        source: Origin of the bytes, for messages.
        lenient: As for :func:`load_site`.

    Raises:
        SiteError: The document cannot be used; the message names the source, the first faulty features (counted from 1)
            and a remedy.
    """
    at = source or name
    if len(data) > MAX_BYTES:
        raise too_big(at, len(data))
    sha256 = hashlib.sha256(data).hexdigest()
    with _garbage_collection_paused():
        records = geojson_records(data, at, lenient=lenient)
        return _site(records, name=name, source=at, sha256=sha256, lenient=lenient)


def _site(records: SiteRecords, *, name: str, source: str, sha256: str, lenient: bool) -> Site:
    faults = Faults(source, records.unit, lenient=lenient)
    features = parse_features(records, faults)
    own = records.name.strip()
    return build(features, faults, name=own or name, sha256=sha256, notes=records.notes)


@contextmanager
def _garbage_collection_paused() -> Iterator[None]:
    """Disable garbage collection while a site is loaded.

    A large site allocates a million objects that all stay alive; repeated collections would take longer than reading
    it.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


__all__ = [
    "BUILT_IN_SITES",
    "BuiltInSite",
    "built_in_path",
    "demo_path",
    "load_built_in",
    "load_demo",
    "load_site",
    "open_site",
    "parse_site",
    "site_files",
    "site_of",
]
