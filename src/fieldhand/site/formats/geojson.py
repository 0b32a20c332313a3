"""Read GeoJSON (RFC 7946) into records."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from fieldhand.errors import SiteError
from fieldhand.site.formats.records import SiteRecords

_DEGREES_CRS = ("crs84", "4326")
_AGAIN = "export it again as GeoJSON"


def geojson_records(data: bytes, at: str, *, lenient: bool = False) -> SiteRecords:
    """Return the features of a GeoJSON FeatureCollection in UTF-8.

    Args:
        data: The document.
        at: Path or name of the document, for messages.
        lenient: Ignore a ``crs`` member that names WGS 84.

    Raises:
        SiteError: The document is not JSON or not a FeatureCollection, or it has a ``crs`` member, which RFC 7946
            removed.
    """
    document = _document(data, at)
    features = _features(document, at)
    notes = _crs(document, at, lenient=lenient)
    own_name = document.get("name")
    return SiteRecords(features=features, name=own_name if isinstance(own_name, str) else "", notes=notes)


def _document(data: bytes, at: str) -> Mapping[str, Any]:
    if not data.strip():
        raise SiteError("the file is empty", where=at, advice="give a GeoJSON FeatureCollection")
    try:
        document = json.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as fault:
        raise SiteError(
            f"the file is not UTF-8 text (byte {fault.start + 1})", where=at, advice="save it as GeoJSON in UTF-8"
        ) from None
    except json.JSONDecodeError as fault:
        raise SiteError(
            f"the file is not JSON: {fault.msg}", where=f"{at}, line {fault.lineno}", advice=_AGAIN
        ) from None
    except RecursionError:
        raise SiteError("the file is nested too deeply", where=at, advice=_AGAIN) from None
    except ValueError:
        raise SiteError("a number in the file has thousands of digits", where=at, advice=_AGAIN) from None
    if not isinstance(document, dict):
        raise SiteError(
            "this is JSON, but not GeoJSON", where=at, advice='give an object of "type": "FeatureCollection"'
        )
    return document


def _features(document: Mapping[str, Any], at: str) -> Sequence[Any]:
    kind, features = document.get("type"), document.get("features")
    if kind != "FeatureCollection" or not isinstance(features, list):
        what = f"it is one {kind}" if kind in ("Feature", "Point", "Polygon", "MultiPoint") else "it is not GeoJSON"
        raise SiteError(
            f"{what}, not a FeatureCollection",
            where=at,
            advice='give an object with "type": "FeatureCollection" and a list "features"',
        )
    return features


def _crs(document: Mapping[str, Any], at: str, *, lenient: bool) -> tuple[str, ...]:
    """Return a note if the ``crs`` member was ignored; reject it otherwise.

    Programs differ in whether they obey the member, so the same file could describe two places.
    """
    if "crs" not in document:
        return ()
    named = document["crs"]
    crs_text = str(named.get("properties", "")).lower() if isinstance(named, dict) else ""
    if not any(known in crs_text for known in _DEGREES_CRS):
        raise SiteError(
            'it has a "crs" member that is not WGS 84, and GeoJSON is always WGS 84 (RFC 7946)',
            where=at,
            advice="export it as WGS 84 (EPSG:4326) without that member: in QGIS, Save As GeoJSON with RFC7946 set to "
            "YES; or ogr2ogr -t_srs EPSG:4326 -lco RFC7946=YES",
        )
    if not lenient:
        raise SiteError(
            'it has a "crs" member, which GeoJSON no longer has (RFC 7946)',
            where=at,
            advice="it says WGS 84, so delete that member and keep the coordinates (in QGIS, Save As GeoJSON with "
            "RFC7946 set to YES), or ignore it with --lenient",
        )
    return ('the "crs" member was ignored: it names WGS 84, which GeoJSON always uses',)
