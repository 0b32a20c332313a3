"""Review: a good draft passes unchanged; each way to be wrong is told with its kind and its line."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings

from fieldhand.planning.llm.review import AnswerProblem, read_draft, review
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.build import number
from fieldhand.task.codec import TaskDraft, encode
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.testing.generated.tasks import ROVER, Parts
from support.sites.grids import grid

SITE = grid(4, 6)
AMIGA = capabilities_of(load_robot("amiga"))
XMLNS = ' xmlns="urn:fieldhand:task:1"'


def document(plan: str, xmlns: str = XMLNS) -> str:
    return f"<task{xmlns}>\n<task-composition>\n<plan>\n{plan}\n</plan>\n</task-composition>\n</task>"


def problems(plan: str) -> tuple[AnswerProblem, ...]:
    draft = read_draft(document(plan), AMIGA)
    return draft if isinstance(draft, tuple) else review(draft, SITE, AMIGA)


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
@given(task=Parts(ROVER).tasks())
def test_a_valid_task_is_read_as_the_plan_that_it_holds_but_for_ids_and_spans(task: Task) -> None:
    draft = read_draft(encode(task).decode().partition("\n")[2], ROVER)
    assert isinstance(draft, TaskDraft), draft
    assert [type(n) for n in walk(draft.plan)] == [type(n) for n in walk(task.composition.plan)]
    assert all(not n.said for n in walk(draft.plan))
    ids = [n.id for n in walk(draft.plan)]
    assert len(set(ids)) == len(ids)
    assert [n.id for n in walk(number(draft.plan))] == [n.id for n in walk(task.composition.plan)]
    budgets = tuple(replace(budget, said=()) for budget in task.constraints.budgets)
    avoid = tuple(replace(one, said=()) for one in task.constraints.avoid)
    gates = tuple(replace(one, said=()) for one in task.constraints.only_gates)
    slow = tuple(replace(one, said=()) for one in task.constraints.slow)
    bare = replace(task.constraints, budgets=budgets, reserve_said=(), avoid=avoid, only_gates=gates, slow=slow)
    assert draft.constraints == bare


def test_a_forgotten_namespace_is_added() -> None:
    plan = "<act><take_picture/><at><first/></at></act>"
    with_it, without = read_draft(document(plan), AMIGA), read_draft(document(plan, xmlns=""), AMIGA)
    assert isinstance(with_it, TaskDraft)
    assert with_it == without


def test_a_wrong_namespace_is_not_passed_over() -> None:
    found = read_draft(document("<stop/>", xmlns=' xmlns="urn:other"'), AMIGA)
    assert isinstance(found, tuple)
    assert found[0].kind == "schema"


@pytest.mark.parametrize(
    ("plan", "kind", "where", "words"),
    [
        ("<act><prune/><at><first/></at></act>", "schema", "line 4", "prune"),
        ("<act><take_picture/>\n<at><nord/></at></act>", "schema", "line 5", "nord"),
        ('<act><take_picture zoom="3"/></act>', "schema", "line 4", "zoom"),
        ("<sequence>\n<act><take_picture></act></sequence>", "schema", "line 5", "well-formed"),
        (
            '<if><condition><compare reading="r" test="lt"><soil_moisture value="15" unit="percent"/></compare>'
            "</condition>"
            "<then><act><take_picture/></act></then></if>",
            "reference",
            "",
            "'r'",
        ),
        ('<go-to><bound label="x"/></go-to>', "reference", "", "'x'"),
        ('<go-to><take count="1"><in-zone zone="pond"/></take></go-to>', "site", "line 4 <go-to>", "pond"),
        ('<go-to><tree-is tree="999"/></go-to>', "site", "line 4 <go-to>", "999"),
        ('<go-to><marker name="charger"/></go-to>', "site", "line 4 <go-to>", "charger"),
        (
            '<for-each><select><top attribute="species" count="1"/></select><body><stop/></body></for-each>',
            "site",
            "line 4 <for-each>",
            "species",
        ),
        (
            '<for-each><select><where attribute="age" test="gt" value="99"/></select><body><stop/></body></for-each>',
            "site",
            "line 4 <for-each>",
            "age",
        ),
        (
            '<for-each reward="nuts"><select><trees/></select><body><stop/></body></for-each>',
            "site",
            "line 4 <for-each>",
            "variety",
        ),
        (
            '<if><condition><tree-has attribute="height" test="gt" value="2"/></condition>'
            "<then><act><take_picture/></act></then></if>",
            "site",
            "line 4 <if>",
            "height",
        ),
        (
            '<go-to><in-row first="1" last="1"><rows first="9" last="9"/></in-row></go-to>',
            "site",
            "line 4 <go-to>",
            "9",
        ),
        (
            '<for-each><select><spaced apart-m="30" count="9" zone="wet corner"/></select><body><stop/></body>'
            "</for-each>",
            "site",
            "line 4 <for-each>",
            "fit",
        ),
        ('<go-to><take count="1"><successive count="40"/></take></go-to>', "site", "line 4 <go-to>", "40"),
        ("<act><take_picture/><at><rows/></at></act>", "site", "line 4 <act>", "for-each"),
        ("<act><take_picture/><at><corners/></at></act>", "site", "line 4 <act>", "for-each"),
        ("<act><take_picture/><at><other/></at></act>", "site", "line 4 <act>", "for-each"),
    ],
)
def test_what_is_wrong_is_told_with_its_kind_and_place(plan: str, kind: str, where: str, words: str) -> None:
    found = problems(plan)
    assert [p.kind for p in found] == [kind] * len(found)
    assert found
    assert any(p.where.startswith(where) and words in str(p) for p in found), found
    assert all("\n" not in str(p) for p in found)


def test_a_static_part_of_a_relative_selector_is_checked_too() -> None:
    found = problems('<go-to><nearest><to><here/></to><of><in-zone zone="pond"/></of></nearest></go-to>')
    assert [p.kind for p in found] == ["site"]


@pytest.mark.parametrize(
    "selector",
    [
        '<corners which="nw"/>',
        '<take count="1"><other/></take>',
        "<first><other/></first>",
        '<in-row first="2" last="2"><row-of/></in-row>',
        '<in-row first="-1" last="-1"><rows first="2" last="2"/></in-row>',
        '<along-row trees="2"><here/></along-row>',
        "<across/>",
        '<nearest fresh="true"><to><here/></to></nearest>',
        '<where attribute="Variety" test="eq" value="kerman"><corners which="nw"/></where>',
    ],
)
def test_a_selector_that_gives_one_place_may_be_where_an_act_is_done(selector: str) -> None:
    assert problems(f"<act><take_picture/><at>{selector}</at></act>") == ()


@pytest.mark.parametrize(
    "selector",
    [
        '<nearest fresh="true"><to><in-zone zone="pond"/></to></nearest>',
        '<nearest><to><in-zone zone="pond"/></to><of><other/></of></nearest>',
        '<farthest><origin><in-zone zone="pond"/></origin><of><other/></of></farthest>',
    ],
)
def test_a_zone_without_trees_is_something_to_measure_from(selector: str) -> None:
    draft = read_draft(document(f"<act><take_picture/><at>{selector}</at></act>"), AMIGA)
    assert isinstance(draft, TaskDraft)
    assert review(draft, open_site("demo"), AMIGA) == ()


@pytest.mark.parametrize(
    "selector",
    [
        '<top attribute="age" count="99"/>',
        '<spaced apart-m="30" count="9" zone="wet corner"/>',
        '<apart apart-m="90" count="5"><rows first="2" last="2"/></apart>',
        '<points-in zone="wet corner" count="99999"/>',
        '<rows first="1" last="1" every="0"/>',
        '<row-of over="40"><origin><tree-is tree="1"/></origin></row-of>',
        '<nearest><to><union><tree-is tree="1"/></union></to><of><in-block block="9"/></of></nearest>',
        '<along-row trees="1"><trees/></along-row>',
    ],
)
def test_no_problem_asks_for_another_request(selector: str) -> None:
    found = problems(f"<for-each><select>{selector}</select><body><stop/></body></for-each>")
    assert found
    for problem in found:
        assert not re.search(r"\b(?:ask for|say |name one)", problem.message), problem


def test_the_values_that_there_are_are_told_where_a_group_lacks_one() -> None:
    select = '<where attribute="variety" test="eq" value="Golden Hills"><half side="west"/></where>'
    found = problems(f"<for-each><select>{select}</select><body><stop/></body></for-each>")
    assert "the values are Kerman" in found[0].message


def test_too_few_trees_apart_are_told_with_their_row_and_its_length() -> None:
    apart = '<apart apart-m="90" count="5"><rows first="2" last="2"/></apart>'
    found = problems(f"<for-each><select>{apart}</select><body><stop/></body></for-each>")
    assert "in row 2: it has 6 trees over 25 m" in found[0].message


def test_a_zone_to_measure_from_has_to_be_one_of_the_site() -> None:
    found = problems('<go-to><nearest fresh="true"><to><in-zone zone="lake"/></to></nearest></go-to>')
    assert [p.kind for p in found] == ["site"]
    assert "lake" in str(found[0])


def test_problems_of_two_nodes_on_one_line_are_two() -> None:
    found = problems('<sequence><go-to><tree-is tree="999"/></go-to><go-to><tree-is tree="999"/></go-to></sequence>')
    assert [p.where for p in found] == ["line 4 <go-to>", "line 4 <go-to> no. 2"]


def test_entities_are_refused() -> None:
    bomb = '<!DOCTYPE task [<!ENTITY a "aaaa">]>' + document("<stop/>")
    found = read_draft(bomb, AMIGA)
    assert isinstance(found, tuple)
    assert found[0].kind == "schema"
