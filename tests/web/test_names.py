"""Names on the page's map: none covers another, none leaves the map, and what matters most is written first."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from random import Random
from typing import Any

import pytest

from support.processes.patience import LONG_S

NODE = shutil.which("node")
UI = Path(__file__).parents[2] / "src" / "fieldhand" / "web" / "ui"
BUNDLER = UI / "node_modules" / "esbuild" / "bin" / "esbuild"
pytestmark = [
    pytest.mark.skipif(NODE is None, reason="no node is installed here"),
    pytest.mark.skipif(not BUNDLER.is_file(), reason="the packages of the page are not installed here"),
]

Box = tuple[float, float, float, float]


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The script as JavaScript."""
    built = tmp_path_factory.mktemp("names") / "names.mjs"
    command = [str(BUNDLER), str(UI / "src" / "map" / "names.ts"), f"--outfile={built}", "--format=esm"]
    subprocess.run(command, capture_output=True, timeout=LONG_S, check=True)
    return built


def run(module: Path, call: str, *given: object) -> Any:
    """Return the result of a function of the script."""
    script = (
        f"import * as names from {json.dumps(str(module))};"
        f"console.log(JSON.stringify(names.{call}(...JSON.parse(process.argv[1]))));"
    )
    assert NODE is not None
    words = [NODE, "--input-type=module", "--eval", script, json.dumps(given)]
    return json.loads(subprocess.run(words, capture_output=True, text=True, timeout=LONG_S, check=True).stdout)


def box(name: dict[str, Any], spot: list[float]) -> Box:
    (x, y), wide, tall = spot, name["width"] / 2, name["height"] / 2
    return (x - wide, y - tall, x + wide, y + tall)


def shares(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


@pytest.mark.parametrize("seed", range(5))
def test_no_name_covers_another_or_leaves_a_phone(seed: int, module: Path) -> None:
    random = Random(seed)
    names = [
        {
            "width": random.uniform(8, 90),
            "height": 14.0,
            "spots": [[random.uniform(0, 390), random.uniform(0, 400)] for _ in range(random.randint(0, 4))],
        }
        for _ in range(300)
    ]
    sign = (100.0, 100.0, 126.0, 126.0)
    found = run(module, "placed", names, [0, 0, 390, 400], [sign])
    boxes = [box(name, spot) for name, spot in zip(names, found, strict=True) if spot]
    assert 20 < len(boxes) < 300
    for k, one in enumerate(boxes):
        assert one[0] >= 0
        assert one[1] >= 0
        assert one[2] <= 390
        assert one[3] <= 400
        assert not any(shares(one, other) for other in (*boxes[:k], sign))
    spots = [spot in name["spots"] for name, spot in zip(names, found, strict=True) if spot]
    assert all(spots)


def test_of_a_long_count_the_ends_and_round_numbers_come_first(module: Path) -> None:
    worth = {number: run(module, "worth", number, 117) for number in (1, 117, 100, 50, 40, 30, 15, 7)}
    assert worth[1] == worth[117] == min(worth.values())
    assert [worth[n] for n in (100, 50, 40, 30, 15, 7)] == sorted({worth[n] for n in (100, 50, 40, 30, 15, 7)})
