"""Determine the format of a file from its extension and first bytes, and read its records."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from fieldhand.errors import SiteError
from fieldhand.files import FileFault, read_file
from fieldhand.hidden_characters import visible
from fieldhand.language import message, recalled
from fieldhand.plugins import active
from fieldhand.short_repr import short_repr
from fieldhand.site.formats.records import MAX_BYTES, SHAPEFILE_PARTS, Format, SiteRecords, too_big

_ENDINGS: dict[str, Format] = {
    ".geojson": "geojson",
    ".json": "geojson",
    ".csv": "table",
    ".tsv": "table",
    ".txt": "table",
    ".shp": "shapefile",
    ".gpkg": "geopackage",
    ".kml": "kml",
    ".kmz": "zip",
    ".zip": "zip",
}
#: Extension under which the reader of a built-in format is registered, if it differs from the name of the format.
_MAIN_ENDINGS: dict[str, str] = {"table": "csv", "shapefile": "shp", "geopackage": "gpkg"}
#: First bytes that identify a format.
_MAGIC: dict[bytes, Format] = {
    b"SQLite format 3\0": "geopackage",
    b"PK\x03\x04": "zip",
    b"\x00\x00\x27\x0a": "shapefile",
}


@dataclass(frozen=True, kw_only=True, repr=False)
class SiteFiles:
    """The raw files of a site, from which the identical site can be read again.

    Attributes:
        parts: Bytes by file name, the main file first; only a Shapefile has more than one.
        source: Path that they were read from, for messages.
    """

    parts: Mapping[str, bytes]
    source: str

    __repr__ = short_repr

    @property
    def name(self) -> str:
        """Return the name of the main file."""
        return next(iter(self.parts))

    @cached_property
    def sha256(self) -> str:
        """Return the SHA-256 of the concatenated bytes of all parts."""
        digest = hashlib.sha256()
        for part in self.parts.values():
            digest.update(part)
        return digest.hexdigest()


def read_files(path: Path) -> SiteFiles:
    """Read a file, and the other parts of a Shapefile.

    Raises:
        SiteError: The path is missing or not a file, or the file is too big or of no readable format.
    """
    at = visible(str(path))
    data = read_bytes(path, at)
    parts = _shapefile_parts(path) if format_of(path.name, data, at) == "shapefile" else [path]
    held = {part.name: data if part == path else read_bytes(part, visible(str(part))) for part in parts}
    return SiteFiles(parts=held, source=at)


def records_of(files: SiteFiles, *, lenient: bool = False) -> SiteRecords:
    """Return the records of these files.

    Raises:
        SiteError: The files are of no readable format, or invalid.
        PluginError: The reader of a plugin cannot be imported.
    """
    form = format_of(files.name, files.parts[files.name], files.source)
    ending = _MAIN_ENDINGS.get(form, form)
    plugin = active("fieldhand.formats").get(ending)
    if plugin is None:
        raise SiteError(
            message("no reader of the format {format} is installed", format=ending),
            where=files.source,
            advice=message("reinstall the distribution fieldhand"),
        )
    reader = plugin.load()
    if not callable(reader):
        raise plugin.error("is not callable")
    records = reader(files, lenient=lenient)
    if not isinstance(records, SiteRecords):
        raise plugin.error("does not return Records")
    return records


def is_plain(files: SiteFiles) -> bool:
    """Return True for GeoJSON and tables, which need neither GDAL nor unpacking.

    Raises:
        SiteError: The files are of no readable format.
    """
    return format_of(files.name, files.parts[files.name], files.source) in ("geojson", "table")


def read_bytes(path: Path, at: str) -> bytes:
    """Return the bytes of a file.

    Raises:
        SiteError: The path is missing or not a file, or the file is too big or cannot be read.
    """
    try:
        return read_file(path, MAX_BYTES, plain=True)
    except FileFault as fault:
        if fault.kind == "too large":
            raise too_big(at, fault.size) from None
        what, advice = {
            "no file": (message("this is not a file"), message("give the file of the site itself")),
            "missing": (
                message("there is no such file"),
                message("check the path, or use 'demo' or 'vineyard', the built-in sites"),
            ),
        }.get(
            fault.kind,
            (message("the file {fault}", fault=recalled(fault.what, "file")), message("check its permissions")),
        )
        raise SiteError(what, where=at, advice=advice) from None


def format_of(name: str, data: bytes, at: str) -> str:
    """Return the format of a file; first bytes that identify a format take precedence over the extension.

    Raises:
        SiteError: The file is of no readable format.
    """
    for magic, form in _MAGIC.items():
        if data.startswith(magic):
            return form
    ending = Path(name).suffix.lower()
    known = _ENDINGS.get(ending)
    if ending in SHAPEFILE_PARTS[1:]:
        raise SiteError(
            message("this is only part of a Shapefile"),
            where=at,
            advice=message("give the .shp file it belongs to"),
        )
    if known in ("geopackage", "zip", "shapefile"):
        raise SiteError(
            message("the name ends in {ending}, but the content is not in that format", ending=ending[1:])
            if data
            else message("the file is empty"),
            where=at,
            advice=message("export it again"),
        )
    if known is not None:
        return known
    if ending[1:] in active("fieldhand.formats"):
        return ending[1:]
    start = data[:200].removeprefix(b"\xef\xbb\xbf").lstrip()
    if start[:1] in (b"{", b"["):
        return "geojson"
    if start[:1] == b"<":
        return "kml"
    if start and b"\0" not in start and any(mark in start.splitlines()[0] for mark in (b",", b";", b"\t")):
        return "table"
    raise SiteError(
        message("the file is not in a known site format") if start else message("the file is empty"),
        where=at,
        advice=message("give GeoJSON or a CSV table; with the extra gis also Shapefile, GeoPackage, KML or KMZ"),
    )


def _shapefile_parts(path: Path) -> list[Path]:
    """Return the parts beside the main file, whatever the case of their extensions."""
    try:
        beside = {p.suffix.lower(): p for p in sorted(path.parent.iterdir()) if p.stem == path.stem and p.is_file()}
    except OSError:
        beside = {}
    return [path, *(beside[part] for part in SHAPEFILE_PARTS[1:] if part in beside)]
