"""Text that a mission is planned, signed or carried out with holds nothing that a person cannot see."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand import mission
from fieldhand.approval.bundle.container import MANIFEST
from fieldhand.errors import BundleError, FieldhandError, ProfileError, RequestError, SiteError, TaskError
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes
from fieldhand.site.loader import load_demo, parse_site
from fieldhand.site.model import Site
from fieldhand.strict_yaml import YamlFault, read_yaml
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Task
from support.missions.signed import good, manifest_of, members_of, opened, signed_with

HIDDEN = (
    "\x9b",
    "\x85",
    "\x7f",
    "\xad",
    "\u200b",
    "\u200d",
    "\u202e",
    "\u2066",
    "\u2028",
    "\ufeff",
    "\ue000",
    "\u3164",
)
hidden = st.sampled_from(HIDDEN)
SITE, HUSKY = load_demo(), load_robot("husky")


def task(request: str = "Read CO2 at tree 4.") -> Task:
    outcome = mission.plan(request, SITE, HUSKY, EnglishPlanner())
    assert isinstance(outcome, Planned)
    return outcome.task


def code(character: str) -> str:
    return f"U+{ord(character):04X}"


def says(error: FieldhandError, character: str) -> None:
    assert code(character) in str(error)
    assert error.advice
    assert character not in str(error)


@pytest.mark.parametrize("character", HIDDEN)
@pytest.mark.parametrize(
    ("element", "before", "after"),
    [
        ("request", "<request>Read", "<request>Re{}ad"),
        ("tree-is", 'tree="4"', 'tree="4{}"'),
        ("command", "<request>", "<assumptions><assumption>Tree 4{}.</assumption></assumptions><request>"),
        ("robot", 'name="husky"', 'name="hus{}ky"'),
    ],
)
def test_a_task_is_refused_with_line_and_element(character: str, element: str, before: str, after: str) -> None:
    document = encode(task()).decode()
    assert before in document, document
    changed = document.replace(before, after.format(character), 1)
    with pytest.raises(TaskError) as refused:
        decode(changed.encode(), source="task.xml")
    says(refused.value, character)
    line = changed[: changed.index(character)].count("\n") + 1
    assert re.match(r"task\.xml, line \d+, <", refused.value.where)
    assert (character != "\x85" and f"line {line}" in refused.value.where) or character == "\x85"


def test_a_line_end_stands_in_the_request_and_in_no_other_text() -> None:
    whole = task("Take a picture of tree 4.\nRead CO2 at tree 5.")
    assert decode(encode(whole)) == whole
    document = encode(whole).decode()
    assumed = "<command><assumptions><assumption>a\nb</assumption></assumptions>"
    for before, after in (('tree="4"', 'tree="4&#10;"'), ("<command>", assumed)):
        with pytest.raises(TaskError, match=r"U\+000A"):
            decode(document.replace(before, after, 1).encode())


@settings(max_examples=40)
@given(st.text(st.characters(codec="utf-8", exclude_characters="\r"), min_size=1))
def test_what_a_task_may_hold_is_what_it_can_be_read_from(text: str) -> None:
    from dataclasses import replace

    given_ = task()
    held = replace(given_, command=replace(given_.command, request=text))
    try:
        document = encode(held)
    except TaskError:
        return
    assert decode(document) == held


@pytest.mark.parametrize("character", HIDDEN)
def test_a_request_is_refused_with_the_place_in_it(character: str) -> None:
    with pytest.raises(RequestError) as refused:
        mission.plan(f"Read{character} CO2 at tree 4.", SITE, HUSKY, EnglishPlanner())
    says(refused.value, character)
    assert "character 5" in refused.value.where


@pytest.mark.parametrize("character", HIDDEN)
def test_yaml_is_refused_with_the_line(character: str) -> None:
    for text in (f'a: 1\nb: "x\\u{ord(character):04x}"', f'a: 1\n"b\\u{ord(character):04x}": 1'):
        with pytest.raises(YamlFault) as refused:
            read_yaml(text)
        assert code(character) in refused.value.what
        assert refused.value.line == 2
    assert read_yaml("a: |\n  one\n  two\n") == {"a": "one\ntwo\n"}


@pytest.mark.parametrize("character", HIDDEN)
def test_a_profile_is_refused_with_the_line(character: str) -> None:
    data, source = profile_bytes("husky")
    text = data.decode()
    escaped = re.sub(r"(?m)^description: .*$", f'description: "a\\\\u{ord(character):04x}"', text, count=1)
    assert escaped != text
    with pytest.raises(ProfileError) as refused:
        parse_profile(escaped.encode(), source=source)
    assert code(character) in str(refused.value)
    assert "line" in refused.value.where


def features(**properties: object) -> list[dict[str, object]]:
    made = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": [-120.0 + 1e-4 * k, 37.0]},
            "properties": {"kind": "tree", "id": str(k)},
        }
        for k in range(3)
    ]
    made[1]["properties"].update(properties)  # type: ignore[attr-defined]
    return made


def site(made: list[dict[str, object]], **whole: object) -> Site:
    return parse_site(json.dumps({"type": "FeatureCollection", "features": made, **whole}).encode(), name="s")


@pytest.mark.parametrize("character", HIDDEN)
@pytest.mark.parametrize("key", ["id", "name", "variety", "row", "kind"])
def test_a_site_is_refused_with_the_feature_and_the_property(key: str, character: str) -> None:
    with pytest.raises(SiteError) as refused:
        site(features(**{key: f"a{character}b"}))
    says(refused.value, character)
    assert "2" in str(refused.value)
    assert key in refused.value.what


@pytest.mark.parametrize("character", HIDDEN)
def test_neither_the_name_of_a_property_nor_that_of_the_site_hides_anything(character: str) -> None:
    with pytest.raises(SiteError) as refused:
        site(features(**{f"a{character}b": 1}))
    says(refused.value, character)
    with pytest.raises(SiteError) as refused:
        site(features(), name=f"Ho{character}me")
    says(refused.value, character)


def test_a_description_on_several_lines_is_read_on_one() -> None:
    made = site(features(note="two\r\n\tlines"))
    assert made.trees[1].properties["note"] == "two lines"


@pytest.mark.parametrize("character", HIDDEN)
def test_the_name_of_a_site_file_hides_nothing(character: str, tmp_path: Path) -> None:
    from fieldhand.site.loader import load_site

    path = tmp_path / f"ho{character}me.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features()}))
    with pytest.raises(SiteError) as refused:
        load_site(path)
    says(refused.value, character)


@pytest.mark.parametrize("character", HIDDEN)
def test_a_bundle_is_refused_whoever_signed_it(character: str) -> None:
    document = members_of(good())["task.xml"].decode()
    changed = document.replace(
        "<request>", f"<assumptions><assumption>a{character}</assumption></assumptions><request>"
    )
    manifest = manifest_of(good())
    sha256 = hashlib.sha256(changed.encode()).hexdigest()
    manifest["files"]["task.xml"] = manifest["task"]["sha256"] = sha256
    with pytest.raises(FieldhandError) as refused:
        opened(signed_with({MANIFEST: json.dumps(manifest).encode(), "task.xml": changed.encode()}))
    says(refused.value, character)
    for key, value in (("request", f"a{character}"), ("confirmed", [f"a{character}"])):
        manifest = manifest_of(good())
        manifest["task" if key == "request" else "approved"][key] = value
        with pytest.raises(BundleError) as refused_bundle:
            opened(signed_with({MANIFEST: json.dumps(manifest).encode()}))
        says(refused_bundle.value, character)
        assert key in str(refused_bundle.value)
