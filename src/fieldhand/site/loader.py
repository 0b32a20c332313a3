"""A site from a file: GeoJSON, a table (CSV), and with the extra ``gis`` what GDAL reads.

Points become trees, markers and gates; polygons become boundary, keep-outs and named zones; fences and their
like become thin keep-outs.
"""

from __future__ import annotations

import gc
import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import resources
from pathlib import Path

from fieldhand.site.build_site import build
from fieldhand.site.features import parse_features
from fieldhand.site.formats.faults import Faults
from fieldhand.site.formats.files import SiteFiles, read_files, records_of
from fieldhand.site.formats.geojson import geojson_records
from fieldhand.site.formats.records import MAX_BYTES, SiteRecords, too_big
from fieldhand.site.model import Site


def demo_path() -> Path:
    """The file of the built-in orchard."""
    return Path(str(resources.files("fieldhand.site") / "data" / "demo.geojson"))


def load_demo() -> Site:
    """The built-in orchard."""
    return load_site(demo_path())


def open_site(name_or_path: str, *, lenient: bool = False) -> Site:
    """The built-in orchard for ``demo``, else the site of that file (``./demo`` for a file of that name).

    Args:
        name_or_path: As on a command line.
        lenient: Load what is sound, with a note for what was left out; see :func:`load_site`.

    Raises:
        SiteError: The file cannot be read or used; see :func:`load_site`.
    """
    return site_of(site_files(name_or_path), lenient=lenient)


def site_files(name_or_path: str) -> SiteFiles:
    """The files of the built-in orchard for ``demo``, else of that path.

    Raises:
        SiteError: There is none that can be read.
    """
    return read_files(demo_path() if name_or_path == "demo" else Path(name_or_path))


def load_site(path: Path, *, lenient: bool = False) -> Site:
    """Read a site from a file: GeoJSON, CSV; with the extra ``gis`` Shapefile, GeoPackage, KML, KMZ, or a zip of one.

    Args:
        path: Of the file; its ending says the format, and where it says nothing the content does.
        lenient: Leave out the features that cannot be used, each with a note, instead of refusing the file. Keep-outs,
            fences and the boundary are never left out.

    Raises:
        SiteError: The file is missing, no file, too big, or does not hold a site; see :func:`parse_site`.
    """
    return site_of(read_files(path), lenient=lenient)


def site_of(files: SiteFiles, *, lenient: bool = False) -> Site:
    """The site that these files hold: the same for the same files, wherever they lie; see :func:`load_site`.

    Raises:
        SiteError: They do not hold a site.
    """
    with _garbage_collection_paused():
        records = records_of(files, lenient=lenient)
        name = Path(files.name).stem
        return _site(records, name=name, source=files.source, sha256=files.sha256, lenient=lenient)


def parse_site(data: bytes, *, name: str, source: str = "", lenient: bool = False) -> Site:
    """A site from the bytes of a GeoJSON document.

    Args:
        data: A FeatureCollection, UTF-8, in degrees WGS 84.
        name: The site's name where the document has no ``name`` of its own.
        source: Where the bytes came from, for messages.
        lenient: As for :func:`load_site`.

    Raises:
        SiteError: The document cannot be used; the message names the source, the first features that are at fault
            (counted from 1) and what to do.
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
    """A large site is a million new objects that are all kept; to look through them for garbage again and again takes
    longer than to read them.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


__all__ = ["demo_path", "load_demo", "load_site", "open_site", "parse_site", "site_files", "site_of"]
