"""What ``scripts/fuzz.py`` feeds to the readers: a few of it with every run of the tests."""

from __future__ import annotations

import random
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from fieldhand.errors import FieldhandError

sys.path.insert(0, str(Path(__file__).parents[1] / "scripts"))
from fuzz import NAMES
from fuzzing.targets import TARGETS

TRIES = 12


def test_every_target_has_a_name_to_ask_for() -> None:
    assert tuple(TARGETS) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_documents_that_are_nearly_right_are_read_or_refused(name: str, tmp_path: Path) -> None:
    target = TARGETS[name]
    seeds, rng, changed = target.seeds(tmp_path), random.Random(name), 0
    for number in range(TRIES):
        data = target.mutate(seeds[number % len(seeds)], rng)
        changed += data not in seeds
        with suppress(FieldhandError):
            target.read(data, tmp_path)
    assert changed > TRIES / 3
    if name != "key":  # a key is read as three kinds of files, and is one of them
        for seed in seeds:
            target.read(seed, tmp_path)
