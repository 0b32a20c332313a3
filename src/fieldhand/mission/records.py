"""Tuples of records that become tables: pandas, GeoPandas, and HTML for notebooks."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, TypeVar

from fieldhand.errors import InputError
from fieldhand.markup import element, table_html

if TYPE_CHECKING:
    import geopandas
    import pandas

T_co = TypeVar("T_co", covariant=True)

#: Rows of a table in a notebook, and characters of a cell.
_MOST_ROWS, _LONGEST = 20, 60
#: Types of records that a representation counts.
_MOST_KINDS = 4


class Records(tuple[T_co, ...]):
    """A tuple of dataclasses with the methods of a table."""

    __slots__ = ()

    def to_pandas(self) -> pandas.DataFrame:
        """Return a DataFrame with a row per record and a column per field; needs the extra ``notebook``.

        Raises:
            InputError: pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise _missing("pandas") from None
        return pandas.DataFrame([record_of(one) for one in self])

    def to_geopandas(self) -> geopandas.GeoDataFrame:
        """Return a GeoDataFrame of the records that have a position, in degrees (EPSG:4326).

        Raises:
            InputError: GeoPandas is not installed, or no record has a position.
        """
        try:
            import geopandas
        except ImportError:
            raise _missing("geopandas") from None
        table = self.to_pandas()
        if "lat" not in table or "lon" not in table:
            raise InputError("these records have no positions", advice="take the observations of the run")
        table = table.dropna(subset=["lat", "lon"])
        return geopandas.GeoDataFrame(
            table, geometry=geopandas.points_from_xy(table["lon"], table["lat"]), crs="EPSG:4326"
        )

    def __repr__(self) -> str:
        kinds = Counter(type(record).__name__ for record in self).most_common()
        shown = ", ".join(f"{count} {kind}" for kind, count in kinds[:_MOST_KINDS])
        return f"<{type(self).__name__}: {shown or 'empty'}{', ...' if len(kinds) > _MOST_KINDS else ''}>"

    def _repr_html_(self) -> str:
        """Return the first rows as a table for a notebook."""
        rows = [record_of(one) for one in self[:_MOST_ROWS]]
        columns = list(dict.fromkeys(key for row in rows for key in row))
        cells = [[_cell(row.get(column, "")) for column in columns] for row in rows]
        more = element("p", f"{len(self) - len(rows)} more rows") if len(self) > len(rows) else ""
        return table_html(columns, cells) + more


def record_of(one: Any) -> dict[str, Any]:
    """Return a dataclass as a flat record; an event begins with its type."""
    kind = getattr(type(one), "event", None)
    fields = asdict(one)
    return {"event": kind, **fields} if isinstance(kind, str) else fields


def _cell(value: object) -> str:
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _missing(library: str) -> InputError:
    return InputError(f"{library} is not installed", advice="pip install 'fieldhand[notebook]'")
