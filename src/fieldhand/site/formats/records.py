"""The result of every reader: features in GeoJSON form, and the position of each in the file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from fieldhand.errors import SiteError

Unit = Literal["feature", "line"]
Format = Literal["geojson", "table", "shapefile", "geopackage", "kml", "zip"]

#: Parts of a Shapefile, the main one first.
SHAPEFILE_PARTS = (".shp", ".shx", ".dbf", ".prj", ".cpg")

MAX_BYTES = 100_000_000


@dataclass(kw_only=True)
class SiteRecords:
    """The features of a file, not yet checked, in degrees WGS 84.

    Attributes:
        features: GeoJSON features as ``json`` reads them; a reader may leave anything in here.
        numbers: For each feature its number in the file; None for 1, 2, 3 ...
        unit: What the numbers count.
        name: The name that the file gives itself, else empty.
        notes: What the reader took otherwise than it stands in the file.
    """

    features: Sequence[Any]
    numbers: Sequence[int] | None = None
    unit: Unit = "feature"
    name: str = ""
    notes: tuple[str, ...] = ()


def too_big(at: str, size: int) -> SiteError:
    """That a file is too big to be read."""
    return SiteError(
        f"the file has {size / 1e6:,.0f} MB, more than {MAX_BYTES / 1e6:,.0f} MB",
        where=at,
        advice="cut the site into smaller ones",
    )


@dataclass(frozen=True)
class UnusablePart:
    """In the place of a feature: why it cannot be read, what to do, and what is known of it all the same."""

    what: str
    advice: str
    properties: Mapping[str, Any] = field(default_factory=dict)
