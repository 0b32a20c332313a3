"""Compilation with numba, kept on disk so that only the first use of an installation waits for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """Compile for this machine; kept beside the source, else in the user's cache folder, else for this process only."""
    return _compile(function, {})


def inner(function: F) -> F:
    """Compile a loop that makes no array, as :func:`compiled` does, without counting who holds the arrays.

    numba counts at every access to an array of a tuple, atomically: measured, that takes 90 ns for a length that is
    looked up in 3. Whoever calls holds the arrays for as long as the call lasts.
    """
    return _compile(function, {"_nrt": False})


def _compile(function: F, more: dict[str, Any]) -> F:
    options: dict[str, Any] = {"error_model": "numpy", "nogil": True, **more}
    try:
        made: F = numba.njit(cache=True, **options)(function)
    except RuntimeError:
        # No folder can be written that numba would keep it in.
        made = numba.njit(**options)(function)
    return made
