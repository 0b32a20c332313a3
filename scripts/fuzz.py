"""Feed a reader with documents that are nearly right, for some minutes, and keep whatever it falls over.

    pip install 'fieldhand[fuzz]'
    python scripts/fuzz.py TARGET --minutes 10 --seed 1 [--keep FOLDER]

Atheris (libFuzzer) chooses what to change by the code that is reached; what it changes is told by ``fuzzing.mutate``.
Seeds are valid documents that the program makes itself (``fuzzing.ground``), never files of anybody. Found are:

* an exception that is none of Fieldhand's own: a user would see a traceback;
* a message that cannot be printed, or is longer than a screen;
* an input that takes longer than ``--limit`` seconds (a hang), or more memory than ``--memory`` megabytes.

Each distinct one is kept with its input in FOLDER; exit status 1 if there is any.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fuzzing.targets import Target

#: Of one input, in bytes; and of a message, in characters.
MAX_INPUT, MAX_MESSAGE = 70_000, 4_000
#: How often figures are written down, so that a reader that is killed takes few with it.
_NOTED_EVERY_S = 0.5
#: What is watched while it reads; what is compiled (numba) or only used to make seeds is not.
READERS = (
    *("fieldhand.approval.bundle", "fieldhand.approval.keys", "fieldhand.evaluation.calibration", "fieldhand.exchange"),
    *("fieldhand.execution.event_log", "fieldhand.execution.drivers.simulation.ground_truth"),
    *(f"fieldhand.execution.drivers.simulation.{part}" for part in ("world_faults", "world_file")),
    *("fieldhand.robot", "fieldhand.strict_yaml", "fieldhand.task"),
    *("fieldhand.site.build_site", "fieldhand.site.features", "fieldhand.site.formats", "fieldhand.site.feature_kinds"),
)
NAMES = ("bundle", "task", "tree", "world", "profile", "site", "table", "log", "mcap", "key")


@dataclass
class Figures:
    """What came of a run.

    Attributes:
        read: Inputs that were read without complaint.
        failures: How often each distinct failure was met.
    """

    inputs: int = 0
    read: int = 0
    slowest_s: float = 0.0
    failures: dict[str, int] = field(default_factory=dict)

    def add(self, other: Figures) -> None:
        """Take in what another process has found."""
        self.inputs += other.inputs
        self.read += other.read
        self.slowest_s = max(self.slowest_s, other.slowest_s)
        for name, times in other.failures.items():
            self.failures[name] = self.failures.get(name, 0) + times


class Reading:
    """One reader under test, called with an input at a time.

    Args:
        target: What reads.
        keep: Folder for inputs that it falls over, and for ``figures.json``.
        work: Folder for files that it takes.
    """

    def __init__(self, target: Target, keep: Path, work: Path) -> None:
        self.figures = Figures()
        self._target, self._keep, self._work = target, keep, work
        self._noted = time.monotonic()

    def __call__(self, data: bytes) -> None:
        """Read one input, and note what comes of it."""
        from fieldhand.errors import FieldhandError

        began = time.process_time()
        try:
            self._target.read(data, self._work)
            self.figures.read += 1
        except FieldhandError as error:
            self._require_printable(str(error), data)
        except Exception as error:  # noqa: BLE001  whatever it is, a user would see it
            self._found(_name(error), data, traceback.format_exc())
        took = time.process_time() - began
        self.figures.inputs += 1
        if took > self.figures.slowest_s:
            self.figures.slowest_s = took
            (self._keep / "slowest").write_bytes(data)
        if time.monotonic() - self._noted > _NOTED_EVERY_S:
            self.note()

    def note(self) -> None:
        """Write the figures down."""
        self._noted = time.monotonic()
        (self._keep / "figures.json").write_text(json.dumps(asdict(self.figures)))

    def _require_printable(self, message: str, data: bytes) -> None:
        if len(message) > MAX_MESSAGE:
            self._found(f"a message of {len(message) // 1000 or 1},000 characters", data, message)
        elif any(0xD800 <= ord(c) <= 0xDFFF for c in message):
            self._found("a message that cannot be printed", data, repr(message))

    def _found(self, name: str, data: bytes, why: str) -> None:
        times = self.figures.failures.get(name, 0)
        self.figures.failures[name] = times + 1
        if times == 0:
            stem = "".join(c if c.isalnum() else "-" for c in name)[:90]
            (self._keep / f"{stem}.input").write_bytes(data)
            (self._keep / f"{stem}.txt").write_text(why, encoding="utf-8", errors="backslashreplace")
            self.note()


def _name(error: BaseException) -> str:
    """What distinguishes a failure from others: its kind, and where in Fieldhand and where at all it came up."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if f"{os.sep}fieldhand{os.sep}" in f.filename] or frames
    places = dict.fromkeys(f"{Path(f.filename).name}:{f.lineno}" for f in (ours[-1], frames[-1]))
    return f"{type(error).__name__} at {' and '.join(places)}"


def fuzz(name: str, given: argparse.Namespace, corpus: Path, keep: Path, seconds: float, seed: int) -> Figures:
    """Fuzz in another process, which may hang or die; what it was at then is kept."""
    command = [sys.executable, __file__, name, "--inside", str(corpus), "--keep", str(keep), "--seed", str(seed)]
    command += ["--minutes", str(seconds / 60), "--limit", str(given.limit), "--memory", str(given.memory)]
    hung = ""
    with (keep / "libfuzzer.log").open("ab") as log:
        try:
            subprocess.run(command, stdout=log, stderr=log, timeout=seconds + 300, check=False)
        except subprocess.TimeoutExpired:
            hung = "the process did not end"
    held = keep / "figures.json"
    found = Figures(**json.loads(held.read_text())) if held.exists() else Figures()
    held.unlink(missing_ok=True)
    if hung:
        found.failures[hung] = 1
    for prefix, what in (("timeout-", "a hang"), ("oom-", "too much memory"), ("crash-", "the process died")):
        for file in keep.glob(f"{prefix}*"):
            found.failures[f"{what}: {file.name}"] = 1
            file.rename(keep / f"kept-{file.name}")
    return found


def inside(name: str, given: argparse.Namespace) -> None:
    """Fuzz in this process until the time is over. Does not return."""
    import atheris

    with atheris.instrument_imports(include=["fieldhand"], exclude=not_watched()):
        from fuzzing.targets import TARGETS
    target = TARGETS[name]
    with tempfile.TemporaryDirectory() as work:
        # What is imported and compiled at the first call counts for no input.
        for seed in target.seeds(Path(work)):
            with suppress(Exception):
                target.read(seed, Path(work))
        reading = Reading(target, Path(given.keep), Path(work))

        def change(data: bytes, max_size: int, seed: int) -> bytes:
            rng = random.Random(seed)
            if rng.random() < 0.15:
                return bytes(atheris.Mutate(data, max_size))
            return target.mutate(data, rng)[:max_size]

        arguments = [
            *(sys.argv[0], str(given.inside), f"-max_total_time={max(1, round(given.minutes * 60))}"),
            *(f"-seed={given.seed}", f"-timeout={given.limit}", f"-rss_limit_mb={given.memory}"),
            *(f"-max_len={MAX_INPUT}", f"-artifact_prefix={given.keep}{os.sep}", "-len_control=0"),
        ]
        atheris.Setup(arguments, reading, custom_mutator=change)
        atheris.Fuzz()


def not_watched() -> list[str]:
    """Every module of Fieldhand that is none of the readers."""
    import fieldhand

    folder = Path(fieldhand.__path__[0])
    files = (path.relative_to(folder.parent).with_suffix("") for path in folder.rglob("*.py"))
    modules = (".".join(file.parts).removesuffix(".__init__") for file in files)
    return [module for module in modules if not module.startswith(READERS)]


def seed_corpus(name: str, corpus: Path, work: Path) -> None:
    """Write the valid documents of a target into a folder."""
    from fuzzing.targets import TARGETS

    for number, data in enumerate(TARGETS[name].seeds(work)):
        (corpus / f"seed-{number}").write_bytes(data)


def main(words: Sequence[str] | None = None) -> int:
    """The command line; status 1 if anything was found."""
    parser = argparse.ArgumentParser(description="Feed a reader with documents that are nearly right.")
    parser.add_argument("target", choices=NAMES)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=int, default=20, help="seconds for one input")
    parser.add_argument("--memory", type=int, default=2048, help="megabytes for the whole process")
    parser.add_argument("--keep", default="", help="folder for what is found (default: a new one)")
    parser.add_argument("--inside", default="", help=argparse.SUPPRESS)
    given = parser.parse_args(words)
    if given.inside:
        inside(given.target, given)
    keep = Path(given.keep or tempfile.mkdtemp(prefix=f"fuzz-{given.target}-"))
    keep.mkdir(parents=True, exist_ok=True)
    figures, began, seed = Figures(), time.monotonic(), given.seed
    with tempfile.TemporaryDirectory() as corpus, tempfile.TemporaryDirectory() as work:
        seed_corpus(given.target, Path(corpus), Path(work))
        while (left := given.minutes * 60 - (time.monotonic() - began)) > 0:
            figures.add(fuzz(given.target, given, Path(corpus), keep, left, seed))
            seed += 1
        grown = len(list(Path(corpus).iterdir()))
    record = {"target": given.target, "seconds": round(time.monotonic() - began), "corpus": grown, **asdict(figures)}
    print(json.dumps(record | {"keep": str(keep)}, indent=1))
    if not figures.failures and not given.keep:
        shutil.rmtree(keep)
    return 1 if figures.failures else 0


if __name__ == "__main__":
    sys.exit(main())
