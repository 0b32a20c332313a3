"""The files that this process opens, for tests that count them."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_counting: list[Counter[str]] = []


def _hear(event: str, values: tuple[object, ...]) -> None:
    if event != "open" or not _counting:
        return
    path, _, flags = values
    if isinstance(path, str | bytes | os.PathLike) and isinstance(flags, int) and not flags & (os.O_WRONLY | os.O_RDWR):
        _counting[-1][str(Path(os.fsdecode(path)).absolute())] += 1


sys.addaudithook(_hear)


@contextmanager
def read_files_under(folder: Path) -> Iterator[Counter[Path]]:
    """Count how often each file of a folder is opened for reading while this lasts; there is the count at the end."""
    found: Counter[Path] = Counter()
    _counting.append(Counter())
    try:
        yield found
    finally:
        counted = _counting.pop()
        found.update(
            {
                Path(path).relative_to(folder): times
                for path, times in counted.items()
                if Path(path).is_relative_to(folder) and Path(path).is_file()
            }
        )
