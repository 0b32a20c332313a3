"""Short representations of large objects, for tracebacks, logs and interactive sessions."""

from __future__ import annotations

from collections.abc import Sized
from dataclasses import fields, is_dataclass
from typing import Any

#: Maximum length of a value, in characters.
_LONGEST = 60


def short_repr(value: Any) -> str:
    """Return the representation of a dataclass: collections by their size, nested dataclasses by their class name.

    Assign it to ``__repr__`` of a dataclass with ``repr=False``.
    """
    parts = ", ".join(f"{f.name}={_short(getattr(value, f.name))}" for f in fields(value) if f.repr)
    return f"{type(value).__name__}({parts})"


def _short(part: Any) -> str:
    if is_dataclass(part) and not isinstance(part, type):
        return f"<{type(part).__name__}>"
    if isinstance(part, Sized) and not isinstance(part, str | bytes):
        return f"<{len(part)} items>" if len(part) else "()"
    if isinstance(part, str | bytes):
        return repr(part if len(part) <= _LONGEST else part[:_LONGEST]) + ("..." if len(part) > _LONGEST else "")
    return type(part).__name__ if len(text := repr(part)) > _LONGEST else text
