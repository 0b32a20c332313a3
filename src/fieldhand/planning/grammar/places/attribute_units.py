"""Units of attributes, which their names end with: "height_cm" is in centimetres."""

from __future__ import annotations

from fieldhand.planning.english.naming import split
from fieldhand.planning.grammar.words import hinted_attributes
from fieldhand.site.model import Site

#: Unit of amounts and factor, by the last word of an attribute's name.
_UNITS: dict[str, tuple[str, float]] = {
    "m": ("metres", 1.0),
    "cm": ("metres", 100.0),
    "mm": ("metres", 1000.0),
    "km": ("metres", 0.001),
    "kg": ("kg", 1.0),
    "g": ("kg", 1000.0),
    "years": ("years", 1.0),
    "months": ("years", 12.0),
    "percent": ("percent", 1.0),
    "pct": ("percent", 1.0),
    "degc": ("degC", 1.0),
    "ppm": ("ppm", 1.0),
    "s": ("seconds", 1.0),
    "min": ("seconds", 1.0 / 60.0),
    "h": ("seconds", 1.0 / 3600.0),
    "days": ("seconds", 1.0 / 86_400.0),
}
#: Word in the name of the attribute that an amount is about, by its unit.
_USUAL = {"years": "age", "kg": "yield", "metres": "height"}


def unit_of_attribute(attribute: str) -> str:
    """Return the unit of amounts with which an attribute is compared; empty if its name gives none."""
    words = split(attribute)
    return _UNITS.get(words[-1], ("", 0.0))[0] if len(words) > 1 else ""


def in_unit_of_attribute(attribute: str, number: float, unit: str) -> float | None:
    """Return an amount in the unit of an attribute; None if it is of another kind.

    Args:
        attribute: Name of the attribute.
        number: Number of the amount.
        unit: Its unit, as of :class:`~fieldhand.planning.grammar.meaning.Amount`; empty if it has none.
    """
    own = unit_of_attribute(attribute)
    if not unit or not own:
        return number
    return round(number * _UNITS[split(attribute)[-1]][1], 9) if own == unit else None


def attributes_in(unit: str, site: Site) -> list[str]:
    """Return the attributes that an amount without a noun is about: "under 22 cm", "over 8 years"."""
    if not unit:
        return []
    usual = hinted_attributes(_USUAL[unit], site) if unit in _USUAL else []
    return usual or [name for name in site.attributes if unit_of_attribute(name) == unit]
