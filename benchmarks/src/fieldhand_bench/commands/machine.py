"""A description of the machine and the software on which figures are measured."""

from __future__ import annotations


def machine() -> dict[str, str]:
    """Return the machine, processor, core count, load and software versions, to be printed beside the figures."""
    import os
    import platform
    from importlib.metadata import version
    from pathlib import Path

    cpu = platform.processor()
    known = Path("/proc/cpuinfo")
    if known.exists():
        named = (
            line.partition(":")[2].strip() for line in known.read_text().splitlines() if line.startswith("model name")
        )
        cpu = next(named, cpu)
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "shapely", "pyproj"))
    return {
        "machine": f"{platform.system()} {platform.machine()}",
        "cpu": cpu or "unknown processor",
        "cores": str(os.cpu_count() or 1),
        "load": f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown",
        "software": f"Python {platform.python_version()}, {packages}",
    }
