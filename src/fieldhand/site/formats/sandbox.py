"""Read files that need GDAL or unpacking in a separate process with limited memory and time.

A malicious file of 200 kB can make a reader allocate gigabytes or never finish, and can exploit errors in a reader
written in C. Therefore the reader runs in its own process (:mod:`fieldhand.site.formats.gis_process`):

    files ──▶ folder ──▶ process with limits ──▶ JSON, bounded ──▶ records
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fieldhand.errors import SiteError
from fieldhand.site.formats.records import SiteRecords, UnusablePart

RESULT, REQUEST = "result.json", "request.json"
#: Environment variables passed to the process; settings of GDAL, proxies and tokens are not.
_PASSED = ("PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "LANG", "LC_ALL", "SYSTEMROOT", "PROJ_DATA", "PROJ_LIB")


@dataclass(frozen=True, kw_only=True)
class ReadLimits:
    """Limits for reading files of a given size.

    Attributes:
        memory: Bytes of address space.
        result: Bytes of the records as JSON.
        cpu_s, wall_s: Seconds of processor time and of wall-clock time.
    """

    memory: int
    result: int
    cpu_s: int
    wall_s: float


def read_limits(size: int) -> ReadLimits:
    """Return the limits for files of a given size; a measured site of 100,000 trees uses a third of them."""
    return ReadLimits(
        memory=min(1_000_000_000 + 20 * size, 3_000_000_000),
        result=min(16_000_000 + 20 * size, 300_000_000),
        cpu_s=20 + size // 1_000_000,
        wall_s=120.0 + size / 250_000,
    )


def read_sandboxed(
    form: str, contents: Mapping[str, bytes], at: str, *, lenient: bool, allowed: ReadLimits | None = None
) -> SiteRecords:
    """Read files in a process with limited resources and return their records.

    Args:
        form, contents, at, lenient: As for :func:`fieldhand.site.formats.gis.gis_records`.
        allowed: Limits; by default those of :func:`read_limits`.

    Raises:
        SiteError: The files cannot be read within the limits.
    """
    allowed = allowed or read_limits(sum(map(len, contents.values())))
    with tempfile.TemporaryDirectory(prefix="fieldhand-") as temporary:
        folder = Path(temporary)
        for number, data in enumerate(contents.values()):
            (folder / str(number)).write_bytes(data)
        request = {
            "form": form,
            "names": list(contents),
            "at": at,
            "lenient": lenient,
            "memory": allowed.memory,
            "result": allowed.result,
            "cpu_s": allowed.cpu_s,
        }
        (folder / REQUEST).write_text(json.dumps(request))
        environment = {name: os.environ[name] for name in _PASSED if name in os.environ}
        environment |= {"TMPDIR": temporary, "HOME": temporary, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        command = [sys.executable, "-m", "fieldhand.site.formats.gis_process", temporary]
        try:
            done = subprocess.run(  # noqa: S603
                command,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=allowed.wall_s,
                check=False,
            ).returncode
        except subprocess.TimeoutExpired:
            raise _too_much(allowed, at) from None
        except OSError as error:
            raise SiteError(
                f"the reader for this format cannot be started ({error.strerror or error})",
                where=at,
                advice="export the site as GeoJSON (WGS 84)",
            ) from None
        return _records(folder / RESULT, done, allowed, at)


def as_json(records: SiteRecords) -> str:
    """Return records as JSON text."""
    features = [
        {"unusable": [f.what, f.advice, dict(f.properties)]} if isinstance(f, UnusablePart) else {"feature": f}
        for f in records.features
    ]
    return json.dumps(
        {
            "features": features,
            "numbers": None if records.numbers is None else list(records.numbers),
            "unit": records.unit,
            "name": records.name,
            "notes": list(records.notes),
        },
        default=_plain,
    )


def _plain(value: Any) -> Any:
    """Return a field value as a JSON type; None for bytes, which no site needs."""
    if isinstance(value, bytes):
        return None
    return value.tolist() if hasattr(value, "tolist") else str(value)


def _records(result: Path, status: int, allowed: ReadLimits, at: str) -> SiteRecords:
    try:
        size = result.stat().st_size if status == 0 else -1
        if not 0 <= size <= allowed.result:
            raise _too_much(allowed, at)
        found = json.loads(result.read_bytes())
        if "error" in found:
            what, where, advice = found["error"]
            raise SiteError(what, where=where, advice=advice)
        return SiteRecords(
            features=[UnusablePart(*f["unusable"]) if "unusable" in f else f["feature"] for f in found["features"]],
            numbers=found["numbers"],
            unit=found["unit"],
            name=found["name"],
            notes=tuple(found["notes"]),
        )
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        raise _too_much(allowed, at) from None


def _too_much(allowed: ReadLimits, at: str) -> SiteError:
    return SiteError(
        f"the file cannot be read within the limits for its size"
        f" ({allowed.memory / 1e9:.1f} GB of memory, {allowed.cpu_s} s), or its reader crashed",
        where=at,
        advice="do not trust this file; export the site as GeoJSON (WGS 84)",
    )
