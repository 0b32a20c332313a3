"""The machine and the software that figures are measured on."""

from __future__ import annotations


def machine() -> dict[str, str]:
    """Return what the figures are measured on, without which they mean nothing."""
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
