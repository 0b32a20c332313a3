"""Read a table (CSV) into records: one tree or marker per line, with columns for latitude and longitude."""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fieldhand.errors import SiteError
from fieldhand.hidden_characters import visible
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.features import readable
from fieldhand.site.formats.faults import UnusableFeature
from fieldhand.site.formats.records import SiteRecords, UnusablePart

# fmt: off
#: Names of the two columns, the most specific first; compared without case, hyphens, underscores and bracketed text.
LATITUDE = ("latitude", "lat", "gps latitude", "gps lat", "decimal latitude", "decimallatitude", "latitude deg",
            "lat deg", "lat dd", "latitude dd", "lat wgs84", "latitude wgs84", "point y", "coord y", "y coord", "y")
LONGITUDE = ("longitude", "lon", "lng", "long", "gps longitude", "gps lon", "gps lng", "gps long", "decimal longitude",
             "decimallongitude", "longitude deg", "lon deg", "lng deg", "long deg", "lon dd", "lng dd", "long dd",
             "longitude dd", "lon wgs84", "lng wgs84", "longitude wgs84", "point x", "coord x", "x coord", "x")
# fmt: on
_DELIMITERS = (",", ";", "\t", "|")
_MISSING = frozenset({"", "nan", "null", "na", "n/a", "#n/a", "-"})
_NUMBER = re.compile(r"[+-]?(?:0|[1-9]\d{0,17})(?:\.\d+)?(?:[eE][+-]?\d{1,3})?")
_BRACKETS = re.compile(r"[(\[].*?[)\]]")
#: Characters of degrees with minutes and optional seconds, including typographic signs.
_SEXAGESIMAL = re.compile(r"[\d\s.,:dms\u00b0\u00ba'\"\u2019\u2032\u201d\u2033NSEWnsew-]+")


def table_records(data: bytes, at: str) -> SiteRecords:
    """Return the lines of a table with a header; each line is a point, its other columns are properties.

    Args:
        data: Text in UTF-8, UTF-16 or Windows-1252 (from older spreadsheets), with commas, semicolons, tabs or bars
            between the columns. If the separator is not a comma, numbers may have decimal commas.
        at: Path or name of the table, for messages.

    Raises:
        SiteError: The data is not such a table, or has no columns for latitude and longitude.
    """
    text, notes = _text(data, at)
    head, _, rest = text.partition("\n")
    if head.strip().lower() in {f"sep={d}" for d in _DELIMITERS}:
        text, skipped, delimiter = rest, 1, head.strip()[4]
    else:
        skipped, delimiter = 0, _delimiter(head)
    lines = _lines(text, delimiter, at, skipped)
    if not lines:
        raise SiteError("the file is empty", where=at, advice="give a table with a header and a line for each tree")
    columns = _columns(lines[0][1], at, lines[0][0])
    features = [_feature(row, columns, comma=delimiter != ",") for _, row in lines[1:]]
    return SiteRecords(features=features, numbers=[number for number, _ in lines[1:]], unit="line", notes=notes)


@dataclass(frozen=True, kw_only=True)
class _Columns:
    """Column indices of latitude and longitude, and property names by column index."""

    names: Sequence[str]
    latitude: int
    longitude: int
    properties: Mapping[int, str]


def _text(data: bytes, at: str) -> tuple[str, tuple[str, ...]]:
    if not data.strip():
        raise SiteError("the file is empty", where=at, advice="give a table with a header and a line for each tree")
    try:
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return data.decode("utf-16"), ()
        return data.decode("utf-8-sig"), ()
    except UnicodeDecodeError:
        if b"\0" in data[:4096]:
            raise SiteError("the file is not a text file", where=at, advice="save the table as CSV in UTF-8") from None
        return data.decode("cp1252", errors="replace"), ("the table is not UTF-8, so it was read as Windows-1252",)


def _delimiter(head: str) -> str:
    bare = re.sub(r'"[^"]*"', "", head)
    return max(_DELIMITERS, key=bare.count)


def _lines(text: str, delimiter: str, at: str, skipped: int) -> list[tuple[int, list[str]]]:
    """Return the rows that are not blank, each with the number of its first line."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    found: list[tuple[int, list[str]]] = []
    begins = 1 + skipped
    try:
        for row in reader:
            if any(map(str.strip, row)):
                found.append((begins, row))
            begins = reader.line_num + 1 + skipped
    except csv.Error as fault:
        raise SiteError(
            f"the table cannot be read from this line on ({fault})",
            where=f"{at}, line {begins}",
            advice="look for a quotation mark that is not closed",
        ) from None
    return found


def _columns(header: Sequence[str], at: str, line: int) -> _Columns:
    names = [_column(name, at, line) for name in header]
    if all(_NUMBER.fullmatch(name.replace(",", ".")) for name in names if name):
        raise SiteError(
            "the first line is not a header",
            where=f"{at}, line {line}",
            advice="name the columns: latitude, longitude, ...",
        )
    words = [phrase(_BRACKETS.sub(" ", name)) for name in names]
    latitude, longitude = _first(LATITUDE, words), _first(LONGITUDE, words)
    missing = [what for what, found in (("latitude", latitude), ("longitude", longitude)) if found is None]
    if latitude is None or longitude is None:
        shown = ", ".join(repr(name[:30]) for name in names[:8]) + (", ..." if len(names) > 8 else "")
        raise SiteError(
            f"it has no column for {' or '.join(missing)} (its columns: {shown})",
            where=f"{at}, line {line}",
            advice="name the columns latitude and longitude; if this is not a table, end its name in .geojson",
        )
    properties: dict[int, str] = {}
    for k, name in enumerate(names):
        if k not in (latitude, longitude) and name:
            twice = sum(other == name for other in properties.values())
            properties[k] = f"{name} {twice + 1}" if twice else name
    return _Columns(names=names, latitude=latitude, longitude=longitude, properties=properties)


def _column(name: str, at: str, line: int) -> str:
    """Return the name of a column, on one line.

    Raises:
        SiteError: The name contains an invisible character.
    """
    try:
        return readable(name.strip(), "header")
    except UnusableFeature as fault:
        raise SiteError(fault.what, where=f"{at}, line {line}", advice=fault.advice) from None


def _first(wanted: Sequence[str], words: Sequence[str]) -> int | None:
    return next((words.index(name) for name in wanted if name in words), None)


def _feature(row: Sequence[str], columns: _Columns, *, comma: bool) -> dict[str, Any] | UnusablePart:
    """Return a GeoJSON feature, or the reason why the row is unusable."""
    width = len(columns.names)
    if len(row) < width or any(map(str.strip, row[width:])):
        return UnusablePart(
            f"it has {len(row)} columns, the header has {width}",
            "give every line as many columns as the header; put text that contains the separator in quotation marks",
        )
    lat = _degrees(row[columns.latitude], "latitude", comma=comma)
    lon = _degrees(row[columns.longitude], "longitude", comma=comma)
    for found in (lat, lon):
        if isinstance(found, UnusablePart):
            return found
    properties = {name: value_of(row[k], comma=comma) for k, name in columns.properties.items()}
    return {
        "type": "Feature",
        "geometry": {"type": "Point", "coordinates": [lon, lat]},
        "properties": {name: value for name, value in properties.items() if value is not None},
    }


def value_of(text: str, *, comma: bool = False) -> str | float | bool | None:
    """Return the value of a cell: a number, a boolean (true, false) or a text.

    Numbers with leading zeros stay text, since 007 is a name. Empty cells and the usual markers of missing values give
    None. With ``comma``, 3,5 is a number.
    """
    text = text.strip()
    lower = text.lower()
    if lower in _MISSING:
        return None
    if lower in ("true", "false"):
        return lower == "true"
    number = text.replace(",", ".", 1) if comma and text.count(",") == 1 and "." not in text else text
    return float(number) if _NUMBER.fullmatch(number) else text


def _degrees(text: str, what: str, *, comma: bool) -> float | UnusablePart:
    text = text.strip()
    if text.lower() in _MISSING - {"nan"}:
        return UnusablePart(f"its {what} is empty", "give it in decimal degrees, or remove the line")
    number = text.replace(",", ".", 1) if comma and text.count(",") == 1 and "." not in text else text
    try:
        return float(number) if "_" not in number else _not_degrees(text, what)
    except ValueError:
        return _not_degrees(text, what)


def _not_degrees(text: str, what: str) -> UnusablePart:
    shown = visible(text)[:40]
    parts = [float(p.replace(",", ".")) for p in re.findall(r"\d+(?:[.,]\d+)?", text)]
    if not _SEXAGESIMAL.fullmatch(text) or len(parts) not in (2, 3) or any(p >= 60 for p in parts[1:]):
        return UnusablePart(f"its {what} is {shown!r}", "give it in decimal degrees, such as 37.208333")
    degrees = sum(part / 60**power for power, part in enumerate(parts))
    negative = text.startswith("-") or bool(set("SWsw") & {text[0], text[-1]})
    return UnusablePart(
        f"its {what} is in degrees and minutes ({shown!r})",
        f"write decimal degrees: {-degrees if negative else degrees:.7f}",
    )
