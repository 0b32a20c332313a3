"""A profile is read as it stands, or refused in one line that says which file, which key and what to do."""

from __future__ import annotations

import copy
import hashlib
import re
from dataclasses import replace
from importlib import resources
from pathlib import Path

import pytest
import yaml

from fieldhand.errors import ProfileError
from fieldhand.robot.fields import Keyed
from fieldhand.robot.loader import MAX_BYTES, load_changed, load_robot, parse_profile, profile_bytes, robot_names
from fieldhand.robot.model import LevelThreshold, Parameter
from support.processes.command import fieldhand

ROVER = {
    "name": "rover",
    "speed_m_s": 1,
    "width_m": 0.5,
    "energy": {"capacity_j": 1e6, "drive_j_per_m": 50, "idle_w": 10, "reserve_percent": 20},
    "leg_cost": {"alpha": 0.5},
    "quantities": {
        "co2": {
            "unit": "ppm",
            "words": ["CO2", "carbon dioxide"],
            "levels": {"low": {"below": 400}, "very high": {"above": 900}},
            "minimum": 0,
            "maximum": 5000,
            "typical": 410,
            "spread": 20,
        }
    },
    "actions": {
        "read_co2": {
            "words": ["co2 reading"],
            "measures": ["co2"],
            "parameters": {
                "height_m": {"default": 1, "minimum": 0.5, "maximum": 2, "unit": "m"},
                "mode": {"default": "fast", "choices": ["fast", "slow"]},
            },
            "duration_s": 5,
            "energy_j": 100,
        }
    },
}


def changed(path: str, value: object) -> dict:
    """ROVER with one key changed, or taken out if the value is ``...``."""
    document = copy.deepcopy(ROVER)
    *parents, last = path.split(".")
    inside = document
    for key in parents:
        inside = inside[key]
    if value is ...:
        del inside[last]
    else:
        inside[last] = value
    return document


def refused(data: bytes) -> str:
    with pytest.raises(ProfileError) as error:
        parse_profile(data, source="rover.yaml")
    message = str(error.value)
    assert message.startswith("rover.yaml")
    assert "\n" not in message
    assert error.value.advice
    return message


def test_a_profile_of_the_users_own_is_read_from_its_path(tmp_path):
    path = tmp_path / "rover.yaml"
    path.write_text(yaml.safe_dump(ROVER))
    robot = load_robot(str(path))
    assert robot.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert robot.source == str(path)
    assert robot.quantity["co2"].words == ("co2", "carbon dioxide")
    assert robot.quantity["co2"].levels == {
        "low": LevelThreshold(direction="below", value=400),
        "very high": LevelThreshold(direction="above", value=900),
    }
    assert robot.action["read_co2"].parameters == (
        Parameter(name="height_m", kind="number", default=1, minimum=0.5, maximum=2, unit="m"),
        Parameter(name="mode", kind="choice", default="fast", choices=("fast", "slow")),
    )
    assert robot.percent(metres=100, seconds=100, action_j=4000) == pytest.approx(1.0)


def test_the_profile_in_the_docs_can_be_used():
    page = (Path(__file__).resolve().parents[2] / "docs" / "add-a-robot.md").read_text()
    robot, camera, over_ros2 = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    assert parse_profile(robot.encode()).action["read_soil_salinity"].measures == ("soil_salinity",)
    reached = parse_profile(f"{robot}\n{over_ros2}".encode()).ros2
    assert reached.actions["read_soil_salinity"].call.readings["soil_salinity"].scale == 10
    values, more = yaml.safe_load(robot), yaml.safe_load(camera)
    values["actions"]["take_picture"] |= more.pop("actions")["take_picture"]
    looking = parse_profile(yaml.safe_dump(values | more).encode())
    assert looking.turn_deg_s == 45
    assert looking.action["take_picture"].camera.side == "right"


def test_every_key_of_a_profile_is_in_the_docs():
    page = (Path(__file__).resolve().parents[2] / "docs" / "formats.md").read_text()
    table = page.partition("## Robot profile")[2].partition("\n## ")[0]
    documents = Keyed.__subclasses__()
    for document in documents:
        documents += document.__subclasses__()
        for key in document.model_fields:
            assert re.search(rf"`[^`\n]*\b{key}\b", table), key


def test_the_hash_is_of_the_bytes_and_a_comment_changes_it():
    data = yaml.safe_dump(ROVER).encode()
    assert parse_profile(data).sha256 != parse_profile(data + b"# mine\n").sha256


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_a_byte_order_mark_does_not_matter(mark):
    assert parse_profile(mark + yaml.safe_dump(ROVER).encode()).name == "rover"


@pytest.mark.parametrize(
    ("path", "value", "expected"),
    [
        ("speed_m_s", ..., "rover.yaml: the key 'speed_m_s' is missing; add it"),
        ("energy.idle_w", ..., "rover.yaml: energy: the key 'idle_w' is missing"),
        ("quantities.co2.unit", ..., "rover.yaml: quantities.co2: the key 'unit' is missing"),
        ("actions.read_co2.words", ..., "rover.yaml: actions.read_co2: the key 'words' is missing"),
        ("speed", 1, "unknown key 'speed'; did you mean 'speed_m_s'?"),
        ("energy.capacity_J", 1, "rover.yaml: energy: unknown key 'capacity_J'; did you mean 'capacity_j'?"),
        ("actions.read_co2.mesures", [], "actions.read_co2: unknown key 'mesures'; did you mean 'measures'?"),
        ("leg_cost.zzz", 1, "leg_cost: unknown key 'zzz'; the keys here are alpha"),
        ("speed_m_s", 1e-320, "speed_m_s: 9.99989e-321 is too small"),
        ("energy.capacity_j", 1e308, "energy.capacity_j: 1e+308 is too large"),
        ("standoff_m", 1e6, "standoff_m: must be less than or equal to 100, is 1000000"),
        ("quantities.co2.typical", 10**400, "is not YAML: the number is too large"),
        ("a" * 10_000, 1, "unknown key 'aaaa"),
        ("speed_m_s", 0, "rover.yaml: speed_m_s: must be greater than 0, is 0"),
        ("speed_m_s", "fast", "speed_m_s: must be a number, is fast; correct the number"),
        ("speed_m_s", True, "speed_m_s: must be a number, not true"),
        ("speed_m_s", [1], "speed_m_s: must be a number, is a list"),
        ("width_m", float("inf"), "width_m: must be a finite number, is inf"),
        ("width_m", float("nan"), "width_m: must be a finite number, is nan"),
        ("retries", 1.5, "retries: must be a whole number, is 1.5"),
        ("retries", -1, "retries: must be greater than or equal to 0, is -1"),
        ("energy", 5, "energy: must be a mapping of keys to values, is 5"),
        ("energy.reserve_percent", 100, "energy.reserve_percent: must be less than 100, is 100"),
        ("leg_cost.alpha", 1.1, "leg_cost.alpha: must be less than or equal to 1, is 1.1"),
        ("name", "My Rover", "name: 'My Rover' is not a name: use lower-case letters"),
        ("name", 5, "name: must be text, is 5"),
        ("actions", {}, "actions: is empty; list at least one"),
        ("actions", [], "actions: must be a mapping of keys to values, is a list"),
        ("actions.Read", ROVER["actions"]["read_co2"], "actions.Read: 'Read' is not a name"),
        ("actions.at", ROVER["actions"]["read_co2"], "an action cannot be called 'at'"),
        ("actions.read_co2.measures", ["co"], "action 'read_co2' measures 'co'; the quantities here are co2"),
        ("actions.read_co2.measures", ["co2", "co2"], "actions.read_co2.measures: 'co2' is given twice here"),
        ("actions.read_co2.words", [], "actions.read_co2.words: is empty; list at least one"),
        ("actions.read_co2.words", "co2", "actions.read_co2.words: must be a list, is co2"),
        ("actions.read_co2.words", [True], "actions.read_co2.words.0: must be text, is True; put it in quotes"),
        ("actions.read_co2.words", ["a  b"], "'a  b' is not a word or words"),
        ("actions.read_co2.duration_s", 0, "actions.read_co2.duration_s: must be greater than 0"),
        ("actions.read_co2.parameters.mode.default", "best", "default 'best' is not one of fast, slow"),
        ("actions.read_co2.parameters.mode.choices", ["10"], "'10' is not a choice"),
        ("actions.read_co2.parameters.mode.minimum", 1, "a parameter has choices, or a minimum, maximum and unit"),
        ("actions.read_co2.parameters.height_m.default", 3, "default 3 is not within 0.5 and 2"),
        ("actions.read_co2.parameters.height_m.default", "low", "default 'low' is not a number"),
        ("actions.read_co2.parameters.height_m.minimum", 2, "minimum 2 is not below maximum 2"),
        ("quantities.co2.minimum", 5000, "quantities.co2: minimum 5000 is not below maximum 5000"),
        ("quantities.co2.typical", 6000, "quantities.co2: typical 6000 is not within 0 and 5000"),
        ("quantities.co2.spread", -1, "quantities.co2.spread: must be greater than or equal to 0"),
        ("quantities.co2.unit", "parts per million", "'parts per million' is not a unit"),
        ("quantities.co2.levels.low", {"below": -1}, "the threshold -1 of 'low' is not within 0 and 5000"),
        ("quantities.co2.levels.low", {}, "quantities.co2.levels.low: give either below or above"),
        ("quantities.co2.levels.low", {"below": 1, "above": 2}, "give either below or above"),
        ("quantities.co2.levels.low", {"under": 1}, "unknown key 'under'"),
        ("quantities.co2.levels.Low", {"below": 1}, "'Low' is not a level word"),
    ],
)
def test_a_wrong_key_is_named_with_its_path(path, value, expected):
    assert expected in refused(yaml.safe_dump(changed(path, value)).encode())


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", "is empty"),
        (b"# later\n", "is empty"),
        (b"- a\n- b\n", "is not a mapping"),
        (b"husky", "is not a mapping"),
        (b"name: rover\nenergy: {a: 1\n", "line 3: is not YAML"),
        (b"name: rover\nname: husky\n", "line 2: is not YAML: the key 'name' is given twice"),
        (b"a: &x [1]\nb: *x\n", "line 2: is not YAML: aliases (*name) are not allowed"),
        (b"a: !!python/object/apply:os.system ['true']\n", "line 1: is not YAML: could not determine a constructor"),
        (b"a: 2001-99-99\n", "is not YAML"),
        (b"? [a, b]\n: 1\n", "is not YAML: "),
        (b"\x00\x01", "is not YAML"),
        (b"\xff\xfe", "is not UTF-8"),
        (b"[" * 5000, "is nested too deeply"),
        (b" " * (MAX_BYTES + 1), "is larger than"),
        (b"1: 2\n", "unknown key '1'"),
    ],
)
def test_what_is_no_profile_is_refused(data, expected):
    assert expected in refused(data)


def test_more_problems_than_one_are_all_told():
    document = changed("speed_m_s", -1)
    document["width_m"] = -1
    assert (
        "speed_m_s: must be greater than 0, is -1 (and 1 more after it: width_m: must be greater than 0, is -1)"
        in refused(yaml.safe_dump(document).encode())
    )


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("huskey", "no robot or profile file 'huskey'; did you mean 'husky'? The installed robots are amiga, husky"),
        ("no/such.yaml", "no robot or profile file 'no/such.yaml'; The installed robots are"),
        ("", "is not a file"),
        ("x" * 5000, "cannot be read"),
        ("a\0b", "no robot or profile file"),
    ],
)
def test_an_unknown_robot_is_refused_with_the_known_ones(name, expected):
    with pytest.raises(ProfileError) as error:
        load_robot(name)
    assert expected in str(error.value)
    assert len(str(error.value)) < 300


def test_a_folder_and_a_large_file_are_refused(tmp_path):
    with pytest.raises(ProfileError, match="is not a file; give the path"):
        load_robot(str(tmp_path))
    large = tmp_path / "large.yaml"
    large.write_bytes(b" " * (MAX_BYTES + 1))
    with pytest.raises(ProfileError, match="larger than"):
        load_robot(str(large))


def test_the_builtin_robots_are_those_of_the_design():
    assert robot_names() == ("amiga", "husky", "tractor")


def test_labels_are_read_by_language() -> None:
    text = (resources.files("fieldhand.robot") / "profiles" / "husky.yaml").read_text()
    changed = text.replace("\n  read_co2:\n", "\n  read_co2:\n    labels: {es: medir el CO2}\n")
    assert parse_profile(changed.encode()).action["read_co2"].labels == {"es": "medir el CO2"}
    for bad in ("{Spanish: x}", '{es: ""}', '{es: "a\\nb"}'):
        with pytest.raises(ProfileError, match="labels"):
            parse_profile(text.replace("\n  read_co2:\n", f"\n  read_co2:\n    labels: {bad}\n").encode())


def test_a_built_in_profile_is_written_out_as_it_stands(tmp_path: Path) -> None:
    assert fieldhand("robot", "amiga", "--yaml", "mine.yaml", cwd=tmp_path).status == 0
    assert (tmp_path / "mine.yaml").read_bytes() == profile_bytes("amiga")[0]


def test_changed_keys_give_a_profile_of_its_own() -> None:
    husky = load_robot("husky")
    changed = load_changed("husky", {"energy": {"capacity_j": 500_000.0}, "retries": None})
    assert changed.energy == replace(husky.energy, capacity_j=500_000.0)
    assert changed.sha256 != husky.sha256
    assert changed == replace(
        husky, energy=changed.energy, sha256=changed.sha256, source=changed.source, retries=changed.retries
    )


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"energy": {"capacity_j": -1}}, "energy.capacity_j"),
        ({"energi": {"capacity_j": 1}}, "energi"),
        ({"energy": 3}, "energy"),
        ({"energy": {"capacity_j": object()}}, "cannot express"),
    ],
)
def test_changes_are_checked_like_a_file(changes: dict[str, object], expected: str) -> None:
    with pytest.raises(ProfileError) as caught:
        load_changed("husky", changes)
    assert expected in str(caught.value)
    assert "husky" in str(caught.value)
