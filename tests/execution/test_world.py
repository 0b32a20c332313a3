"""World files: what they say is what the simulation gets, and each mistake is one line that names it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldhand.errors import WorldError
from fieldhand.execution.drivers.simulation import world as w
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.drivers.simulation.world_file import MAX_BYTES, load_world, parse_world
from fieldhand.strict_yaml import read_yaml


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "w.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_whole_file_is_read(tmp_path: Path) -> None:
    text = """
readings:
  co2: 380
  wet: true
  canopy_temperature:
    default: 31.5
    trees:
    - {lat: 37.0001, lon: -120.0002, value: 40}
    - {id: 12, value: false}
seed: 7
charge_percent: 64.5
faults:
- {fault: action_fails, action: read_co2, times: 2}
- {fault: sensor_silent, quantity: co2, at: {id: r1c1}}
- {fault: sensor_absurd, quantity: co2, value: 99999}
- {fault: blocked, at: {id: r1c1}, within_m: 2}
- {fault: battery_drains, factor: 3}
- {fault: robot_stops, at_s: 120}
"""
    world = load_world(write(tmp_path, text))
    assert world.readings == {
        "co2": w.Truth(default=380.0),
        "wet": w.Truth(default=1.0),
        "canopy_temperature": w.Truth(
            default=31.5, trees=((w.TreeRef(lat=37.0001, lon=-120.0002), 40.0), (w.TreeRef(id="12"), 0.0))
        ),
    }
    assert (world.seed, world.charge_percent) == (7, 64.5)
    assert world.faults == (
        w.ActionFails(action="read_co2", times=2),
        w.SensorSilent(quantity="co2", at=w.TreeRef(id="r1c1")),
        w.SensorAbsurd(quantity="co2", value=99999.0),
        w.Blocked(at=w.TreeRef(id="r1c1"), within_m=2.0),
        w.BatteryDrains(factor=3.0),
        w.RobotStops(at_s=120.0, why="power cut"),
    )


def test_what_a_file_leaves_out_is_as_in_a_world_without_one(tmp_path: Path) -> None:
    world = load_world(write(tmp_path, "readings: {}\n"))
    assert world.data == b"readings: {}\n"  # a pipe is read once
    assert (world.readings, world.faults, world.seed, world.charge_percent) == ({}, (), 0, 100.0)
    assert World().charge_percent == 100.0


def test_the_example_in_the_docs_is_a_world(tmp_path: Path) -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "formats.md").read_text()
    example = re.search(r"## World file.*?```yaml\n(.*?)```", page, re.DOTALL)
    assert example is not None
    world = load_world(write(tmp_path, example[1]))
    kinds = {type(f) for f in world.faults}
    assert kinds == set(get_args(w.WorldFault))
    assert set(world.readings) == {"co2", "canopy_temperature"}


BAD = {
    "": "is empty",
    "- a": "is not a mapping",
    "a: [": "line 1: is not YAML",
    "seed: 1\nseed: 2": "line 2: is not YAML: the key 'seed' is given twice",
    "seed: 2024-13-45": "is not YAML",
    "seed: \x00": "is not YAML",
    "begins: 0001-01-01T00:00:00+14:00": "begins: the year 1 is not in 2000 to 2999",
    "begins: 9999-12-31T23:59:59-12:00": "is not in 2000 to 2999",
    "faults: [{fault: blocked, at: {id: a}, within_m: 1e308}]": "within_m: must be less than or equal to 100000",
    "faults: [{fault: localisation_lost, at: {id: a}, within_m: 1e308}]": "within_m: must be less than or equal to",
    "readings: {co2: &x 1, b: *x}": "line 1: is not YAML: aliases",
    "x: " + "[" * 5000: "nested too deeply",
    "reading: {co2: 1}": "reading: there is no key 'reading' here; did you mean 'readings'?",
    "readings: 3": "readings: must be a mapping of keys to values",
    "readings: {co2: lots}": "readings.co2: must be a number, true or false, is lots",
    "readings: {co2: .nan}": "readings.co2: must be a number, true or false, is nan",
    "readings: {co2: [1]}": "readings.co2: must be a number, true or false, is a list",
    "readings: {co2: }": "readings.co2: must be a number, true or false, is empty",
    "readings: {co2: {defalt: 3}}": "readings.co2.defalt: there is no key 'defalt' here; did you mean 'default'?",
    "readings: {co2: {trees: [{id: 4, valu: 3}]}}": "readings.co2.trees[0].valu: there is no key 'valu' here; did",
    "readings: {co2: {trees: [{id: 4}]}}": "readings.co2.trees[0]: the key 'value' is missing",
    "readings: {co2: {trees: [{lat: 4, value: 3}]}}": "readings.co2.trees[0]: a tree is named by id, or by lat and lon",
    "readings: {co2: {trees: [{lat: 94, lon: 3, value: 3}]}}": "trees[0].lat: must be less than or equal to 90",
    "faults: {fault: x}": "faults: must be a list, is a mapping",
    "faults: [3]": "faults[0]: must be a mapping of keys to values, is 3",
    "faults: [{action: x}]": "faults[0]: the key 'fault' is missing",
    "faults: [{fault: action_fail, action: x}]": "faults[0]: there is no fault 'action_fail'; did you mean 'action",
    "faults: [{fault: action_fails}]": "faults[0]: the key 'action' is missing",
    "faults: [{fault: action_fails, action: x, time: 2}]": "faults[0].time: there is no key 'time' here; did you mean",
    "faults: [{fault: action_fails, action: x, times: 0}]": "faults[0].times: must be greater than or equal to 1",
    "faults: [{fault: blocked, at: {ids: 4}}]": "faults[0].at.ids: there is no key 'ids' here; did you mean 'id'?",
    "faults: [{fault: battery_drains, factor: 0}]": "faults[0].factor: must be greater than 0",
    "faults: [{fault: robot_stops, at_s: -1}]": "faults[0].at_s: must be greater than or equal to 0",
    "readings: {float: lots}": "readings.float: must be a number, true or false, is lots",
    "readings: {'a[b': {defalt: 3}}": "readings.a[b.defalt: there is no key 'defalt' here; did you mean 'default'?",
    "readings: {co2: {TruthModel: 3}}": "readings.co2.TruthModel: there is no key 'TruthModel' here",
    "readings: {co2: {trees: [{id: 4, value: 3, int: 3}]}}": "readings.co2.trees[0].int: there is no key 'int' here",
    "float: 3": "float: there is no key 'float' here; known here: readings",
    "blocked: 3": "blocked: there is no key 'blocked' here; known here: readings",
    "'a[0]': 3": "there is no key 'a[0]' here; known here: readings",
    "faults: [{fault: robot_stops, at_s: 1, str: 2}]": "faults[0].str: there is no key 'str' here; known here: fault",
    "faults: [{fault: blocked, at: {id: 4, bool: 1}}]": "faults[0].at.bool: there is no key 'bool' here",
    "faults: [{fault: robot_stops, at_s: 1, why: ''}]": "faults[0].why: is empty",
    "faults: [{fault: blocked}]": "faults[0]: give the tree that it is at, or the two trees that it is between",
    "faults: [{fault: blocked, at: {id: 1}, between: [{id: 1}, {id: 2}]}]": "faults[0]: give the tree that it is",
    "faults: [{fault: blocked, at: {id: 1}, from_s: 9, until_s: 9}]": "faults[0]: until_s 9 is not after from_s 9",
    "faults: [{fault: blocked, between: [{id: 1}, {ix: 2}]}]": "faults[0].between[1].ix: there is no key 'ix' here",
    "faults: [{fault: blocked, between: [{id: 1}]}]": "faults[0].between: has 1 of its entries, and needs more",
    "faults: [{fault: localisation_lost}]": "faults[0]: give the time with at_s, in seconds, or the tree with at",
    "faults: [{fault: clock_jumps, at_s: 3}]": "faults[0]: the key 'by_s' is missing",
    "faults: [{fault: clock_jumps, at_s: 3, by_s: .nan}]": "faults[0].by_s",
    "faults: [{fault: disk_full, at_s: -1}]": "faults[0].at_s: must be greater than or equal to 0",
    "begins: 2026-05-01T06:00:00": "begins",
    "begins: yesterday": "begins",
    "seed: -1": "seed: must be greater than or equal to 0",
    "seed: 1.5": "seed: must be a valid integer, is 1.5",
    "charge_percent: 0": "charge_percent: must be greater than 0",
    "charge_percent: 101": "charge_percent: must be less than or equal to 100",
}


@pytest.mark.parametrize(("text", "says"), BAD.items(), ids=[k[:40] for k in BAD])
def test_a_mistake_is_one_line_that_says_where_and_what(tmp_path: Path, text: str, says: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(WorldError) as caught:
        load_world(path)
    line = str(caught.value)
    assert line.startswith(str(path))
    assert says in line
    assert "\n" not in line
    assert caught.value.advice


#: Lines of a file, and what is said of them where they are wrong.
LINES = (
    ("seed: -1", "seed: must be greater than or equal to 0, is -1"),
    ("begins: yesterday", "begins: must be"),
    ("chare: 3", "chare: there is no key 'chare' here (known here:"),
    ("charge_percent: 0", "charge_percent: must be greater than 0, is 0"),
)
READINGS = (
    ("co2: lots", "readings.co2: must be a number, true or false, is lots"),
    ("wet: {defalt: 3, default: x}", "readings.wet.defalt: there is no key 'defalt' here (did you mean 'default'?)"),
    ("ph: {trees: [{id: 4}]}", "readings.ph.trees[0]: the key 'value' is missing"),
)
FAULTS = (
    ("{fault: fly}", "there is no fault 'fly'"),
    ("{fault: blocked}", "give the tree that it is at"),
    ("{fault: robot_stops, at_s: -1}", "at_s: must be greater than or equal to 0, is -1"),
)


@given(st.sets(st.sampled_from(LINES)), st.sets(st.sampled_from(READINGS)), st.lists(st.sampled_from(FAULTS)))
def test_every_mistake_of_a_file_is_said_at_once_with_its_place(
    lines: set[tuple[str, str]], readings: set[tuple[str, str]], faults: list[tuple[str, str]]
) -> None:
    says = [said for _, said in (*lines, *readings)] + [f"faults[{n}" for n, _ in enumerate(faults)]
    says += [said for _, said in faults]
    count = len(lines) + len(readings) + len(faults) + ("wet: {defalt: 3, default: x}" in dict(readings))
    assume(2 <= count <= 10)
    text = [line for line, _ in lines] + ["readings:", "  co: 400", *(f"  {line}" for line, _ in readings)]
    content = read_yaml(
        "\n".join([*text, "faults:", *(f"- {line}" for line, _ in faults), "- {fault: disk_full, at_s: 3}"])
    )
    with pytest.raises(WorldError) as caught:
        parse_world(content, source="w.yaml")
    line = str(caught.value)
    assert line.startswith(f"w.yaml: {count} mistakes: ")
    for said in says:
        assert said in line
    assert "\n" not in line
    assert f"faults[{len(faults)}" not in line


def test_of_very_many_mistakes_ten_are_said_and_the_others_counted() -> None:
    with pytest.raises(
        WorldError, match=r"30 mistakes: faults\[0\]: .*faults\[9\]: .*; and 20 more; see docs"
    ) as caught:
        parse_world({"faults": [3] * 30})
    assert "faults[10]" not in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match=r"cannot be read: No such file"):
        load_world(tmp_path / "missing.yaml")
    with pytest.raises(WorldError, match=r"cannot be read: Is a directory"):
        load_world(tmp_path)
    binary = tmp_path / "b.yaml"
    binary.write_bytes(b"\xff\xfe\x00x")
    with pytest.raises(WorldError, match="is not UTF-8"):
        load_world(binary)
    large = tmp_path / "l.yaml"
    large.write_text("#" * (MAX_BYTES + 1))
    with pytest.raises(WorldError, match="is larger than"):
        load_world(large)
