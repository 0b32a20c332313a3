"""Readers of the built-in formats, as entry points of the group ``fieldhand.formats``.

The name of an entry point is a file extension without its dot. Its value is a reader: it takes the files of a site
(:class:`~fieldhand.site.formats.files.SiteFiles`) and ``lenient``, and returns the features
(:class:`~fieldhand.site.formats.records.SiteRecords`), or raises a :class:`~fieldhand.errors.SiteError`.
"""

from __future__ import annotations

from fieldhand.site.formats.files import SiteFiles, format_of
from fieldhand.site.formats.records import SiteRecords


def read_geojson(files: SiteFiles, *, lenient: bool) -> SiteRecords:
    """Read the features of a GeoJSON file."""
    from fieldhand.site.formats.geojson import geojson_records

    return geojson_records(files.parts[files.name], files.source, lenient=lenient)


def read_table(files: SiteFiles, *, lenient: bool) -> SiteRecords:  # noqa: ARG001  each line is a feature or an error
    """Read the features of a table: CSV, TSV or another separator."""
    from fieldhand.site.formats.table import table_records

    return table_records(files.parts[files.name], files.source)


def read_with_gdal(files: SiteFiles, *, lenient: bool) -> SiteRecords:
    """Read the features of a Shapefile, GeoPackage, KML or KMZ file, or of a zip file that holds one."""
    from fieldhand.site.formats.gis import gis_records

    form = format_of(files.name, files.parts[files.name], files.source)
    return gis_records(form, files.parts, files.source, lenient=lenient)
