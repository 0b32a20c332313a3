"""The referee that stands beside the project, not in it, and the cases that it judges."""

from __future__ import annotations

import importlib.util
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

SHARED = Path(__file__).resolve().parents[4] / "shared"
CASES = SHARED / "data" / "missions" / "orchard.yaml"
_PROGRAM = SHARED / "tools" / "referee.py"
HERE = _PROGRAM.exists() and CASES.exists()


@cache
def referee() -> ModuleType:
    """The referee's program as a module; it imports nothing of this package."""
    spec = importlib.util.spec_from_file_location("referee", _PROGRAM)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def ground(path: Path) -> Any:
    """The referee's view of a site; its corners are worked out once, not for every tree that it looks at."""
    site = referee().Site(path)
    corners = site.corner_trees()
    site.corner_trees = lambda: corners
    return site
