"""Case files: what they hold becomes what the judge expects, and each mistake in one is named with its place."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.errors import CaseError, InputError
from fieldhand_bench.missions.case_file import load_cases
from fieldhand_bench.missions.case_form import EndForm, ExpectForm
from fieldhand_bench.missions.places import Near, Positions

STEP = {"do": "take_thermal_picture"}
PAST = {"as_of": "2026-01-01T12:00:00+00:00"}
WORLD = {"expect": {"steps": [STEP]}}


def case(**more: Any) -> dict[str, Any]:
    return {"id": "one", "request": "take a picture of tree 7", "worlds": [WORLD]} | more


def expecting(**expect: Any) -> dict[str, Any]:
    return case(worlds=[{"expect": expect}])


def at(**place: Any) -> dict[str, Any]:
    return expecting(steps=[STEP | {"as": "A"}, STEP | {"at": place}])


def write(folder: Path, content: Any) -> str:
    path = folder / "cases.yaml"
    path.write_text(content if isinstance(content, str) else yaml.safe_dump(content))
    return str(path)


def book(*cases: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"site": "builtin:demo", "robot": "husky", "cases": list(cases)} | more


def without(key: str) -> dict[str, Any]:
    return {k: v for k, v in case().items() if k != key}


def test_every_key_of_a_world_arrives_at_the_judge(tmp_path: Path) -> None:
    world = {
        "context": "for people",
        "readings": {"co2": {"default": 400, "trees": [{"id": "7", "value": 380}]}},
        "expect": {
            "order": "any",
            "steps": [
                {"do": "read_co2", "n": 2, "as": "A"},
                {"do": "take_thermal_picture", "at": {"next_to": "A", "not": "A", "ids": [5, 7]}},
            ],
            "max_travel_m": 300,
            "min_steps": 2,
            "status": "returned",
            "end": {"marker": "end"},
        },
    }
    (loaded,) = load_cases([write(tmp_path, book(case(worlds=[world])))])
    expected = loaded.worlds[0].expected
    assert expected.steps is not None
    assert [(s.action, s.captures, s.label) for s in expected.steps] == [
        ("read_co2", 2, "A"),
        ("take_thermal_picture", 1, ""),
    ]
    assert Near("A", 4, adjacent=True) in expected.steps[1].at.demands
    assert Positions(frozenset({5, 7})) in expected.steps[1].at.demands
    assert expected.steps[1].at.words == "{not: [A], next_to: A, ids: [5, 7]}"
    assert (expected.any_order, expected.most_travel_m, expected.least_stops) == (True, 300, 2)
    assert (expected.status, expected.end) == ("returned", "end")
    assert loaded.worlds[0].world.readings["co2"].trees[0][1] == 380


def test_earlier_missions_of_a_case_are_records_in_the_order_of_time(tmp_path: Path) -> None:
    reading = {"name": "co2", "value": 520, "unit": "ppm"}
    late = {"begun": "2025-12-31T08:00:00+00:00", "captures": [{"trees": [3], "outcome": "left_out"}]}
    early = {
        "begun": "2025-12-20T08:00:00+00:00",
        "captures": [{"trees": [7, "8"], "do": "read_co2", "read": [reading]}, {"trees": [9], "do": "read_co2"}],
    }
    earlier = {"as_of": "2026-01-01T12:00:00+00:00", "missions": [late, early]}
    (loaded,) = load_cases([write(tmp_path, book(case(earlier=earlier)))])
    assert loaded.earlier is not None
    first, last = loaded.earlier.missions
    assert [(one.place, one.at[11:16], one.action) for one in first.captures] == [
        ("7", "08:00", "read_co2"),
        ("8", "08:01", "read_co2"),
        ("9", "08:02", "read_co2"),
    ]
    assert [value.value for one in first.captures for value in one.values] == [520.0, 520.0]
    assert [(one.place, one.outcome) for one in last.captures] == [("3", "left_out")]


def test_a_case_names_its_own_site_beside_its_file(tmp_path: Path) -> None:
    tree = {"type": "Feature", "properties": {"kind": "tree"}, "geometry": {"type": "Point", "coordinates": [0.0, 0.0]}}
    other = tree | {"geometry": {"type": "Point", "coordinates": [0.0001, 0.0]}}
    (tmp_path / "two.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [tree, other]}))
    (loaded,) = load_cases([write(tmp_path, {"cases": [case(site="two.geojson", robot="husky")]})])
    assert loaded.site == tmp_path / "two.geojson"
    home = expecting(steps=[], end={"marker": "end"})
    with pytest.raises(CaseError, match="the site has no end marker"):
        load_cases([write(tmp_path, {"cases": [home | {"site": "two.geojson", "robot": "husky"}]})])


def test_the_page_shows_a_file_that_can_be_used_and_names_every_key(tmp_path: Path) -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "bench-missions.md").read_text()
    _, example, rest = page.replace("```yaml", "```").split("```", 4)[2:5]
    assert [case.id for case in load_cases([write(tmp_path, example)])] == ["low-co2", "which-of-two"]
    for key in (*ExpectForm.keys(), *EndForm.keys()):
        assert key in rest, key


BAD = {
    "not YAML": ("cases: [", "line 1: is not YAML"),
    "a key twice": ("site: a\nsite: b\ncases: []", "the key 'site' is given twice"),
    "empty": ("", "holds no cases"),
    "a list": ("- 1", "holds no cases"),
    "no cases": ({"site": "builtin:demo", "robot": "husky"}, "the key 'cases' is missing"),
    "no case at all": (book(), "cases: "),
    "an unknown key of the file": (book(case(), sites="x"), "no key 'sites' here; did you mean 'site'?"),
    "an unknown key of a case": (book(case(requst="x")), "case 'one': there is no key 'requst' here; did you mean"),
    "an unknown key of a world": (book(case(worlds=[WORLD | {"wind": 3}])), "worlds[0]: there is no key 'wind' here"),
    "an unknown key of what is expected": (book(expecting(step=[])), "no key 'step' here; did you mean 'steps'?"),
    "an unknown key of a place": (book(at(corners="nw")), "steps[1].at: there is no key 'corners' here; did you mean"),
    "no id": (book(without("id")), "case 1 of the list: the key 'id' is missing"),
    "no request": (book(without("request")), "the key 'request' is missing"),
    "no worlds": (book(without("worlds")), "the key 'worlds' is missing (or 'ask: true'"),
    "asked in a world": (book(case(ask=True)), "leave out ask or worlds"),
    "nothing expected": (book(case(worlds=[{"readings": {"co2": 1}}])), "the key 'expect' is missing"),
    "nothing said of what must be done": (book(expecting(max_travel_m=5)), "give steps, count_only or worked"),
    "an unknown key of earlier work": (
        book(case(earlier=PAST | {"missions": [{"begun": PAST["as_of"], "captures": [{"tree": [4]}]}]})),
        "no key 'tree'",
    ),
    "earlier work left out, with an action": (
        book(
            case(
                earlier=PAST
                | {
                    "missions": [
                        {"begun": PAST["as_of"], "captures": [{"trees": [4], "do": "read_co2", "outcome": "left_out"}]}
                    ]
                }
            )
        ),
        "give the action under 'do'",
    ),
    "no site": ({"robot": "husky", "cases": [case()]}, "has no site"),
    "a missing site": (book(case(), site="nowhere.geojson"), "there is no site file 'nowhere.geojson'"),
    "a site that is none": (book(case(), site="cases.yaml"), "is not a GeoJSON file"),
    "an unknown built-in site": (book(case(), site="builtin:moon"), "no built-in site 'builtin:moon'"),
    "no robot": ({"site": "builtin:demo", "cases": [case()]}, "has no robot"),
    "an unknown robot": (book(case(), robot="no-such-robot"), "no-such-robot"),
    "an unknown action": (book(expecting(steps=[{"do": "read_co"}])), "no action 'read_co'; did you mean 'read_co2'?"),
    "an unknown action that is counted": (book(expecting(count_only={"dance": [1, 1]})), "no action 'dance'"),
    "a reading of no use": (book(case(worlds=[WORLD | {"readings": {"co2": "much"}}])), "must be a number"),
    "bounds the wrong way": (book(expecting(count_only={"read_co2": [3, 1]})), "the least comes first"),
    "an unknown side": (book(at(half="up")), "steps[1].at.half: must be 'north', 'south', 'east' or 'west', is 'up'"),
    "an unknown label": (book(at(near="B")), "step 2: no earlier step is called 'B'"),
    "a label of a later step": (
        book(expecting(steps=[STEP | {"at": {"same": "A"}}, STEP | {"as": "A"}])),
        "step 1: no",
    ),
    "a label twice": (book(expecting(steps=[STEP | {"as": "A"}] * 2)), "step 2: an earlier step is called 'A'"),
    "a label where none is known": (book(expecting(steps=[], at_all={"near": "A"})), "at_all: no earlier step"),
    "a rank of nothing": (book(at(rank=3)), "'rank' says more about 'next_to or near'"),
    "a tree that is not there": (book(at(ids=[169])), "ids: there is no tree 169"),
    "an attribute that is not there": (book(at(attribute={"leafcolor": "red"})), "did you mean 'leaf_color'?"),
    "a marker for a step": (book(at(marker="end")), "there is no key 'marker' here"),
    "a marker and more": (book(expecting(steps=[], end={"marker": "end", "half": "north"})), "a marker stands alone"),
    "order without steps": (book(expecting(count_only={"read_co2": [1, 1]}, order="any")), "'order' is about steps"),
    "a number that is none": (book(expecting(steps=[], max_travel_m=True)), "must be a number"),
    "the same id twice": (book(case(), case()), "two cases are called 'one'"),
}


@pytest.mark.parametrize(("content", "says"), BAD.values(), ids=BAD)
def test_a_bad_file_of_cases_is_refused_with_what_is_wrong_and_where(content: Any, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        load_cases([write(tmp_path, content)])
    assert says in str(caught.value)


@pytest.mark.parametrize("name", ["nowhere.yaml", "."])
def test_a_file_that_cannot_be_read_is_named(name: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="cannot be read"):
        load_cases([str(tmp_path / name)])


def test_bytes_that_are_no_text_are_named(tmp_path: Path) -> None:
    (tmp_path / "cases.yaml").write_bytes(b"\xff\xfe\x00cases")
    with pytest.raises(CaseError):
        load_cases([str(tmp_path / "cases.yaml")])
