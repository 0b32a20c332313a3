"""Each kind of bad input gets one clear line (what, where, what to do), exit status 2, and never a traceback."""

from __future__ import annotations

import json
import os
from itertools import pairwise
from pathlib import Path

import pytest

from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.errors import KeyFileError
from support.processes.command import Run, fieldhand


def is_one_clear_line(run: Run, *words: str) -> bool:
    """One line for the user, holding these words; no traceback."""
    assert run.status == 2, (run.status, run.out, run.err)
    assert "Traceback" not in run.err
    said = [line for line in run.err.splitlines() if line.startswith("fieldhand: ")]
    assert len(said) == 1, run.err
    for word in words:
        assert word.lower() in said[0].lower(), said[0]
    return True


def point(lon: object, lat: object, **properties: object) -> dict[str, object]:
    return {"type": "Feature", "geometry": {"type": "Point", "coordinates": [lon, lat]}, "properties": properties}


def collection(*features: dict[str, object]) -> str:
    return json.dumps({"type": "FeatureCollection", "features": list(features)})


SITES = {
    "empty": ("", "empty"),
    "not JSON": ("{trees: 3", "JSON"),
    "JSON but not GeoJSON": ('{"trees": 3}', "FeatureCollection"),
    "no points": (collection(), "tree"),
    "out of range": (collection(point(-120.0, 137.0), point(-120.0, 37.0)), "feature 1"),
    "swapped": (collection(point(37.2, -120.4), point(37.2, -120.41)), "swapped"),
    "NaN": (collection(point(float("nan"), 37.0)), "feature 1"),
}


@pytest.mark.parametrize("kind", SITES)
def test_a_site_that_cannot_be_used(kind: str, tmp_path: Path) -> None:
    text, word = SITES[kind]
    path = tmp_path / "site.geojson"
    path.write_text(text)
    assert is_one_clear_line(fieldhand("site", str(path)), "site.geojson", word)


def test_a_site_that_is_not_there(tmp_path: Path) -> None:
    assert is_one_clear_line(fieldhand("site", str(tmp_path / "none.geojson")), "none.geojson")


def test_an_unknown_robot_names_those_there_are() -> None:
    assert is_one_clear_line(fieldhand("robot", "husqvarna"), "husqvarna", "husky", "amiga")


HUSKY_KEY = "speed_m_s"


@pytest.mark.parametrize("mend", ["missing", "misspelt"])
def test_a_profile_with_a_key_missing_or_misspelt_names_it(mend: str, tmp_path: Path) -> None:
    from importlib.resources import files

    text = (files("fieldhand.robot") / "profiles" / "husky.yaml").read_text()
    assert HUSKY_KEY in text
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith(HUSKY_KEY))
    lines[at] = "" if mend == "missing" else lines[at].replace(HUSKY_KEY, "sped_m_s")
    path = tmp_path / "mine.yaml"
    path.write_text("\n".join(lines))
    assert is_one_clear_line(fieldhand("robot", str(path)), "mine.yaml", HUSKY_KEY)


ENTITY = '<?xml version="1.0"?><!DOCTYPE t [<!ENTITY e SYSTEM "file:///etc/hostname">]>'
LEVELS = "abcdefghi"
BOMB = (
    '<?xml version="1.0"?><!DOCTYPE t [<!ENTITY a "aaaaaaaaaa">'
    + "".join(f'<!ENTITY {outer} "{f"&{inner};" * 10}">' for inner, outer in pairwise(LEVELS))
    + "]>"
)
DOCUMENTS = {
    "empty": ("", "empty"),
    "malformed": ("<task><plan></task>", "line 1"),
    "an external entity": (ENTITY + "<task>&e;</task>", "entit"),
    "an entity bomb": (BOMB + "<task>&i;</task>", "entit"),
}


@pytest.mark.parametrize("kind", DOCUMENTS)
def test_a_document_that_cannot_be_used(kind: str, tmp_path: Path) -> None:
    text, word = DOCUMENTS[kind]
    path = tmp_path / "task.xml"
    path.write_text(text)
    for command in ("check", "run"):
        assert is_one_clear_line(fieldhand(command, str(path), "--site", "demo"), "task.xml", word)


def test_a_document_with_an_action_that_the_robot_lacks_names_it(tmp_path: Path) -> None:
    path = tmp_path / "task.xml"
    made = fieldhand("plan", "Take a picture of the first tree.", "--site", "demo", "-o", str(path))
    assert made.status == 0, made.err
    path.write_text(path.read_text().replace("take_thermal_picture", "take_x_ray"))
    assert is_one_clear_line(fieldhand("check", str(path), "--site", "demo"), "take_x_ray", "line")


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ("", ["empty"]),
        ("   \n\t ", ["empty"]),
        ("Colorless ideas dream furiously", ["colorless"]),
        ("word " * 20_000, ["100,000", "characters"]),
        ("Take pictures of trees older than 900 years.", ["900"]),
        ("Take a picture of tree 99999.", ["99999"]),
    ],
    ids=["empty", "blank", "nothing understood", "100,000 characters", "selector finds nothing", "no such tree"],
)
def test_a_request_that_cannot_be_used(request_: str, words: list[str]) -> None:
    run = fieldhand("plan", request_, "--site", "demo", "--planner", "english")
    assert is_one_clear_line(run, *words)


def test_a_budget_too_small_to_do_anything_is_not_approved() -> None:
    run = fieldhand(
        "run", "Take pictures of as many trees as you can without driving more than 1 meter.", "--site", "demo", "--yes"
    )
    assert "Traceback" not in run.err
    assert run.status in (1, 2)
    assert "1 m" in run.out + run.err


@pytest.mark.parametrize("speed", ["0", "-1", "nan", "fast"])
def test_a_speed_that_is_none(speed: str) -> None:
    run = fieldhand("run", "Take a picture of the first tree.", "--site", "demo", "--yes", "--speed", speed)
    assert is_one_clear_line(run, "--speed")


def test_nobody_there_to_approve_is_no_approval() -> None:
    run = fieldhand("run", "Take a picture of the first tree.", "--site", "demo")
    assert run.status == 1
    assert "--yes" in run.err
    assert "Traceback" not in run.err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("run",), "fieldhand: run: missing argument 'request'; see fieldhand run --help"),
        (("fly",), "fieldhand: no such command 'fly'; see fieldhand --help"),
        (("keys", "lend"), "fieldhand: keys: no such command 'lend'; see fieldhand keys --help"),
        (("robot", "husky", "--xml", "a"), "fieldhand: robot show: no such option: --xml"),
        (("plan", "--site"), "requires an argument"),
        (("run", "Read CO2 at tree 4.", "--site", "demo", "--seed", "-1"), "invalid value for '--seed'"),
        (("run", "Read", "CO2", "--site", "demo"), "unexpected extra argument"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_a_command_that_is_called_as_it_cannot_be(words: tuple[str, ...], says: str) -> None:
    run = fieldhand(*words)
    assert is_one_clear_line(run, says, "; see fieldhand ", "--help")
    assert (run.out, run.err.count("\n")) == ("", 1)


def test_without_a_command_the_help_is_shown_and_nothing_else() -> None:
    run = fieldhand()
    assert (run.status, run.err) == (2, "")
    assert "demo" in run.out


@pytest.mark.parametrize(
    ("begins", "says"),
    [
        (b"Take a picture.", ["a file", '"$(cat it.txt)"']),
        (b"", ["a file"]),
        (b"\xff\x00", ["a file"]),
        (b"\xef\xbb\xbf <Task/>", ["an XML file", "(.xml)"]),
        (b"PK\x03\x04", ["a zip file", "(.mission)"]),
        (b'{"type": "FeatureCollection"}', ["a JSON file", "--site", "report"]),
    ],
    ids=["words", "empty", "binary", "XML", "zip", "JSON"],
)
def test_the_name_of_a_file_is_no_request(begins: bytes, says: list[str], tmp_path: Path) -> None:
    (tmp_path / "it.txt").write_bytes(begins)
    for command in ("run", "plan"):
        run = fieldhand(command, "it.txt", "--site", "demo", cwd=tmp_path)
        assert is_one_clear_line(run, "it.txt: is ", "not what the robot should do", *says)


@pytest.mark.parametrize(
    ("variable", "words"),
    [
        ("FIELDHAND_CONFIG", ("keys", "list")),
        ("XDG_CONFIG_HOME", ("keys", "new", "--name", "Ada")),
        ("FIELDHAND_MISSIONS", ("status",)),
        ("XDG_STATE_HOME", ("run", "Read CO2 at tree 4.", "--site", "demo", "--yes")),
        ("FIELDHAND_OUTBOX", ("outbox",)),
    ],
)
def test_a_file_where_the_environment_has_to_name_a_folder(
    variable: str, words: tuple[str, ...], tmp_path: Path
) -> None:
    usual = ("FIELDHAND_CONFIG", "XDG_CONFIG_HOME", "FIELDHAND_MISSIONS", "XDG_STATE_HOME", "FIELDHAND_OUTBOX")
    env = {name: value for name, value in os.environ.items() if name not in usual}
    (tmp_path / "file").touch()
    run = fieldhand(*words, cwd=tmp_path, env=env | {variable: "file"})
    assert is_one_clear_line(run, f"{variable}: file is a file, not a folder", "give a folder")
    assert run.out == ""


def test_a_terminal_that_cannot_show_every_sign_still_gets_an_answer() -> None:
    run = fieldhand("robot", "husky", env=dict(os.environ) | {"PYTHONIOENCODING": "ascii"})
    assert run.status == 0, run.err
    plan = fieldhand(
        "plan", "Read CO2 at tree 5.", "--site", "demo", env=dict(os.environ) | {"PYTHONIOENCODING": "ascii"}
    )
    assert plan.status == 0, plan.err
    assert "CO?" in plan.out


def test_a_file_without_end_is_not_read_to_its_end() -> None:
    assert is_one_clear_line(fieldhand("check", "/dev/zero", "--site", "demo"), "/dev/zero", "larger than")


def test_a_signed_mission_is_written_to_a_file_and_not_approved_again(tmp_path: Path) -> None:
    words = ("approve", "Read CO2 at tree 4.", "--site", "demo", "--yes")
    assert is_one_clear_line(fieldhand(*words, "-o", str(tmp_path / "a.zip")), "ends in .mission", "write it to", "a.m")
    env = dict(os.environ) | {"FIELDHAND_CONFIG": str(tmp_path)}
    assert fieldhand("keys", "new", "--name", "Ada", env=env).status == 0
    again = fieldhand("approve", "a.mission", "--site", "demo", "-o", "b.mission", "--yes", cwd=tmp_path, env=env)
    assert is_one_clear_line(again, "a.mission: is a signed mission", "inspect")


def test_a_folder_of_keys_that_cannot_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(self: Path) -> bool:
        raise PermissionError(13, "Permission denied", str(self))

    monkeypatch.setattr(Path, "exists", refused)
    with pytest.raises(KeyFileError, match="keys: cannot be read: Permission denied; check the permissions"):
        SigningKeys(tmp_path).held()
