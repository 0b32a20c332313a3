"""Short representations of large objects, for tracebacks, logs and interactive sessions."""

from __future__ import annotations

from collections.abc import Sized
from dataclasses import fields, is_dataclass
from typing import Any

_LONGEST = 60


def brief_repr(value: Any) -> str:
    """Return a dataclass as its fields: collections as their size, parts that are dataclasses as their class.

    Assign it to ``__repr__`` of a dataclass with ``repr=False``.
    """
    held = ", ".join(f"{f.name}={_brief(getattr(value, f.name))}" for f in fields(value) if f.repr)
    return f"{type(value).__name__}({held})"


def _brief(part: Any) -> str:
    if is_dataclass(part) and not isinstance(part, type):
        return f"<{type(part).__name__}>"
    if isinstance(part, Sized) and not isinstance(part, str | bytes):
        return f"<{len(part)} items>" if len(part) else "()"
    if isinstance(part, str | bytes):
        return repr(part if len(part) <= _LONGEST else part[:_LONGEST]) + ("..." if len(part) > _LONGEST else "")
    return type(part).__name__ if len(text := repr(part)) > _LONGEST else text
