"""Wording of tree attributes: "age is above 10 years"."""

from __future__ import annotations

from fieldhand.language import message, named
from fieldhand.language.words import say_name, say_value
from fieldhand.places.filters.attribute_dates import is_date
from fieldhand.terms import Test, Value

_ATTRIBUTE_UNITS = {
    "years": message("years"),
    "kg": "kg",
    "m": "m",
    "cm": "cm",
    "mm": "mm",
    "percent": "%",
    "degc": "°C",
    "ppm": "ppm",
    "days": message("days"),
}


def say_attribute(name: str) -> tuple[str, str]:
    """Split an attribute into its name in words and its unit suffix: ``age_years`` gives ("age", "years")."""
    stem, _, last = name.rpartition("_")
    unit = _ATTRIBUTE_UNITS.get(last.lower(), "")
    return (say_name(stem), unit) if stem and unit else (say_name(name), "")


def say_with_article(name: str) -> str:
    """Return a quantity or attribute with its article: "the canopy temperature", "the age"."""
    words = say_name(name)
    return named(f"the {words}", "the", message("the “{name}”", name=str(words)))


def say_whose(attribute: str, test: Test, value: Value) -> str:
    """Return a filter as a clause: "whose age is above 10 years", "whose leaf color is not yellow"."""
    name, unit = say_attribute(attribute)
    if isinstance(value, bool) and test in ("eq", "ne"):
        marked = value == (test == "eq")
        return message("marked as “{name}”", name=name) if marked else message("not marked as “{name}”", name=name)
    amount = _amount(value, unit)
    if is_date(value) and test not in ("eq", "ne"):
        return _whose_day(name, test, amount)
    match test:
        case "eq":
            return message("whose {name} is {amount}", name=name, amount=amount)
        case "ne":
            return message("whose {name} is not {amount}", name=name, amount=amount)
        case "lt":
            return message("whose {name} is below {amount}", name=name, amount=amount)
        case "le":
            return message("whose {name} is at most {amount}", name=name, amount=amount)
        case "gt":
            return message("whose {name} is above {amount}", name=name, amount=amount)
        case "ge":
            return message("whose {name} is at least {amount}", name=name, amount=amount)


def _whose_day(name: str, test: Test, day: str) -> str:
    """Return a comparison with a date as a clause."""
    match test:
        case "lt":
            return message("whose {name} is before {day}", name=name, day=day)
        case "le":
            return message("whose {name} is {day} or earlier", name=name, day=day)
        case "gt":
            return message("whose {name} is after {day}", name=name, day=day)
        case _:
            return message("whose {name} is {day} or later", name=name, day=day)


def say_of_tree(attribute: str, test: Test, value: Value) -> str:
    """Return a test of the current tree as a clause: "the tree's age is above 10 years"."""
    stem, unit = say_attribute(attribute)
    name = named(str(stem), "of the tree", message("“{name}” of the tree", name=str(stem)))
    amount = _amount(value, unit)
    match test:
        case "eq":
            return message("the tree's {name} is {amount}", name=name, amount=amount)
        case "ne":
            return message("the tree's {name} is not {amount}", name=name, amount=amount)
        case "lt":
            return message("the tree's {name} is below {amount}", name=name, amount=amount)
        case "le":
            return message("the tree's {name} is at most {amount}", name=name, amount=amount)
        case "gt":
            return message("the tree's {name} is above {amount}", name=name, amount=amount)
        case "ge":
            return message("the tree's {name} is at least {amount}", name=name, amount=amount)


def _amount(value: Value, unit: str) -> str:
    text = named(value, "value") if isinstance(value, str) else say_value(value)
    return message("{value} {unit}", value=text, unit=unit)
