"""The base class of the parts of a case file."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class Form(BaseModel):
    """A part of the file, which has the declared keys and no others."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @classmethod
    def keys(cls) -> tuple[str, ...]:
        """Return the keys that it may have."""
        return tuple(field.alias or name for name, field in cls.model_fields.items())
