"""Value types shared by all parts of a profile file."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from typing import Annotated

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator


def no_bool(value: object) -> object:
    """Reject booleans where a number is expected."""
    if isinstance(value, bool):
        raise ValueError(f"must be a number, not {str(value).lower()}")
    return value


def _name(value: str) -> str:
    if not re.fullmatch(r"[a-z][a-z0-9_]*", value):
        raise ValueError(
            f"{value!r} is not a name: use lower-case letters, digits and underscores, beginning with a letter"
        )
    return value


def _unit(value: str) -> str:
    if not re.fullmatch(r"\S{1,20}", value) or not value.isprintable():
        raise ValueError(f"{value!r} is not a unit: at most 20 characters without spaces, such as degC, ppm, percent")
    return value


def each_once(values: tuple[str, ...]) -> tuple[str, ...]:
    """Reject lists with duplicates."""
    twice = sorted({v for v in values if values.count(v) > 1})
    if twice:
        raise ValueError(f"{twice[0]!r} is given twice here")
    return values


def _not_tiny(value: float) -> float:
    if 0 < value < _LEAST:
        raise ValueError(f"{value:g} is too small: a value other than 0 must be at least {_LEAST:g} here")
    return value


def _not_huge(value: float) -> float:
    if abs(value) > _MOST:
        raise ValueError(f"{value:g} is too large: a number here must not exceed {_MOST:g}")
    return value


#: Smallest and largest magnitude of a number in any unit, so that computations neither overflow nor underflow.
_LEAST, _MOST = 1e-9, 1e12

NumberField = Annotated[float, BeforeValidator(no_bool), Field(allow_inf_nan=False), AfterValidator(_not_huge)]
Positive = Annotated[NumberField, Field(gt=0), AfterValidator(_not_tiny)]
NotNegative = Annotated[NumberField, Field(ge=0)]
IdentifierField = Annotated[str, AfterValidator(_name)]
UnitField = Annotated[str, AfterValidator(_unit)]


class Keyed(BaseModel):
    """The base model of profile parts; it rejects unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: object) -> object:
        """Report a misspelt key with the nearest known one, before the latter is reported as missing."""
        if isinstance(data, Mapping):
            for key in data:
                if key not in cls.model_fields:
                    near = difflib.get_close_matches(str(key), cls.model_fields, n=1)
                    hint = f"did you mean {near[0]!r}?" if near else f"the keys here are {', '.join(cls.model_fields)}"
                    raise ValueError(f"unknown key {str(key)!r}; {hint}")
        return data
