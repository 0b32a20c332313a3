"""Process in which GDAL reads a file, started by :mod:`fieldhand.site.formats.sandbox`."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from fieldhand.errors import SiteError
from fieldhand.site.formats.sandbox import REQUEST, RESULT, as_json

#: Packages that pyogrio imports if they are installed, which takes most of a second; no function used here needs them.
_UNUSED = ("geopandas", "pandas", "pyarrow")


def main(folder: Path) -> int:
    """Read the files of a folder and write the records, or the error, beside them."""
    request = json.loads((folder / REQUEST).read_text())
    _limit(memory=request["memory"], cpu_s=request["cpu_s"], result=max(request["result"], 250_000_000))
    sys.modules |= dict.fromkeys(_UNUSED)  # type: ignore[arg-type]  # None: as if not installed
    from fieldhand.site.formats.gis import read_in_process

    contents = {name: (folder / str(number)).read_bytes() for number, name in enumerate(request["names"])}
    try:
        text = as_json(read_in_process(request["form"], contents, request["at"], lenient=request["lenient"]))
    except SiteError as error:
        text = json.dumps({"error": [error.what, error.where, error.advice]})
    except (MemoryError, RecursionError):
        return 1
    (folder / RESULT).write_text(text)
    return 0


def _limit(*, memory: int, cpu_s: int, result: int) -> None:
    """Limit the memory, processor time and files of this process."""
    try:
        import resource
    except ImportError:  # not available on this system; the wall-clock limit remains
        return
    for kind, most in (
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_CPU, cpu_s),
        (resource.RLIMIT_FSIZE, result),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_NOFILE, 256),
    ):
        _, hard = resource.getrlimit(kind)
        bounded = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(kind, (bounded, bounded))


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1])))
