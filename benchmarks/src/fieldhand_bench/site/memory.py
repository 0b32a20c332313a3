"""Measure the peak memory of a fresh process that only loads a site with its rows and its drivable graph."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

_PROGRAM = "import sys; from fieldhand_bench.site.measure import load; load(*sys.argv[1:])"


def peak_bytes(file: Path, clearance_m: float, standoff_m: float) -> int | None:
    """Return the peak memory of loading a file, bytes; None if the system does not report it."""
    done = subprocess.run(  # noqa: S603  (our own interpreter, our own program)
        [sys.executable, "-c", _PROGRAM, str(file), str(clearance_m), str(standoff_m)],
        capture_output=True,
        text=True,
        check=False,
    )
    text = done.stdout.strip()
    return int(text) if done.returncode == 0 and text.isdigit() else None


def own_peak_bytes() -> int | None:
    """Return the peak memory of this process, bytes; None if the system does not report it."""
    # On Linux ru_maxrss of a child process includes the peak of its parent; VmHWM does not.
    status = Path("/proc/self/status")
    if status.exists():
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    try:
        import resource
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
