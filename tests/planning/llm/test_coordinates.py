"""No coordinate of a model's own gets into a plan: the language has none, and names do not smuggle one in."""

from __future__ import annotations

from dataclasses import fields

import pytest

from fieldhand.errors import ModelError
from fieldhand.planning.llm.coordinates import coordinates
from fieldhand.planning.llm.review import AnswerProblem, read_draft, review
from fieldhand.planning.planner import Planned
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from fieldhand.task.codec import TaskDraft
from fieldhand.task.codec_shapes import all_shapes
from fieldhand.testing.scripted_chat import ScriptedChat, planner_of, task_document
from support.sites.grids import grid

HUSKY = load_robot("husky")
ABLE = capabilities_of(HUSKY)
SITE = grid(4, 6)
MEASURED = grid(4, 6, extra={"lat": 37.30009, "Longitude": -120.5, "zone code": "37.12"})
REQUEST = "Take a picture of the first tree."


def problems(plan: str, request: str = REQUEST, site: Site = SITE) -> tuple[AnswerProblem, ...]:
    draft = read_draft(task_document(plan), ABLE)
    if not isinstance(draft, TaskDraft):
        return draft
    return (*review(draft, site, ABLE), *coordinates(draft, request, site))


@pytest.mark.parametrize(
    "place",
    [
        '<point lat="37.12" lon="-120.5"/>',
        '<place x="3.5" y="4.5"/>',
        '<tree-is lat="37.12" lon="-120.5"/>',
        '<first lat="37.12"/>',
        '<trees near="37.12,-120.5"/>',
        '<marker name="start" x="3.5"/>',
        '<marker name="37.12"/>',
        '<corners which="37.12"/>',
        '<within distance-m="5" lat="37.12"><to><here/></to></within>',
        "<at>37.12, -120.5</at>",
        "<first>37.12, -120.5</first>",
        "<coordinates>37.12 -120.5</coordinates>",
    ],
)
def test_a_position_has_no_element_no_attribute_and_no_text(place: str) -> None:
    found = problems(f"<act><take_thermal_picture/><at>{place}</at></act>")
    assert found
    assert {p.kind for p in found} == {"schema"}


@pytest.mark.parametrize(
    "plan",
    [
        '<go-to lat="37.12" lon="-120.5"><first/></go-to>',
        '<act x="1.5" y="2.5"><take_thermal_picture/></act>',
        '<act><take_thermal_picture lat="37.12"/></act>',
        '<go-to to="37.12,-120.5"><first/></go-to>',
    ],
)
def test_a_node_holds_no_position_either(plan: str) -> None:
    assert {p.kind for p in problems(plan)} == {"schema"}


def test_no_field_of_the_plan_language_is_a_position() -> None:
    records = "fieldhand.site.earlier_missions"  # which the program writes
    names = {field.name for cls in all_shapes() if cls.__module__ != records for field in fields(cls)}
    assert not names & {"lat", "lon", "latitude", "longitude", "x", "y", "easting", "northing", "point", "coordinates"}


@pytest.mark.parametrize(
    "plan",
    [
        '<go-to label="37.12,-120.5"><first/></go-to>',
        '<act reading="37.12"><take_thermal_picture/></act>',
        '<act label="37,12"><take_thermal_picture/></act>',
        '<act label="N 37° 18"><take_thermal_picture/></act>',
        '<for-each label="at 37.12"><select><trees/></select><body><act><read_co2/></act></body></for-each>',
        '<go-to><tree-is tree="37.12"/></go-to>',
        '<go-to><take count="1"><in-zone zone="37.12 -120.5"/></take></go-to>',
        '<go-to><take count="1"><in-block block="37.12"/></take></go-to>',
        '<go-to><take count="1"><rows first="37.12" last="37.12"/></take></go-to>',
        '<go-to><take count="1"><where attribute="variety" test="eq" value-as="text" value="37.12"/></take></go-to>',
        '<go-to><take count="1"><where attribute="37.12" test="eq" value="x"/></take></go-to>',
        '<if><condition><tree-has attribute="37.12" test="eq" value="x"/></condition><then><stop/></then></if>',
    ],
)
def test_digits_of_a_position_do_not_hide_in_a_name(plan: str) -> None:
    assert "coordinate" in {p.kind for p in problems(plan)}


@pytest.mark.parametrize("test", ["eq", "gt", "le"])
@pytest.mark.parametrize(("column", "value"), [("lat", "37.3001"), ("Longitude", "-120.4998"), ("longitude", "-120")])
def test_a_column_of_coordinates_is_no_way_to_a_place(column: str, value: str, test: str) -> None:
    plan = f'<go-to><take count="1"><where attribute="{column}" test="{test}" value="{value}"/></take></go-to>'
    assert "coordinate" in {p.kind for p in problems(plan, site=MEASURED)}


def test_a_number_that_the_request_gives_may_stand() -> None:
    plan = '<go-to><take count="1"><where attribute="lat" test="gt" value="37.3"/></take></go-to>'
    said = "Go to a tree whose lat is above 37.3."
    assert "coordinate" not in {p.kind for p in problems(plan, said, MEASURED)}
    assert "coordinate" in {p.kind for p in problems(plan, REQUEST, MEASURED)}


def test_a_name_of_the_site_with_a_point_in_it_may_stand() -> None:
    plan = (
        '<go-to><take count="1"><where attribute="zone code" test="eq" value="37.12" value-as="text"/></take></go-to>'
    )
    assert problems(plan, site=MEASURED) == ()


def test_ordinary_names_are_none() -> None:
    assert problems('<go-to label="tree 4 of row 12"><first/></go-to>') == ()


def test_a_pair_of_numbers_in_an_assumption_is_a_position() -> None:
    document = task_document("<go-to><first/></go-to>")
    head = document.index("<task-composition>")
    said = "<assumption>The first tree is at 37.30012, -120.50031.</assumption>"
    said = f"<command><assumptions>{said}</assumptions></command>"
    draft = read_draft(document[:head] + said + document[head:], ABLE)
    assert isinstance(draft, TaskDraft)
    assert [p.kind for p in coordinates(draft, REQUEST, SITE)] == ["coordinate"]
    converted = read_draft(document[:head] + said.replace("37.30012, -120.50031", "30.5 m") + document[head:], ABLE)
    assert isinstance(converted, TaskDraft)
    assert coordinates(converted, REQUEST, SITE) == ()


def test_the_model_is_told_and_a_plan_that_keeps_it_is_never_given() -> None:
    bad = task_document('<go-to label="37.12,-120.5"><first/></go-to>')
    good = task_document("<act><take_thermal_picture/><at><first/></at></act>")
    chat = ScriptedChat(bad, good)
    assert isinstance(planner_of(chat).plan(REQUEST, SITE, HUSKY), Planned)
    assert "[coordinate] line 4 <go-to>: the label '37.12,-120.5' holds '37.12'" in chat.prompts[1]
    with pytest.raises(ModelError, match="coordinate"):
        planner_of(ScriptedChat(bad)).plan(REQUEST, SITE, HUSKY)
