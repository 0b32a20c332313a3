"""Compilation with numba, kept on disk so that only the first use of an installation waits for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """Compile for this machine; kept beside the source, else in the user's cache folder, else for this process only."""
    options: dict[str, Any] = {"error_model": "numpy", "nogil": True}
    try:
        made: F = numba.njit(cache=True, **options)(function)
    except RuntimeError:
        # No folder can be written that numba would keep it in.
        made = numba.njit(**options)(function)
    return made
