"""Compilation with numba, kept on disk so that only the first use of an installation waits for it."""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])


def remove_stale(folder: Path) -> None:
    """Remove machine code that was compiled from other sources than those in a folder.

    numba compares the source of each function, but fails to read an index in which a class is named that has been
    renamed since.

    Args:
        folder: Folder of the kernels' sources; the machine code is in its ``__pycache__``.
    """
    digest = hashlib.sha256(b"\0".join(path.read_bytes() for path in sorted(folder.glob("*.py")))).hexdigest()
    stamp = folder / "__pycache__" / "sources.sha256"
    with contextlib.suppress(OSError):
        if stamp.is_file() and stamp.read_text("utf-8") == digest:
            return
        for pattern in ("*.nbi", "*.nbc"):
            for file in stamp.parent.glob(pattern):
                file.unlink(missing_ok=True)
        if stamp.parent.is_dir():
            stamp.write_text(digest, "utf-8")


remove_stale(Path(__file__).parent)


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
