"""Compilation with numba, cached on disk so that only the first use of an installation has to wait for it."""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from fieldhand.extras import missing_package

try:
    import numba
except ModuleNotFoundError as error:
    raise (missing_package(error) or error) from error

F = TypeVar("F", bound=Callable[..., Any])


def remove_stale(folder: Path) -> None:
    """Remove cached machine code that was compiled from other sources than the present ones.

    numba checks the source of each function, but cannot read an index that refers to a class that has since been
    renamed.

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
    """Compile for this machine; cache beside the source, else in the user's cache folder, else only in this process."""
    return _compile(function, {})


def inner(function: F) -> F:
    """Compile, as :func:`compiled` does, a loop that creates no arrays, without reference counting.

    numba counts references atomically at every access to an array in a tuple: as measured, 90 ns for a length that is
    looked up in 3 ns. The caller holds references to the arrays for the duration of the call.
    """
    return _compile(function, {"_nrt": False})


def _compile(function: F, more: dict[str, Any]) -> F:
    options: dict[str, Any] = {"error_model": "numpy", "nogil": True, **more}
    try:
        made: F = numba.njit(cache=True, **options)(function)
    except RuntimeError:
        # numba finds no writable folder for its cache.
        made = numba.njit(**options)(function)
    return made
