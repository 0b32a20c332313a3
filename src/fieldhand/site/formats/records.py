"""Result of every reader: features in GeoJSON form with their numbers in the file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from fieldhand.errors import SiteError

RecordUnit = Literal["feature", "line"]
Format = Literal["geojson", "table", "shapefile", "geopackage", "kml", "zip"]

#: Parts of a Shapefile, the main one first.
SHAPEFILE_PARTS = (".shp", ".shx", ".dbf", ".prj", ".cpg")

MAX_BYTES = 100_000_000


@dataclass(kw_only=True)
class SiteRecords:
    """The unchecked features of a file, in degrees WGS 84.

    Attributes:
        features: GeoJSON features as decoded by ``json``; entries may be of any type.
        numbers: Number of each feature in the file; None for 1, 2, 3 ...
        unit: Unit that the numbers count.
        name: Name in the file, else empty.
        notes: Notes about content that the reader interpreted differently from the file.
    """

    features: Sequence[Any]
    numbers: Sequence[int] | None = None
    unit: RecordUnit = "feature"
    name: str = ""
    notes: tuple[str, ...] = ()


def too_big(at: str, size: int) -> SiteError:
    """Return the error for a file that is too big."""
    return SiteError(
        f"the file has {size / 1e6:,.0f} MB, more than {MAX_BYTES / 1e6:,.0f} MB",
        where=at,
        advice="divide the site into smaller ones",
    )


@dataclass(frozen=True)
class UnusablePart:
    """A placeholder for a feature that cannot be read: the reason, a remedy, and the properties that were read."""

    what: str
    advice: str
    properties: Mapping[str, Any] = field(default_factory=dict)
