"""Determine the format of a file from its ending and first bytes, and read its records."""

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
#: Of each built-in format, the ending under which its reader is registered.
_MAIN_ENDINGS: dict[str, str] = {"table": "csv", "shapefile": "shp", "geopackage": "gpkg"}
#: How files begin that can be nothing else.
_MAGIC: dict[bytes, Format] = {
    b"SQLite format 3\0": "geopackage",
    b"PK\x03\x04": "zip",
    b"\x00\x00\x27\x0a": "shapefile",
}


@dataclass(frozen=True, kw_only=True, repr=False)
class SiteFiles:
    """The files of a site as they were read: whoever has them can read the very same site again.

    Attributes:
        parts: Bytes by file name, the main file first; more than one for a Shapefile alone.
        source: Where they were read from, for messages.
    """

    parts: Mapping[str, bytes]
    source: str

    __repr__ = short_repr

    @property
    def name(self) -> str:
        """Of the main file."""
        return next(iter(self.parts))

    @cached_property
    def sha256(self) -> str:
        """Of the bytes, for a Shapefile of its parts one after the other."""
        digest = hashlib.sha256()
        for part in self.parts.values():
            digest.update(part)
        return digest.hexdigest()


def read_files(path: Path) -> SiteFiles:
    """A file, and what belongs to it.

    Raises:
        SiteError: It is missing, no file, too big, or has no format that can be read.
    """
    at = visible(str(path))
    data = read_bytes(path, at)
    parts = _shapefile_parts(path) if format_of(path.name, data, at) == "shapefile" else [path]
    held = {part.name: data if part == path else read_bytes(part, visible(str(part))) for part in parts}
    return SiteFiles(parts=held, source=at)


def records_of(files: SiteFiles, *, lenient: bool = False) -> SiteRecords:
    """The records that these files hold.

    Raises:
        SiteError: They have no format that can be read, or not what belongs to it.
        PluginError: The reader of a plugin cannot be imported.
    """
    form = format_of(files.name, files.parts[files.name], files.source)
    ending = _MAIN_ENDINGS.get(form, form)
    plugin = active("fieldhand.formats").get(ending)
    if plugin is None:
        raise SiteError(
            message("no reader of the format {format} is installed", format=ending),
            where=files.source,
            advice=message("install the distribution fieldhand again"),
        )
    reader = plugin.load()
    if not callable(reader):
        raise plugin.error("is not callable")
    records = reader(files, lenient=lenient)
    if not isinstance(records, SiteRecords):
        raise plugin.error("does not return Records")
    return records


def is_plain(files: SiteFiles) -> bool:
    """Return True for a format that is read here: GeoJSON or a table. Others take GDAL, or are unpacked first.

    Raises:
        SiteError: They have no format that can be read.
    """
    return format_of(files.name, files.parts[files.name], files.source) in ("geojson", "table")


def read_bytes(path: Path, at: str) -> bytes:
    """The bytes of a file that is not too big.

    Raises:
        SiteError: It is missing, no file, too big or cannot be read.
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
                message("check the path, or use 'demo' for the built-in orchard"),
            ),
        }.get(
            fault.kind,
            (message("the file {fault}", fault=recalled(fault.what, "file")), message("check its permissions")),
        )
        raise SiteError(what, where=at, advice=advice) from None


def format_of(name: str, data: bytes, at: str) -> str:
    """The format of a file; a beginning that can mean only one thing counts more than the ending of the name.

    Raises:
        SiteError: It is none that can be read.
    """
    for magic, form in _MAGIC.items():
        if data.startswith(magic):
            return form
    ending = Path(name).suffix.lower()
    known = _ENDINGS.get(ending)
    if ending in SHAPEFILE_PARTS[1:]:
        raise SiteError(
            message("this is a part of a Shapefile"), where=at, advice=message("give the .shp file that it belongs to")
        )
    if known in ("geopackage", "zip", "shapefile"):
        raise SiteError(
            message("the file is no {ending} file, whatever its name says", ending=ending[1:])
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
        message("the file has no format of a site") if start else message("the file is empty"),
        where=at,
        advice=message("give GeoJSON or a CSV table; with the extra gis also Shapefile, GeoPackage, KML or KMZ"),
    )


def _shapefile_parts(path: Path) -> list[Path]:
    """The parts that lie beside the main file, however their endings are written."""
    try:
        beside = {p.suffix.lower(): p for p in sorted(path.parent.iterdir()) if p.stem == path.stem and p.is_file()}
    except OSError:
        beside = {}
    return [path, *(beside[part] for part in SHAPEFILE_PARTS[1:] if part in beside)]
