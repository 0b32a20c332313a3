"""``fieldhand`` where only the smallest set of packages is installed, those that the distribution itself requires."""

from __future__ import annotations

import importlib.metadata
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from packaging.requirements import Requirement

from fieldhand.compatibility import tomllib
from support.processes.command import Run

ROOT = Path(__file__).parents[3]

#: Runs the command line; packages of the first argument cannot be imported.
_PROGRAM = """
import sys
absent = frozenset(sys.argv.pop(1).split(","))

class Absent:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name.partition(".")[0] in absent:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Absent)
from fieldhand.program import main
main()
"""


def requirements() -> tuple[list[str], dict[str, list[str]]]:
    """Return the requirements of the distribution and those of its extras, as this checkout declares them."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return project["dependencies"], project["optional-dependencies"]


def _folded(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _installed(declared: Sequence[str], found: set[str]) -> None:
    """Add the installed distributions that these requirements bring."""
    for text in declared:
        wanted = Requirement(text)
        name = _folded(wanted.name)
        if name in found or (wanted.marker is not None and not wanted.marker.evaluate({"extra": ""})):
            continue
        found.add(name)
        try:
            _installed(importlib.metadata.requires(wanted.name) or [], found)
        except importlib.metadata.PackageNotFoundError:
            continue


@cache
def absent() -> frozenset[str]:
    """Return the top-level modules of installed distributions that the smallest set lacks."""
    present = {"fieldhand"}
    _installed(requirements()[0], present)
    owners: dict[str, set[str]] = {}
    for distribution in importlib.metadata.distributions():
        for module in _modules(distribution):
            owners.setdefault(module, set()).add(_folded(distribution.metadata["Name"]))
    return frozenset(module for module, names in owners.items() if module.isidentifier() and not present & names)


def _modules(distribution: importlib.metadata.Distribution) -> set[str]:
    """Return the top-level modules of a distribution.

    ``packages_distributions()`` of Python 3.10 omits distributions without ``top_level.txt``, which is most of them.
    """
    modules = set((distribution.read_text("top_level.txt") or "").split())
    for file in distribution.files or ():
        if len(file.parts) > 1:
            modules.add(file.parts[0])
        elif file.suffix in (".py", ".so"):
            modules.add(file.name.partition(".")[0])
    return modules


def fieldhand_on_robot(*words: str, cwd: Path, config: Path) -> Run:
    """Run ``fieldhand`` with these words on a robot, whose keys are in a folder."""
    environment = os.environ | {
        "FIELDHAND_CONFIG": str(config),
        "PYTHONPATH": os.pathsep.join(p for p in sys.path if p),
    }
    done = subprocess.run(
        [sys.executable, "-c", _PROGRAM, ",".join(sorted(absent())), *words],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    return Run(status=done.returncode, out=done.stdout, err=done.stderr)
