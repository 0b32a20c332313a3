"""Attributes of trees in words: "age is above 10 years"."""

from __future__ import annotations

from fieldhand.task.selectors import Test, Value
from fieldhand.task.words import TESTS, say_name, say_value

_ATTRIBUTE_UNITS = {
    "years": "years",
    "kg": "kg",
    "m": "m",
    "cm": "cm",
    "mm": "mm",
    "percent": "%",
    "degc": "°C",
    "ppm": "ppm",
    "days": "days",
}


def say_attribute(name: str) -> tuple[str, str]:
    """An attribute as words and the unit that its name ends with: ``age_years`` is ("age", "years")."""
    stem, _, last = name.rpartition("_")
    unit = _ATTRIBUTE_UNITS.get(last.lower(), "")
    return (say_name(stem), unit) if stem and unit else (say_name(name), "")


def say_test(attribute: str, test: Test, value: Value) -> str:
    """A test of an attribute as a clause: "age is above 10 years", "leaf color is not yellow"."""
    name, unit = say_attribute(attribute)
    amount = f"{say_value(value)} {unit}".rstrip()
    match test:
        case "eq":
            return f"{name} is {amount}"
        case "ne":
            return f"{name} is not {amount}"
        case _:
            return f"{name} is {TESTS[test]} {amount}"
