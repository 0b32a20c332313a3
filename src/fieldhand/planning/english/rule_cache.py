"""Keep what is worked out from ``wordings/`` in a file: to work it out takes a fifth of a second a process."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any


def cached(texts: Sequence[str], work_out: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """Return a JSON record from the file beside the compiled modules; work it out where the file does not fit.

    The file is trusted as the compiled modules are, and holds data alone.

    Args:
        texts: What the record is worked out from; the code that does it counts as well.
        work_out: Returns the record.
    """
    file = Path(__file__).parent / "__pycache__" / "rules.json"
    code = [(Path(__file__).parent / name).read_text("utf-8") for name in ("wording.py", "triggers.py")]
    digest = hashlib.sha256("\0".join([*code, *texts]).encode()).hexdigest()
    with contextlib.suppress(OSError, ValueError, LookupError, TypeError):
        kept = json.loads(file.read_bytes())
        if kept["digest"] == digest:
            return dict(kept["record"])
    record = work_out()
    _write(file, {"digest": digest, "record": record})
    return record


def _write(file: Path, kept: dict[str, Any]) -> None:
    """Write the file whole or not at all: other processes may read it meanwhile."""
    beside = file.with_suffix(f".{os.getpid()}")
    with contextlib.suppress(OSError):
        beside.write_text(json.dumps(kept), encoding="utf-8")
        beside.replace(file)
