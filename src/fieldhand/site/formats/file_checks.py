"""Check a file before GDAL opens it: no XML entities, no references to other files, no views instead of tables."""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing
from pathlib import Path
from xml.parsers import expat

from fieldhand.errors import SiteError
from fieldhand.hidden_characters import visible

MAX_DEPTH = 100
_VIRTUAL = re.compile(r"\s*CREATE\s+VIRTUAL", re.IGNORECASE)
_INDEX = re.compile(r"\bUSING\s+[\"'`\[]?(?:rtree|fts[345])\b", re.IGNORECASE)
#: Markers of files that GDAL treats as lists of other files, whatever their names.
_LISTS = (b"<OGRVRT", b"<VRTDataset", b"<GDALTileIndex", b"<OGRWFS", b"<WFS_Capabilities", b'"gdal_streamed_alg"')


def check_kml(path: Path, at: str) -> None:
    """Reject a file that is not plain KML.

    Raises:
        SiteError: The file is not well-formed or not KML, is nested too deeply, or has a document type, which could
            define entities.
    """
    data = path.read_bytes()
    if any(mark in data for mark in _LISTS):
        raise SiteError("the file refers to other files", where=at, advice="export it again as plain KML")
    depth = 0

    def begin(name: str, _: object) -> None:
        nonlocal depth
        if depth == 0 and name.rpartition(":")[2] != "kml":
            raise SiteError(
                f"this is XML, but not KML (its root is {visible(name)[:40]!r})", where=at, advice="give KML"
            )
        depth += 1
        if depth > MAX_DEPTH:
            raise SiteError("the file is nested too deeply", where=at, advice="export it again as KML")

    def end(_: str) -> None:
        nonlocal depth
        depth -= 1

    def refuse(*_: object) -> None:
        raise SiteError(
            "the file declares a document type or entities",
            where=at,
            advice="export it again as plain KML without either",
        )

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.StartDoctypeDeclHandler = refuse
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as fault:
        raise SiteError(
            f"the file is not well-formed XML ({expat.ErrorString(fault.code)})",
            where=f"{at}, line {fault.lineno}",
            advice="export it again as KML",
        ) from None
    except (LookupError, ValueError) as fault:  # an encoding that expat does not have
        raise SiteError(f"the file cannot be read ({fault})", where=at, advice="save it in UTF-8") from None


def check_geopackage(path: Path, at: str) -> frozenset[str]:
    """Return the names of the layers that are views; they are queries, so they are not read.

    Raises:
        SiteError: The file is not a GeoPackage, one of its system tables is a view, or it has a virtual table other
            than a spatial or text index, which could refer to any local file.
    """
    try:
        with closing(sqlite3.connect(f"{path.as_uri()}?mode=ro&immutable=1", uri=True)) as database:
            database.text_factory = lambda text: text.decode(errors="replace")
            found = database.execute(
                "SELECT name, type, coalesce(sql, '') FROM sqlite_master WHERE type IN ('table', 'view')"
            ).fetchall()
    except (sqlite3.Error, UnicodeDecodeError) as fault:  # its messages quote what is damaged
        raise SiteError(f"the file cannot be read ({fault})", where=at, advice="export it again") from None
    tables = {str(name).lower() for name, kind, _ in found if kind == "table"}
    views = {str(name) for name, kind, _ in found if kind == "view"}
    if any(_VIRTUAL.match(str(sql)) and not _INDEX.search(str(sql)) for _, _, sql in found):
        raise SiteError("the file has virtual tables", where=at, advice="export the site again")
    if "gpkg_contents" not in tables or any(name.lower().startswith(("gpkg_", "rtree_")) for name in views):
        raise SiteError("this is an SQLite database, but not a GeoPackage", where=at, advice="export the site again")
    return frozenset(views)
