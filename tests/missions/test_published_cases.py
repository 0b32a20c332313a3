"""The published requests end as they were meant, judged by a referee that knows nothing of this package.

The cases and the referee stand beside the project, not in it; without them there is nothing to judge by.
"""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import yaml

from flights import fly_request

SHARED = Path(__file__).resolve().parents[3] / "shared"
CASES = SHARED / "data" / "missions" / "orchard.yaml"
WANTED = (
    "corners-relative",
    "corners-absolute",
    "north-center-east",
    "five-nested-ifs",
    "if-else-nested",
    "four-trees-two-sensors",
    "relative-absolute",
    "reward",
    "yellow-north",
)


def cases() -> list[Any]:
    if not CASES.exists():
        return [pytest.param(None, 0, "", marks=pytest.mark.skip(reason="the published cases are not here"))]
    book = yaml.safe_load(CASES.read_text())
    return [
        pytest.param(case, k, book["site"], id=f"{case['id']}[{k}]")
        for case in book["cases"]
        if case["id"] in WANTED
        for k in range(len(case["worlds"]))
    ]


@pytest.fixture(scope="module")
def referee() -> ModuleType:
    spec = importlib.util.spec_from_file_location("referee", SHARED / "tools" / "referee.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(("case", "world", "default_site"), cases())
def test_ends_as_it_was_meant(case: dict[str, Any], world: int, default_site: str, referee: ModuleType) -> None:
    site = (CASES.parent / case.get("site", default_site)).resolve()
    meant = case["worlds"][world]
    flight = fly_request(
        case["request"], site=str(site), robot=case.get("robot", "husky"), readings=meant.get("readings", {})
    )
    events = [json.loads(line) for line in flight.lines]
    assert referee.judge(referee.Site(site), meant["expect"], events) is None
