"""Run the fast part of the tests on every other supported Python at hand, and compare the results of all.

    python scripts/test_versions.py --within 150

Interpreters are found as python3.10 and so on in the PATH, and among those of pyenv. Each gets an environment below
build/pythons, with the smallest set of packages and what the tests need.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "build" / "pythons"
#: Supported releases, by the order in which they are tested.
RELEASES = ((3, 10), (3, 13), (3, 12), (3, 11))
PACKAGES = ("-e", ".[testing]", "rapidfuzz")
#: Tests that need neither the solver nor another process, about half a minute on one core.
FAST = (
    "tests/test_compatibility.py",
    "tests/test_strict_yaml.py",
    "tests/test_errors.py",
    "tests/task",
    "tests/timetable",
)


class OutOfTimeError(Exception):
    """The time for all interpreters is used up."""


@dataclass(frozen=True)
class Deadline:
    """Instant at which everything ends, in seconds of the monotonic clock."""

    at_s: float

    def run(self, *words: str | Path) -> subprocess.CompletedProcess[str]:
        """Run a program in the checkout, and return its output.

        Raises:
            OutOfTimeError: It did not end in time.
        """
        left_s = self.at_s - time.monotonic()
        try:
            if left_s <= 0:
                raise OutOfTimeError
            return subprocess.run(
                list(map(str, words)), cwd=ROOT, capture_output=True, text=True, check=False, timeout=left_s
            )
        except subprocess.TimeoutExpired as error:
            raise OutOfTimeError from error


def interpreter(release: tuple[int, int]) -> Path | None:
    """Return an interpreter of a release; None if there is none."""
    name = "python{}.{}".format(*release)
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    patched = pyenv.glob("{}.{}.*/bin/python".format(*release))
    found = [shutil.which(name), *sorted(patched, key=lambda path: int(path.parts[-3].rpartition(".")[2]))[::-1]]
    asked = "import sys, venv; print(sys.version_info[:2])"
    for path in filter(None, found):
        told = subprocess.run([str(path), "-c", asked], capture_output=True, text=True, check=False)
        if told.stdout.strip() == str(release):
            return Path(path)
    return None


def prepared(python: Path, folder: Path, deadline: Deadline) -> Path:
    """Return the interpreter of an environment with the packages, which is made if it is missing or outdated.

    Raises:
        RuntimeError: The packages cannot be installed.
    """
    own = folder / "bin" / "python"
    wanted = [
        str(python.resolve()),
        *PACKAGES,
        *((ROOT / name).read_text() for name in ("pyproject.toml", "constraints.txt")),
    ]
    digest, stamp = hashlib.sha256("\0".join(wanted).encode()).hexdigest(), folder / "packages.sha256"
    if stamp.is_file() and stamp.read_text() == digest:
        return own
    pip = (own, "-m", "pip", "install", "-q", "--no-compile", "--disable-pip-version-check")
    for words in ((python, "-m", "venv", "--clear", folder), (*pip, "-c", "constraints.txt", *PACKAGES)):
        done = deadline.run(*words)
        if done.returncode:
            raise RuntimeError(done.stderr.strip() or done.stdout.strip())
    stamp.write_text(digest)
    return own


def problem(python: Path, release: tuple[int, int], expected: str, deadline: Deadline) -> str:
    """Return what is wrong with a release; empty if nothing is."""
    try:
        own = prepared(python, FOLDER / "{}.{}".format(*release), deadline)
    except RuntimeError as error:
        return f"its packages cannot be installed\n{error}"
    results = deadline.run(own, "scripts/results.py")
    if results.returncode or results.stdout != expected:
        return f"scripts/results.py differs\n{results.stdout}{results.stderr}\nExpected:\n{expected}"
    tests = deadline.run(own, "-m", "pytest", "-p", "no:cacheprovider", *FAST)
    return f"tests failed\n{tests.stdout}{tests.stderr}" if tests.returncode else ""


def main() -> int:
    """Test all releases and print a line for each; return the exit status."""
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--within", type=float, default=600.0, metavar="SECONDS", help="time for all; default 600")
    within_s = options.parse_args().within
    deadline = Deadline(time.monotonic() + within_s)
    status = 0
    own = deadline.run(sys.executable, "scripts/results.py")
    if own.returncode:
        print(own.stderr)
        return 1
    for release in RELEASES:
        if release == sys.version_info[:2]:
            continue
        name, begun_s = "Python {}.{}".format(*release), time.monotonic()
        python = interpreter(release)
        if python is None:
            print(f"{name}: not tested, there is none at hand")
            continue
        try:
            wrong = problem(python, release, own.stdout, deadline)
        except OutOfTimeError:
            print(f"{name}: not tested, {within_s:g} s are over")
            continue
        status = 1 if wrong else status
        print(f"{name}: {wrong}" if wrong else f"{name}: passed in {time.monotonic() - begun_s:.0f} s", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
